// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/grid_structures.h"
#include "vera/accel/packet_query.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/grid_search.cpp"
#include <hwy/foreach_target.h>
// Behind the line above, which includes this file once for each instruction set.
#include "vera/accel/element_tests-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

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

template <std::size_t Width>
HWY_INLINE Vec<Width> all(float value) {
    return hn::Set(Tag<Width>(), value);
}

template <std::size_t Width>
HWY_INLINE TestedRays<Tag<Width>> rays_at(const Frame& frame, std::size_t lane) {
    return {
        {row<Width>(frame.origin[0], lane),
         row<Width>(frame.origin[1], lane),
         row<Width>(frame.origin[2], lane)},
        {row<Width>(frame.direction[0], lane),
         row<Width>(frame.direction[1], lane),
         row<Width>(frame.direction[2], lane)},
        {row<Width>(frame.inverse[0], lane),
         row<Width>(frame.inverse[1], lane),
         row<Width>(frame.inverse[2], lane)},
        row<Width>(frame.limit, lane),
        frame.slack,
        frame.double_slack};
}

template <std::size_t Width>
HWY_INLINE LaneMask meets_grid(
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
    hn::StoreU(near, d, near_row + lane);
    hn::StoreU(far, d, far_row + lane);
    return bits<Width>(hn::Le(near, hn::Add(far, all<Width>(slack))), lane);
}

/// The part of the lanes from this one on whose rays may meet the element.
template <std::size_t Width>
HWY_INLINE LaneMask
may_meet_part(const Frame& frame, const ElementRecord& record, std::size_t lane) {
    Vec<Width> values[11];
    for (std::size_t i = 0; i < 11; ++i)
        values[i] = all<Width>(record.values[i]);
    return bits<Width>(
        may_meet(Tag<Width>(), rays_at<Width>(frame, lane), record.kind, values), lane);
}

template <std::size_t Width>
HWY_INLINE LaneMask may_meet(const Frame& frame, const ElementRecord& record, std::size_t first) {
    LaneMask result = 0;
    for (std::size_t i = 0; i < Width; i += hn::Lanes(Tag<Width>()))
        result |= may_meet_part<Width>(frame, record, first + i);
    return result;
}

inline const GeometryGrids& grids_of(const Frame& frame) {
    return static_cast<const GeometryGrids&>(*frame.local);
}

/// A grid's cells seen along the axis that a packet advances on, slice by slice.
struct Advance {
    std::size_t axis = 0;
    std::size_t u_axis = 1;
    std::size_t v_axis = 2;
    bool forward = true;
};

/// Where a packet's rays are between, across its direction of advance: along u from values[0] to
/// values[1], along v from values[2] to values[3].
struct Window4 {
    double values[4] = {};
};

/// The way of a packet through a grid, in cells: the windows on the planes where it enters and
/// leaves.
struct Way {
    Advance advance;
    double enter = 0; ///< along the axis of advance
    double leave = 0;
    double margin = 0; ///< what slack means there; the windows have theirs within
    Window4 at_enter;
    Window4 at_leave;
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
    const GeometryGrids& grids = grids_of(frame);
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

template <std::size_t Width>
HWY_INLINE hn::Mask<Tag<Width>> mask_of(LaneMask lanes, std::size_t lane) {
    const LaneMask here = lanes >> lane;
    const std::uint8_t bytes[8] = {
        static_cast<std::uint8_t>(here), static_cast<std::uint8_t>(here >> 8U)};
    return hn::LoadMaskBits(Tag<Width>(), bytes);
}

/// The least and the greatest of a packet's values.
template <std::size_t Width>
class Span {
public:
    HWY_INLINE Span()
        : least_(all<Width>(1e30F))
        , most_(all<Width>(-1e30F)) {}

    HWY_INLINE void add(Vec<Width> value, hn::Mask<Tag<Width>> mask) {
        least_ = hn::Min(least_, hn::IfThenElse(mask, value, least_));
        most_ = hn::Max(most_, hn::IfThenElse(mask, value, most_));
    }

    HWY_INLINE float least() const { return hn::GetLane(hn::MinOfLanes(Tag<Width>(), least_)); }

    HWY_INLINE float most() const { return hn::GetLane(hn::MaxOfLanes(Tag<Width>(), most_)); }

private:
    Vec<Width> least_;
    Vec<Width> most_;
};

inline Advance advance_on(std::size_t axis, bool forward) {
    return {axis, axis == 0 ? std::size_t{1} : 0, axis == 2 ? std::size_t{1} : 2, forward};
}

/// The axis on which all lanes advance the same way, and through the most slices a unit of length;
/// false when there is none.
template <std::size_t Width>
HWY_INLINE bool find_advance(
    const Frame& frame, const Grid& grid, std::size_t first, LaneMask lanes, Advance& advance) {
    double best = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Span<Width> span;
        for (std::size_t i = first; i < first + Width; i += hn::Lanes(Tag<Width>()))
            span.add(row<Width>(frame.direction[axis], i), mask_of<Width>(lanes, i));
        const float least = span.least();
        const float most = span.most();
        const float slowest = least > 0 ? least : -most;
        const double slices = static_cast<double>(slowest) * grid.cells_per_unit[axis];
        if (slices > best) {
            best = slices;
            advance = advance_on(axis, least > 0);
        }
    }
    return best > 0;
}

/// The way of the lanes' rays, which run in the grid's box from t = near to t = far.
template <std::size_t Width>
HWY_INLINE Way way_of(
    const Frame& frame,
    const Grid& grid,
    std::size_t first,
    LaneMask lanes,
    const float* near,
    const float* far,
    const Advance& advance) {
    const Tag<Width> d;
    const std::size_t step = hn::Lanes(d);
    const std::size_t k = advance.axis;
    const std::size_t across[2] = {advance.u_axis, advance.v_axis};
    Span<Width> places;
    for (std::size_t i = first; i < first + Width; i += step) {
        const auto origin = row<Width>(frame.origin[k], i);
        const auto along = row<Width>(frame.direction[k], i);
        const auto mask = mask_of<Width>(lanes, i);
        places.add(hn::Add(origin, hn::Mul(hn::LoadU(d, near + i), along)), mask);
        places.add(hn::Add(origin, hn::Mul(hn::LoadU(d, far + i), along)), mask);
    }
    const float enter = advance.forward ? places.least() : places.most();
    const float leave = advance.forward ? places.most() : places.least();
    Span<Width> entering[2];
    Span<Width> leaving[2];
    Span<Width> slopes[2];
    for (std::size_t i = first; i < first + Width; i += step) {
        const auto mask = mask_of<Width>(lanes, i);
        const auto origin = row<Width>(frame.origin[k], i);
        const auto inverse = row<Width>(frame.inverse[k], i);
        for (std::size_t side = 0; side < 2; ++side) {
            const auto start = row<Width>(frame.origin[across[side]], i);
            const auto slope = hn::Mul(row<Width>(frame.direction[across[side]], i), inverse);
            entering[side].add(
                hn::Add(start, hn::Mul(hn::Sub(all<Width>(enter), origin), slope)), mask);
            leaving[side].add(
                hn::Add(start, hn::Mul(hn::Sub(all<Width>(leave), origin), slope)), mask);
            slopes[side].add(hn::Abs(slope), mask);
        }
    }
    Way way;
    way.advance = advance;
    const double slack = 2 * static_cast<double>(frame.slack);
    const auto in_cells = [&](float place, std::size_t axis) {
        return (static_cast<double>(place) - grid.box.lower[axis]) * grid.cells_per_unit[axis];
    };
    way.enter = in_cells(enter, k);
    way.leave = in_cells(leave, k);
    way.margin = slack * grid.cells_per_unit[k];
    for (std::size_t side = 0; side < 2; ++side) {
        const std::size_t axis = across[side];
        // The slope's rounding, and slack along the axis of advance, move a place by slope times
        // that.
        const double margin =
            slack * (1 + static_cast<double>(slopes[side].most())) * grid.cells_per_unit[axis];
        way.at_enter.values[2 * side] = in_cells(entering[side].least(), axis) - margin;
        way.at_enter.values[2 * side + 1] = in_cells(entering[side].most(), axis) + margin;
        way.at_leave.values[2 * side] = in_cells(leaving[side].least(), axis) - margin;
        way.at_leave.values[2 * side + 1] = in_cells(leaving[side].most(), axis) + margin;
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
    return static_cast<std::int32_t>(std::clamp(place, 0.0, static_cast<double>(count - 1)));
}

/// The farthest that any of the lanes still has to be followed, along the axis of advance.
template <std::size_t Width>
HWY_INLINE double last_place(
    const Frame& frame,
    const Grid& grid,
    std::size_t first,
    LaneMask lanes,
    const float* far,
    const Advance& advance) {
    const Tag<Width> d;
    const std::size_t k = advance.axis;
    Span<Width> places;
    for (std::size_t i = first; i < first + Width; i += hn::Lanes(d)) {
        const auto t = hn::Min(hn::LoadU(d, far + i), row<Width>(frame.limit, i));
        places.add(
            hn::Add(row<Width>(frame.origin[k], i), hn::Mul(t, row<Width>(frame.direction[k], i))),
            mask_of<Width>(lanes, i));
    }
    const auto last = static_cast<double>(advance.forward ? places.most() : places.least());
    return (last - grid.box.lower[k]) * grid.cells_per_unit[k];
}

/// The window that holds the packet from one plane between slices to the next, and what it moves by
/// from slice to slice.
struct MovingWindow {
    Window4 now;
    Window4 step;
};

/// The window for the first slice, of which the part `left` is still to be passed.
inline MovingWindow first_window(const Way& way, double left) {
    MovingWindow window;
    const double length = std::abs(way.leave - way.enter);
    for (std::size_t i = 0; i < 4; ++i) {
        const bool upper = i % 2 == 1;
        const double enter = way.at_enter.values[i];
        const double leave = way.at_leave.values[i];
        const auto outer = [&](double a, double b) {
            return upper ? std::max(a, b) : std::min(a, b);
        };
        if (length > 0x1p-10) {
            const double step = (leave - enter) / length;
            window.step.values[i] = step;
            // Where it stands behind the slice, or one slice before that.
            const double after = enter + left * step;
            window.now.values[i] = outer(after, after - step);
        } else {
            window.now.values[i] = outer(enter, leave); // too short for a slope
        }
    }
    return window;
}

/// Cells of a slice of a grid: those from (u[0], v[0]) to (u[1], v[1]).
struct CellBlock {
    const Cell* slice = nullptr;
    std::size_t u_stride = 0;
    std::size_t v_stride = 0;
    std::size_t u[2] = {};
    std::size_t v[2] = {};
};

template <std::size_t Width>
HWY_INLINE void visit_cells(
    PacketQuery& query, Frame& frame, std::size_t first, LaneMask lanes, const CellBlock& block) {
    query.counts.cells += (block.u[1] - block.u[0] + 1) * (block.v[1] - block.v[0] + 1);
    for (std::size_t v = block.v[0]; v <= block.v[1]; ++v)
        for (std::size_t u = block.u[0]; u <= block.u[1]; ++u) {
            const Cell cell = block.slice[u * block.u_stride + v * block.v_stride];
            if (cell.empty())
                continue;
            if (cell.is_grid())
                visit_grid<Width>(query, frame, first, lanes, cell.grid());
            else
                visit_list<Width>(query, frame, first, lanes, cell.list());
        }
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
    const double u_end = counts[advance.u_axis];
    const double v_end = counts[advance.v_axis];
    const auto u_last = static_cast<std::size_t>(counts[advance.u_axis] - 1);
    const auto v_last = static_cast<std::size_t>(counts[advance.v_axis] - 1);

    std::int32_t slice = slice_at(way.enter - sign * way.margin, along_count);
    std::int32_t last = slice_at(way.leave + sign * way.margin, along_count);
    MovingWindow window = first_window(
        way, std::max(advance.forward ? slice + 1 - way.enter : way.enter - slice, 0.0));
    const Cell* cells = grids_of(frame).cells.data() + grid.first_cell
        + static_cast<std::size_t>(slice) * strides[advance.axis];
    const std::ptrdiff_t slice_stride = step * static_cast<std::ptrdiff_t>(strides[advance.axis]);
    std::uint32_t changes = query.changes;
    while (true) {
        const double* now = window.now.values;
        if (now[1] >= 0 && now[3] >= 0 && now[0] < u_end && now[2] < v_end) {
            const CellBlock block = {
                cells,
                strides[advance.u_axis],
                strides[advance.v_axis],
                {static_cast<std::size_t>(std::max(now[0], 0.0)),
                 std::min(static_cast<std::size_t>(std::min(now[1], u_end)), u_last)},
                {static_cast<std::size_t>(std::max(now[2], 0.0)),
                 std::min(static_cast<std::size_t>(std::min(now[3], v_end)), v_last)}};
            visit_cells<Width>(query, frame, first, lanes, block);
            if (query.changes != changes) {
                changes = query.changes;
                lanes &= query.active;
                if (lanes == 0)
                    return;
                const double place = last_place<Width>(frame, grid, first, lanes, far, advance);
                last = slice_at(place + sign * way.margin, along_count);
            }
        }
        if (advance.forward ? slice >= last : slice <= last)
            return;
        slice += step;
        cells += slice_stride;
        for (std::size_t i = 0; i < 4; ++i)
            window.now.values[i] += window.step.values[i];
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
    const Grid& grid = grids_of(frame).grids[number];
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
        touching |= meets_grid<Width>(frame, lower, upper, 2 * frame.slack, first + i, near, far);
    lanes &= touching;
    if (lanes == 0)
        return;
    Advance advance;
    if (!find_advance<Width>(frame, grid, first, lanes, advance))
        return visit_in_parts<Width>(query, frame, first, lanes, number);
    const Way way = way_of<Width>(frame, grid, first, lanes, near, far, advance);
    if (Width > 1 && cells_covered(way) > 2 + 1.5 * std::popcount(lanes))
        return visit_in_parts<Width>(query, frame, first, lanes, number);
    follow<Width>(query, frame, first, lanes, grid, way, far);
}

void search_grids_kernel(PacketQuery& query) {
    query.mailbox.clear();
    query.local_start = LocalStart::in_bounds;
    const LaneMask lanes = enter_scene(query);
    if (lanes != 0)
        visit_grid<packet_size>(query, query.frames.front(), 0, lanes, 0);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera::detail {

HWY_EXPORT(search_grids_kernel);

void search_grids(PacketQuery& query) {
    HWY_DYNAMIC_DISPATCH(search_grids_kernel)(query);
}

} // namespace vera::detail

#endif
