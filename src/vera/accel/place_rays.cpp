// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/packet_query.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

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

struct Placed {
    LaneMask touching = 0;
    LaneMask strange = 0; ///< lanes whose rays have no direction, or are not finite
    double slack = 0;
};

/// The part of a frame from a lane on that fits into a register.
HWY_INLINE void
place_part(Frame& frame, const RayRows::Row& limit, std::size_t lane, Placed& placed) {
    const LocalGeometry& local = *frame.local;
    const Doubles d;
    const auto scale = all(local.scale);
    Vec origin[3];
    Vec given[3];
    auto origin_size = hn::Zero(d);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        origin[axis] =
            hn::Mul(scale, hn::Sub(row(frame.rays.origin[axis], lane), all(local.center[axis])));
        given[axis] = row(frame.rays.direction[axis], lane);
        origin_size = hn::Max(origin_size, hn::Abs(origin[axis]));
    }
    const auto norm_squared = hn::Add(
        hn::Add(hn::Mul(given[0], given[0]), hn::Mul(given[1], given[1])),
        hn::Mul(given[2], given[2]));
    const auto norm = hn::Sqrt(norm_squared);
    const auto per_norm = hn::Div(all(1), norm);
    const auto speed = hn::Mul(norm, scale);
    const auto slack = hn::Add(
        all(least_slack + 0x1p-44 * local.scale * local.coordinate_size),
        hn::Add(
            hn::Mul(all(0x1p-44), origin_size),
            hn::Mul(all(2 * local.scale), row(frame.rays.origin_error, lane))));
    auto near = hn::Mul(row(frame.rays.t_min, lane), speed);
    auto far = hn::Mul(hn::Min(row(frame.rays.t_max, lane), row(limit, lane)), speed);
    Vec direction[3];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        direction[axis] = hn::Mul(given[axis], per_norm);
        const auto size = hn::Max(hn::Abs(direction[axis]), all(1e-20));
        const auto inverse = hn::Div(all(1), hn::CopySign(size, direction[axis]));
        const auto lower =
            hn::Sub(hn::Sub(all(local.local_bounds.lower[axis]), slack), origin[axis]);
        const auto upper =
            hn::Sub(hn::Add(all(local.local_bounds.upper[axis]), slack), origin[axis]);
        const auto at_lower = hn::Mul(lower, inverse);
        const auto at_upper = hn::Mul(upper, inverse);
        near = hn::Max(near, hn::Min(at_lower, at_upper));
        far = hn::Min(far, hn::Max(at_lower, at_upper));
        store(direction[axis], frame.direction[axis], lane);
        store(inverse, frame.inverse[axis], lane);
    }
    for (std::size_t axis = 0; axis < 3; ++axis)
        store(hn::Add(origin[axis], hn::Mul(near, direction[axis])), frame.origin[axis], lane);
    hn::StoreU(hn::Div(near, speed), d, frame.start_t.data() + lane);
    hn::StoreU(speed, d, frame.speed.data() + lane);

    // Squares outside of these bounds have lost digits.
    const auto usual = hn::And(
        hn::And(hn::Gt(norm_squared, all(1e-280)), hn::Lt(norm_squared, all(1e280))),
        hn::And(hn::Gt(speed, all(1e-280)), hn::Lt(origin_size, all(1e280))));
    const auto touching = hn::And(usual, hn::Le(near, hn::Add(far, slack)));
    placed.touching |= bits(touching, lane);
    placed.strange |= bits(hn::Not(usual), lane);
    const auto counted = hn::IfThenElseZero(touching, slack);
    placed.slack = std::max(placed.slack, hn::GetLane(hn::MaxOfLanes(d, counted)));
}

LaneMask place_rays_kernel(Frame& frame, LaneMask lanes, const RayRows::Row& limit) {
    Placed placed;
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(Doubles()))
        if ((lanes >> lane & ((LaneMask{1} << hn::Lanes(Doubles())) - 1)) != 0)
            place_part(frame, limit, lane, placed);
    frame.slack = static_cast<float>(std::max(placed.slack * (1 + 0x1p-20), least_slack));
    placed.strange &= lanes;
    for (std::size_t lane = 0; lane < packet_size; ++lane) {
        if ((placed.strange >> lane & 1U) == 0)
            continue;
        // A ray that cannot be followed is let meet everything.
        for (std::size_t axis = 0; axis < 3; ++axis) {
            frame.origin[axis][lane] = 0;
            frame.direction[axis][lane] = axis == 0 ? 1 : 0;
            frame.inverse[axis][lane] = axis == 0 ? 1 : 1e20F;
        }
        frame.start_t[lane] = 0;
        frame.speed[lane] = 0;
        frame.slack = 64;
    }
    return (placed.touching & lanes) | placed.strange;
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

LaneMask place_rays(Frame& frame, LaneMask lanes, const RayRows::Row& limit) {
    return HWY_DYNAMIC_DISPATCH(place_rays_kernel)(frame, lanes, limit);
}

void transform_rays(const Affine3& map, const RayRows& rays, RayRows& result) {
    HWY_DYNAMIC_DISPATCH(transform_rays_kernel)(map, rays, result);
}

} // namespace vera::detail

#endif
