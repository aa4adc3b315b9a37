// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/ray_parts.h"

#include "vera/theory/conjugation_tree.h"

#include <algorithm>
#include <numeric>
#include <thread>

namespace vera {

void for_each_part(
    std::size_t most,
    EqualPoints equal,
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    const AnswerPart& answer,
    const Progress& progress,
    const CancelFlag* cancel) {
    std::vector<PlanePoint> points(swept.rays.size());
    std::transform(swept.rays.begin(), swept.rays.end(), points.begin(), x_point);
    std::vector<std::uint32_t> all(points.size());
    std::iota(all.begin(), all.end(), std::uint32_t{0});
    const ConjugationTree tree(points, std::move(all), most, {}, cancel, equal);
    std::vector<ConjugationNode> parts;
    for (const ConjugationNode& node : tree.nodes())
        if (node.is_leaf())
            parts.push_back(node);
    long_parallel_loop(parts.size(), progress, cancel, 1, [&](std::size_t i) {
        StepCounts steps;
        std::vector<std::uint32_t> asked;
        for (std::uint32_t r = 0; r < rectangles.size(); ++r)
            if (tree.inclusion(parts[i], x_strip(rectangles[r]), steps) != Inclusion::none)
                asked.push_back(r);
        answer(tree.numbers_of(parts[i]), asked);
    });
    if (progress)
        progress(1);
}

std::size_t part_size(std::size_t rays, std::size_t level) {
    return std::max<std::size_t>((rays + (std::size_t{1} << level) - 1) >> level, 1);
}

std::size_t usual_parts_level(std::size_t rays) {
    constexpr std::size_t fewest = 256; // of a part
    std::size_t level = 0;
    while (level < 3 && rays >> (level + 1) >= fewest)
        ++level;
    return level;
}

std::size_t parts_at_work(std::size_t level) {
    return std::min<std::size_t>(
        std::max(std::thread::hardware_concurrency(), 1U), std::size_t{1} << level);
}

double parts_bytes_forecast(std::size_t level, std::size_t rectangles, std::size_t rays) {
    constexpr std::size_t each_ray =
        sizeof(PlanePoint) + sizeof(std::uint32_t) + ConjugationTree::building_bytes_per_point;
    return static_cast<double>(rays * each_ray)
        + static_cast<double>(parts_at_work(level) * rectangles * sizeof(std::uint32_t))
        + ConjugationTree::bytes_forecast(rays, part_size(rays, level));
}

RayPart::RayPart(
    std::span<const IsoRectangle> rectangles,
    const SweptRays& swept,
    std::span<const std::uint32_t> rays,
    std::span<const std::uint32_t> asked)
    : ray_numbers_(rays)
    , rectangle_numbers_(asked) {
    rays_.reserve(rays.size());
    for (const std::uint32_t ray : rays)
        rays_.push_back(swept.rays[ray]);
    if (!swept.last_z.empty()) {
        last_z_.reserve(rays.size());
        for (const std::uint32_t ray : rays)
            last_z_.push_back(swept.last_z[ray]);
    }
    rectangles_.reserve(asked.size());
    for (const std::uint32_t rectangle : asked)
        rectangles_.push_back(rectangles[rectangle]);
}

Meeting RayPart::meeting(const Meeting& of_all) const {
    return [this, &of_all](std::uint32_t rectangle, std::uint32_t ray) {
        return of_all(rectangle_numbers_[rectangle], ray_numbers_[ray]);
    };
}

} // namespace vera
