// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/exact_triangles.h"

#include <bit>
#include <cstdint>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/exact_triangles.cpp"
#include <hwy/foreach_target.h>
// Behind the line above, which includes this file once for each instruction set.
#include "vera/accel/exact_lanes-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void prepare_rays_kernel(Frame& frame) {
    const Doubles d;
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d)) {
        const Vec x = row(frame.rays.direction[0], lane);
        const Vec y = row(frame.rays.direction[1], lane);
        const Vec z = row(frame.rays.direction[2], lane);
        // As longest_axis() does, also where numbers are none.
        const auto along_x =
            hn::And(hn::Ge(hn::Abs(x), hn::Abs(y)), hn::Ge(hn::Abs(x), hn::Abs(z)));
        const auto along_y = hn::AndNot(along_x, hn::Ge(hn::Abs(y), hn::Abs(z)));
        const Vec along = chosen(along_x, x, along_y, y, z);
        PreparedRows& prepared = frame.prepared_rows;
        store(
            chosen(along_x, hn::Zero(d), along_y, hn::Set(d, 1), hn::Set(d, 2)),
            prepared.axis,
            lane);
        store(hn::Div(chosen(along_x, y, along_y, z, x), along), prepared.shear_x, lane);
        store(hn::Div(chosen(along_x, z, along_y, x, y), along), prepared.shear_y, lane);
        store(along, prepared.direction_z, lane);
        store(
            hn::Max(
                hn::Max(
                    hn::Abs(row(frame.rays.origin[0], lane)),
                    hn::Abs(row(frame.rays.origin[1], lane))),
                hn::Abs(row(frame.rays.origin[2], lane))),
            prepared.origin_size,
            lane);
    }
}

HWY_INLINE Vec size3(const Vec (&a)[3]) {
    return sum3(hn::Abs(a[0]), hn::Abs(a[1]), hn::Abs(a[2]));
}

/// edge_function()
HWY_INLINE Vec edge(Vec ax, Vec ay, Vec bx, Vec by) {
    return hn::Sub(hn::Mul(ax, by), hn::Mul(ay, bx));
}

/// The operations of triangle_crossing() and starts_on_triangle(), in their order.
HWY_INLINE LaneMask
cross_part(const Frame& frame, const TriangleRows& triangles, std::size_t lane, RayRows::Row& ts) {
    const Doubles d;
    const Vec zero = hn::Zero(d);
    const PreparedRows& prepared = frame.prepared_rows;
    const Vec axis = row(prepared.axis, lane);
    const auto along_x = hn::Eq(axis, zero);
    const auto along_y = hn::Eq(axis, hn::Set(d, 1));
    const Vec shear_x = row(prepared.shear_x, lane);
    const Vec shear_y = row(prepared.shear_y, lane);
    Vec x[3];
    Vec y[3];
    Vec z[3];
    Vec from_origin[3] = {zero, zero, zero}; // of the first corner
    for (std::size_t corner = 0; corner < 3; ++corner) {
        Vec from[3] = {zero, zero, zero};
        for (std::size_t i = 0; i < 3; ++i) {
            from[i] = hn::Sub(row(triangles[corner][i], lane), row(frame.rays.origin[i], lane));
            if (corner == 0)
                from_origin[i] = from[i];
        }
        z[corner] = chosen(along_x, from[0], along_y, from[1], from[2]);
        x[corner] = hn::Sub(
            chosen(along_x, from[1], along_y, from[2], from[0]), hn::Mul(shear_x, z[corner]));
        y[corner] = hn::Sub(
            chosen(along_x, from[2], along_y, from[0], from[1]), hn::Mul(shear_y, z[corner]));
    }
    const Vec u = edge(x[1], y[1], x[2], y[2]);
    const Vec v = edge(x[2], y[2], x[0], y[0]);
    const Vec w = edge(x[0], y[0], x[1], y[1]);
    const auto left = hn::And(hn::And(hn::Ge(u, zero), hn::Ge(v, zero)), hn::Ge(w, zero));
    const auto right = hn::And(hn::And(hn::Le(u, zero), hn::Le(v, zero)), hn::Le(w, zero));
    const Vec area = sum3(u, v, w);
    const Vec t = hn::Div(
        sum3(hn::Mul(u, z[0]), hn::Mul(v, z[1]), hn::Mul(w, z[2])),
        hn::Mul(area, row(prepared.direction_z, lane)));
    const Vec t_min = row(frame.rays.t_min, lane);
    const auto covered = covers(frame, lane, t);
    store(t, ts, lane);

    Vec ab[3];
    Vec ac[3];
    Vec corner_size = zero;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec a = row(triangles[0][i], lane);
        const Vec b = row(triangles[1][i], lane);
        const Vec c = row(triangles[2][i], lane);
        ab[i] = hn::Sub(b, a);
        ac[i] = hn::Sub(c, a);
        corner_size = hn::Max(corner_size, hn::Max(hn::Abs(a), hn::Max(hn::Abs(b), hn::Abs(c))));
    }
    const Vec normal[3] = {
        edge(ab[1], ab[2], ac[1], ac[2]),
        edge(ab[2], ab[0], ac[2], ac[0]),
        edge(ab[0], ab[1], ac[0], ac[1])};
    const Vec start_distance = hn::Add(
        row(frame.rays.origin_error, lane),
        hn::Mul(hn::Set(d, 0x1p-48), hn::Max(corner_size, row(prepared.origin_size, lane))));
    const Vec bound = hn::Add(
        hn::Mul(start_distance, size3(normal)),
        hn::Mul(
            hn::Mul(hn::Mul(hn::Set(d, 0x1p-50), size3(ab)), size3(ac)), largest3(from_origin)));
    const Vec distance = dot3(normal, from_origin);
    const auto starts = hn::And(hn::Ge(t_min, zero), hn::Le(hn::Abs(distance), bound));
    const auto met =
        hn::AndNot(starts, hn::And(hn::Or(left, right), hn::AndNot(hn::Eq(area, zero), covered)));
    return bits(met, lane);
}

LaneMask cross_triangles_kernel(
    const Frame& frame, LaneMask lanes, const TriangleRows& triangles, RayRows::Row& t) {
    LaneMask met = 0;
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(Doubles()))
        if (any_in_vector(lanes, lane))
            met |= cross_part(frame, triangles, lane, t);
    return met & lanes;
}

LaneMask take_candidates_kernel(Frame& frame, LaneMask lanes, TakenCandidates& result) {
    const hn::CappedTag<float, packet_size> d;
    const hn::RebindToUnsigned<decltype(d)> d_elements;
    Candidates& candidates = frame.candidates;
    LaneMask taken = 0;
    for (std::size_t i = 0; i < candidates.count && taken != lanes; ++i) {
        LaneMask wanted = candidates.all[i].lanes & lanes & ~taken;
        if (wanted == 0)
            continue;
        candidates.all[i].lanes &= ~wanted;
        LaneMask behind = 0;
        for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d)) {
            std::uint8_t bytes[8] = {};
            hn::StoreMaskBits(
                d,
                hn::Gt(
                    hn::LoadU(d, candidates.near[i].data() + lane),
                    hn::LoadU(d, frame.limit.data() + lane)),
                bytes);
            const LaneMask bits = bytes[0] | LaneMask{bytes[1]} << 8U;
            behind |= (bits & ((LaneMask{1} << hn::Lanes(d)) - 1)) << lane;
        }
        wanted &= ~behind;
        taken |= wanted;
        result.of_kind[static_cast<std::size_t>(candidates.all[i].kind)] |= wanted;
        for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d)) {
            const std::uint8_t bytes[8] = {
                static_cast<std::uint8_t>(wanted >> lane),
                static_cast<std::uint8_t>(wanted >> lane >> 8U)};
            hn::BlendedStore(
                hn::Set(d_elements, candidates.all[i].element),
                hn::LoadMaskBits(d_elements, bytes),
                d_elements,
                result.elements.data() + lane);
        }
    }
    return taken;
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera::detail {

HWY_EXPORT(prepare_rays_kernel);
HWY_EXPORT(cross_triangles_kernel);
HWY_EXPORT(take_candidates_kernel);

void prepare_rays(Frame& frame) {
    HWY_DYNAMIC_DISPATCH(prepare_rays_kernel)(frame);
}

LaneMask cross_triangles(
    const Frame& frame, LaneMask lanes, const TriangleRows& triangles, RayRows::Row& t) {
    return HWY_DYNAMIC_DISPATCH(cross_triangles_kernel)(frame, lanes, triangles, t);
}

LaneMask take_candidates(Frame& frame, LaneMask lanes, TakenCandidates& taken) {
    return HWY_DYNAMIC_DISPATCH(take_candidates_kernel)(frame, lanes, taken);
}

} // namespace vera::detail

#endif
