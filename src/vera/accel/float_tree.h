// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/box_tree.h"
#include "vera/accel/index_ray.h"
#include "vera/math/vec3.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera::detail {

/// Elements of a leaf are tested against a ray together.
constexpr std::size_t most_in_leaf = 8;

/// How far boxes are enlarged for what is rounded where a ray is tested against them, as a part of
/// their own largest coordinate and of the ray's origin's: a plane's place is off by up to five
/// units of 2^-24 of the sum of both. The first stands in the tree, so that what is small is not
/// enlarged by what is large elsewhere.
constexpr float box_rounding = 0x1p-20F;

/// 2^exponent as two factors, of which each is a usual number.
struct FloatScale {
    float first = 1;
    float second = 1;

    FloatScale() = default;

    explicit FloatScale(int exponent)
        : first(std::ldexp(1.0F, exponent / 2))
        , second(std::ldexp(1.0F, exponent - exponent / 2)) {}

    float operator()(float coordinate) const { return coordinate * first * second; }
};

/// A tree of boxes of elements whose numbers are of single precision, in their coordinates
/// multiplied by 2^exponent: then the largest is below 1, and products of them neither overflow nor
/// vanish in single precision.
///
/// A leaf is a block of a BoxTree. The numbers of its elements stand in leaves from Tree::leaf_rows
/// * first() on, row by row, a row being as long as the leaf has elements; the last row holds the
/// bits of which element each is. What is loaded of the last rows beyond their ends is something,
/// but no matter what.
///
/// What there is of each kind of element, of which the Tree is derived from this: `Tree::Hit`, what
/// is told of a crossing; leaf_rows; groups_at_once, how many times sixteen rays go through the
/// tree at a time; most_beam_steps, after which what a beam meets is smaller than the space between
/// its rays, so that they go on in a stream; shafts, whether rays that only ask whether they meet
/// anything go in those; decider_of(tree, ray), the arithmetic that decides;
/// and what rays do at a leaf in single precision (mesh_leaves-inl.h, sphere_leaves-inl.h).
struct FloatTree {
    std::vector<WideNode> nodes; ///< the first is the root; none where no element can be met
    std::vector<float> leaves;
    int exponent = 0;
    FloatScale scale;      ///< 2^exponent
    FloatScale scale_back; ///< 2^-exponent
    bool exact = true;     ///< each number here is 2^exponent times what it was, not rounded
    std::size_t levels = 0;
};

/// Steps that were counted while queries were answered.
struct SearchCounts {
    std::uint64_t nodes = 0;
    std::uint64_t tests = 0; ///< of rays with elements
};

/// How many elements a leaf has.
inline std::size_t leaf_size(const TreeChild& leaf) {
    return leaf.kind() + 1;
}

inline Vec3 in_double(const std::array<float, 3>& point) {
    return {
        static_cast<double>(point[0]),
        static_cast<double>(point[1]),
        static_cast<double>(point[2])};
}

/// Whether queries follow the ray: see IndexRay.
inline bool is_followed(const IndexRay& ray) {
    bool directed = false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!std::isfinite(ray.origin[axis]) || !std::isfinite(ray.direction[axis]))
            return false;
        directed = directed || ray.direction[axis] != 0;
    }
    return directed && ray.t_min <= ray.t_max; // false where one is no number
}

} // namespace vera::detail
