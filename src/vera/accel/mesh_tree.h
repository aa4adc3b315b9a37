// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/box_tree.h"
#include "vera/accel/mesh_index.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera::detail {

/// Numbers in a leaf for each of its triangles: the coordinates of its corners, and its number.
constexpr std::size_t mesh_leaf_rows = 10;
constexpr std::size_t mesh_number_row = 9;

/// Triangles of a leaf are tested against a ray together.
constexpr std::size_t mesh_leaf_size = 8;

/// 2^exponent as two factors, of which each is a usual number.
struct MeshScale {
    float first = 1;
    float second = 1;

    MeshScale() = default;

    explicit MeshScale(int exponent)
        : first(std::ldexp(1.0F, exponent / 2))
        , second(std::ldexp(1.0F, exponent - exponent / 2)) {}

    float operator()(float coordinate) const { return coordinate * first * second; }
};

/// The tree of boxes of a mesh, in its coordinates multiplied by 2^exponent: then the largest is
/// below 1, and products of them neither overflow nor vanish in single precision.
///
/// A leaf is a block of a BoxTree. The numbers of its triangles stand in leaves from
/// mesh_leaf_rows * first() on, row by row, a row being as long as the leaf has triangles. What is
/// loaded of the last rows beyond their ends is something, but no matter what.
struct MeshTree {
    MeshSpans mesh;
    std::vector<WideNode> nodes; ///< the first is the root; none where no triangle can be met
    std::vector<float> leaves;
    int exponent = 0;
    MeshScale scale;      ///< 2^exponent
    MeshScale scale_back; ///< 2^-exponent
    bool exact = true;    ///< each coordinate here is 2^exponent times what it was, not rounded
    MeshIndexStatistics statistics;
};

/// How many triangles a leaf of a mesh's tree has.
inline std::size_t leaf_size(const TreeChild& leaf) {
    return leaf.kind() + 1;
}

/// MeshIndex::MeshIndex
MeshTree build_mesh_tree(MeshSpans mesh, MeshIndexQuality quality, const CancelFlag* cancel);

/// MeshIndex::nearest_hits and meet_any.
void search_nearest(
    const MeshTree& tree,
    std::span<const MeshRay> rays,
    std::span<MeshHit> hits,
    MeshQueryCounts& counts);
void search_any(
    const MeshTree& tree,
    std::span<const MeshRay> rays,
    std::span<std::uint8_t> met,
    MeshQueryCounts& counts);

/// The same for one ray, in double precision throughout: for rays that single precision cannot
/// follow.
MeshHit nearest_plainly(const MeshTree& tree, const MeshRay& ray);
bool meets_any_plainly(const MeshTree& tree, const MeshRay& ray);

/// MeshIndex::all_hits
std::vector<MeshHit> all_hits_of(const MeshTree& tree, const MeshRay& ray);

} // namespace vera::detail
