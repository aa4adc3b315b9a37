// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/draw_scene.h"

#include <cstddef>
#include <functional>

#include "draw_report.h"
#include "messages.h"
#include "prepared_scene.h"

namespace vera {

/// What compares the map with rays at so many points, and lets no drawing be written that differs:
/// throws InputError. All that is given must outlive it.
std::function<void(const PrimitiveMap&, const Progress&)> verification(
    std::size_t points,
    double deviation,
    const PreparedScene& prepared,
    const Console& console,
    DrawReport& report);

} // namespace vera
