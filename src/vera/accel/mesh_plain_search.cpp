// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/mesh_crossing.h"
#include "vera/accel/mesh_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace vera::detail {

namespace {

/// A ray in the mesh's coordinates as it is tested against boxes.
class PlainRay {
public:
    PlainRay(const MeshTree& tree, const Ray& ray)
        : ray_(ray)
        , per_scale_(std::ldexp(1.0, -tree.exponent)) {
        // Far more than by how much crossings are off that mesh_crossing() calls well known, which
        // is 2^20 roundings.
        margin_ = 0x1p-24 * (per_scale_ + max_component(abs(ray.origin)));
    }

    /// Whether the ray may meet something in the child's box before or at t = limit.
    bool may_meet(const WideNode& node, std::size_t child, double limit) const {
        double near = ray_.t_min;
        double far = limit;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double lower = plane(node, axis, child) - margin_ - ray_.origin[axis];
            const double upper = plane(node, 3 + axis, child) + margin_ - ray_.origin[axis];
            const double direction = ray_.direction[axis];
            if (direction == 0) {
                if (lower > 0 || upper < 0)
                    return false;
                continue;
            }
            near = std::max(near, std::min(lower / direction, upper / direction));
            far = std::min(far, std::max(lower / direction, upper / direction));
        }
        return near <= far;
    }

private:
    double plane(const WideNode& node, std::size_t number, std::size_t child) const {
        return static_cast<double>(node.planes[number][child]) * per_scale_;
    }

    Ray ray_;
    double per_scale_;
    double margin_ = 0;
};

/// Calls add(crossing, triangle) for the ray's crossings; those behind limit() may be left out, all
/// that remain once done() is true.
template <typename Add, typename Limit, typename Done>
void for_each_crossing(
    const MeshTree& tree,
    const MeshRay& mesh_ray,
    const Add& add,
    const Limit& limit,
    const Done& done) {
    if (tree.nodes.empty() || !is_followed(mesh_ray))
        return;
    const PreparedRay prepared = prepared_mesh_ray(mesh_ray);
    const PlainRay ray(tree, prepared.ray);
    std::vector<std::size_t> waiting = {0};
    while (!waiting.empty()) {
        const WideNode& node = tree.nodes[waiting.back()];
        waiting.pop_back();
        for (std::size_t i = 0; i < tree_width; ++i) {
            const TreeChild& child = node.children[i];
            // The boxes of absent children are empty.
            if (!(node.planes[0][i] <= node.planes[3][i]) || !ray.may_meet(node, i, limit()))
                continue;
            if (child.is_block() == 0) {
                waiting.push_back(child.first());
                continue;
            }
            const std::size_t size = leaf_size(child);
            const float* const numbers =
                tree.leaves.data() + mesh_leaf_rows * child.first() + mesh_number_row * size;
            for (std::size_t j = 0; j < size; ++j) {
                const auto triangle = std::bit_cast<std::uint32_t>(numbers[j]);
                if (const auto crossing = crossing_with(tree.mesh, prepared, triangle))
                    add(*crossing, triangle);
                if (done())
                    return;
            }
        }
    }
}

} // namespace

MeshHit nearest_plainly(const MeshTree& tree, const MeshRay& ray) {
    NearestCrossing nearest;
    for_each_crossing(
        tree,
        ray,
        [&](const MeshCrossing& crossing, std::uint32_t triangle) {
            nearest.add(crossing, triangle);
        },
        [&] { return std::min(nearest.crossing.t, static_cast<double>(ray.t_max)); },
        [] { return false; });
    return nearest.hit();
}

bool meets_any_plainly(const MeshTree& tree, const MeshRay& ray) {
    bool met = false;
    for_each_crossing(
        tree,
        ray,
        [&](const MeshCrossing&, std::uint32_t) { met = true; },
        [&] { return static_cast<double>(ray.t_max); },
        [&] { return met; });
    return met;
}

std::vector<MeshHit> all_hits_of(const MeshTree& tree, const MeshRay& ray) {
    struct Found {
        MeshCrossing crossing;
        std::uint32_t triangle = no_triangle;
    };

    std::vector<Found> all;
    for_each_crossing(
        tree,
        ray,
        [&](const MeshCrossing& crossing, std::uint32_t triangle) {
            all.push_back({crossing, triangle});
        },
        [&] { return static_cast<double>(ray.t_max); },
        [] { return false; });
    std::sort(all.begin(), all.end(), [](const Found& a, const Found& b) {
        return a.crossing.t < b.crossing.t
            || (a.crossing.t == b.crossing.t && a.triangle < b.triangle);
    });
    std::vector<MeshHit> hits;
    hits.reserve(all.size());
    for (const Found& found : all)
        hits.push_back(mesh_hit(found.crossing, found.triangle));
    return hits;
}

} // namespace vera::detail
