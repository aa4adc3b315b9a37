// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/draw_scene.h"
#include "vera/visible/map_check.h"

#include <cstddef>

#include "messages.h"
#include <nlohmann/json.hpp>

namespace vera {

/// What vera draw tells at its end, beside what the drawing itself tells.
struct DrawReport {
    double read_seconds = 0;
    double draw_seconds = 0;
    double verify_seconds = 0;
    MapCheck check; ///< of no points where nothing was verified
    double write_seconds = 0;
    std::size_t bytes = 0;
};

/// What was left out of the drawing, and where it may be wrong.
void print_notes(const DrawnScene& drawn, const Console& console);

void print_check(const MapCheck& check, const Console& console);

nlohmann::ordered_json as_json(const DrawReport& report, const DrawnScene& drawn);

} // namespace vera
