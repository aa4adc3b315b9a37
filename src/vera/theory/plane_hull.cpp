// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/plane_hull.h"

#include "vera/exact/wide_integer.h"

#include <algorithm>
#include <utility>

namespace vera {

namespace {

using Numbers = std::vector<std::uint32_t>;

bool is_left(PlanePoint a, PlanePoint b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
}

/// 1 where the way from a over b to c turns to the left, -1 where to the right.
int turn(PlanePoint a, PlanePoint b, PlanePoint c) {
    const PlaneDirection ab = direction_between(a, b);
    const PlaneDirection ac = direction_between(a, c);
    return sign(Int128{ab.x} * ac.y - Int128{ab.y} * ac.x);
}

/// The vertices of the sorted points where the way turns so at each (Andrew 1979).
Numbers chain(std::span<const PlanePoint> points, const Numbers& sorted, int wanted_turn) {
    Numbers kept;
    for (const std::uint32_t number : sorted) {
        while (kept.size() > 1
               && turn(points[kept[kept.size() - 2]], points[kept.back()], points[number])
                   != wanted_turn)
            kept.pop_back();
        kept.push_back(number);
    }
    return kept;
}

PlaneHull hull_of_numbers(std::span<const PlanePoint> points, Numbers numbers) {
    std::sort(numbers.begin(), numbers.end(), [&](std::uint32_t a, std::uint32_t b) {
        return points[a] != points[b] ? is_left(points[a], points[b]) : a < b;
    });
    const auto end =
        std::unique(numbers.begin(), numbers.end(), [&](std::uint32_t a, std::uint32_t b) {
            return points[a] == points[b];
        });
    numbers.erase(end, numbers.end());
    return {chain(points, numbers, 1), chain(points, numbers, -1)};
}

/// Products along a chain, and how many of them were asked for.
class ChainProducts {
public:
    ChainProducts(PlaneDirection normal, std::span<const PlanePoint> points)
        : normal_(normal)
        , points_(points) {}

    std::int64_t of(std::uint32_t number) {
        ++count_;
        return dot(normal_, points_[number]);
    }

    /// At the first vertex whose next one is not before it; before(a, b) compares products, and
    /// holds from one vertex to the next up to some place.
    template <typename Before>
    std::int64_t last_that_follows(std::span<const std::uint32_t> chain, const Before& before) {
        std::size_t low = 0;
        std::size_t high = chain.size() - 1;
        while (low < high) {
            const std::size_t middle = (low + high) / 2;
            if (before(of(chain[middle]), of(chain[middle + 1])))
                low = middle + 1;
            else
                high = middle;
        }
        return of(chain[low]);
    }

    std::uint64_t count() const { return count_; }

private:
    PlaneDirection normal_;
    std::span<const PlanePoint> points_;
    std::uint64_t count_ = 0;
};

} // namespace

PlaneHull hull_of(std::span<const PlanePoint> points, std::span<const std::uint32_t> numbers) {
    return hull_of_numbers(points, Numbers(numbers.begin(), numbers.end()));
}

PlaneHull
hull_of(std::span<const PlanePoint> points, const PlaneHull& first, const PlaneHull& second) {
    Numbers numbers = first.below;
    for (const Numbers* chain : {&first.above, &second.below, &second.above})
        numbers.insert(numbers.end(), chain->begin(), chain->end());
    return hull_of_numbers(points, std::move(numbers));
}

HullExtent extent_along(
    PlaneDirection normal,
    std::span<const PlanePoint> points,
    std::span<const std::uint32_t> below,
    std::span<const std::uint32_t> above) {
    if (normal.y < 0) {
        const HullExtent turned = extent_along(-normal, points, below, above);
        return {-turned.highest, -turned.lowest, turned.vertices};
    }
    // The normal does not point down. So the product falls first along the chain below and then
    // does not; along that above it does not fall first, and then does.
    ChainProducts products(normal, points);
    const std::int64_t lowest =
        products.last_that_follows(below, [](std::int64_t a, std::int64_t b) { return b < a; });
    const std::int64_t highest =
        products.last_that_follows(above, [](std::int64_t a, std::int64_t b) { return b >= a; });
    return {lowest, highest, products.count()};
}

} // namespace vera
