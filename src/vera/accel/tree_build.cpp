// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/tree_build.h"

#include "vera/base/check.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vera::detail {

namespace {

constexpr float infinite = std::numeric_limits<float>::infinity();

struct BoxF {
    std::array<float, 3> lower = {infinite, infinite, infinite};
    std::array<float, 3> upper = {-infinite, -infinite, -infinite};
};

void include(BoxF& box, const BoxF& more) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = std::min(box.lower[axis], more.lower[axis]);
        box.upper[axis] = std::max(box.upper[axis], more.upper[axis]);
    }
}

/// Half the surface: lines meet a convex box with a probability in proportion to it.
float surface(const BoxF& box) {
    const float x = box.upper[0] - box.lower[0];
    const float y = box.upper[1] - box.lower[1];
    const float z = box.upper[2] - box.lower[2];
    return x * y + y * z + z * x;
}

/// An element as the builder moves it about.
struct Reference {
    BoxF box;
    std::uint32_t element = 0;
    ElementRecord::Kind kind = ElementRecord::Kind::box;
};

/// Twice the middle of the reference's box along an axis.
float middle(const Reference& reference, std::size_t axis) {
    return reference.box.lower[axis] + reference.box.upper[axis];
}

/// References [first, last), and what holds them.
struct Range {
    std::size_t first = 0;
    std::size_t last = 0;
    BoxF box;
    BoxF middles;      ///< of their doubled middles
    float content = 0; ///< the surfaces of their boxes

    std::size_t size() const { return last - first; }
};

constexpr std::size_t bin_count = 16;

struct Bin {
    BoxF box;
    std::size_t count = 0;
};

/// The references of a range sorted by their middles, along each axis.
using Bins = std::array<std::array<Bin, bin_count>, 3>;

void add(Bins& bins, const Bins& more) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < bin_count; ++i) {
            include(bins[axis][i].box, more[axis][i].box);
            bins[axis][i].count += more[axis][i].count;
        }
}

/// Which bin a middle lies in.
struct Binning {
    std::array<float, 3> start = {};
    std::array<float, 3> bins_per_unit = {};

    explicit Binning(const BoxF& middles)
        : start(middles.lower) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float length = middles.upper[axis] - middles.lower[axis];
            bins_per_unit[axis] = length > 0 ? static_cast<float>(bin_count) / length : 0;
        }
    }

    bool has(std::size_t axis) const { return bins_per_unit[axis] > 0; }

    std::size_t operator()(const Reference& reference, std::size_t axis) const {
        const float place = (middle(reference, axis) - start[axis]) * bins_per_unit[axis];
        // A tiny length makes the factor infinite, and 0 times that no number.
        if (!(place > 0))
            return 0;
        return place < static_cast<float>(bin_count) ? static_cast<std::size_t>(place)
                                                     : bin_count - 1;
    }
};

/// A cut between two bins of an axis.
struct Cut {
    std::size_t axis = 3; ///< 3 where there is none
    std::size_t bin = 0;  ///< the first on the right
};

Cut best_cut(const Bins& bins, const Binning& binning) {
    Cut best;
    float best_cost = infinite;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (!binning.has(axis))
            continue;
        std::array<float, bin_count> right_cost = {};
        Bin right;
        for (std::size_t i = bin_count; i-- > 1;) {
            include(right.box, bins[axis][i].box);
            right.count += bins[axis][i].count;
            right_cost[i] =
                right.count > 0 ? surface(right.box) * static_cast<float>(right.count) : infinite;
        }
        Bin left;
        for (std::size_t i = 1; i < bin_count; ++i) {
            include(left.box, bins[axis][i - 1].box);
            left.count += bins[axis][i - 1].count;
            if (left.count == 0)
                continue;
            const float cost = surface(left.box) * static_cast<float>(left.count) + right_cost[i];
            if (cost < best_cost) {
                best_cost = cost;
                best = {axis, i};
            }
        }
    }
    return best;
}

/// What a part of a tree is made into.
struct Output {
    std::vector<WideNode> nodes;
    std::vector<BlockRow> rows;
    std::size_t blocks = 0;
    std::size_t levels = 0;
};

/// A child that is built later, on any thread.
struct Deferred {
    std::size_t node = 0;
    std::size_t child = 0;
    std::size_t depth = 0;
    Range range;
};

WideNode empty_node() {
    WideNode node = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.planes[axis].fill(infinite);
        node.planes[3 + axis].fill(-infinite);
    }
    return node;
}

void set_box(WideNode& node, std::size_t child, const BoxF& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        node.planes[axis][child] = box.lower[axis];
        node.planes[3 + axis][child] = box.upper[axis];
    }
}

/// Notes in which order rays come to the node's children, of which there are count. Those of an
/// octant come to them by where the middles of the boxes lie along the octant's diagonal; those
/// that ask for anything come first to the ones that are the fullest.
void set_orders(WideNode& node, std::size_t count, const std::array<float, tree_width>& fullness) {
    for (std::size_t order = 0; order <= any_order; ++order) {
        std::array<float, tree_width> place = {};
        std::array<std::size_t, tree_width> last_first = {};
        for (std::size_t i = 0; i < tree_width; ++i) {
            last_first[i] = i;
            if (order == any_order)
                place[i] = -fullness[i];
            else
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    const float middle = node.planes[axis][i] + node.planes[3 + axis][i];
                    place[i] += (order >> axis & 1U) != 0 ? -middle : middle;
                }
        }
        std::stable_sort(
            last_first.begin(),
            last_first.begin() + static_cast<std::ptrdiff_t>(count),
            [&](std::size_t a, std::size_t b) { return place[a] > place[b]; });
        for (std::size_t i = 0; i < tree_width; ++i)
            node.children[i].set_order(order, last_first[i]);
    }
}

/// Cuts ranges of references in two where lines have the least to do with the halves, weighed by
/// their surfaces (MacDonald and Booth 1990; in bins, Wald 2007), and makes nodes of eight.
class Builder {
public:
    Builder(GeometryTree& tree, std::vector<Reference>& references, const CancelFlag* cancel)
        : tree_(tree)
        , references_(references)
        , cancel_(cancel) {}

    void build() {
        const Range all = range_of(0, references_.size());
        Output top;
        std::vector<Deferred> deferred;
        // About so many subtrees for the threads, their number not depending on that of the
        // threads: the tree is always the same.
        constexpr std::size_t subtrees = 64;
        constexpr std::size_t least = 2048;
        const std::size_t deferred_size = std::max(least, references_.size() / subtrees);
        build_node(top, all, 1, &deferred, deferred_size);

        std::vector<Output> outputs(deferred.size());
        parallel_ranges(deferred.size(), 1, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                build_node(outputs[i], deferred[i].range, deferred[i].depth, nullptr, 0);
        });
        join(top, deferred, outputs);
    }

private:
    Range range_of(std::size_t first, std::size_t last) const {
        Range range;
        range.first = first;
        range.last = last;
        for (std::size_t i = first; i < last; ++i) {
            include(range.box, references_[i].box);
            range.content += surface(references_[i].box);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const float place = middle(references_[i], axis);
                range.middles.lower[axis] = std::min(range.middles.lower[axis], place);
                range.middles.upper[axis] = std::max(range.middles.upper[axis], place);
            }
        }
        return range;
    }

    Bins bins_of(std::size_t first, std::size_t last, const Binning& binning) const {
        Bins bins;
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                Bin& bin = bins[axis][binning(references_[i], axis)];
                include(bin.box, references_[i].box);
                ++bin.count;
            }
        return bins;
    }

    Bins bins_of(const Range& range, const Binning& binning) const {
        constexpr std::size_t part = std::size_t{1} << 16U;
        if (range.size() <= part)
            return bins_of(range.first, range.last, binning);
        const std::size_t parts = (range.size() + part - 1) / part;
        std::vector<Bins> of_parts(parts);
        parallel_ranges(parts, 1, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                of_parts[i] = bins_of(
                    range.first + i * part,
                    std::min(range.first + (i + 1) * part, range.last),
                    binning);
        });
        for (std::size_t i = 1; i < parts; ++i)
            add(of_parts[0], of_parts[i]);
        return of_parts[0];
    }

    bool of_one_kind(const Range& range) const {
        for (std::size_t i = range.first + 1; i < range.last; ++i)
            if (references_[i].kind != references_[range.first].kind)
                return false;
        return true;
    }

    /// Whether the range makes a leaf as it is.
    bool is_leaf(const Range& range) const {
        return range.size() <= block_width && of_one_kind(range);
    }

    using Place = std::vector<Reference>::iterator;

    Place place(std::size_t i) const {
        return references_.begin() + static_cast<std::ptrdiff_t>(i);
    }

    /// Cuts the range, which is no leaf, in two that are not empty.
    std::pair<Range, Range> halves(const Range& range, std::size_t depth) const {
        const auto cut_at = [&](Place cut) {
            const auto at = static_cast<std::size_t>(cut - references_.begin());
            return std::pair(range_of(range.first, at), range_of(at, range.last));
        };
        if (range.size() <= block_width) {
            const ElementRecord::Kind kind = references_[range.first].kind;
            return cut_at(std::partition(
                place(range.first), place(range.last), [&](const Reference& reference) {
                    return reference.kind == kind;
                }));
        }
        // Where cuts by surface have led so deep, halving bounds how much deeper it goes.
        constexpr std::size_t deep = 40;
        if (depth < deep) {
            const Binning binning(range.middles);
            const Cut cut = best_cut(bins_of(range, binning), binning);
            if (cut.axis < 3)
                return cut_at(std::partition(
                    place(range.first), place(range.last), [&](const Reference& reference) {
                        return binning(reference, cut.axis) < cut.bin;
                    }));
        }
        return cut_at(place(range.first + range.size() / 2));
    }

    std::size_t build_node(
        Output& output,
        const Range& range,
        std::size_t depth,
        std::vector<Deferred>* deferred,
        std::size_t deferred_size) const {
        VERA_CHECK(depth <= most_tree_levels);
        if (cancel_ != nullptr)
            cancel_->throw_if_raised();
        output.levels = std::max(output.levels, depth);
        const std::vector<Range> children = children_of(range, depth);
        const std::size_t number = output.nodes.size();
        output.nodes.push_back(empty_node());
        WideNode node = empty_node();
        std::array<float, tree_width> fullness = {};
        for (std::size_t i = 0; i < children.size(); ++i) {
            const Range& child = children[i];
            set_box(node, i, child.box);
            fullness[i] = surface(child.box) > 0 ? child.content / surface(child.box) : infinite;
            if (is_leaf(child)) {
                node.children[i] = TreeChild::block(
                    add_block(output, child),
                    static_cast<std::uint64_t>(references_[child.first].kind),
                    child.size());
                continue;
            }
            std::size_t below = 0;
            if (deferred != nullptr && child.size() <= deferred_size)
                deferred->push_back({number, i, depth + 1, child});
            else
                below = build_node(output, child, depth + 1, deferred, deferred_size);
            node.children[i] = TreeChild::node(below);
        }
        set_orders(node, children.size(), fullness);
        output.nodes[number] = node;
        return number;
    }

    /// Cuts the range, the part of the largest surface first, until there are eight or only leaves.
    std::vector<Range> children_of(const Range& range, std::size_t depth) const {
        std::vector<Range> children;
        children.reserve(tree_width);
        children.push_back(range);
        while (children.size() < tree_width) {
            std::size_t largest = children.size();
            float most = -1;
            for (std::size_t i = 0; i < children.size(); ++i)
                if (!is_leaf(children[i]) && !(surface(children[i].box) <= most)) {
                    most = surface(children[i].box);
                    largest = i;
                }
            if (largest == children.size())
                break;
            const auto [left, right] = halves(children[largest], depth);
            children[largest] = left;
            children.push_back(right);
        }
        return children;
    }

    std::size_t add_block(Output& output, const Range& range) const {
        const ElementRecord::Kind kind = references_[range.first].kind;
        const std::size_t first = output.rows.size();
        const std::size_t values = value_count(kind);
        output.rows.resize(first + 1 + values);
        ++output.blocks;
        for (std::size_t i = 0; i < block_width; ++i) {
            const Reference& reference = references_[range.first + std::min(i, range.size() - 1)];
            const Element element = element_at(*tree_.geometry, reference.element);
            const ElementRecord record = element_record(tree_, element, box_of(reference));
            output.rows[first][i] = std::bit_cast<float>(reference.element);
            for (std::size_t value = 0; value < values; ++value)
                output.rows[first + 1 + value][i] = record.values[value];
        }
        return first;
    }

    static Box3 box_of(const Reference& reference) {
        Box3 box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.lower[axis] = static_cast<double>(reference.box.lower[axis]);
            box.upper[axis] = static_cast<double>(reference.box.upper[axis]);
        }
        return box;
    }

    /// The subtrees behind the top, in their order.
    void join(Output& top, const std::vector<Deferred>& deferred, std::vector<Output>& outputs) {
        std::size_t nodes = top.nodes.size();
        std::size_t rows = top.rows.size();
        for (const Output& output : outputs) {
            nodes += output.nodes.size();
            rows += output.rows.size();
        }
        if (nodes > TreeChild::most || rows > TreeChild::most)
            throw std::runtime_error(
                "more primitives in one scene or subscene than the hierarchy of boxes can number; "
                "move parts of it into subscenes, or use --index grid");
        top.nodes.reserve(nodes);
        top.rows.reserve(rows);
        for (std::size_t i = 0; i < outputs.size(); ++i) {
            Output& output = outputs[i];
            const auto first_node = static_cast<std::uint32_t>(top.nodes.size());
            const auto first_row = static_cast<std::uint32_t>(top.rows.size());
            top.nodes[deferred[i].node].children[deferred[i].child].bits += first_node;
            for (WideNode& node : output.nodes) {
                for (TreeChild& child : node.children)
                    child.bits += child.is_block() != 0 ? first_row : first_node;
                top.nodes.push_back(node);
            }
            top.rows.insert(top.rows.end(), output.rows.begin(), output.rows.end());
            top.blocks += output.blocks;
            top.levels = std::max(top.levels, output.levels);
            output = {};
        }
        tree_.nodes = std::move(top.nodes);
        tree_.rows = std::move(top.rows);
        tree_.blocks = top.blocks;
        tree_.levels = top.levels;
    }

    GeometryTree& tree_;
    std::vector<Reference>& references_;
    const CancelFlag* cancel_;
};

/// Rounded outward. Infinite bounds, of elements of the size of the largest numbers, stay so.
BoxF rounded(const Box3& box) {
    BoxF result;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto lower = static_cast<float>(box.lower[axis]);
        const auto upper = static_cast<float>(box.upper[axis]);
        result.lower[axis] =
            static_cast<double>(lower) > box.lower[axis] ? std::nextafter(lower, -infinite) : lower;
        result.upper[axis] =
            static_cast<double>(upper) < box.upper[axis] ? std::nextafter(upper, infinite) : upper;
    }
    return result;
}

} // namespace

std::size_t forecast_tree_bytes(const Geometry& geometry) {
    // Blocks are about 0.7 full, nodes have about 5 children; while the parts are joined, both are
    // held twice.
    constexpr double rows_of_element = 12.0 * sizeof(float) / 0.7;
    constexpr double nodes_of_element = sizeof(WideNode) / (5 * 0.7 * block_width);
    return static_cast<std::size_t>(
        static_cast<double>(geometry.element_count)
            * (sizeof(Reference) + 2 * (rows_of_element + nodes_of_element))
        + static_cast<double>(most_memory_of_outline_table(geometry) + sizeof(GeometryTree)));
}

GeometryTree build_geometry_tree(
    const Geometry& geometry, const std::vector<Box3>& subscene_bounds, const CancelFlag* cancel) {
    GeometryTree tree;
    static_cast<LocalGeometry&>(tree) = local_geometry(geometry, subscene_bounds);
    if (tree.bounds.empty())
        return tree;
    tree.outlines = outline_table(geometry);
    const auto count = static_cast<std::size_t>(geometry.element_count);
    std::vector<Reference> references(count);
    parallel_ranges(count, 1024, [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            const Element element = element_at(geometry, i);
            const Box3 box = local_box(tree, element, subscene_bounds);
            references[i].box = rounded(box);
            references[i].element = static_cast<std::uint32_t>(i);
            references[i].kind = element_record(tree, element, box).kind;
        }
    });
    // Calls of empty subscenes are met by nothing.
    std::erase_if(references, [](const Reference& reference) {
        return !(reference.box.lower[0] <= reference.box.upper[0]);
    });
    tree.elements = references.size();
    Builder(tree, references, cancel).build();
    return tree;
}

} // namespace vera::detail
