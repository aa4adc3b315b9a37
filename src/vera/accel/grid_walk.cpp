// SPDX-License-Identifier: Apache-2.0
// The plain walk of one ray through a tree of grids, in the arithmetic of grid_search.cpp: floats
// where that has registers of floats.
#include "vera/accel/element_meeting.h"
#include "vera/accel/grid_structures.h"
#include "vera/accel/walk_recorder.h"

#include <algorithm>
#include <cmath>

namespace vera::detail {

namespace {

using Outcome = WalkedObject::Outcome;

/// A grid that the ray comes to.
struct GridVisit {
    Frame& frame;
    std::size_t place = 0; ///< number in RayWalk::places
    std::uint32_t level = 1;
    std::uint32_t number = 0; ///< of the grid

    const GeometryGrids& grids() const { return static_cast<const GeometryGrids&>(*frame.local); }

    const Grid& grid() const { return grids().grids[number]; }
};

/// What lies between two numbers.
struct Range {
    double least = 0;
    double most = 0;
};

/// The ray's part in a grid, in cells. It goes on slice by slice along the axis on which it passes
/// the most of them.
struct Way {
    std::size_t axis = 0;
    std::array<std::size_t, 2> across = {1, 2};
    bool forward = true;
    float box_far = 0;             ///< the local distance where it leaves the grid's box
    double enter = 0;              ///< along the axis
    double leave = 0;              ///< along the axis
    double margin = 0;             ///< along the axis: the ray may be off by so much
    std::array<Range, 2> at_enter; ///< across, margins included
    std::array<Range, 2> at_leave;
};

/// Where a line is on the planes between slices, and by how much it moves from each to the next.
struct MovingRange {
    Range now;
    Range step;
};

bool meets_box(const Frame& frame, const Box3& box, float& near, float& far) {
    const float slack = 2 * frame.slack;
    near = 0;
    far = frame.limit[0];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float origin = frame.origin[axis][0];
        const float inverse = frame.inverse[axis][0];
        const float at_lower = (static_cast<float>(box.lower[axis]) - slack - origin) * inverse;
        const float at_upper = (static_cast<float>(box.upper[axis]) + slack - origin) * inverse;
        near = std::max(near, std::min(at_lower, at_upper));
        far = std::min(far, std::max(at_lower, at_upper));
    }
    return near <= far + slack;
}

double in_cells(const Grid& grid, std::size_t axis, float place) {
    return (static_cast<double>(place) - grid.box.lower[axis]) * grid.cells_per_unit[axis];
}

/// False where the ray has no direction.
bool find_advance(const Frame& frame, const Grid& grid, Way& way) {
    double most_slices = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float along = frame.direction[axis][0];
        const double slices = static_cast<double>(std::abs(along)) * grid.cells_per_unit[axis];
        if (slices <= most_slices)
            continue;
        most_slices = slices;
        way.axis = axis;
        way.across = {axis == 0 ? std::size_t{1} : 0, axis == 2 ? std::size_t{1} : 2};
        way.forward = along > 0;
    }
    return most_slices > 0;
}

void find_ends(const Frame& frame, const Grid& grid, float near, float far, Way& way) {
    const std::size_t k = way.axis;
    const float origin = frame.origin[k][0];
    const float along = frame.direction[k][0];
    const float at_near = origin + near * along;
    const float at_far = origin + far * along;
    const float least = std::min(at_near, at_far);
    const float most = std::max(at_near, at_far);
    const float enter = way.forward ? least : most;
    const float leave = way.forward ? most : least;
    const double slack = 2 * static_cast<double>(frame.slack);
    way.box_far = far;
    way.enter = in_cells(grid, k, enter);
    way.leave = in_cells(grid, k, leave);
    way.margin = slack * grid.cells_per_unit[k];
    for (std::size_t side = 0; side < 2; ++side) {
        const std::size_t axis = way.across[side];
        const float start = frame.origin[axis][0];
        const float slope = frame.direction[axis][0] * frame.inverse[k][0];
        const double margin =
            slack * (1 + static_cast<double>(std::abs(slope))) * grid.cells_per_unit[axis];
        const double entering = in_cells(grid, axis, start + (enter - origin) * slope);
        const double leaving = in_cells(grid, axis, start + (leave - origin) * slope);
        way.at_enter[side] = {entering - margin, entering + margin};
        way.at_leave[side] = {leaving - margin, leaving + margin};
    }
}

/// What holds the ray in the first slice, of which the part `left` is still to be passed.
MovingRange first_range(const Way& way, std::size_t side, double left) {
    const Range& enter = way.at_enter[side];
    const Range& leave = way.at_leave[side];
    const double length = std::abs(way.leave - way.enter);
    if (length <= 0x1p-10) // too short for a slope
        return {{std::min(enter.least, leave.least), std::max(enter.most, leave.most)}, {}};
    const Range step = {(leave.least - enter.least) / length, (leave.most - enter.most) / length};
    const Range after = {enter.least + left * step.least, enter.most + left * step.most};
    return {
        {std::min(after.least, after.least - step.least),
         std::max(after.most, after.most - step.most)},
        step};
}

std::int32_t slice_at(double place, std::int32_t count) {
    return static_cast<std::int32_t>(std::clamp(place, 0.0, static_cast<double>(count - 1)));
}

class GridWalk {
public:
    explicit GridWalk(PacketQuery& query)
        : query_(query) {}

    void visit(const GridVisit& at) {
        if (!is_active(query_))
            return;
        Way way;
        float near = 0;
        float far = 0;
        if (!meets_box(at.frame, at.grid().box, near, far)
            || !find_advance(at.frame, at.grid(), way))
            return;
        find_ends(at.frame, at.grid(), near, far, way);
        follow(at, way);
    }

private:
    /// The slice in which the ray ends, as far as is known now.
    static std::int32_t last_slice(const GridVisit& at, const Way& way) {
        const Frame& frame = at.frame;
        const float t = std::min(way.box_far, frame.limit[0]);
        const float place = frame.origin[way.axis][0] + t * frame.direction[way.axis][0];
        const double margin = way.forward ? way.margin : -way.margin;
        return slice_at(in_cells(at.grid(), way.axis, place) + margin, at.grid().counts[way.axis]);
    }

    void follow(const GridVisit& at, const Way& way) {
        const std::int32_t count = at.grid().counts[way.axis];
        const double margin = way.forward ? way.margin : -way.margin;
        std::int32_t slice = slice_at(way.enter - margin, count);
        std::int32_t last = slice_at(way.leave + margin, count);
        const double left = std::max(way.forward ? slice + 1 - way.enter : way.enter - slice, 0.0);
        std::array<MovingRange, 2> ranges = {first_range(way, 0, left), first_range(way, 1, left)};
        std::uint32_t changes = query_.changes;
        while (true) {
            visit_slice(at, way, slice, ranges);
            if (query_.changes != changes) {
                changes = query_.changes;
                if (!is_active(query_))
                    return;
                last = last_slice(at, way);
            }
            if (way.forward ? slice >= last : slice <= last)
                return;
            slice += way.forward ? 1 : -1;
            for (MovingRange& range : ranges) {
                range.now.least += range.step.least;
                range.now.most += range.step.most;
            }
        }
    }

    /// All cells of the slice in which the ray may be.
    void visit_slice(
        const GridVisit& at,
        const Way& way,
        std::int32_t slice,
        const std::array<MovingRange, 2>& ranges) {
        std::array<std::int32_t, 2> first = {};
        std::array<std::int32_t, 2> last = {};
        for (std::size_t side = 0; side < 2; ++side) {
            const Range& now = ranges[side].now;
            const std::int32_t count = at.grid().counts[way.across[side]];
            if (now.most < 0 || now.least >= count)
                return;
            first[side] = slice_at(now.least, count);
            last[side] = slice_at(now.most, count);
        }
        std::array<std::int32_t, 3> cell = {};
        cell[way.axis] = slice;
        query_.counts.cells += static_cast<std::uint64_t>(last[0] - first[0] + 1)
            * static_cast<std::uint64_t>(last[1] - first[1] + 1);
        for (std::int32_t v = first[1]; v <= last[1]; ++v)
            for (std::int32_t u = first[0]; u <= last[0]; ++u) {
                cell[way.across[0]] = u;
                cell[way.across[1]] = v;
                visit_cell(at, cell);
            }
    }

    void visit_cell(const GridVisit& at, const std::array<std::int32_t, 3>& place) {
        const Grid& grid = at.grid();
        const auto number = static_cast<std::size_t>(
            place[0] + grid.counts[0] * (place[1] + std::int64_t{grid.counts[1]} * place[2]));
        const Cell cell = at.grids().cells[grid.first_cell + number];
        WalkStep step;
        step.place = at.place;
        step.level = at.level;
        step.number = at.number;
        step.cell = place;
        Vec3 lower = grid.box.lower;
        for (std::size_t axis = 0; axis < 3; ++axis)
            lower[axis] += grid.cell_size[axis] * place[axis];
        step.box = {own_point(at.grids(), lower), own_point(at.grids(), lower + grid.cell_size)};
        if (!cell.empty() && cell.is_grid()) {
            step.is_grid = true;
            step.own_grid = cell.grid();
        } else if (!cell.empty()) {
            step.listed = at.grids().lists[cell.list()];
        }
        const std::size_t added = query_.recorder->add(step);
        if (step.is_grid)
            visit({at.frame, at.place, at.level + 1, step.own_grid});
        else if (!cell.empty())
            visit_list(at, added, cell.list());
    }

    void visit_list(const GridVisit& at, std::size_t step, std::uint32_t list) {
        const std::uint32_t* const elements = at.grids().lists.data() + list + 1;
        const std::uint32_t count = at.grids().lists[list];
        for (std::uint32_t i = 0; i < count && is_active(query_); ++i) {
            const std::uint32_t element = elements[i];
            if (query_.mailbox.post(at.frame.visit, element, walking_lane) == 0) {
                query_.recorder->add_object(step, at.frame, element, Outcome::again);
                continue;
            }
            const ElementRecord& record = at.grids().records[element];
            const bool may = element_meeting(at.frame, record).may;
            if (record.kind == ElementRecord::Kind::call) {
                visit_call(at, step, element, may);
                continue;
            }
            ++query_.counts.tests;
            query_.recorder->add_test(step, query_, at.frame, element);
            if (may)
                test_exactly(query_, at.frame, element, walking_lane);
        }
    }

    void visit_call(const GridVisit& at, std::size_t step, std::uint32_t element, bool may) {
        WalkRecorder& recorder = *query_.recorder;
        if (may && too_deep(at.frame))
            return recorder.add_plain_search(step, query_, at.frame, element);
        if (!may || enter_call(query_, at.frame, element, walking_lane) == 0) {
            recorder.add_object(step, at.frame, element);
            return;
        }
        const std::size_t place = recorder.enter_call(at.place, at.frame, element);
        recorder.add_object(step, at.frame, element, Outcome::entered).place = place;
        visit({query_.frames[at.frame.depth + std::size_t{1}], place, at.level + 1, 0});
        refresh_limits(query_, at.frame, walking_lane);
    }

    PacketQuery& query_;
};

} // namespace

void walk_grids(PacketQuery& query) {
    query.mailbox.clear();
    query.local_start = LocalStart::in_bounds;
    const std::size_t place = query.recorder->enter_scene();
    if (enter_scene(query) != 0)
        GridWalk(query).visit({query.frames.front(), place, 1, 0});
}

} // namespace vera::detail
