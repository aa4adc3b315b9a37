// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/ray_index.h"

#include <memory>

namespace vera {

/// The index that leaves nothing out: every ray is tested against every primitive. The reference
/// for all others. The scene must outlive it.
std::unique_ptr<RayIndex> make_brute_force(const Scene& scene);

} // namespace vera
