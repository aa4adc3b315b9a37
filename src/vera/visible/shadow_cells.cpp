// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/shadow_cells.h"

#include "vera/base/available_memory.h"
#include "vera/base/long_loop.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace vera {

std::span<const std::uint32_t>
ShadowCells::shadows_on(std::size_t cell, std::uint32_t source, const ScreenScene& scene) const {
    const auto all = shadows_of(cell);
    const auto first = std::partition_point(all.begin(), all.end(), [&](std::uint32_t triangle) {
        return scene.triangles[triangle].source < source;
    });
    const auto last = std::partition_point(first, all.end(), [&](std::uint32_t triangle) {
        return scene.triangles[triangle].source == source;
    });
    return {first, last};
}

ShadowCells shadow_cells_of(
    const Cells& cells,
    const ScreenScene& scene,
    std::span<const NearnessSlope> slopes,
    const CancelFlag* cancel,
    std::size_t first_triangle) {
    std::vector<std::uint32_t> by_source;
    for (auto i = static_cast<std::uint32_t>(first_triangle); i < scene.triangles.size(); ++i)
        if (scene.triangles[i].is_shadow())
            by_source.push_back(i);
    std::stable_sort(by_source.begin(), by_source.end(), [&](std::uint32_t a, std::uint32_t b) {
        return scene.triangles[a].source < scene.triangles[b].source;
    });
    const auto for_each_entry = [&](const auto& visit) {
        for (const std::uint32_t i : by_source) {
            stop_if_raised(cancel);
            const auto corners = corners_of(scene, scene.triangles[i]);
            const double near = nearest_for_hiding(
                slopes[i], std::array{corners[0].point, corners[1].point, corners[2].point});
            for_each_cell_of(cells, corners, [&](std::size_t cell) {
                if (near >= cells.blocked[cell])
                    visit(cell, i);
            });
        }
    };
    ShadowCells shadows;
    if (by_source.empty())
        return shadows;
    shadows.starts.resize(cells.starts.size());
    std::uint64_t entries = 0;
    for_each_entry([&](std::size_t cell, std::uint32_t) {
        ++shadows.starts[cell + 1];
        ++entries;
    });
    require_memory(
        sizeof(std::uint32_t) * static_cast<double>(entries),
        "listing shadows in the parts of the picture that they lie in",
        "--shadows off leaves them out");
    if (entries > std::numeric_limits<std::uint32_t>::max())
        throw std::runtime_error("the shadows lie in more than 2^32 parts of the picture: "
                                 "--shadows off leaves them out");
    std::partial_sum(shadows.starts.begin(), shadows.starts.end(), shadows.starts.begin());
    shadows.triangles.resize(shadows.starts.back());
    std::vector<std::uint32_t> next(shadows.starts.begin(), shadows.starts.end() - 1);
    for_each_entry([&](std::size_t cell, std::uint32_t i) { shadows.triangles[next[cell]++] = i; });
    return shadows;
}

} // namespace vera
