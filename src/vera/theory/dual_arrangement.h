// SPDX-License-Identifier: Apache-2.0
// Point location among lines of a dual plane (VERA 3.3.1, figure 3c). Seen from the side, a ray's
// line is x = a z + b. It is the point (a, b) of the dual plane, and a point (z, x) there is the
// line b = x - a z of all lines through it. A line lies below a point where its dual point lies
// below the point's line. To move a line upward until it meets a point is to move its dual point
// upward to the first line above it.
//
// From left to right, the order of n dual lines changes where two of them cross: at O(n^2) slopes.
// All orders are kept, in a tree of which a version is a root: what does not change is shared
// (Sarnak and Tarjan 1986, by copying paths). A location is a search for the version, and one in
// it: O(log n), in O(n^2 log n) of space.
#pragma once

#include "vera/base/parallel.h"
#include "vera/theory/plane_strip.h"
#include "vera/theory/slope.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// The end of a side of a rectangle, seen from the side: x is z of the point's y.
struct DualLine {
    PlanePoint end;        ///< (z, x)
    bool is_upper = false; ///< of the side; else the lower one

    friend constexpr bool operator==(DualLine, DualLine) = default;
};

/// The height of the dual line at the slope, times its run: at most 2^62.
constexpr std::int64_t height_at(const DualLine& line, Slope slope) {
    return line.end.y * slope.run - line.end.x * slope.rise;
}

/// The steps of a query; the same on every machine.
struct DualCounts {
    std::uint64_t comparisons = 0; ///< of slopes, of points and lines, and in sorted lists
    std::uint64_t nodes = 0;       ///< of trees
    std::uint64_t rectangles = 0;  ///< looked at one by one
    std::uint64_t words = 0;       ///< of bits

    std::uint64_t steps() const { return comparisons + nodes + rectangles + words; }
};

/// Whether the line has risen past the end, so that the end decides no more: to a lower end, which
/// belongs to its side, or beyond an upper one.
constexpr bool is_past(const SideView& line, const DualLine& dual) {
    const std::int64_t height = height_at(dual, line.slope);
    return dual.is_upper ? line.height > height : line.height >= height;
}

class DualArrangement {
public:
    DualArrangement() = default;

    /// Of lines of which no two are equal; at most 2^16. Takes O(n^2 log n). Throws Cancelled.
    explicit DualArrangement(
        std::vector<DualLine> lines,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    /// The number of the line that comes first when the ray's line rises, of those that it is not
    /// past; of several at once a lower end. Nothing where it is past all.
    std::optional<std::uint32_t> first_above(const SideView& line, DualCounts& counts) const;

    std::span<const DualLine> lines() const { return lines_; }

    /// Of the order of lines: two for each slope at which lines cross, and one.
    std::size_t version_count() const { return roots_.size(); }

    /// The lines of a version, from the lowest to the highest.
    std::vector<std::uint32_t> order(std::size_t version) const;

    std::span<const Slope> crossing_slopes() const { return slopes_; }

    std::size_t bytes() const;

    /// At most so much, in bytes, of so many lines; with what building takes for a while.
    static double bytes_forecast(std::size_t lines);

private:
    friend class DualArrangementBuilder;

    /// Of the places from some on; a leaf is one place, and has its line in `line`.
    struct Node {
        std::uint32_t left = 0;
        std::uint32_t right = 0;
        std::uint32_t line = 0; ///< the lowest one of the right child
    };

    std::vector<DualLine> lines_;
    std::vector<Slope> slopes_;        ///< at which lines cross, ascending
    std::vector<std::uint32_t> roots_; ///< before the first slope, at it, behind it, and so on
    std::vector<Node> nodes_;
};

/// The reference: looks at each line.
std::optional<std::uint32_t>
brute_force_first_above(std::span<const DualLine> lines, const SideView& line);

} // namespace vera
