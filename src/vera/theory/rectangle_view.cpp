// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/rectangle_view.h"

#include "vera/base/available_memory.h"
#include "vera/base/long_loop.h"
#include "vera/theory/covered_union.h"
#include "vera/theory/grid_rings.h"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>

namespace vera {

namespace {

bool has_area(const IsoRectangle& rectangle) {
    return rectangle.lower_x < rectangle.upper_x && rectangle.lower_y < rectangle.upper_y;
}

/// In ascending order, each once.
class Coordinates {
public:
    void add(std::int32_t value) { values_.push_back(value); }

    void sort() {
        std::sort(values_.begin(), values_.end());
        values_.erase(std::unique(values_.begin(), values_.end()), values_.end());
    }

    std::int32_t value(std::int32_t number) const {
        return values_[static_cast<std::size_t>(number)];
    }

    std::int32_t number(std::int32_t value) const {
        return static_cast<std::int32_t>(
            std::lower_bound(values_.begin(), values_.end(), value) - values_.begin());
    }

    std::int32_t count() const { return static_cast<std::int32_t>(values_.size()); }

private:
    std::vector<std::int32_t> values_;
};

/// Those with an area, the nearest first.
std::vector<std::uint32_t> depth_order(std::span<const IsoRectangle> rectangles) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t i = 0; i < rectangles.size(); ++i)
        if (has_area(rectangles[i]))
            order.push_back(i);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return rectangles[a].z < rectangles[b].z;
    });
    return order;
}

/// Asks for memory before it is taken. How much will be seen, nobody knows before: what a rectangle
/// may take is told by what it meets; and whenever the union and the map have grown to what was
/// asked for, it is for twice as much.
class RoomForView {
public:
    RoomForView(std::size_t rectangles, std::int32_t columns, std::int32_t rows)
        : what_("what is seen of " + std::to_string(rectangles) + " rectangles") {
        require_bytes(
            WindowTree::bytes_without_segments(columns) + WindowTree::bytes_without_segments(rows));
    }

    void
    require(const CoveredUnion& covered, const BoxMeeting& meeting, const RectangleView& view) {
        const std::size_t edges = meeting.most_edges();
        const std::size_t entries = covered.most_new_entries(meeting);
        require_bytes(
            static_cast<double>(edges) * bytes_of_edge
            + static_cast<double>(entries) * WindowTree::bytes_of_entry);
        require_twice(covered.entry_count() + entries, WindowTree::bytes_of_entry, most_entries_);
        require_twice(view.corners.size() + edges, bytes_of_corner, most_corners_);
    }

private:
    void require_bytes(double bytes) const {
        require_memory(
            bytes, what_, "take fewer of them, or rectangles that hide more of each other");
    }

    void require_twice(std::size_t count, double bytes, std::size_t& most) const {
        if (count <= most)
            return;
        most = std::max<std::size_t>(2 * count, 65536);
        require_bytes(static_cast<double>(most) / 2 * bytes);
    }

    /// Of a corner of the map, with its part of a ring, while lists grow.
    static constexpr double bytes_of_corner = 28;
    /// Of what is met, the edges that come of it, and the rings that are made of them.
    static constexpr double bytes_of_edge = 100;

    std::string what_;
    std::size_t most_entries_ = 0;
    std::size_t most_corners_ = 0;
};

} // namespace

RectangleView rectangle_view(
    std::span<const IsoRectangle> rectangles,
    WindowCounts* counts,
    const Progress& progress,
    const CancelFlag* cancel) {
    require_rectangles(rectangles);
    const std::vector<std::uint32_t> order = depth_order(rectangles);
    Coordinates xs;
    Coordinates ys;
    for (const std::uint32_t number : order) {
        const IsoRectangle& rectangle = rectangles[number];
        xs.add(rectangle.lower_x);
        xs.add(rectangle.upper_x);
        ys.add(rectangle.lower_y);
        ys.add(rectangle.upper_y);
    }
    xs.sort();
    ys.sort();

    WindowCounts here;
    RoomForView room(order.size(), xs.count(), ys.count());
    CoveredUnion covered(xs.count(), ys.count(), here);
    RectangleView view;
    const LongLoop loop(order.size(), progress, cancel);
    for (std::size_t i = 0; i < order.size(); ++i) {
        loop.turn(i);
        const IsoRectangle& rectangle = rectangles[order[i]];
        const CellBox box = {
            {PlaceRange{xs.number(rectangle.lower_x), xs.number(rectangle.upper_x)},
             PlaceRange{ys.number(rectangle.lower_y), ys.number(rectangle.upper_y)}}};
        const BoxMeeting meeting = covered.meeting(box);
        room.require(covered, meeting, view);
        for (const GridRing& ring : grid_rings(covered.cover(meeting), here.comparisons)) {
            view.rings.push_back({order[i], view.corners.size(), ring.size()});
            for (const GridCorner corner : ring)
                view.corners.push_back({xs.value(corner.x), ys.value(corner.y)});
        }
    }
    std::stable_sort(
        view.rings.begin(),
        view.rings.end(),
        [](const RectangleView::Ring& a, const RectangleView::Ring& b) {
            return a.rectangle < b.rectangle;
        });
    if (counts != nullptr)
        *counts += here;
    return view;
}

ScreenScene screen_scene(std::span<const IsoRectangle> rectangles) {
    std::vector<std::int32_t> depths;
    for (const IsoRectangle& rectangle : rectangles)
        depths.push_back(rectangle.z);
    std::sort(depths.begin(), depths.end());
    depths.erase(std::unique(depths.begin(), depths.end()), depths.end());
    const std::int64_t step = depth_size / static_cast<std::int64_t>(depths.size() + 1);

    ScreenScene scene;
    for (std::uint32_t i = 0; i < rectangles.size(); ++i) {
        const IsoRectangle& rectangle = rectangles[i];
        if (rectangle.lower_x < 0 || rectangle.lower_y < 0 || rectangle.upper_x > screen_size
            || rectangle.upper_y > screen_size)
            throw std::invalid_argument(
                "rectangle " + std::to_string(i) + " lies outside the grid of the picture: take "
                + "corners from 0 to " + std::to_string(screen_size));
        const auto behind = std::lower_bound(depths.begin(), depths.end(), rectangle.z);
        const std::int64_t nearness = step * std::distance(behind, depths.end());
        const auto first = static_cast<std::uint32_t>(scene.vertices.size());
        scene.vertices.push_back({{rectangle.lower_x, rectangle.lower_y}, nearness});
        scene.vertices.push_back({{rectangle.upper_x, rectangle.lower_y}, nearness});
        scene.vertices.push_back({{rectangle.upper_x, rectangle.upper_y}, nearness});
        scene.vertices.push_back({{rectangle.lower_x, rectangle.upper_y}, nearness});
        add_triangle(scene, {first, first + 1, first + 2}, i);
        add_triangle(scene, {first, first + 2, first + 3}, i);
    }
    return scene;
}

} // namespace vera
