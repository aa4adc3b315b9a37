// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/conjugation_tree.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/theory/ham_sandwich.h"

#include <algorithm>
#include <utility>

namespace vera {

namespace {

using Numbers = std::vector<std::uint32_t>;

/// What dividing takes of the time, beside the hulls.
constexpr double dividing_part = 0.8;

/// What is asked for where memory is not known to suffice.
std::span<const PlanePoint> required(std::span<const PlanePoint> points, std::size_t leaf_size) {
    require_tree(
        "a conjugation tree",
        points,
        leaf_size,
        ConjugationTree::bytes_forecast(points.size(), leaf_size)
            + static_cast<double>(points.size() * ConjugationTree::building_bytes_per_point));
    return points;
}

class ConjugationCuts {
public:
    ConjugationCuts(
        std::span<const PlanePoint> points,
        Numbers numbers,
        std::size_t leaf_size,
        EqualPoints equal,
        Progress progress,
        const CancelFlag* cancel)
        : points_(points)
        , leaf_size_(std::max<std::size_t>(leaf_size, 1))
        , equal_(equal)
        , progress_(std::move(progress))
        , cancel_(cancel) {
        shape_.numbers = std::move(numbers);
    }

    TreeShape shape() {
        const auto count = static_cast<std::uint32_t>(shape_.numbers.size());
        if (count > 0)
            add_node(0, count, {1, 0});
        return std::move(shape_);
    }

private:
    /// A node of the points from first to last, and all below it. Halves them along the direction.
    void add_node(std::uint32_t first, std::uint32_t last, PlaneDirection direction) {
        stop_if_raised(cancel_);
        const std::size_t number = shape_.nodes.size();
        shape_.nodes.push_back({first, last});
        if (is_undivided(first, last)) {
            tell(last);
            return;
        }
        const std::uint32_t middle = first + (last - first) / 2;
        halve(first, middle, last, direction);
        const PlaneDirection next = conjugate(first, middle, last, direction);
        add_node(first, middle, next);
        shape_.nodes[number].children = static_cast<std::uint32_t>(shape_.nodes.size());
        add_node(middle, last, next);
    }

    bool is_undivided(std::uint32_t first, std::uint32_t last) const {
        return last - first <= leaf_size_
            || (equal_ == EqualPoints::together && are_equal(first, last));
    }

    bool are_equal(std::uint32_t first, std::uint32_t last) const {
        const PlanePoint point = at(first);
        for (std::uint32_t i = first + 1; i < last; ++i)
            if (at(i) != point)
                return false;
        return true;
    }

    void
    halve(std::uint32_t first, std::uint32_t middle, std::uint32_t last, PlaneDirection direction) {
        const auto place = [&](std::uint32_t i) {
            return shape_.numbers.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(
            place(first),
            place(middle),
            place(last),
            [&, before = TurnedOrder{direction}](std::uint32_t a, std::uint32_t b) {
                return before(points_[a], points_[b]);
            });
    }

    /// The direction that halves both halves; any one where neither is divided.
    PlaneDirection conjugate(
        std::uint32_t first,
        std::uint32_t middle,
        std::uint32_t last,
        PlaneDirection direction) const {
        if (last - middle <= leaf_size_)
            return direction;
        std::vector<PlanePoint> points(last - first);
        for (std::uint32_t i = first; i < last; ++i)
            points[i - first] = at(i);
        const auto halves = std::span<const PlanePoint>(points);
        return conjugate_direction(
            halves.first(middle - first), halves.subspan(middle - first), direction, first);
    }

    void tell(std::uint32_t done) const {
        if (progress_)
            progress_(static_cast<double>(done) / static_cast<double>(shape_.numbers.size()));
    }

    PlanePoint at(std::uint32_t place) const { return points_[shape_.numbers[place]]; }

    std::span<const PlanePoint> points_;
    std::size_t leaf_size_;
    EqualPoints equal_;
    Progress progress_;
    const CancelFlag* cancel_;
    TreeShape shape_;
};

} // namespace

ConjugationTree::ConjugationTree(
    std::span<const PlanePoint> points,
    std::vector<std::uint32_t> numbers,
    std::size_t leaf_size,
    const Progress& progress,
    const CancelFlag* cancel,
    EqualPoints equal)
    : PartitionTree(
        points,
        ConjugationCuts(
            points,
            std::move(numbers),
            leaf_size,
            equal,
            progress_between(progress, 0, dividing_part),
            cancel)
            .shape(),
        progress_between(progress, dividing_part, 1),
        cancel) {}

ConjugationTree::ConjugationTree(
    std::span<const PlanePoint> points,
    std::size_t leaf_size,
    const Progress& progress,
    const CancelFlag* cancel)
    : ConjugationTree(
        required(points, leaf_size), all_numbers(points.size()), leaf_size, progress, cancel) {}

} // namespace vera
