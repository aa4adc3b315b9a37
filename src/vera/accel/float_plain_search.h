// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/float_tree.h"
#include "vera/math/ray.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera::detail {

/// A ray in the elements' coordinates as it is tested against boxes, in double precision.
class PlainRay {
public:
    PlainRay(const FloatTree& tree, const IndexRay& ray)
        : origin_(in_double(ray.origin))
        , direction_(in_double(ray.direction))
        , t_min_(static_cast<double>(ray.t_min))
        , per_scale_(std::ldexp(1.0, -tree.exponent)) {
        // Of the origin, as box_rounding is of boxes, far more than by how much crossings are off
        // that mesh_crossing() calls well known, which is 2^20 roundings; and more than those of
        // sphere_crossings() are, 2^-24.4. What is too small to be scaled exactly is less than the
        // rest.
        margin_ = 0x1p-22 * max_component(abs(origin_)) + 0x1p-44 * per_scale_;
    }

    /// Whether the ray may meet something in the child's box before or at t = limit.
    bool may_meet(const WideNode& node, std::size_t child, double limit) const {
        double near = t_min_;
        double far = limit;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double lower = plane(node, axis, child) - margin_ - origin_[axis];
            const double upper = plane(node, 3 + axis, child) + margin_ - origin_[axis];
            const double direction = direction_[axis];
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

    Vec3 origin_;
    Vec3 direction_;
    double t_min_;
    double per_scale_;
    double margin_ = 0;
};

/// Calls visit(element) for those that the ray may meet; those behind limit() may be left out, all
/// that remain once visit() returns true.
template <typename Tree, typename Visit, typename Limit>
void visit_plainly(
    const Tree& tree, const IndexRay& index_ray, const Visit& visit, const Limit& limit) {
    if (tree.nodes.empty() || !is_followed(index_ray))
        return;
    const PlainRay ray(tree, index_ray);
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
                tree.leaves.data() + Tree::leaf_rows * child.first() + (Tree::leaf_rows - 1) * size;
            for (std::size_t j = 0; j < size; ++j)
                if (visit(std::bit_cast<std::uint32_t>(numbers[j])))
                    return;
        }
    }
}

/// nearest_hits() of one ray, in double precision throughout.
template <typename Tree>
typename Tree::Hit nearest_hit_plainly(const Tree& tree, const IndexRay& ray) {
    if (!is_followed(ray))
        return {};
    auto decider = decider_of(tree, ray);
    visit_plainly(
        tree,
        ray,
        [&](std::uint32_t element) {
            decider.consider(element);
            return false;
        },
        [&] { return std::min(decider.t(), static_cast<double>(ray.t_max)); });
    return decider.hit();
}

/// The same of meet_any().
template <typename Tree>
bool meets_plainly(const Tree& tree, const IndexRay& ray) {
    if (!is_followed(ray))
        return false;
    const auto decider = decider_of(tree, ray);
    bool met = false;
    visit_plainly(
        tree,
        ray,
        [&](std::uint32_t element) { return met = decider.meets(element); },
        [&] { return static_cast<double>(ray.t_max); });
    return met;
}

/// Every hit, by t and then by element; element_of(hit) is its number.
template <typename Tree, typename ElementOf>
std::vector<typename Tree::Hit>
all_hits_plainly(const Tree& tree, const IndexRay& ray, const ElementOf& element_of) {
    using Hit = typename Tree::Hit;

    struct Found {
        Hit hit;
        double t = 0;
    };

    if (!is_followed(ray))
        return {};
    const auto decider = decider_of(tree, ray);
    std::vector<Found> all;
    visit_plainly(
        tree,
        ray,
        [&](std::uint32_t element) {
            decider.for_each_hit(element, [&](const Hit& hit, double t) {
                all.push_back({hit, t});
            });
            return false;
        },
        [&] { return static_cast<double>(ray.t_max); });
    std::sort(all.begin(), all.end(), [&](const Found& a, const Found& b) {
        return a.t < b.t || (a.t == b.t && element_of(a.hit) < element_of(b.hit));
    });
    std::vector<Hit> hits;
    hits.reserve(all.size());
    for (const Found& found : all)
        hits.push_back(found.hit);
    return hits;
}

} // namespace vera::detail
