// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/shadow_cells.h"

#include <algorithm>

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

ShadowCells taken_shadows(Cells& cells, const ScreenScene& scene) {
    ShadowCells shadows;
    if (std::none_of(scene.triangles.begin(), scene.triangles.end(), [](const ScreenTriangle& i) {
            return i.is_shadow();
        }))
        return shadows;
    shadows.starts.reserve(cells.starts.size());
    shadows.starts.push_back(0);
    std::uint32_t kept = 0;
    for (std::size_t cell = 0; cell + 1 < cells.starts.size(); ++cell) {
        const std::uint32_t first = cells.starts[cell];
        const std::uint32_t last = cells.starts[cell + 1];
        cells.starts[cell] = kept;
        for (std::uint32_t i = first; i < last; ++i) {
            const std::uint32_t triangle = cells.triangles[i];
            if (scene.triangles[triangle].is_shadow())
                shadows.triangles.push_back(triangle);
            else
                cells.triangles[kept++] = triangle;
        }
        const auto begin = shadows.triangles.begin() + shadows.starts.back();
        std::stable_sort(begin, shadows.triangles.end(), [&](std::uint32_t a, std::uint32_t b) {
            return scene.triangles[a].source < scene.triangles[b].source;
        });
        shadows.starts.push_back(static_cast<std::uint32_t>(shadows.triangles.size()));
    }
    cells.starts.back() = kept;
    cells.triangles.resize(kept);
    return shadows;
}

} // namespace vera
