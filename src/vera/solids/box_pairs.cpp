// SPDX-License-Identifier: Apache-2.0
#include "vera/solids/box_pairs.h"

#include "vera/base/long_loop.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace vera {

namespace {

using Numbers = std::vector<std::uint32_t>;

bool meet(const Box3& a, const Box3& b) {
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y
        && b.lower.y <= a.upper.y && a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

/// Halves sets of boxes again and again: what meets within a set meets within one half, or between
/// the halves.
class PairSearch {
public:
    PairSearch(
        std::span<const Box3> boxes,
        const std::function<void(std::uint32_t, std::uint32_t)>& visit,
        const Progress& progress,
        const CancelFlag* cancel)
        : boxes_(boxes)
        , visit_(visit)
        , progress_(progress)
        , cancel_(cancel) {}

    void within(std::span<std::uint32_t> numbers) {
        stop_if_raised(cancel_);
        if (numbers.size() <= few) {
            for (std::size_t i = 0; i < numbers.size(); ++i)
                for (std::size_t k = i + 1; k < numbers.size(); ++k)
                    compare(numbers[i], numbers[k]);
            done_ += numbers.size();
            if (progress_ && done_ > 0)
                progress_(static_cast<double>(done_) / static_cast<double>(boxes_.size()));
            return;
        }
        const std::size_t half = numbers.size() / 2;
        halve(numbers);
        const Numbers first(numbers.begin(), numbers.begin() + static_cast<std::ptrdiff_t>(half));
        const Numbers second(numbers.begin() + static_cast<std::ptrdiff_t>(half), numbers.end());
        between(first, second);
        within(numbers.first(half));
        within(numbers.subspan(half));
    }

private:
    static constexpr std::size_t few = 16;

    void compare(std::uint32_t i, std::uint32_t k) const {
        if (meet(boxes_[i], boxes_[k]))
            visit_(std::min(i, k), std::max(i, k));
    }

    Box3 around(std::span<const std::uint32_t> numbers) const {
        Box3 box;
        for (const std::uint32_t i : numbers) {
            box.lower = min(box.lower, boxes_[i].lower);
            box.upper = max(box.upper, boxes_[i].upper);
        }
        return box;
    }

    Numbers those_that_meet(const Box3& box, const Numbers& numbers) const {
        Numbers kept;
        for (const std::uint32_t i : numbers)
            if (meet(box, boxes_[i]))
                kept.push_back(i);
        return kept;
    }

    /// Across the longest side of the box round the middles.
    void halve(std::span<std::uint32_t> numbers) const {
        const auto middle = [&](std::uint32_t i) {
            return 0.5 * boxes_[i].lower + 0.5 * boxes_[i].upper;
        };
        Box3 middles;
        for (const std::uint32_t i : numbers)
            middles = grown(middles, middle(i));
        const std::size_t axis = longest_axis(middles.upper - middles.lower);
        std::nth_element(
            numbers.begin(),
            numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2),
            numbers.end(),
            [&](std::uint32_t a, std::uint32_t b) {
                const double at_a = middle(a)[axis];
                const double at_b = middle(b)[axis];
                return at_a != at_b ? at_a < at_b : a < b;
            });
    }

    void between(const Numbers& all_first, const Numbers& all_second) {
        stop_if_raised(cancel_);
        const Numbers first = those_that_meet(around(all_second), all_first);
        Numbers second = those_that_meet(around(first), all_second);
        if (first.empty() || second.empty())
            return;
        if (first.size() <= few || second.size() <= few) {
            for (const std::uint32_t i : first)
                for (const std::uint32_t k : second)
                    compare(i, k);
            return;
        }
        const bool halves_first = first.size() > second.size();
        Numbers halved = halves_first ? first : second;
        const Numbers& whole = halves_first ? second : first;
        halve(halved);
        const auto middle = halved.begin() + static_cast<std::ptrdiff_t>(halved.size() / 2);
        between(Numbers(halved.begin(), middle), whole);
        between(Numbers(middle, halved.end()), whole);
    }

    std::span<const Box3> boxes_;
    const std::function<void(std::uint32_t, std::uint32_t)>& visit_;
    const Progress& progress_;
    const CancelFlag* cancel_;
    std::size_t done_ = 0;
};

} // namespace

void for_each_box_pair(
    std::span<const Box3> boxes,
    const std::function<void(std::uint32_t, std::uint32_t)>& visit,
    const Progress& progress,
    const CancelFlag* cancel) {
    Numbers numbers(boxes.size());
    std::iota(numbers.begin(), numbers.end(), std::uint32_t{0});
    PairSearch(boxes, visit, progress, cancel).within(numbers);
    if (progress)
        progress(1);
}

} // namespace vera
