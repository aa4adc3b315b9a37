// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/packet_query.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/grid_search.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// A sub-packet is Width lanes from first_lane on. Packets that fall apart are looked at in smaller
// ones, at last ray by ray; nothing is copied for that.
template <std::size_t Width>
using Tag = hn::CappedTag<float, Width>;

template <std::size_t Width>
using Vec = hn::Vec<Tag<Width>>;

template <std::size_t Width>
HWY_INLINE Vec<Width> row(const Frame::Row& values, std::size_t lane) {
    return hn::LoadU(Tag<Width>(), values.data() + lane);
}

template <std::size_t Width, typename Mask>
HWY_INLINE LaneMask bits(Mask mask, std::size_t lane) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Tag<Width>(), mask, bytes);
    const LaneMask all = bytes[0] | LaneMask{bytes[1]} << 8U;
    return (all & ((LaneMask{1} << hn::Lanes(Tag<Width>())) - 1)) << lane;
}

/// The rays of some lanes, in registers.
template <std::size_t Width>
struct Rays {
    Vec<Width> origin[3];
    Vec<Width> direction[3];
    Vec<Width> limit;
};

template <std::size_t Width>
HWY_INLINE Rays<Width> rays_at(const Frame& frame, std::size_t lane) {
    return {
        {row<Width>(frame.origin[0], lane),
         row<Width>(frame.origin[1], lane),
         row<Width>(frame.origin[2], lane)},
        {row<Width>(frame.direction[0], lane),
         row<Width>(frame.direction[1], lane),
         row<Width>(frame.direction[2], lane)},
        row<Width>(frame.limit, lane)};
}

template <std::size_t Width>
HWY_INLINE Vec<Width> all(float value) {
    return hn::Set(Tag<Width>(), value);
}

template <typename V>
HWY_INLINE V dot3(const V (&a)[3], const V (&b)[3]) {
    return hn::Add(hn::Add(hn::Mul(a[0], b[0]), hn::Mul(a[1], b[1])), hn::Mul(a[2], b[2]));
}

template <typename V>
HWY_INLINE void cross3(const V (&a)[3], const V (&b)[3], V (&result)[3]) {
    result[0] = hn::Sub(hn::Mul(a[1], b[2]), hn::Mul(a[2], b[1]));
    result[1] = hn::Sub(hn::Mul(a[2], b[0]), hn::Mul(a[0], b[2]));
    result[2] = hn::Sub(hn::Mul(a[0], b[1]), hn::Mul(a[1], b[0]));
}

// The cheap tests. Each returns all lanes whose rays, moved by up to frame.slack, may meet the
// element before their limits.

/// Squares of sums are rounded by a few units of 2^-24.
constexpr float up = 1 + 0x1p-20F;

template <std::size_t Width>
HWY_INLINE LaneMask
meets_ball(const Rays<Width>& rays, const float* center, float radius, std::size_t lane) {
    Vec<Width> to_center[3];
    for (std::size_t axis = 0; axis < 3; ++axis)
        to_center[axis] = hn::Sub(all<Width>(center[axis]), rays.origin[axis]);
    const auto closest = dot3(to_center, rays.direction);
    Vec<Width> offset[3];
    for (std::size_t axis = 0; axis < 3; ++axis)
        offset[axis] = hn::Sub(to_center[axis], hn::Mul(closest, rays.direction[axis]));
    const auto distance_squared = dot3(offset, offset);
    // The part of the ray from 0 to its limit comes as near as it does at the t nearest to closest.
    const auto zero = hn::Zero(Tag<Width>());
    const auto t = hn::Max(zero, hn::Min(rays.limit, closest));
    const auto beyond = hn::Sub(closest, t);
    const auto sum = hn::Add(distance_squared, hn::Mul(beyond, beyond));
    const auto near = hn::Le(sum, all<Width>(radius * radius * up));
    return bits<Width>(hn::And(near, hn::Ge(rays.limit, zero)), lane);
}

template <std::size_t Width>
HWY_INLINE LaneMask
meets_triangle(const Rays<Width>& rays, const float* values, float slack, std::size_t lane) {
    const float* a = values;
    const float* e = values + 3;
    const float* f = values + 6;
    float largest = 0;
    for (std::size_t i = 3; i < 9; ++i)
        largest = std::max(largest, std::abs(values[i]));
    // Moving the ray by slack changes a volume with the edge by at most slack times the edge's
    // length, which is at most sqrt(3) times its largest component; the third is a sum of two.
    const float volume_slack = 4 * slack * largest;
    const float depth_slack = 8 * slack * largest * largest;

    const Vec<Width> normal[3] = {
        all<Width>(e[1] * f[2] - e[2] * f[1]),
        all<Width>(e[2] * f[0] - e[0] * f[2]),
        all<Width>(e[0] * f[1] - e[1] * f[0])};
    Vec<Width> to_corner[3];
    for (std::size_t axis = 0; axis < 3; ++axis)
        to_corner[axis] = hn::Sub(all<Width>(a[axis]), rays.origin[axis]);
    Vec<Width> moment[3];
    cross3(to_corner, rays.direction, moment);
    const Vec<Width> edge_e[3] = {all<Width>(e[0]), all<Width>(e[1]), all<Width>(e[2])};
    const Vec<Width> edge_f[3] = {all<Width>(f[0]), all<Width>(f[1]), all<Width>(f[2])};
    const auto speed = dot3(normal, rays.direction);
    const auto depth = dot3(normal, to_corner);
    const auto u = dot3(moment, edge_f);
    const auto v = hn::Neg(dot3(moment, edge_e));
    const auto w = hn::Sub(hn::Sub(speed, u), v);

    const auto more = all<Width>(volume_slack);
    const auto less = all<Width>(-volume_slack);
    const auto lowest = hn::Min(u, hn::Min(v, w));
    const auto highest = hn::Max(u, hn::Max(v, w));
    const auto met = hn::Or(hn::Ge(lowest, less), hn::Le(highest, more));
    // t speed = depth: 0 <= t <= limit.
    const auto size = hn::Abs(speed);
    const auto forward = hn::CopySignToAbs(all<Width>(1), speed);
    const auto t_size = hn::Mul(depth, forward);
    const auto deep = all<Width>(depth_slack);
    const auto behind_start =
        hn::Ge(hn::Add(t_size, deep), hn::Neg(hn::Mul(all<Width>(slack), size)));
    const auto before_limit = hn::Le(hn::Sub(t_size, deep), hn::Mul(rays.limit, size));
    return bits<Width>(hn::And(met, hn::And(behind_start, before_limit)), lane);
}

template <std::size_t Width>
HWY_INLINE LaneMask meets_box(
    const Frame& frame,
    const float* lower,
    const float* upper,
    float slack,
    std::size_t lane,
    float* near_row,
    float* far_row) {
    const Tag<Width> d;
    auto near = hn::Zero(d);
    auto far = row<Width>(frame.limit, lane);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto origin = row<Width>(frame.origin[axis], lane);
        const auto inverse = row<Width>(frame.inverse[axis], lane);
        const auto at_lower = hn::Mul(hn::Sub(all<Width>(lower[axis] - slack), origin), inverse);
        const auto at_upper = hn::Mul(hn::Sub(all<Width>(upper[axis] + slack), origin), inverse);
        near = hn::Max(near, hn::Min(at_lower, at_upper));
        far = hn::Min(far, hn::Max(at_lower, at_upper));
    }
    if (near_row != nullptr) {
        hn::StoreU(near, d, near_row + lane);
        hn::StoreU(far, d, far_row + lane);
    }
    return bits<Width>(hn::Le(near, hn::Add(far, all<Width>(slack))), lane);
}

template <std::size_t Width>
HWY_INLINE LaneMask
meets_cylinder(const Rays<Width>& rays, const float* values, float slack, std::size_t lane) {
    const float radius = values[6];
    const float half = values[7];
    const LaneMask round = meets_ball<Width>(
        rays, values, std::sqrt(radius * radius + half * half) * up + 2 * slack, lane);
    if (round == 0)
        return 0;
    // The distance of the ray's line from the axis is |from_axis . across| / |across|.
    Vec<Width> to_center[3];
    for (std::size_t axis = 0; axis < 3; ++axis)
        to_center[axis] = hn::Sub(all<Width>(values[axis]), rays.origin[axis]);
    const Vec<Width> axis_direction[3] = {
        all<Width>(values[3]), all<Width>(values[4]), all<Width>(values[5])};
    Vec<Width> across[3];
    cross3(rays.direction, axis_direction, across);
    const auto size = hn::Sqrt(dot3(across, across));
    const auto apart = hn::Abs(dot3(to_center, across));
    const auto reach =
        hn::Add(hn::Mul(size, all<Width>((radius + 2 * slack) * up)), all<Width>(4 * slack));
    return round & bits<Width>(hn::Le(apart, reach), lane);
}

template <std::size_t Width>
HWY_INLINE LaneMask
may_meet_part(const Frame& frame, const ElementRecord& record, std::size_t lane) {
    const float slack = frame.slack;
    const float* values = record.values.data();
    switch (record.kind) {
    case ElementRecord::Kind::sphere:
        return meets_ball<Width>(rays_at<Width>(frame, lane), values, values[3] + 2 * slack, lane);
    case ElementRecord::Kind::triangle:
        return meets_triangle<Width>(rays_at<Width>(frame, lane), values, slack, lane);
    case ElementRecord::Kind::cylinder:
        return meets_cylinder<Width>(rays_at<Width>(frame, lane), values, slack, lane);
    case ElementRecord::Kind::box:
    case ElementRecord::Kind::call:
        return meets_box<Width>(frame, values, values + 3, 2 * slack, lane, nullptr, nullptr);
    }
    return ~LaneMask{0};
}

template <std::size_t Width>
HWY_INLINE LaneMask may_meet(const Frame& frame, const ElementRecord& record, std::size_t first) {
    LaneMask result = 0;
    for (std::size_t i = 0; i < Width; i += hn::Lanes(Tag<Width>()))
        result |= may_meet_part<Width>(frame, record, first + i);
    return result;
}

/// A grid's cells seen along the axis that a packet advances on, slice by slice.
struct Advance {
    std::size_t axis = 0;
    std::size_t u_axis = 0;
    std::size_t v_axis = 0;
    bool forward = true;
};

/// Where a packet's rays are between, across its direction of advance: along u from values[0] to
/// values[1], along v from values[2] to values[3], in cells.
struct Window4 {
    double values[4] = {};
};

/// The way of a packet through a grid: the windows on the planes where it enters and leaves.
struct Way {
    Advance advance;
    double enter = 0; ///< along the axis of advance, in cells
    double leave = 0;
    Window4 at_enter;
    Window4 at_leave;
    double margins[3] = {}; ///< of advance, u and v, in cells: what slack means there
};

template <std::size_t Width>
void visit_grid(
    PacketQuery& query, Frame& frame, std::size_t first, LaneMask lanes, std::uint32_t number);

template <std::size_t Width>
void visit_call(
    PacketQuery& query, Frame& frame, std::size_t first, LaneMask lanes, std::uint32_t element) {
    if (too_deep(frame))
        return search_plainly(query, frame, element, lanes);
    const LaneMask entering = enter_call(query, frame, element, lanes);
    if (entering == 0)
        return;
    visit_grid<Width>(query, query.frames[frame.depth + std::size_t{1}], first, entering, 0);
    refresh_limits(query, frame, lanes);
}

template <std::size_t Width>
void visit_list(
    PacketQuery& query, Frame& frame, std::size_t first, LaneMask lanes, std::uint32_t place) {
    const GeometryGrids& grids = *frame.grids;
    const std::uint32_t* list = grids.lists.data() + place;
    const std::uint32_t count = *list++;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t element = list[i];
        const LaneMask fresh = query.mailbox.post(frame.visit, element, lanes & query.active);
        if (fresh == 0)
            continue;
        const ElementRecord& record = grids.records[element];
        const LaneMask met = may_meet<Width>(frame, record, first) & fresh;
        if (record.kind == ElementRecord::Kind::call) {
            if (met != 0)
                visit_call<Width>(query, frame, first, met, element);
            continue;
        }
        query.counts.tests += static_cast<std::uint64_t>(std::popcount(fresh));
        if (met != 0)
            test_exactly(query, frame, element, met);
    }
}

/// The axis on which all lanes advance the same way, and through the most slices a unit of length;
/// false when there is none.
template <std::size_t Width>
bool find_advance(
    const Frame& frame, const Grid& grid, std::size_t first, LaneMask lanes, Advance& advance) {
    double best = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        float least = 4;
        bool forward = false;
        bool backward = false;
        for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            const float along = frame.direction[axis][lane];
            forward = forward || along > 0;
            backward = backward || along < 0;
            least = std::min(least, std::abs(along));
        }
        const double slices = static_cast<double>(least) * grid.cells_per_unit[axis];
        if (forward != backward && slices > best) {
            best = slices;
            advance = {
                axis, axis == 0 ? std::size_t{1} : 0, axis == 2 ? std::size_t{1} : 2, forward};
        }
    }
    (void)first;
    return best > 0;
}

/// The way of the lanes' rays, which run in the grid's box from t = near to t = far.
inline Way way_of(
    const Frame& frame,
    const Grid& grid,
    LaneMask lanes,
    const float* near,
    const float* far,
    const Advance& advance) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const std::size_t k = advance.axis;
    const std::size_t across[2] = {advance.u_axis, advance.v_axis};
    Way way;
    way.advance = advance;
    double lowest = infinity;
    double highest = -infinity;
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const double origin = static_cast<double>(frame.origin[k][lane]);
        const double along = static_cast<double>(frame.direction[k][lane]);
        const double a = origin + static_cast<double>(near[lane]) * along;
        const double b = origin + static_cast<double>(far[lane]) * along;
        lowest = std::min(lowest, std::min(a, b));
        highest = std::max(highest, std::max(a, b));
    }
    const double enter = advance.forward ? lowest : highest;
    const double leave = advance.forward ? highest : lowest;
    way.at_enter = {{infinity, -infinity, infinity, -infinity}};
    way.at_leave = way.at_enter;
    const double slack = 2 * static_cast<double>(frame.slack);
    double steepest[2] = {0, 0};
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const double origin = static_cast<double>(frame.origin[k][lane]);
        const double along = static_cast<double>(frame.direction[k][lane]);
        for (std::size_t i = 0; i < 2; ++i) {
            const std::size_t axis = across[i];
            const double slope = static_cast<double>(frame.direction[axis][lane]) / along;
            const double start = static_cast<double>(frame.origin[axis][lane]);
            const double a = start + (enter - origin) * slope;
            const double b = start + (leave - origin) * slope;
            way.at_enter.values[2 * i] = std::min(way.at_enter.values[2 * i], a);
            way.at_enter.values[2 * i + 1] = std::max(way.at_enter.values[2 * i + 1], a);
            way.at_leave.values[2 * i] = std::min(way.at_leave.values[2 * i], b);
            way.at_leave.values[2 * i + 1] = std::max(way.at_leave.values[2 * i + 1], b);
            steepest[i] = std::max(steepest[i], std::abs(slope));
        }
    }
    // From here on in cells.
    way.enter = (enter - grid.box.lower[k]) * grid.cells_per_unit[k];
    way.leave = (leave - grid.box.lower[k]) * grid.cells_per_unit[k];
    way.margins[0] = slack * grid.cells_per_unit[k];
    for (std::size_t i = 0; i < 2; ++i) {
        const std::size_t axis = across[i];
        const double per_unit = grid.cells_per_unit[axis];
        way.margins[1 + i] = slack * (1 + steepest[i]) * per_unit;
        for (Window4* window : {&way.at_enter, &way.at_leave})
            for (std::size_t side = 0; side < 2; ++side) {
                double& value = window->values[2 * i + side];
                value = (value - grid.box.lower[axis]) * per_unit
                    + (side == 0 ? -way.margins[1 + i] : way.margins[1 + i]);
            }
    }
    return way;
}

/// Cells of a slice that the packet covers, about.
inline double cells_covered(const Way& way) {
    double most = 0;
    for (const Window4* window : {&way.at_enter, &way.at_leave}) {
        const double u = window->values[1] - window->values[0] + 1.5;
        const double v = window->values[3] - window->values[2] + 1.5;
        most = std::max(most, u * v);
    }
    return most;
}

inline std::int32_t slice_at(double place, std::int32_t count) {
    return static_cast<std::int32_t>(
        std::clamp(std::floor(place), 0.0, static_cast<double>(count - 1)));
}

/// The farthest that any of the lanes still has to be followed, along the axis of advance.
inline double last_place(
    const Frame& frame,
    const Grid& grid,
    LaneMask lanes,
    const float* far,
    const Advance& advance) {
    const std::size_t k = advance.axis;
    double last = advance.forward ? -std::numeric_limits<double>::infinity()
                                  : std::numeric_limits<double>::infinity();
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const double t = static_cast<double>(std::min(far[lane], frame.limit[lane]));
        const double place = static_cast<double>(frame.origin[k][lane])
            + t * static_cast<double>(frame.direction[k][lane]);
        last = advance.forward ? std::max(last, place) : std::min(last, place);
    }
    return (last - grid.box.lower[k]) * grid.cells_per_unit[k];
}

/// Follows the packet slice by slice. All that a step does to the window is additions.
template <std::size_t Width>
void follow(
    PacketQuery& query,
    Frame& frame,
    std::size_t first,
    LaneMask lanes,
    const Grid& grid,
    const Way& way,
    const float* far) {
    const auto& counts = grid.counts;
    const Advance& advance = way.advance;
    const std::size_t strides[3] = {
        1,
        static_cast<std::size_t>(counts[0]),
        static_cast<std::size_t>(counts[0]) * static_cast<std::size_t>(counts[1])};
    const double sign = advance.forward ? 1 : -1;
    const std::int32_t step = advance.forward ? 1 : -1;
    const std::int32_t along_count = counts[advance.axis];
    const double u_last = counts[advance.u_axis] - 1;
    const double v_last = counts[advance.v_axis] - 1;

    std::int32_t slice = slice_at(way.enter - sign * way.margins[0], along_count);
    std::int32_t last = slice_at(way.leave + sign * way.margins[0], along_count);
    Window4 from = way.at_enter;
    Window4 to = way.at_enter;
    Window4 steps;
    const double length = sign * (way.leave - way.enter);
    // What is left of the first slice.
    const double left = std::max(advance.forward ? slice + 1 - way.enter : way.enter - slice, 0.0);
    for (std::size_t i = 0; i < 4; ++i) {
        const double difference = way.at_leave.values[i] - way.at_enter.values[i];
        if (length > 0x1p-10) {
            steps.values[i] = difference / length;
            to.values[i] += left * steps.values[i];
        } else {
            // Too short for a slope: the window that holds both.
            const bool upper = i % 2 == 1;
            from.values[i] = upper ? std::max(way.at_enter.values[i], way.at_leave.values[i])
                                   : std::min(way.at_enter.values[i], way.at_leave.values[i]);
            to.values[i] = from.values[i];
        }
    }
    std::uint32_t changes = query.changes;
    const std::size_t u_stride = strides[advance.u_axis];
    const std::size_t v_stride = strides[advance.v_axis];
    for (;; slice += step) {
        const double u_from = std::max(std::min(from.values[0], to.values[0]), 0.0);
        const double u_to = std::min(std::max(from.values[1], to.values[1]), u_last);
        const double v_from = std::max(std::min(from.values[2], to.values[2]), 0.0);
        const double v_to = std::min(std::max(from.values[3], to.values[3]), v_last);
        if (u_to >= 0 && v_to >= 0 && u_from < u_last + 1 && v_from < v_last + 1) {
            const auto u0 = static_cast<std::size_t>(u_from);
            const auto u1 = static_cast<std::size_t>(u_to);
            const auto v0 = static_cast<std::size_t>(v_from);
            const auto v1 = static_cast<std::size_t>(v_to);
            const Cell* cells = frame.grids->cells.data() + grid.first_cell
                + static_cast<std::size_t>(slice) * strides[advance.axis];
            query.counts.cells += (u1 - u0 + 1) * (v1 - v0 + 1);
            for (std::size_t v = v0; v <= v1; ++v)
                for (std::size_t u = u0; u <= u1; ++u) {
                    const Cell cell = cells[u * u_stride + v * v_stride];
                    if (cell.empty())
                        continue;
                    if (cell.is_grid())
                        visit_grid<Width>(query, frame, first, lanes, cell.grid());
                    else
                        visit_list<Width>(query, frame, first, lanes, cell.list());
                }
        }
        if (query.changes != changes) {
            changes = query.changes;
            lanes &= query.active;
            if (lanes == 0)
                return;
            const double place = last_place(frame, grid, lanes, far, advance);
            last = slice_at(place + sign * way.margins[0], along_count);
        }
        if (advance.forward ? slice >= last : slice <= last)
            return;
        for (std::size_t i = 0; i < 4; ++i) {
            from.values[i] = to.values[i];
            to.values[i] += steps.values[i];
        }
    }
}

/// The same in two or more smaller packets.
template <std::size_t Width>
void visit_in_parts(
    PacketQuery& query, Frame& frame, std::size_t first, LaneMask lanes, std::uint32_t number) {
    if constexpr (Width > 1) {
        constexpr std::size_t part = Width > 4 ? 4 : 1;
        constexpr LaneMask part_lanes = (LaneMask{1} << part) - 1;
        for (std::size_t i = first; i < first + Width; i += part)
            if ((lanes & part_lanes << i) != 0)
                visit_grid<part>(query, frame, i, lanes & part_lanes << i, number);
    }
}

template <std::size_t Width>
void visit_grid(
    PacketQuery& query, Frame& frame, std::size_t first, LaneMask lanes, std::uint32_t number) {
    const Grid& grid = frame.grids->grids[number];
    lanes &= query.active;
    if (Width > 1 && std::popcount(lanes) == 1)
        return visit_grid<1>(
            query, frame, static_cast<std::size_t>(std::countr_zero(lanes)), lanes, number);
    float near[packet_size];
    float far[packet_size];
    const float lower[] = {
        static_cast<float>(grid.box.lower.x),
        static_cast<float>(grid.box.lower.y),
        static_cast<float>(grid.box.lower.z)};
    const float upper[] = {
        static_cast<float>(grid.box.upper.x),
        static_cast<float>(grid.box.upper.y),
        static_cast<float>(grid.box.upper.z)};
    LaneMask touching = 0;
    for (std::size_t i = 0; i < Width; i += hn::Lanes(Tag<Width>()))
        touching |= meets_box<Width>(frame, lower, upper, 2 * frame.slack, first + i, near, far);
    lanes &= touching;
    if (lanes == 0)
        return;
    Advance advance;
    if (!find_advance<Width>(frame, grid, first, lanes, advance))
        return visit_in_parts<Width>(query, frame, first, lanes, number);
    const Way way = way_of(frame, grid, lanes, near, far, advance);
    if (Width > 1 && cells_covered(way) > 2 + 1.5 * std::popcount(lanes))
        return visit_in_parts<Width>(query, frame, first, lanes, number);
    follow<Width>(query, frame, first, lanes, grid, way, far);
}

void search_grids_kernel(PacketQuery& query) {
    query.mailbox.clear();
    const LaneMask lanes = enter_scene(query);
    if (lanes != 0)
        visit_grid<packet_size>(query, query.frames.front(), 0, lanes, 0);
}

} // namespace HWY_NAMESPACE
} // namespace vera::detail

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera::detail {

HWY_EXPORT(search_grids_kernel);

void search_grids(PacketQuery& query) {
    HWY_DYNAMIC_DISPATCH(search_grids_kernel)(query);
}

} // namespace vera::detail

#endif
