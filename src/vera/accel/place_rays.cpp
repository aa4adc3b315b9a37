// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/packet_query.h"

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/place_rays.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, packet_size>;
using Floats = hn::Rebind<float, Doubles>;
using Vec = hn::Vec<Doubles>;

HWY_INLINE Vec row(const RayRows::Row& values, std::size_t lane) {
    return hn::LoadU(Doubles(), values.data() + lane);
}

HWY_INLINE Vec all(double value) {
    return hn::Set(Doubles(), value);
}

HWY_INLINE void store(Vec value, Frame::Row& values, std::size_t lane) {
    hn::StoreU(hn::DemoteTo(Floats(), value), Floats(), values.data() + lane);
}

template <typename Mask>
HWY_INLINE LaneMask bits(Mask mask, std::size_t lane) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(Doubles(), mask, bytes);
    return (LaneMask{bytes[0]} & ((LaneMask{1} << hn::Lanes(Doubles())) - 1)) << lane;
}

/// With it, everything in the bounds may be met.
constexpr double largest_slack = 64;

struct Placed {
    LaneMask touching = 0;
    LaneMask strange =
        0; ///< lanes whose rays have no direction, or are not finite, or too far away
};

/// The rays of a frame from a lane on, as many as fit into a register: in local coordinates, where
/// t is as in the world.
struct LocalRays {
    Vec origin[3];
    Vec origin_size;
    Vec direction[3];
    Vec speed;
    Vec slack;
    Vec t_min;
    Vec t_max;
};

HWY_INLINE void store_limit(Frame& frame, const LocalRays& rays, Vec start_t, std::size_t lane) {
    const auto distance =
        hn::MulAdd(hn::Sub(rays.t_max, start_t), rays.speed, hn::Add(rays.slack, rays.slack));
    store(hn::Mul(hn::Min(distance, all(farthest)), all(1 + 0x1p-20)), frame.limit, lane);
}

/// For rays that start near the bounds, and there: single precision is good for their origins.
HWY_INLINE void place_near(Frame& frame, const LocalRays& rays, std::size_t lane) {
    const Doubles d;
    const Floats f;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto direction = hn::DemoteTo(f, rays.direction[axis]);
        const auto size = hn::Max(hn::Abs(direction), hn::Set(f, 1e-20F));
        hn::StoreU(direction, f, frame.direction[axis].data() + lane);
        hn::StoreU(
            hn::Div(hn::Set(f, 1), hn::CopySign(size, direction)),
            f,
            frame.inverse[axis].data() + lane);
        store(rays.origin[axis], frame.origin[axis], lane);
    }
    hn::StoreU(hn::Zero(d), d, frame.start_t.data() + lane);
    store_limit(frame, rays, hn::Zero(d), lane);
}

/// For all others: they are let start where they enter the bounds.
HWY_INLINE hn::Mask<Doubles> place_far(Frame& frame, const LocalRays& rays, std::size_t lane) {
    const Doubles d;
    const LocalGeometry& local = *frame.local;
    auto near = hn::Mul(rays.t_min, rays.speed);
    auto far = hn::Mul(rays.t_max, rays.speed);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto size = hn::Max(hn::Abs(rays.direction[axis]), all(1e-20));
        const auto inverse = hn::Div(all(1), hn::CopySign(size, rays.direction[axis]));
        const auto lower =
            hn::Sub(hn::Sub(all(local.local_bounds.lower[axis]), rays.slack), rays.origin[axis]);
        const auto upper =
            hn::Sub(hn::Add(all(local.local_bounds.upper[axis]), rays.slack), rays.origin[axis]);
        const auto at_lower = hn::Mul(lower, inverse);
        const auto at_upper = hn::Mul(upper, inverse);
        near = hn::Max(near, hn::Min(at_lower, at_upper));
        far = hn::Min(far, hn::Max(at_lower, at_upper));
        store(rays.direction[axis], frame.direction[axis], lane);
        store(inverse, frame.inverse[axis], lane);
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
        store(
            hn::Add(rays.origin[axis], hn::Mul(near, rays.direction[axis])),
            frame.origin[axis],
            lane);
    const auto start_t = hn::Div(near, rays.speed);
    hn::StoreU(start_t, d, frame.start_t.data() + lane);
    store_limit(frame, rays, start_t, lane);
    return hn::Le(near, hn::Add(far, rays.slack));
}

/// Fills in the part of a frame from a lane on that fits into a register, and keeps the largest of
/// the slacks and of what is as far behind, in any lane.
HWY_INLINE void place_part(
    Frame& frame,
    const RayRows::Row& limit,
    const RayRows::Row& world_reach,
    LocalStart local_start,
    LaneMask lanes,
    std::size_t lane,
    Placed& placed,
    Vec& slack,
    Vec& behind) {
    const LocalGeometry& local = *frame.local;
    const Doubles d;
    const auto scale = all(local.scale);
    LocalRays rays = {
        {hn::Zero(d), hn::Zero(d), hn::Zero(d)},
        hn::Zero(d),
        {hn::Zero(d), hn::Zero(d), hn::Zero(d)},
        hn::Zero(d),
        hn::Zero(d),
        row(frame.rays.t_min, lane),
        hn::Min(row(frame.rays.t_max, lane), row(limit, lane))};
    Vec given[3] = {
        row(frame.rays.direction[0], lane),
        row(frame.rays.direction[1], lane),
        row(frame.rays.direction[2], lane)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        rays.origin[axis] =
            hn::Mul(scale, hn::Sub(row(frame.rays.origin[axis], lane), all(local.center[axis])));
        // A sum, which is not a number where one of them is none.
        rays.origin_size = hn::Add(rays.origin_size, hn::Abs(rays.origin[axis]));
    }
    const auto norm_squared = hn::Add(
        hn::Add(hn::Mul(given[0], given[0]), hn::Mul(given[1], given[1])),
        hn::Mul(given[2], given[2]));
    const auto norm = hn::Sqrt(norm_squared);
    const auto per_norm = hn::Div(all(1), norm);
    for (std::size_t axis = 0; axis < 3; ++axis)
        rays.direction[axis] = hn::Mul(given[axis], per_norm);
    rays.speed = hn::Mul(norm, scale);
    rays.slack = hn::Add(
        all(least_slack + 0x1p-44 * local.scale * local.coordinate_size),
        hn::Add(
            hn::Mul(all(0x1p-44), rays.origin_size),
            hn::Mul(all(2 * local.scale), row(frame.rays.origin_error, lane))));
    hn::StoreU(rays.speed, d, frame.speed.data() + lane);

    // Squares outside of these bounds have lost digits; and where the slack is so large that
    // nothing is ruled out, single precision need not hold it. What is not a number fails all.
    const auto usual = hn::And(
        hn::And(
            hn::And(hn::Gt(norm_squared, all(1e-280)), hn::Lt(norm_squared, all(1e280))),
            hn::And(hn::Gt(rays.speed, all(1e-280)), hn::Lt(rays.origin_size, all(1e280)))),
        hn::And(
            hn::Lt(rays.slack, all(largest_slack)),
            hn::And(
                hn::Eq(rays.t_min, rays.t_min),
                hn::Eq(row(frame.rays.t_max, lane), row(frame.rays.t_max, lane)))));
    const auto near = hn::And(hn::Lt(rays.origin_size, all(2)), hn::Eq(rays.t_min, hn::Zero(d)));
    const LaneMask part = lanes >> lane & ((LaneMask{1} << hn::Lanes(d)) - 1);
    LaneMask touching = bits(usual, lane);
    if (local_start == LocalStart::near_bounds && (bits(hn::Not(near), 0) & part) == 0)
        place_near(frame, rays, lane);
    else
        touching &= bits(place_far(frame, rays, lane), lane);
    placed.touching |= touching;
    placed.strange |= bits(hn::Not(usual), lane);
    std::uint8_t counted[8] = {static_cast<std::uint8_t>((touching & lanes) >> lane)};
    const auto counts = hn::LoadMaskBits(d, counted);
    slack = hn::Max(slack, hn::IfThenElseZero(counts, rays.slack));
    // Twice coincidence_tolerance(), as a local distance.
    const auto reach = hn::Add(
        hn::Max(row(world_reach, lane), hn::Zero(d)),
        hn::Abs(hn::LoadU(d, frame.start_t.data() + lane)));
    const auto behind_here =
        hn::MulAdd(hn::Mul(reach, rays.speed), all(0x1p-40), all(0x1p-40 * farthest));
    behind = hn::Max(behind, hn::IfThenElseZero(counts, behind_here));
}

/// The largest coordinate of where the lanes' rays start, without its sign.
HWY_INLINE float largest_origin(const Frame& frame, LaneMask lanes) {
    const hn::CappedTag<float, packet_size> d;
    auto largest = hn::Zero(d);
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d)) {
        const std::uint8_t set[8] = {
            static_cast<std::uint8_t>(lanes >> lane),
            static_cast<std::uint8_t>(lanes >> lane >> 8U)};
        const auto counts = hn::LoadMaskBits(d, set);
        for (const Frame::Row& row : frame.origin) {
            const auto size = hn::Abs(hn::LoadU(d, row.data() + lane));
            largest = hn::IfThenElse(hn::And(counts, hn::Gt(size, largest)), size, largest);
        }
    }
    return hn::GetLane(hn::MaxOfLanes(d, largest));
}

LaneMask place_rays_kernel(
    Frame& frame,
    LaneMask lanes,
    const RayRows::Row& limit,
    const RayRows::Row& world_reach,
    LocalStart local_start) {
    const Doubles d;
    Placed placed;
    Vec slacks = hn::Zero(d);
    Vec behinds = hn::Zero(d);
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d))
        if ((lanes >> lane & ((LaneMask{1} << hn::Lanes(d)) - 1)) != 0)
            place_part(
                frame, limit, world_reach, local_start, lanes, lane, placed, slacks, behinds);
    const double slack = hn::GetLane(hn::MaxOfLanes(d, slacks));
    const double behind = hn::GetLane(hn::MaxOfLanes(d, behinds));
    frame.slack = static_cast<float>(std::max(slack * (1 + 0x1p-20), least_slack));
    frame.double_slack = static_cast<float>(std::max(slack - least_slack, 0.0) * (1 + 0x1p-20));
    frame.behind = static_cast<float>(behind * (1 + 0x1p-20));
    frame.box_slack =
        2 * frame.double_slack + box_rounding * largest_origin(frame, placed.touching & lanes);
    placed.strange &= lanes;
    for (LaneMask rest = placed.strange; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        // A ray that cannot be followed is let meet everything.
        for (std::size_t axis = 0; axis < 3; ++axis) {
            frame.origin[axis][lane] = 0;
            frame.direction[axis][lane] = axis == 0 ? 1 : 0;
            frame.inverse[axis][lane] = axis == 0 ? 1 : 1e20F;
        }
        frame.limit[lane] = static_cast<float>(farthest);
        frame.start_t[lane] = 0;
        frame.speed[lane] = 0;
        frame.slack = static_cast<float>(largest_slack);
        frame.double_slack = frame.slack;
        frame.box_slack = 2 * frame.slack;
    }
    return (placed.touching & lanes) | placed.strange;
}

/// Two numbers of each of two rays, which stand side by side there, to two rows.
HWY_INLINE void fill_two(const double* first, const double* second, double* row, double* next_row) {
#if HWY_TARGET == HWY_SCALAR
    row[0] = first[0];
    row[1] = second[0];
    next_row[0] = first[1];
    next_row[1] = second[1];
#else
    const hn::FixedTag<double, 2> d;
    const auto a = hn::LoadU(d, first);
    const auto b = hn::LoadU(d, second);
    hn::StoreU(hn::InterleaveLower(d, a, b), d, row);
    hn::StoreU(hn::InterleaveUpper(d, a, b), d, next_row);
#endif
}

void fill_rows_kernel(std::span<const QueryRay> rays, RayRows& rows) {
    static_assert(offsetof(Ray, origin) == 0);
    static_assert(offsetof(Ray, direction) == 3 * sizeof(double));
    static_assert(offsetof(Ray, t_min) == 6 * sizeof(double));
    static_assert(offsetof(Ray, t_max) == 7 * sizeof(double));
    for (std::size_t lane = 0; lane < rays.size(); lane += 2) {
        const Ray& a = rays[lane].ray;
        // The last one may stand alone; there is room for it twice.
        const Ray& b = rays[std::min(lane + 1, rays.size() - 1)].ray;
        const auto* const first = reinterpret_cast<const double*>(&a);
        const auto* const second = reinterpret_cast<const double*>(&b);
        fill_two(first, second, &rows.origin[0][lane], &rows.origin[1][lane]);
        fill_two(first + 2, second + 2, &rows.origin[2][lane], &rows.direction[0][lane]);
        fill_two(first + 4, second + 4, &rows.direction[1][lane], &rows.direction[2][lane]);
        fill_two(first + 6, second + 6, &rows.t_min[lane], &rows.t_max[lane]);
        rows.origin_error[lane] = a.origin_error;
        rows.origin_error[lane + 1] = b.origin_error;
    }
}

/// The largest component of abs() of the vectors, as max_component() finds it.
HWY_INLINE Vec largest(const std::array<RayRows::Row, 3>& vectors, std::size_t lane) {
    const Vec x = hn::Abs(row(vectors[0], lane));
    const Vec y = hn::Abs(row(vectors[1], lane));
    const Vec z = hn::Abs(row(vectors[2], lane));
    const Vec larger = hn::IfThenElse(hn::Gt(x, y), x, y);
    return hn::IfThenElse(hn::Gt(larger, z), larger, z);
}

void fill_reaches_kernel(const RayRows& rays, RayRows::Row& reaches) {
    const Doubles d;
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d)) {
        const Vec direction_size = largest(rays.direction, lane);
        const Vec origin_size = hn::Add(largest(rays.origin, lane), row(rays.origin_error, lane));
        const Vec reach = hn::IfThenElse(
            hn::Gt(direction_size, hn::Zero(d)),
            hn::Div(origin_size, direction_size),
            all(-std::numeric_limits<double>::infinity()));
        hn::StoreU(reach, d, reaches.data() + lane);
    }
}

void transform_rays_kernel(const Affine3& map, const RayRows& rays, RayRows& result) {
    const Doubles d;
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d)) {
        auto error = hn::Zero(d);
        const Vec origin[3] = {
            row(rays.origin[0], lane), row(rays.origin[1], lane), row(rays.origin[2], lane)};
        const Vec direction[3] = {
            row(rays.direction[0], lane),
            row(rays.direction[1], lane),
            row(rays.direction[2], lane)};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // In the order of dot() and of transformed_ray().
            const Vec3& m = map.linear.rows[axis];
            const Vec3 size = abs(m);
            const auto translation = all(map.translation[axis]);
            const auto turned = hn::Add(
                hn::Add(hn::Mul(all(m.x), origin[0]), hn::Mul(all(m.y), origin[1])),
                hn::Mul(all(m.z), origin[2]));
            hn::StoreU(hn::Add(turned, translation), d, result.origin[axis].data() + lane);
            hn::StoreU(
                hn::Add(
                    hn::Add(hn::Mul(all(m.x), direction[0]), hn::Mul(all(m.y), direction[1])),
                    hn::Mul(all(m.z), direction[2])),
                d,
                result.direction[axis].data() + lane);
            const auto reach = hn::Add(
                hn::Add(
                    hn::Mul(all(size.x), hn::Abs(origin[0])),
                    hn::Mul(all(size.y), hn::Abs(origin[1]))),
                hn::Mul(all(size.z), hn::Abs(origin[2])));
            const auto here = hn::Add(
                hn::Mul(all(0x1p-48), hn::Add(reach, hn::Abs(translation))),
                hn::Mul(row(rays.origin_error, lane), all(size.x + size.y + size.z)));
            error = hn::IfThenElse(hn::Gt(here, error), here, error);
        }
        hn::StoreU(row(rays.t_min, lane), d, result.t_min.data() + lane);
        hn::StoreU(row(rays.t_max, lane), d, result.t_max.data() + lane);
        hn::StoreU(error, d, result.origin_error.data() + lane);
    }
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera::detail {

HWY_EXPORT(place_rays_kernel);
HWY_EXPORT(transform_rays_kernel);
HWY_EXPORT(fill_rows_kernel);
HWY_EXPORT(fill_reaches_kernel);

void fill_rows(std::span<const QueryRay> rays, RayRows& rows) {
    HWY_DYNAMIC_DISPATCH(fill_rows_kernel)(rays, rows);
}

void fill_reaches(const RayRows& rays, RayRows::Row& reaches) {
    HWY_DYNAMIC_DISPATCH(fill_reaches_kernel)(rays, reaches);
}

LaneMask place_rays(
    Frame& frame,
    LaneMask lanes,
    const RayRows::Row& limit,
    const RayRows::Row& world_reach,
    LocalStart local_start) {
    return HWY_DYNAMIC_DISPATCH(place_rays_kernel)(frame, lanes, limit, world_reach, local_start);
}

void transform_rays(const Affine3& map, const RayRows& rays, RayRows& result) {
    HWY_DYNAMIC_DISPATCH(transform_rays_kernel)(map, rays, result);
}

} // namespace vera::detail

#endif
