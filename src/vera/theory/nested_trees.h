// SPDX-License-Identifier: Apache-2.0
// The first of n rectangles that a ray meets, by nested conjugation trees (VERA 3.3.1, proposition
// 1; the nesting is that of Dobkin and Edelsbrunner 1984): O(n^0.695 polylog n) steps a ray, and
// O(n polylog n) of space.
//
// A rectangle is met where four points of the plane lie in four half-planes, one for each of its
// sides (iso_rectangle.h). A conjugation tree of the first points tells where the first condition
// holds: it names O(n^0.695) nodes that hold such points alone. Each node has a tree of its own, of
// the second points of the same rectangles; each node of that one has a tree of the third, and each
// of that one of the fourth. A node that the fourth tree names holds rectangles that are met, all
// of them, sorted by z: the first one behind the ray's origin is found by bisection.
//
// Nodes tell how near their rectangles are. The nearer child is searched first, and what lies
// behind a rectangle that is met already is not. Nodes of few rectangles have no trees: these are
// looked at one by one.
#pragma once

#include "vera/theory/iso_rectangle.h"
#include "vera/theory/nearest_rectangle.h"
#include "vera/theory/partition_tree.h"
#include "vera/theory/tree_kind.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// Which conditions are asked for first.
enum class ConditionOrder { x_first, y_first };

class NestedTrees {
public:
    /// Nodes of so many rectangles, at most, have no trees: large enough that these fit into
    /// memory.
    static std::size_t usual_few(std::size_t rectangles);

    /// Takes O(n log^6 n). Throws std::invalid_argument as require_rectangles() does,
    /// std::runtime_error where the memory that is available does not suffice, and Cancelled.
    explicit NestedTrees(
        std::span<const IsoRectangle> rectangles,
        std::optional<std::size_t> few = {},
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr,
        TreeKind kind = TreeKind::conjugation,
        ConditionOrder order = ConditionOrder::x_first);

    /// As brute_force_first_rectangle(), and throws likewise. May be asked from many threads.
    std::optional<std::uint32_t>
    first_rectangle(const WholeRay& ray, StepCounts* counts = nullptr) const;

    std::span<const IsoRectangle> rectangles() const { return rectangles_; }

    /// What it takes of memory.
    std::size_t bytes() const;

    /// At most so much, in bytes, whatever the rectangles are, of optimal trees about so much; with
    /// what building takes for a while, and without what the allocator takes for itself.
    static double
    bytes_forecast(std::size_t rectangles, std::size_t few, TreeKind kind = TreeKind::conjugation);

private:
    friend class NestedTreesBuilder;
    friend class RectangleSearch;

    /// A tree of one condition's points, and what its nodes have.
    struct Level {
        PartitionTree tree;
        std::vector<NearnessOfNode> nearness; ///< of each node
        std::vector<std::unique_ptr<Level>>
            inner; ///< of each node of more than few; not of the last
        /// Of the last condition's tree: the numbers of its nodes at each depth, each node's in its
        /// place and sorted by z.
        std::vector<std::vector<std::uint32_t>> by_z;
    };

    static std::size_t bytes_of(const Level& level);
    static double level_bytes_forecast(std::size_t condition, std::size_t count, std::size_t few);

    std::vector<IsoRectangle> rectangles_;
    std::array<SideCondition, side_condition_count> conditions_; ///< of the trees, outermost first
    std::array<std::vector<PlanePoint>, side_condition_count> points_; ///< for each of them
    std::size_t few_ = 0;
    TreeKind kind_ = TreeKind::conjugation;
    std::unique_ptr<Level> outermost_;
};

} // namespace vera
