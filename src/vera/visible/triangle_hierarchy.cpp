// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/triangle_hierarchy.h"

#include "vera/base/check.h"
#include "vera/base/long_loop.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <utility>

namespace vera {

namespace {

/// A triangulation has points of so many neighbours, or less: their mean is less than 6.
constexpr std::size_t most_neighbors = 8;

} // namespace

/// Makes one level of the hierarchy after the other.
class TriangleHierarchyBuilder {
public:
    explicit TriangleHierarchyBuilder(TriangleHierarchy& hierarchy)
        : hierarchy_(hierarchy) {}

    void build(const CancelFlag* cancel);

private:
    using Triangle = TriangleHierarchy::Triangle;

    void list_triangles_of_points();
    bool take_points();
    bool find_ring(std::uint32_t point);
    void fill_ring(std::span<const std::uint32_t> before);
    void add_triangle(
        const std::array<std::uint32_t, 3>& corners, std::span<const std::uint32_t> before);
    bool is_ear(std::size_t middle);
    bool do_overlap(const std::array<std::uint32_t, 3>& a, const std::array<std::uint32_t, 3>& b);

    int side(std::uint32_t from, std::uint32_t to, std::uint32_t point) {
        ++hierarchy_.build_steps_;
        return vera::side(
            hierarchy_.points_[from], hierarchy_.points_[to], hierarchy_.points_[point]);
    }

    std::span<const std::uint32_t> triangles_of(std::uint32_t point) const {
        return std::span(triangles_).subspan(starts_[point], starts_[point + 1] - starts_[point]);
    }

    TriangleHierarchy& hierarchy_;
    std::vector<std::uint32_t> level_;     ///< the triangles of the last level so far
    std::vector<std::uint32_t> starts_;    ///< of each point, in triangles_
    std::vector<std::uint32_t> triangles_; ///< of the level, by their corners
    std::vector<std::uint32_t> ring_;      ///< the neighbours of a point, to the left round it
};

void TriangleHierarchyBuilder::list_triangles_of_points() {
    starts_.assign(hierarchy_.points_.size() + 1, 0);
    for (const std::uint32_t triangle : level_)
        for (const std::uint32_t corner : hierarchy_.triangles_[triangle].corners)
            ++starts_[corner + 1];
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    triangles_.resize(starts_.back());
    std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
    for (const std::uint32_t triangle : level_)
        for (const std::uint32_t corner : hierarchy_.triangles_[triangle].corners)
            triangles_[next[corner]++] = triangle;
}

/// Of an inner point with few neighbours.
bool TriangleHierarchyBuilder::find_ring(std::uint32_t point) {
    const auto around = triangles_of(point);
    if (around.empty() || around.size() > most_neighbors)
        return false;
    const auto way_past = [&](std::uint32_t triangle) {
        const auto& corners = hierarchy_.triangles_[triangle].corners;
        const auto at = static_cast<std::size_t>(
            std::find(corners.begin(), corners.end(), point) - corners.begin());
        return std::pair(corners[(at + 1) % 3], corners[(at + 2) % 3]);
    };
    ring_.assign(1, way_past(around[0]).second);
    while (ring_.size() < around.size()) {
        const auto next = std::find_if(around.begin(), around.end(), [&](std::uint32_t triangle) {
            return way_past(triangle).first == ring_.back();
        });
        VERA_CHECK(next != around.end());
        ring_.push_back(way_past(*next).second);
    }
    return true;
}

bool TriangleHierarchyBuilder::is_ear(std::size_t middle) {
    const std::size_t count = ring_.size();
    const std::array<std::uint32_t, 3> ear = {
        ring_[(middle + count - 1) % count], ring_[middle], ring_[(middle + 1) % count]};
    if (side(ear[0], ear[1], ear[2]) <= 0)
        return false;
    return std::none_of(ring_.begin(), ring_.end(), [&](std::uint32_t point) {
        return std::find(ear.begin(), ear.end(), point) == ear.end()
            && side(ear[0], ear[1], point) >= 0 && side(ear[1], ear[2], point) >= 0
            && side(ear[2], ear[0], point) >= 0;
    });
}

/// Whether they have more in common than points of their borders.
bool TriangleHierarchyBuilder::do_overlap(
    const std::array<std::uint32_t, 3>& a, const std::array<std::uint32_t, 3>& b) {
    const auto is_parted_by_side_of = [&](const auto& one, const auto& other) {
        for (std::size_t i = 0; i < 3; ++i)
            if (std::all_of(other.begin(), other.end(), [&](std::uint32_t point) {
                    return side(one[i], one[(i + 1) % 3], point) <= 0;
                }))
                return true;
        return false;
    };
    return !is_parted_by_side_of(a, b) && !is_parted_by_side_of(b, a);
}

void TriangleHierarchyBuilder::add_triangle(
    const std::array<std::uint32_t, 3>& corners, std::span<const std::uint32_t> before) {
    Triangle triangle;
    triangle.corners = corners;
    triangle.first = static_cast<std::uint32_t>(hierarchy_.overlapped_.size());
    for (const std::uint32_t other : before)
        if (do_overlap(corners, hierarchy_.triangles_[other].corners))
            hierarchy_.overlapped_.push_back(other);
    triangle.overlap_count =
        static_cast<std::uint32_t>(hierarchy_.overlapped_.size()) - triangle.first;
    level_.push_back(static_cast<std::uint32_t>(hierarchy_.triangles_.size()));
    hierarchy_.triangles_.push_back(triangle);
}

/// Cuts off ears: a polygon of so few corners has no need of more.
void TriangleHierarchyBuilder::fill_ring(std::span<const std::uint32_t> before) {
    while (ring_.size() > 3) {
        std::size_t middle = 0;
        while (!is_ear(middle)) {
            ++middle;
            VERA_CHECK(middle < ring_.size());
        }
        const std::size_t count = ring_.size();
        add_triangle(
            {ring_[(middle + count - 1) % count], ring_[middle], ring_[(middle + 1) % count]},
            before);
        ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(middle));
    }
    add_triangle({ring_[0], ring_[1], ring_[2]}, before);
}

/// Makes the next level; false where there are no inner points left.
bool TriangleHierarchyBuilder::take_points() {
    list_triangles_of_points();
    hierarchy_.build_steps_ += level_.size();
    const auto count = static_cast<std::uint32_t>(hierarchy_.points_.size());
    std::vector<std::uint8_t> has_taken_neighbor(count);
    std::vector<std::uint8_t> is_replaced(hierarchy_.triangles_.size());
    bool any = false;
    for (std::uint32_t point = 2; point + 2 < count; ++point) {
        if (has_taken_neighbor[point] != 0 || !find_ring(point))
            continue;
        any = true;
        for (const std::uint32_t neighbor : ring_)
            has_taken_neighbor[neighbor] = 1;
        for (const std::uint32_t triangle : triangles_of(point))
            is_replaced[triangle] = 1;
        fill_ring(triangles_of(point));
    }
    std::erase_if(level_, [&](std::uint32_t triangle) {
        return triangle < is_replaced.size() && is_replaced[triangle] != 0;
    });
    return any;
}

void TriangleHierarchyBuilder::build(const CancelFlag* cancel) {
    level_.resize(hierarchy_.triangles_.size());
    std::iota(level_.begin(), level_.end(), 0U);
    do {
        stop_if_raised(cancel);
        ++hierarchy_.levels_;
    } while (take_points());
    hierarchy_.last_level_ = std::move(level_);
}

TriangleHierarchy::TriangleHierarchy(MapTriangulation map, const CancelFlag* cancel)
    : points_(std::move(map.points))
    , build_steps_(map.steps) {
    triangles_.reserve(3 * map.triangles.size());
    for (std::size_t i = 0; i < map.triangles.size(); ++i)
        triangles_.push_back({map.triangles[i], 0, map.regions[i]});
    TriangleHierarchyBuilder(*this).build(cancel);
}

bool TriangleHierarchy::contains(
    const Triangle& triangle, const MapPoint& point, LocatorSteps& steps) const {
    for (std::size_t i = 0; i < 3; ++i) {
        ++steps.comparisons;
        if (side(points_[triangle.corners[i]], points_[triangle.corners[(i + 1) % 3]], point) < 0)
            return false;
    }
    return true;
}

std::uint32_t TriangleHierarchy::region_at(const MapPoint& point, LocatorSteps& steps) const {
    ++steps.queries;
    const auto containing = [&](std::span<const std::uint32_t> triangles) {
        // What lies in their union and in none of the others lies in the last one.
        for (const std::uint32_t triangle : triangles.first(triangles.size() - 1))
            if (contains(triangles_[triangle], point, steps))
                return triangle;
        return triangles.back();
    };
    std::uint32_t at = containing(last_level_);
    while (triangles_[at].overlap_count != 0)
        at = containing(
            std::span(overlapped_).subspan(triangles_[at].first, triangles_[at].overlap_count));
    return triangles_[at].first;
}

std::size_t TriangleHierarchy::memory() const {
    return points_.capacity() * sizeof(MapPoint) + triangles_.capacity() * sizeof(Triangle)
        + (overlapped_.capacity() + last_level_.capacity()) * sizeof(std::uint32_t);
}

} // namespace vera
