// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace vera {

/// About how much of each kind of geometry a text holds. Good for reserving memory, no more:
/// comments and mistakes are counted as well.
struct StatementCounts {
    std::size_t spheres = 0;
    std::size_t triangles = 0;
    std::size_t polygons = 0;
    std::size_t corners = 0; ///< of the polygons
    std::size_t patches = 0;
    std::size_t others = 0; ///< items of other kinds

    std::size_t items() const { return spheres + triangles + polygons + patches + others; }
};

/// Which scene a text is counted for: a subscene ends at MA, LI, PROJECTION and PARALLEL.
enum class CountFor { main_scene, subscene };

/// Counts up to the end of the scene that the text begins in. Far faster than reading.
StatementCounts count_statements(std::string_view text, CountFor scene);

} // namespace vera
