// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/sphere_tree.h"

#include "vera/accel/float_plain_search.h"
#include "vera/accel/float_tree_build.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace vera::detail {

namespace {

/// The largest of the sphere's numbers, without its sign; 0 where it is none and left out.
float size_of(const std::array<float, 4>& sphere) {
    if (!is_sphere(sphere))
        return 0;
    float size = sphere[3];
    for (std::size_t axis = 0; axis < 3; ++axis)
        size = std::max(size, std::abs(sphere[axis]));
    return size;
}

/// The sphere's box, scaled and rounded outward; empty where it is none.
FloatBox box_of(const std::array<float, 4>& sphere, const FloatScale& scale) {
    FloatBox box;
    if (!is_sphere(sphere))
        return box;
    const float radius = scale(sphere[3]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float center = scale(sphere[axis]);
        box.lower[axis] = std::nextafter(center - radius, -HUGE_VALF);
        box.upper[axis] = std::nextafter(center + radius, HUGE_VALF);
    }
    return box;
}

} // namespace

SphereTree build_sphere_tree(SphereSpan spheres, IndexQuality quality, const CancelFlag* cancel) {
    if (spheres.size() >= TreeChild::most)
        throw std::length_error(fmt::format(
            "{} spheres are more than one index can number; make several of at most {}",
            spheres.size(),
            TreeChild::most - 1));
    SphereTree tree;
    tree.spheres = spheres;
    // A sphere reaches as far as the largest coordinate and the largest radius together.
    const float largest =
        largest_size(spheres.size(), [&](std::size_t i) { return size_of(spheres[i]); });
    set_scale(tree, 2 * static_cast<double>(largest));
    tree.exact = holds_for_all(spheres.size(), [&](std::size_t i) {
        return !is_sphere(spheres[i]) || scales_exactly(tree, spheres[i]);
    });
    std::vector<BoxReference> references = float_references(
        spheres.size(), [&](std::size_t i) { return box_of(spheres[i], tree.scale); });
    const std::size_t met = references.size();
    const std::size_t leaves = grow_float_tree(
        tree, std::move(references), quality, cancel, {}, [&](std::uint32_t sphere) {
            std::array<float, 4> numbers = spheres[sphere];
            for (float& number : numbers)
                number = tree.scale(number);
            return numbers;
        });
    tree.statistics = {
        met, spheres.size() - met, tree.levels, tree.nodes.size(), leaves, bytes_of(tree)};
    return tree;
}

SphereHit nearest_plainly(const SphereTree& tree, const IndexRay& ray) {
    return nearest_hit_plainly(tree, ray);
}

bool meets_any_plainly(const SphereTree& tree, const IndexRay& ray) {
    return meets_plainly(tree, ray);
}

std::vector<SphereHit> all_hits_of(const SphereTree& tree, const IndexRay& ray) {
    return all_hits_plainly(tree, ray, [](const SphereHit& hit) { return hit.sphere; });
}

} // namespace vera::detail
