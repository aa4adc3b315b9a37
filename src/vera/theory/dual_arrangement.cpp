// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/dual_arrangement.h"

#include "vera/base/check.h"
#include "vera/base/long_loop.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace vera {

namespace {

struct Crossing {
    Slope slope;
    std::uint32_t first = 0;
    std::uint32_t second = 0;
};

} // namespace

/// Goes from slope to slope.
class DualArrangementBuilder {
public:
    DualArrangementBuilder(DualArrangement& arrangement)
        : made_(arrangement)
        , order_(arrangement.lines_.size())
        , place_(arrangement.lines_.size()) {}

    void build(const Progress& progress, const CancelFlag* cancel) {
        if (order_.empty())
            return;
        std::iota(order_.begin(), order_.end(), 0U);
        std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
            return comes_before_from_the_left(made_.lines_[a], made_.lines_[b]);
        });
        for (std::uint32_t i = 0; i < order_.size(); ++i)
            place_[order_[i]] = i;
        made_.roots_.push_back(whole_tree(0, static_cast<std::uint32_t>(order_.size())));
        const std::vector<Crossing> crossings = crossings_by_slope();
        const LongLoop loop(crossings.size(), progress, cancel);
        for (std::size_t i = 0; i < crossings.size();) {
            loop.turn(i);
            std::size_t end = i;
            lines_here_.clear();
            for (; end < crossings.size() && crossings[end].slope == crossings[i].slope; ++end) {
                lines_here_.push_back(crossings[end].first);
                lines_here_.push_back(crossings[end].second);
            }
            pass(crossings[i].slope);
            i = end;
        }
        if (progress)
            progress(1);
    }

private:
    /// At slopes that fall without end: of two lines that of the larger z lies above. Of one z the
    /// heights decide, and on one line the lower end comes first.
    static bool comes_before_from_the_left(const DualLine& a, const DualLine& b) {
        if (a.end.x != b.end.x)
            return a.end.x < b.end.x;
        return a.end.y != b.end.y ? a.end.y < b.end.y : a.is_upper < b.is_upper;
    }

    std::vector<Crossing> crossings_by_slope() const {
        std::vector<Crossing> found;
        const auto count = static_cast<std::uint32_t>(made_.lines_.size());
        for (std::uint32_t i = 0; i < count; ++i)
            for (std::uint32_t k = i + 1; k < count; ++k) {
                const PlaneDirection way =
                    direction_between(made_.lines_[i].end, made_.lines_[k].end);
                if (way.x != 0)
                    found.push_back({Slope::of(way.y, way.x), i, k});
            }
        std::sort(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) {
            return a.slope < b.slope;
        });
        return found;
    }

    /// The order at the slope, at which these lines cross others, and that behind it.
    void pass(Slope slope) {
        std::sort(lines_here_.begin(), lines_here_.end());
        lines_here_.erase(std::unique(lines_here_.begin(), lines_here_.end()), lines_here_.end());
        places_here_.clear();
        for (const std::uint32_t line : lines_here_)
            places_here_.push_back(place_[line]);
        std::sort(places_here_.begin(), places_here_.end());
        made_.slopes_.push_back(slope);
        reorder(
            [&](const DualLine& a, const DualLine& b) { return a.is_upper < b.is_upper; }, slope);
        // Behind it a line of smaller z lies above one of larger z. Ends of one z at one height are
        // the two ends of no more than a point.
        reorder(
            [](const DualLine& a, const DualLine& b) {
                return a.end.x != b.end.x ? a.end.x > b.end.x : a.is_upper < b.is_upper;
            },
            slope);
    }

    /// Bundles that cross in a point keep their places among all, since no other line goes through
    /// it; within them the rule decides.
    template <typename Rule>
    void reorder(const Rule& rule, Slope slope) {
        std::sort(lines_here_.begin(), lines_here_.end(), [&](std::uint32_t a, std::uint32_t b) {
            const DualLine& line_a = made_.lines_[a];
            const DualLine& line_b = made_.lines_[b];
            const std::int64_t height_of_a = height_at(line_a, slope);
            const std::int64_t height_of_b = height_at(line_b, slope);
            return height_of_a != height_of_b ? height_of_a < height_of_b : rule(line_a, line_b);
        });
        changed_.clear();
        for (std::size_t i = 0; i < lines_here_.size(); ++i) {
            const std::uint32_t place = places_here_[i];
            if (order_[place] != lines_here_[i])
                changed_.push_back(place);
            order_[place] = lines_here_[i];
            place_[lines_here_[i]] = place;
        }
        const std::uint32_t root = made_.roots_.back();
        made_.roots_.push_back(
            changed_.empty()
                ? root
                : with_changes(root, 0, static_cast<std::uint32_t>(order_.size()), changed_));
    }

    std::uint32_t add(const DualArrangement::Node& node) {
        made_.nodes_.push_back(node);
        return static_cast<std::uint32_t>(made_.nodes_.size() - 1);
    }

    std::uint32_t whole_tree(std::uint32_t first, std::uint32_t last) {
        if (last - first == 1)
            return add({0, 0, order_[first]});
        const std::uint32_t middle = first + (last - first) / 2;
        const std::uint32_t left = whole_tree(first, middle);
        const std::uint32_t right = whole_tree(middle, last);
        return add({left, right, order_[middle]});
    }

    /// A copy of the node's tree where the places, some of its own, have the lines that they have
    /// now.
    std::uint32_t with_changes(
        std::uint32_t number,
        std::uint32_t first,
        std::uint32_t last,
        std::span<const std::uint32_t> places) {
        if (places.empty())
            return number;
        if (last - first == 1)
            return add({0, 0, order_[first]});
        const std::uint32_t middle = first + (last - first) / 2;
        const auto split = static_cast<std::size_t>(
            std::lower_bound(places.begin(), places.end(), middle) - places.begin());
        const DualArrangement::Node before = made_.nodes_[number];
        const std::uint32_t left = with_changes(before.left, first, middle, places.first(split));
        const std::uint32_t right = with_changes(before.right, middle, last, places.subspan(split));
        return add({left, right, order_[middle]});
    }

    DualArrangement& made_;
    std::vector<std::uint32_t> order_; ///< the line in each place
    std::vector<std::uint32_t> place_; ///< of each line
    std::vector<std::uint32_t> lines_here_;
    std::vector<std::uint32_t> places_here_;
    std::vector<std::uint32_t> changed_;
};

DualArrangement::DualArrangement(
    std::vector<DualLine> lines, const Progress& progress, const CancelFlag* cancel)
    : lines_(std::move(lines)) {
    VERA_CHECK(lines_.size() <= (std::size_t{1} << 16));
    DualArrangementBuilder(*this).build(progress, cancel);
}

std::optional<std::uint32_t>
DualArrangement::first_above(const SideView& line, DualCounts& counts) const {
    if (lines_.empty())
        return std::nullopt;
    const auto at = std::partition_point(slopes_.begin(), slopes_.end(), [&](Slope slope) {
        ++counts.comparisons;
        return slope < line.slope;
    });
    std::size_t version = 2 * static_cast<std::size_t>(at - slopes_.begin());
    if (at != slopes_.end() && *at == line.slope)
        ++version;
    std::optional<std::uint32_t> found;
    std::uint32_t number = roots_[version];
    for (;;) {
        const Node& node = nodes_[number];
        ++counts.comparisons;
        const bool past = is_past(line, lines_[node.line]);
        if (!past)
            found = node.line;
        if (node.left == node.right)
            return found;
        number = past ? node.right : node.left;
    }
}

std::vector<std::uint32_t> DualArrangement::order(std::size_t version) const {
    std::vector<std::uint32_t> lines;
    std::vector<std::uint32_t> open = {roots_.at(version)};
    while (!open.empty()) {
        const Node& node = nodes_[open.back()];
        open.pop_back();
        if (node.left == node.right) {
            lines.push_back(node.line);
            continue;
        }
        open.push_back(node.right);
        open.push_back(node.left);
    }
    return lines;
}

std::size_t DualArrangement::bytes() const {
    return lines_.capacity() * sizeof(DualLine) + slopes_.capacity() * sizeof(Slope)
        + roots_.capacity() * sizeof(std::uint32_t) + nodes_.capacity() * sizeof(Node);
}

double DualArrangement::bytes_forecast(std::size_t lines) {
    const auto n = static_cast<double>(lines);
    const double crossings = n * (n - 1) / 2;
    const auto levels = static_cast<double>(std::bit_width(lines) + 1);
    // A crossing changes two places next to each other, at it or behind it; a vector that grows has
    // up to twice the room.
    return n * sizeof(DualLine) + crossings * (sizeof(Crossing) + 2 * sizeof(Slope))
        + 4 * crossings * sizeof(std::uint32_t)
        + 2 * (2 * n + crossings * (levels + 4)) * sizeof(Node);
}

std::optional<std::uint32_t>
brute_force_first_above(std::span<const DualLine> lines, const SideView& line) {
    std::optional<std::uint32_t> first;
    for (std::uint32_t i = 0; i < lines.size(); ++i) {
        if (is_past(line, lines[i]))
            continue;
        if (!first) {
            first = i;
            continue;
        }
        const std::int64_t height = height_at(lines[i], line.slope);
        const std::int64_t height_of_first = height_at(lines[*first], line.slope);
        if (height < height_of_first
            || (height == height_of_first && lines[i].is_upper < lines[*first].is_upper))
            first = i;
    }
    return first;
}

} // namespace vera
