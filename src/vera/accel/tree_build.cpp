// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/tree_build.h"

#include "vera/accel/box_tree.h"
#include "vera/accel/box_tree_nodes.h"
#include "vera/accel/packet_query.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

namespace vera::detail {

namespace {

/// In single precision, and enlarged by far more than that rounds: see box_rounding. Infinite
/// bounds, of elements of the size of the largest numbers, stay so, and others beside them finite.
FloatBox enlarged(const Box3& box) {
    const double largest = max_component(max(abs(box.lower), abs(box.upper)));
    const double rounding = static_cast<double>(box_rounding) * std::min(largest, 1.0);
    FloatBox result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        result.lower[axis] = static_cast<float>(box.lower[axis] - rounding);
        result.upper[axis] = static_cast<float>(box.upper[axis] + rounding);
    }
    return result;
}

Box3 box_of(const BoxReference& reference) {
    Box3 box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = static_cast<double>(reference.lower[axis]);
        box.upper[axis] = static_cast<double>(reference.upper[axis]);
    }
    return box;
}

/// What rays can meet of the geometry.
std::vector<BoxReference>
references_of(const LocalGeometry& local, const std::vector<Box3>& subscene_bounds) {
    const Geometry& geometry = *local.geometry;
    const auto count = static_cast<std::size_t>(geometry.element_count);
    std::vector<BoxReference> references(count);
    parallel_ranges(count, 1024, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const Element element = element_at(geometry, i);
            const Box3 box = local_box(local, element, subscene_bounds);
            const auto [lower, upper] = enlarged(box);
            const ElementRecord::Kind kind = element_record(local, element, box).kind;
            references[i] = {
                lower, static_cast<std::uint32_t>(i), upper, static_cast<std::uint32_t>(kind)};
        }
    });
    // Calls of empty subscenes are met by nothing.
    std::erase_if(references, [](const BoxReference& reference) {
        return !(reference.lower[0] <= reference.upper[0]);
    });
    return references;
}

[[noreturn]] void refuse_too_many() {
    throw std::runtime_error(
        "more primitives in one scene or subscene than the hierarchy of boxes can number; "
        "move parts of it into subscenes, or use --index grid");
}

/// Makes blocks of the leaves of a tree, in the order in which its nodes have them.
class BlockMaker {
public:
    BlockMaker(GeometryTree& tree, const BoxTree& boxes)
        : tree_(tree)
        , boxes_(boxes) {}

    void make() {
        constexpr std::size_t part = 256; // nodes
        const std::size_t parts = (tree_.nodes.size() + part - 1) / part;
        std::vector<std::size_t> first_rows(parts + 1);
        for_parts(part, [&](std::size_t i, std::span<WideNode> nodes) {
            first_rows[i + 1] = row_count(nodes);
        });
        std::partial_sum(first_rows.begin(), first_rows.end(), first_rows.begin());
        if (first_rows.back() > TreeChild::most)
            refuse_too_many();
        tree_.rows.resize(first_rows.back());
        for_parts(part, [&](std::size_t i, std::span<WideNode> nodes) {
            make_blocks(nodes, first_rows[i]);
        });
    }

private:
    template <typename Turn>
    void for_parts(std::size_t part, const Turn& turn) {
        const std::span<WideNode> nodes = tree_.nodes;
        parallel_ranges(
            (nodes.size() + part - 1) / part, 1, [&](std::size_t first, std::size_t last) {
                for (std::size_t i = first; i < last; ++i)
                    turn(i, nodes.subspan(i * part, std::min(part, nodes.size() - i * part)));
            });
    }

    /// The references of a leaf of the tree of boxes.
    std::span<const BoxReference> leaf(TreeChild child) const {
        return std::span(boxes_.references).subspan(child.first(), child.kind() + 1);
    }

    static ElementRecord::Kind kind_of(std::span<const BoxReference> leaf) {
        return static_cast<ElementRecord::Kind>(leaf.front().kind);
    }

    std::size_t row_count(std::span<const WideNode> nodes) const {
        std::size_t count = 0;
        for (const WideNode& node : nodes)
            for (const TreeChild child : node.children)
                if (child.is_block() != 0)
                    count += 1 + value_count(kind_of(leaf(child)));
        return count;
    }

    void make_blocks(std::span<WideNode> nodes, std::size_t row) {
        for (WideNode& node : nodes)
            for (TreeChild& child : node.children)
                if (child.is_block() != 0) {
                    const std::span<const BoxReference> references = leaf(child);
                    const ElementRecord::Kind kind = kind_of(references);
                    child.bits &= ~TreeChild::lower_part;
                    child.bits |=
                        TreeChild::block(row, static_cast<std::uint64_t>(kind), references.size())
                            .bits;
                    make_block(references, value_count(kind), tree_.rows.data() + row);
                    row += 1 + value_count(kind);
                }
    }

    void
    make_block(std::span<const BoxReference> references, std::size_t values, BlockRow* rows) const {
        for (std::size_t i = 0; i < block_width; ++i) {
            const BoxReference& reference = references[std::min(i, references.size() - 1)];
            const Element element = element_at(*tree_.geometry, reference.element);
            const ElementRecord record = element_record(tree_, element, box_of(reference));
            rows[0][i] = std::bit_cast<float>(reference.element);
            for (std::size_t value = 0; value < values; ++value)
                rows[1 + value][i] = record.values[value];
        }
    }

    GeometryTree& tree_;
    const BoxTree& boxes_;
};

} // namespace

std::size_t forecast_tree_bytes(const Geometry& geometry) {
    // The references; of each block two binary nodes, the node that it is a child of, twice while
    // the parts are joined, and its rows: what was given back may still be the process's. Blocks
    // are about 0.7 full, nodes have about 5 children.
    constexpr double blocks_of_element = 1 / (0.7 * block_width);
    constexpr double bytes_of_block =
        2 * sizeof(BinaryNode) + 2 * sizeof(WideNode) / 5.0 + 12 * sizeof(BlockRow);
    return static_cast<std::size_t>(
        static_cast<double>(geometry.element_count)
            * (sizeof(BoxReference) + blocks_of_element * bytes_of_block)
        + static_cast<double>(most_memory_of_outline_table(geometry) + sizeof(GeometryTree)));
}

GeometryTree build_geometry_tree(
    const Geometry& geometry, const std::vector<Box3>& subscene_bounds, const CancelFlag* cancel) {
    GeometryTree tree;
    static_cast<LocalGeometry&>(tree) = local_geometry(geometry, subscene_bounds);
    if (tree.bounds.empty())
        return tree;
    tree.outlines = outline_table(geometry);
    std::vector<BoxReference> references = references_of(tree, subscene_bounds);
    if (references.size() > TreeChild::most)
        refuse_too_many();
    BoxTree boxes = build_box_tree(std::move(references), block_width, cancel);
    tree.elements = boxes.references.size();
    tree.blocks = boxes.leaves;
    tree.levels = boxes.levels;
    tree.nodes = std::move(boxes.nodes);
    BlockMaker(tree, boxes).make();
    return tree;
}

} // namespace vera::detail
