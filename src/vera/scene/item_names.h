// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/geometry.h"

namespace vera {

/// What messages and drawings call an item of the kind, as "rotational shape".
const char* name_of(ItemKind kind);

} // namespace vera
