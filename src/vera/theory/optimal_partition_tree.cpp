// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/optimal_partition_tree.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/base/random.h"
#include "vera/theory/ham_sandwich.h"
#include "vera/theory/plane_hull.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>

namespace vera {

namespace {

using Numbers = std::vector<std::uint32_t>;

/// Into how many parts a cell is divided, about. Trees of 8 to 64 cost the same, within 10 %.
constexpr std::size_t parts_per_cell = 16;

/// What dividing takes of the time, beside the hulls.
constexpr double dividing_part = 0.9;

/// What is asked for where memory is not known to suffice.
std::span<const PlanePoint> required(std::span<const PlanePoint> points, std::size_t leaf_size) {
    require_tree(
        "an optimal partition tree",
        points,
        leaf_size,
        OptimalPartitionTree::bytes_forecast(points.size(), leaf_size)
            + OptimalPartitionTree::building_bytes(points.size(), leaf_size));
    return points;
}

/// A line through a point, turned to the left by less than anything; the point itself lies above.
class TestLine {
public:
    TestLine(PlanePoint through, PlaneDirection direction)
        : direction_(direction)
        , at_(offset(direction, through))
        , along_(dot(direction, through)) {}

    PlaneDirection direction() const { return direction_; }

    /// offset(direction(), p) is dot(normal(), p), which on the line is at().
    PlaneDirection normal() const { return {-direction_.y, direction_.x}; }

    std::int64_t at() const { return at_; }

    bool is_below(PlanePoint point) const {
        const std::int64_t at = offset(direction_, point);
        return at != at_ ? at < at_ : dot(direction_, point) > along_;
    }

private:
    PlaneDirection direction_;
    std::int64_t at_;
    std::int64_t along_;
};

/// From 0 to 1.
double random_part(std::uint64_t seed, std::uint64_t a, std::uint64_t b) {
    return static_cast<double>(random(seed, a, b) >> 11) * 0x1p-53;
}

class PartitionCuts {
public:
    PartitionCuts(
        std::span<const PlanePoint> points,
        Numbers numbers,
        std::size_t leaf_size,
        EqualPoints equal,
        Progress progress,
        const CancelFlag* cancel)
        : points_(points)
        , numbers_(std::move(numbers))
        , leaf_size_(std::max<std::size_t>(leaf_size, 1))
        , equal_(equal)
        , progress_(std::move(progress))
        , cancel_(cancel) {}

    TreeShape shape() {
        if (!numbers_.empty()) {
            draw_test_lines();
            divide_all();
        }
        return in_order();
    }

private:
    /// A node, and the test lines that cross it.
    struct Cell {
        std::uint32_t node = 0;
        Numbers lines;
    };

    struct Node {
        std::uint32_t first = 0;
        std::uint32_t last = 0;
        std::uint32_t children = 0; ///< the first; the second is the next

        std::uint32_t size() const { return last - first; }
    };

    /// The lines through any two of some points.
    void draw_test_lines() {
        const double leaves =
            static_cast<double>(numbers_.size()) / static_cast<double>(leaf_size_);
        // So many that there are as many lines as leaves.
        const auto count = static_cast<std::size_t>(std::sqrt(2 * leaves)) + 1;
        std::vector<PlanePoint> drawn;
        for (std::size_t i = 0; i < count; ++i)
            drawn.push_back(points_[numbers_[random(1, i, 0) % numbers_.size()]]);
        for (std::size_t i = 0; i < count; ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (drawn[i] != drawn[j])
                    lines_.emplace_back(drawn[i], direction_between(drawn[i], drawn[j]));
    }

    void divide_all() {
        nodes_.push_back({0, static_cast<std::uint32_t>(numbers_.size()), 0});
        std::vector<Cell> cells(1);
        cells[0].lines.resize(lines_.size());
        std::iota(cells[0].lines.begin(), cells[0].lines.end(), std::uint32_t{0});
        std::size_t most = 2 * numbers_.size();
        while (!cells.empty()) {
            most = std::max(most / parts_per_cell, leaf_size_);
            cells = divided(std::move(cells), most);
        }
    }

    /// The cells of the next level, of at most so many points. In an order of no meaning, so that
    /// lines that are spared are so everywhere.
    std::vector<Cell> divided(std::vector<Cell> cells, std::size_t most) {
        std::sort(cells.begin(), cells.end(), [](const Cell& a, const Cell& b) {
            return random(2, a.node, 0) < random(2, b.node, 0);
        });
        weights_.assign(lines_.size(), 1);
        std::vector<Cell> next;
        for (Cell& cell : cells) {
            stop_if_raised(cancel_);
            if (nodes_[cell.node].size() <= most)
                keep(std::move(cell), next);
            else
                for (Cell& part : parts(std::exchange(cell, {}), most))
                    keep(std::move(part), next);
        }
        return next;
    }

    /// Of those that are still to be divided.
    void keep(Cell cell, std::vector<Cell>& next) {
        if (!is_undivided(nodes_[cell.node])) {
            next.push_back(std::move(cell));
            return;
        }
        done_ += nodes_[cell.node].size();
        if (progress_)
            progress_(static_cast<double>(done_) / static_cast<double>(numbers_.size()));
    }

    bool is_undivided(const Node& node) const {
        return node.size() <= leaf_size_ || (equal_ == EqualPoints::together && are_equal(node));
    }

    bool are_equal(const Node& node) const {
        const PlanePoint point = points_[numbers_[node.first]];
        for (std::uint32_t i = node.first + 1; i < node.last; ++i)
            if (points_[numbers_[i]] != point)
                return false;
        return true;
    }

    /// Those that a cell is divided into, of at most so many points.
    std::vector<Cell> parts(const Cell& cell, std::size_t most) {
        Numbers leaves = {cell.node};
        part_by_lines(cell, leaves);
        for (std::size_t i = 0; i < leaves.size();)
            if (nodes_[leaves[i]].size() > most && !is_undivided(nodes_[leaves[i]]))
                halve(i, leaves, cell);
            else
                ++i;
        std::vector<Cell> made;
        for (const std::uint32_t leaf : leaves)
            made.push_back({leaf, {}});
        note_crossings(cell, made);
        return made;
    }

    /// Parts the leaves by lines that cross the cell, drawn by their weights.
    void part_by_lines(const Cell& cell, Numbers& leaves) {
        if (cell.lines.empty())
            return;
        std::vector<double> sums;
        double sum = 0;
        for (const std::uint32_t line : cell.lines)
            sums.push_back(sum += weights_[line]);
        for (std::uint64_t draw = 0; leaves.size() < parts_per_cell && draw < parts_per_cell;
             ++draw) {
            const auto found =
                std::upper_bound(sums.begin(), sums.end(), sum * random_part(3, cell.node, draw));
            const auto number = static_cast<std::size_t>(found - sums.begin());
            const TestLine& line = lines_[cell.lines[std::min(number, sums.size() - 1)]];
            const std::size_t count = leaves.size();
            for (std::size_t i = 0; i < count; ++i)
                part(i, leaves, line);
        }
    }

    /// Parts a leaf in two where points of it are on both sides of the line.
    void part(std::size_t leaf, Numbers& leaves, const TestLine& line) {
        const Node node = nodes_[leaves[leaf]];
        if (node.size() <= leaf_size_)
            return;
        const auto first = numbers_.begin() + static_cast<std::ptrdiff_t>(node.first);
        const auto last = numbers_.begin() + static_cast<std::ptrdiff_t>(node.last);
        const auto middle = std::partition(
            first, last, [&](std::uint32_t number) { return line.is_below(points_[number]); });
        if (middle != first && middle != last)
            add_children(leaf, leaves, static_cast<std::uint32_t>(middle - numbers_.begin()));
    }

    /// Along any of the lines that cross the cell.
    void halve(std::size_t leaf, Numbers& leaves, const Cell& cell) {
        const Node node = nodes_[leaves[leaf]];
        const PlaneDirection direction = cell.lines.empty()
            ? PlaneDirection{1, 0}
            : lines_[cell.lines[random(4, leaves[leaf], 0) % cell.lines.size()]].direction();
        const std::uint32_t middle = node.first + node.size() / 2;
        const auto place = [&](std::uint32_t i) {
            return numbers_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(
            place(node.first),
            place(middle),
            place(node.last),
            [&, before = TurnedOrder{direction}](std::uint32_t a, std::uint32_t b) {
                return before(points_[a], points_[b]);
            });
        add_children(leaf, leaves, middle);
    }

    void add_children(std::size_t leaf, Numbers& leaves, std::uint32_t middle) {
        const auto children = static_cast<std::uint32_t>(nodes_.size());
        Node& parent = nodes_[leaves[leaf]];
        parent.children = children;
        const Node lower = {parent.first, middle, 0};
        const Node upper = {middle, parent.last, 0};
        nodes_.push_back(lower);
        nodes_.push_back(upper);
        leaves[leaf] = children;
        leaves.push_back(children + 1);
    }

    /// Which lines cross which part. Each makes its line as much heavier.
    void note_crossings(const Cell& cell, std::vector<Cell>& parts) {
        std::vector<PlaneHull> hulls;
        hulls.reserve(parts.size());
        for (const Cell& part : parts) {
            const Node& node = nodes_[part.node];
            hulls.push_back(hull_of(points_, std::span(numbers_).subspan(node.first, node.size())));
        }
        constexpr double growth = 1 + 1.0 / static_cast<double>(parts_per_cell);
        for (const std::uint32_t line : cell.lines)
            for (std::size_t i = 0; i < parts.size(); ++i)
                if (crosses(lines_[line], hulls[i])) {
                    parts[i].lines.push_back(line);
                    weights_[line] *= growth;
                }
    }

    bool crosses(const TestLine& line, const PlaneHull& hull) const {
        // Few corners are looked at one after the other in less time, and so are all where the line
        // goes through one.
        if (hull.below.size() + hull.above.size() > 16) {
            const HullExtent extent = extent_along(line.normal(), points_, hull.below, hull.above);
            if (line.at() < extent.lowest || extent.highest < line.at())
                return false;
            if (extent.lowest < line.at() && line.at() < extent.highest)
                return true;
        }
        const auto is_below = [&](std::uint32_t corner) { return line.is_below(points_[corner]); };
        const bool first_is_below = is_below(hull.below.front());
        for (const Numbers* chain : {&hull.below, &hull.above})
            for (const std::uint32_t corner : *chain)
                if (is_below(corner) != first_is_below)
                    return true;
        return false;
    }

    TreeShape in_order() {
        TreeShape shape;
        if (!nodes_.empty())
            add_in_order(0, shape);
        shape.numbers = std::move(numbers_);
        return shape;
    }

    void add_in_order(std::uint32_t number, TreeShape& shape) const {
        const Node& node = nodes_[number];
        const std::size_t place = shape.nodes.size();
        shape.nodes.push_back({node.first, node.last});
        if (node.children == 0)
            return;
        add_in_order(node.children, shape);
        shape.nodes[place].children = static_cast<std::uint32_t>(shape.nodes.size());
        add_in_order(node.children + 1, shape);
    }

    std::span<const PlanePoint> points_;
    Numbers numbers_;
    std::size_t leaf_size_;
    EqualPoints equal_;
    Progress progress_;
    const CancelFlag* cancel_;
    std::vector<TestLine> lines_;
    std::vector<double> weights_; ///< of each line
    std::vector<Node> nodes_;
    std::size_t done_ = 0; ///< points of leaves
};

} // namespace

OptimalPartitionTree::OptimalPartitionTree(
    std::span<const PlanePoint> points,
    std::vector<std::uint32_t> numbers,
    std::size_t leaf_size,
    const Progress& progress,
    const CancelFlag* cancel,
    EqualPoints equal)
    : PartitionTree(
        points,
        PartitionCuts(
            points,
            std::move(numbers),
            leaf_size,
            equal,
            progress_between(progress, 0, dividing_part),
            cancel)
            .shape(),
        progress_between(progress, dividing_part, 1),
        cancel) {}

OptimalPartitionTree::OptimalPartitionTree(
    std::span<const PlanePoint> points,
    std::size_t leaf_size,
    const Progress& progress,
    const CancelFlag* cancel)
    : OptimalPartitionTree(
        required(points, leaf_size), all_numbers(points.size()), leaf_size, progress, cancel) {}

double OptimalPartitionTree::bytes_forecast(std::size_t count, std::size_t leaf_size) {
    return depth_factor * halved_bytes_forecast(count, leaf_size);
}

double OptimalPartitionTree::building_bytes(std::size_t count, std::size_t leaf_size) {
    const double leaves =
        static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(leaf_size, 1));
    // Of each point, its hulls; of each test line, itself and the cells of a level that it crosses.
    return 48 * static_cast<double>(count) + leaves * (48 + 4 * std::sqrt(leaves));
}

} // namespace vera
