// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/word_reader.h"
#include "vera/scene/horizon_profile.h"

#include <optional>

namespace vera {

/// n a1 h1 ... an hn | MOUNTAINS seed height roughness
/// What follows PROFILE. Returns nothing, and has complained, when it cannot be used.
std::optional<HorizonProfile> read_profile(WordReader& words);

} // namespace vera
