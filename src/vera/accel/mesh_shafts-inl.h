// SPDX-License-Identifier: Apache-2.0
// What the rays of shafts do at the leaves of the tree of a mesh: see float_shafts-inl.h. Compiled
// once for each instruction set.

#if defined(VERA_ACCEL_MESH_SHAFTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_MESH_SHAFTS_INL_H
#undef VERA_ACCEL_MESH_SHAFTS_INL_H
#else
#define VERA_ACCEL_MESH_SHAFTS_INL_H
#endif

#include "vera/accel/float_shafts-inl.h"
#include "vera/accel/mesh_crossing.h"
#include "vera/accel/mesh_leaves-inl.h"

#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Which rays may meet triangles, and which surely do.
template <typename D>
struct AnyMeeting {
    hn::Mask<D> may;
    hn::Mask<D> sure;
};

/// The same as meeting_triangle() where nobody asks for t: without a quotient, as depths are
/// compared with speeds times t. Half as much again as the errors is more than what that rounds.
template <typename D>
HWY_INLINE AnyMeeting<D>
any_meeting_triangle(D d, const Passing<hn::Vec<D>>& passing, hn::Vec<D> t_min, hn::Vec<D> limit) {
    using V = hn::Vec<D>;
    const V w = hn::Sub(hn::Sub(passing.speed, passing.u), passing.v);
    const V lowest = hn::Min(hn::Min(passing.u, passing.v), w);
    const V highest = hn::Max(hn::Max(passing.u, passing.v), w);
    const V negative_error = hn::Neg(passing.side_error);
    const auto in_outline =
        hn::Or(hn::Ge(lowest, negative_error), hn::Le(highest, passing.side_error));
    const auto surely_in_outline =
        hn::Or(hn::Gt(lowest, passing.side_error), hn::Lt(highest, negative_error));
    const V size = hn::Abs(passing.speed);
    const V depth = hn::Xor(passing.depth, hn::AndNot(size, passing.speed));
    const auto known = hn::Gt(size, hn::Mul(hn::Set(d, well_known), passing.speed_error));
    const V more = hn::Set(d, 1.5F);
    const V fastest = hn::MulAdd(more, passing.speed_error, size);
    const V slowest = hn::NegMulAdd(more, passing.speed_error, size);
    const V deepest = hn::MulAdd(more, passing.depth_error, depth);
    const V shallowest = hn::NegMulAdd(more, passing.depth_error, depth);
    const auto in_range = hn::And(
        hn::Ge(deepest, hn::Mul(t_min, slowest)), hn::Le(shallowest, hn::Mul(limit, fastest)));
    const auto surely_in_range = hn::And(
        hn::Gt(shallowest, hn::Mul(t_min, fastest)), hn::Lt(deepest, hn::Mul(limit, slowest)));
    return {
        hn::And(in_outline, hn::Or(hn::Not(known), in_range)),
        hn::And(hn::And(surely_in_outline, known), surely_in_range)};
}

/// The triangles of a leaf, number by number, so that rays in lanes can be tested against one.
struct SpreadTriangles {
    static constexpr std::size_t count = 14;
    alignas(64) float rows[count][most_in_leaf];
};

HWY_INLINE SpreadTriangles
spread_elements(const Search<MeshTree>& search, const float* rows, std::size_t size) {
    const LeafLanes d;
    using V = hn::Vec<LeafLanes>;
    SpreadTriangles spread;
    for (std::size_t i = 0; i < size; i += hn::Lanes(d)) {
        const Sides<V> sides = elements_at(search, d, rows, size, i);
        const V values[SpreadTriangles::count] = {
            sides.corner.x,
            sides.corner.y,
            sides.corner.z,
            sides.e.x,
            sides.e.y,
            sides.e.z,
            sides.f.x,
            sides.f.y,
            sides.f.z,
            sides.normal.x,
            sides.normal.y,
            sides.normal.z,
            sides.size,
            sides.product};
        for (std::size_t j = 0; j < SpreadTriangles::count; ++j)
            hn::Store(values[j], d, spread.rows[j] + i);
    }
    return spread;
}

/// Which of the triangles rays of the shaft may meet, told for all that start and run between its
/// bounds at once, by middle and half.
HWY_INLINE std::uint32_t
elements_in_shaft(const SpreadTriangles& spread, std::size_t size, const RayShaft& shaft) {
    const LeafLanes d;
    using V = hn::Vec<LeafLanes>;
    const Vector<V> direction = same_for_all(d, shaft.direction_middle);
    const Vector<V> direction_half = same_for_all(d, shaft.direction_half);
    const Vector<V> anchor_half = same_for_all(d, shaft.anchor_half);
    const Vector<V> moment_half = same_for_all(d, shaft.moment_half);
    std::uint32_t may = 0;
    for (std::size_t i = 0; i < size; i += hn::Lanes(d)) {
        const auto row = [&](std::size_t j) HWY_ATTR { return hn::Load(d, spread.rows[j] + i); };
        const Vector<V> corner = {row(0), row(1), row(2)};
        const Vector<V> e = {row(3), row(4), row(5)};
        const Vector<V> f = {row(6), row(7), row(8)};
        const Vector<V> normal = {row(9), row(10), row(11)};
        const Sides<V> sides = {corner, e, f, normal, row(12), row(13)};
        const Vector<V> way = difference(corner, same_for_all(d, shaft.anchor_middle));
        const Vector<V> u_of = cross_product(f, way);
        const Vector<V> v_of = cross_product(way, e);
        const Vector<V> w_of = difference(difference(normal, u_of), v_of);
        const V q = hn::Add(largest(way), hn::Set(d, shaft.anchor_reach));
        const V error = side_error(d, sides, shaft.direction_size, q);
        const V n_error = speed_error(d, sides, shaft.direction_size);
        const V t_error = depth_error(d, sides, q);
        const V u = product(u_of, direction);
        const V v = product(v_of, direction);
        const V speed = product(normal, direction);
        const V w = hn::Sub(hn::Sub(speed, u), v);
        const V depth = product(normal, way);
        const auto half = [&](const Vector<V>& of, const Vector<V>& side) HWY_ATTR {
            return hn::Add(
                hn::Add(
                    product(absolute(of), direction_half), product(absolute(side), moment_half)),
                error);
        };
        const V u_half = half(u_of, f);
        const V v_half = half(v_of, e);
        const V w_half = half(w_of, difference(e, f));
        const V speed_half = hn::Add(product(absolute(normal), direction_half), error);
        const V depth_half = hn::Add(product(absolute(normal), anchor_half), t_error);
        const auto front = hn::And(
            hn::And(hn::Ge(u, hn::Neg(u_half)), hn::Ge(v, hn::Neg(v_half))),
            hn::And(hn::Ge(w, hn::Neg(w_half)), hn::Ge(speed, hn::Neg(speed_half))));
        const auto back = hn::And(
            hn::And(hn::Le(u, u_half), hn::Le(v, v_half)),
            hn::And(hn::Le(w, w_half), hn::Le(speed, speed_half)));
        const V speed_size = hn::Abs(speed);
        // Between the first start and the last end.
        const V largest_speed = hn::Add(speed_size, speed_half);
        const V before = hn::MulAdd(hn::Set(d, shaft.before), largest_speed, depth_half);
        const V after = hn::MulAdd(hn::Set(d, shaft.after), largest_speed, depth_half);
        const auto front_ahead =
            hn::And(front, hn::And(hn::Ge(depth, hn::Neg(before)), hn::Le(depth, after)));
        const auto back_ahead =
            hn::And(back, hn::And(hn::Le(depth, before), hn::Ge(depth, hn::Neg(after))));
        // What is seen edge-on is met where its plane need not be: see mesh_crossing().
        const auto edge_on =
            hn::Le(hn::Sub(speed_size, speed_half), hn::Mul(hn::Set(d, well_known), n_error));
        may |=
            bits_of(
                d, hn::Or(hn::Or(front_ahead, back_ahead), hn::And(hn::Or(front, back), edge_on)))
            << i;
    }
    return may & ((std::uint32_t{1} << size) - 1);
}

/// How rays number i on of the group meet triangle j.
HWY_INLINE AnyMeeting<Rays> meeting_spread(
    Rays d, const SpreadTriangles& spread, std::size_t j, const RayGroup& group, std::size_t i) {
    using V = hn::Vec<Rays>;
    const auto value = [&](std::size_t row) HWY_ATTR { return hn::Set(d, spread.rows[row][j]); };
    const auto vector = [&](const GroupRow<float>* rows) HWY_ATTR {
        return Vector<V>{
            hn::Load(d, rows[0].data() + i),
            hn::Load(d, rows[1].data() + i),
            hn::Load(d, rows[2].data() + i)};
    };
    const Sides<V> sides = {
        {value(0), value(1), value(2)},
        {value(3), value(4), value(5)},
        {value(6), value(7), value(8)},
        {value(9), value(10), value(11)},
        value(12),
        value(13)};
    return any_meeting_triangle(
        d,
        passing_triangle(
            d, vector(group.origin), vector(group.direction), group.direction_size, sides),
        hn::Load(d, group.t_min.data() + i),
        hn::Load(d, group.limit.data() + i));
}

/// Those of the lanes' rays that double precision does not at once rule out to meet a triangle with
/// these corners: as mesh_crossing() begins, to the bit, in the operations of plane_crossing().
/// What is multiplied here by powers of two is so on both sides of each comparison.
HWY_INLINE GroupMask
not_ruled_out(const float* rows, std::size_t size, GroupMask lanes, const RayGroup& group) {
    const DecidingLanes d;
    const hn::Rebind<float, DecidingLanes> f;
    using V = hn::Vec<DecidingLanes>;
    const auto corner = [&](std::size_t row) HWY_ATTR {
        const auto number = [&](std::size_t axis)
                                HWY_ATTR { return static_cast<double>(rows[(row + axis) * size]); };
        return Vector<V>{hn::Set(d, number(0)), hn::Set(d, number(1)), hn::Set(d, number(2))};
    };
    const Vector<V> a = corner(0);
    const Vector<V> e = difference(corner(3), a);
    const Vector<V> g = difference(corner(6), a);
    const Vector<V> normal = cross_in_order(e, g, d);
    const V sides_size = hn::Mul(largest(e), largest(g));
    GroupMask left = 0;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        const auto row = [&](const GroupRow<float>& values)
                             HWY_ATTR { return hn::PromoteTo(d, hn::Load(f, values.data() + i)); };
        const auto vector = [&](const GroupRow<float>* of) HWY_ATTR {
            return Vector<V>{row(of[0]), row(of[1]), row(of[2])};
        };
        const Vector<V> direction = vector(group.direction);
        const V speed = dot_in_order(normal, direction, d);
        const V t = hn::Mul(
            dot_in_order(normal, difference(a, vector(group.origin)), d),
            hn::Div(hn::Set(d, 1), speed));
        const V largest_size = hn::Mul(sides_size, largest(direction));
        const auto known =
            hn::Gt(hn::Abs(speed), hn::Mul(hn::Set(d, well_known_crossing), largest_size));
        const auto covered = hn::And(hn::Ge(t, row(group.t_min)), hn::Le(t, row(group.limit)));
        left |= bits_of(d, hn::Or(hn::Not(known), covered)) << i;
    }
    return left & lanes;
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
