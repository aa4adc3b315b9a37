// SPDX-License-Identifier: Apache-2.0
// What rays do at the leaves of the tree of a mesh: see float_search-inl.h. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_MESH_LEAVES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_MESH_LEAVES_INL_H
#undef VERA_ACCEL_MESH_LEAVES_INL_H
#else
#define VERA_ACCEL_MESH_LEAVES_INL_H
#endif

#include "vera/accel/float_beams-inl.h"
#include "vera/accel/float_leaves-inl.h"
#include "vera/accel/float_singles-inl.h"
#include "vera/accel/float_workspace-inl.h"
#include "vera/accel/mesh_tree.h"

#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Bounds of what is rounded. Corners and rays are exact, so that a difference of two of them is off
// by u = 2^-24 of itself, and each further operation by as much. With e and f the sides from corner
// a, q the way from the origin to a, and d the direction, of which |x| is the sum of the
// coordinates without their signs and [q] the largest one: each of the six products that a volume
// adds up is rounded seven times, or eight where all three are differences, so that volumes are off
// by at most
//   7 u [q] |d| |side|     of q, a side and the direction,
//   7 u |d| |e| |f|        of e, f and the direction,
//   8 u [q] |e| |f|        of e, f and q.
// The quotient t of the last two is rounded three times more, which counts as the speed's.
// That of the third side is the second less two of the first: it is off by
//   9 u |d| (|e| + |f|) ([q] + (|e| + |f|) / 4).
constexpr float side_rounding = 10 * 0x1p-24F;
constexpr float speed_rounding = 10.5F * 0x1p-24F;
constexpr float depth_rounding = 8.5F * 0x1p-24F;

// What is too small for a usual number loses digits, or all: volumes may be off by this as well. Of
// a speed, so much that its inverse is finite.
constexpr float volume_underflow = 0x1p-110F;
constexpr float speed_underflow = 0x1p-120F;

/// A triangle as single precision sees it.
template <typename V>
struct Sides {
    Vector<V> corner;
    Vector<V> e;
    Vector<V> f;
    Vector<V> normal;
    V size;    ///< |e| + |f|: see above
    V product; ///< |e| |f|
};

/// Of triangles number i on of a leaf.
template <typename D>
HWY_INLINE Sides<hn::Vec<D>>
elements_at(const TreeSearch<MeshTree>&, D d, const float* rows, std::size_t size, std::size_t i) {
    using V = hn::Vec<D>;
    const auto row = [&](std::size_t j) HWY_ATTR { return hn::LoadU(d, rows + j * size + i); };
    const Vector<V> a = {row(0), row(1), row(2)};
    const Vector<V> e = difference<V>({row(3), row(4), row(5)}, a);
    const Vector<V> f = difference<V>({row(6), row(7), row(8)}, a);
    const V e_size = sum_of(absolute(e));
    const V f_size = sum_of(absolute(f));
    return {a, e, f, cross_product(e, f), hn::Add(e_size, f_size), hn::Mul(e_size, f_size)};
}

/// How rays pass triangles, each a volume of the ray's direction and two others: u, v and w have
/// the sign of speed, or are 0, where the ray meets the triangle, and there t is depth / speed.
template <typename V>
struct Passing {
    V u;
    V v;
    V speed;
    V depth;
    V side_error; ///< of u, v and w
    V speed_error;
    V depth_error;
};

/// Speeds of more than so many times what they are off by tell where a triangle is met: far more
/// than mesh_crossing() asks for.
constexpr float well_known = 16;

template <typename D>
HWY_INLINE FloatMeeting<D>
meeting_triangle(D d, const Passing<hn::Vec<D>>& passing, hn::Vec<D> t_min, hn::Vec<D> limit) {
    using V = hn::Vec<D>;
    const V w = hn::Sub(hn::Sub(passing.speed, passing.u), passing.v);
    const V lowest = hn::Min(hn::Min(passing.u, passing.v), w);
    const V highest = hn::Max(hn::Max(passing.u, passing.v), w);
    const V size = hn::Abs(passing.speed);
    const auto in_outline =
        hn::Or(hn::Ge(lowest, hn::Neg(passing.side_error)), hn::Le(highest, passing.side_error));
    const auto surely_in_outline =
        hn::Or(hn::Gt(lowest, passing.side_error), hn::Lt(highest, hn::Neg(passing.side_error)));
    // Then t is off by at most 1 / (1 - 1 / 16) times what both errors make of it.
    const auto known = hn::Gt(size, hn::Mul(hn::Set(d, well_known), passing.speed_error));
    const V per_speed = hn::Div(hn::Set(d, 1), passing.speed);
    const V t = hn::Mul(passing.depth, per_speed);
    const V error = hn::Mul(
        hn::MulAdd(hn::Abs(t), passing.speed_error, passing.depth_error),
        hn::Abs(hn::Mul(hn::Set(d, 1.07F), per_speed)));
    const V near = hn::Sub(t, error);
    const V far = hn::Add(t, error);
    const auto in_range = hn::And(hn::Ge(far, t_min), hn::Le(near, limit));
    const auto surely_in_range = hn::And(hn::Gt(near, t_min), hn::Lt(far, limit));
    return {
        hn::And(in_outline, hn::Or(hn::Not(known), in_range)),
        hn::And(hn::And(surely_in_outline, known), surely_in_range),
        near,
        far};
}

/// The bound of what the volumes with the sides are off by; direction_size is |d|, largest_way [q].
template <typename D>
HWY_INLINE hn::Vec<D>
side_error(D d, const Sides<hn::Vec<D>>& sides, float direction_size, hn::Vec<D> largest_way) {
    return hn::MulAdd(
        hn::Mul(hn::Set(d, side_rounding * direction_size), sides.size),
        hn::MulAdd(hn::Set(d, 0.25F), sides.size, largest_way),
        hn::Set(d, volume_underflow));
}

/// The same for their speed.
template <typename D>
HWY_INLINE hn::Vec<D> speed_error(D d, const Sides<hn::Vec<D>>& sides, float direction_size) {
    return hn::MulAdd(
        hn::Set(d, speed_rounding * direction_size), sides.product, hn::Set(d, speed_underflow));
}

/// The same for their depth.
template <typename D>
HWY_INLINE hn::Vec<D> depth_error(D d, const Sides<hn::Vec<D>>& sides, hn::Vec<D> largest_way) {
    return hn::MulAdd(
        hn::Mul(hn::Set(d, depth_rounding), sides.product),
        largest_way,
        hn::Set(d, volume_underflow));
}

/// How rays pass triangles; direction_size as in a RayGroup.
template <typename D>
HWY_INLINE Passing<hn::Vec<D>> passing_triangle(
    D d,
    const Vector<hn::Vec<D>>& origin,
    const Vector<hn::Vec<D>>& direction,
    float direction_size,
    const Sides<hn::Vec<D>>& sides) {
    using V = hn::Vec<D>;
    const Vector<V> way = difference(sides.corner, origin);
    const Vector<V> moment = cross_product(way, direction);
    const V q = largest(way);
    return {
        product(moment, sides.f),
        hn::Neg(product(moment, sides.e)),
        product(sides.normal, direction),
        product(sides.normal, way),
        side_error(d, sides, direction_size, q),
        speed_error(d, sides, direction_size),
        depth_error(d, sides, q)};
}

/// The triangles of a leaf as seen from an origin, number by number: what only the direction is
/// missing from.
struct SeenTriangles {
    static constexpr std::size_t count = 13;
    std::uint32_t may = 0; ///< which of them the beam's rays may meet before its limit
    alignas(64) float rows[count][most_in_leaf];
};

/// The triangles of a leaf as they are seen from the beam's origin. Which of them may be met is
/// told for all directions of its rays at once, by middle and half.
HWY_INLINE SeenTriangles seen_elements(
    const Search<MeshTree>& search, const float* rows, std::size_t size, const BeamWalk& beam) {
    const LeafLanes d;
    using V = hn::Vec<LeafLanes>;
    const RayGroup& group = *beam.group;
    const Vector<V> middle = same_for_all(d, beam.direction_middle);
    const Vector<V> half = same_for_all(d, beam.direction_half);
    SeenTriangles seen;
    std::uint32_t may = 0;
    for (std::size_t i = 0; i < size; i += hn::Lanes(d)) {
        const Sides<V> sides = elements_at(search, d, rows, size, i);
        const Vector<V> way = difference(sides.corner, same_for_all(d, beam.origin));
        const Vector<V> u = cross_product(sides.f, way);
        const Vector<V> v = cross_product(way, sides.e);
        const Vector<V>& normal = sides.normal;
        const V depth = product(normal, way);
        const V q = largest(way);
        const V u_v_error = side_error(d, sides, beam.direction_size, q);
        const V n_error = speed_error(d, sides, group.direction_size);
        const V t_error = depth_error(d, sides, q);
        const V values[SeenTriangles::count] = {
            u.x,
            u.y,
            u.z,
            v.x,
            v.y,
            v.z,
            normal.x,
            normal.y,
            normal.z,
            depth,
            u_v_error,
            n_error,
            t_error};
        for (std::size_t j = 0; j < SeenTriangles::count; ++j)
            hn::Store(values[j], d, seen.rows[j] + i);

        const Vector<V> w = difference(difference(normal, u), v);
        const V u_middle = product(u, middle);
        const V v_middle = product(v, middle);
        const V speed_middle = product(normal, middle);
        const V w_middle = hn::Sub(hn::Sub(speed_middle, u_middle), v_middle);
        const V u_half = hn::Add(product(absolute(u), half), u_v_error);
        const V v_half = hn::Add(product(absolute(v), half), u_v_error);
        const V w_half = hn::Add(product(absolute(w), half), u_v_error);
        const V speed_half = hn::Add(product(absolute(normal), half), u_v_error);
        // Whether all of these can be positive, or negative: u, v, w and speed.
        const auto front = hn::And(
            hn::And(hn::Ge(u_middle, hn::Neg(u_half)), hn::Ge(v_middle, hn::Neg(v_half))),
            hn::And(hn::Ge(w_middle, hn::Neg(w_half)), hn::Ge(speed_middle, hn::Neg(speed_half))));
        const auto back = hn::And(
            hn::And(hn::Le(u_middle, u_half), hn::Le(v_middle, v_half)),
            hn::And(hn::Le(w_middle, w_half), hn::Le(speed_middle, speed_half)));
        const V speed_size = hn::Abs(speed_middle);
        const auto before = hn::Le(
            hn::Sub(hn::Abs(depth), t_error),
            hn::Mul(hn::Set(d, beam.limit), hn::Add(speed_size, speed_half)));
        // What is seen edge-on is met where its plane need not be: see mesh_crossing().
        const auto edge_on =
            hn::Le(hn::Sub(speed_size, speed_half), hn::Mul(hn::Set(d, well_known), n_error));
        const auto in_range = hn::Or(before, edge_on);
        may |= bits_of(d, hn::And(hn::Or(front, back), in_range)) << i;
    }
    seen.may = may & ((std::uint32_t{1} << size) - 1);
    return seen;
}

/// Rays of a group, which start at one origin.
struct DirectedRays {
    Vector<hn::Vec<Rays>> direction;
    hn::Vec<Rays> t_min;
};

/// Those from number i on.
HWY_INLINE DirectedRays rays_at(const Search<MeshTree>&, const RayGroup& group, std::size_t i) {
    const Rays d;
    return {
        {hn::Load(d, group.direction[0].data() + i),
         hn::Load(d, group.direction[1].data() + i),
         hn::Load(d, group.direction[2].data() + i)},
        hn::Load(d, group.t_min.data() + i)};
}

/// How the rays meet a triangle that was seen from their origin.
HWY_INLINE FloatMeeting<Rays> meeting_seen(
    Rays d,
    const DirectedRays& rays,
    const SeenTriangles& seen,
    std::size_t triangle,
    hn::Vec<Rays> limit) {
    const auto value = [&](std::size_t j) HWY_ATTR { return hn::Set(d, seen.rows[j][triangle]); };
    const Passing<hn::Vec<Rays>> passing = {
        product({value(0), value(1), value(2)}, rays.direction),
        product({value(3), value(4), value(5)}, rays.direction),
        product({value(6), value(7), value(8)}, rays.direction),
        value(9),
        value(10),
        value(11),
        value(12)};
    return meeting_triangle(d, passing, rays.t_min, limit);
}

/// The triangles that a ray may pass through wherever they are along it, as bits: sooner known than
/// how it meets them, which begins with the same operations.
HWY_INLINE std::uint32_t
passed_through(const Sides<hn::Vec<LeafLanes>>& sides, const SingleRay& ray) {
    const LeafLanes d;
    using V = hn::Vec<LeafLanes>;
    const Passing<V> passing = passing_triangle(
        d, same_for_all(d, ray.origin), same_for_all(d, ray.direction), ray.direction_size, sides);
    const V w = hn::Sub(hn::Sub(passing.speed, passing.u), passing.v);
    const V lowest = hn::Min(hn::Min(passing.u, passing.v), w);
    const V highest = hn::Max(hn::Max(passing.u, passing.v), w);
    return bits_of(
        d,
        hn::Or(hn::Ge(lowest, hn::Neg(passing.side_error)), hn::Le(highest, passing.side_error)));
}

/// How a ray meets the triangles.
HWY_INLINE FloatMeeting<LeafLanes>
meeting_single(const Sides<hn::Vec<LeafLanes>>& sides, const SingleRay& ray) {
    const LeafLanes d;
    return meeting_triangle(
        d,
        passing_triangle(
            d,
            same_for_all(d, ray.origin),
            same_for_all(d, ray.direction),
            ray.direction_size,
            sides),
        hn::Set(d, ray.t_min),
        hn::Set(d, ray.limit));
}

// Triangles ask for no more of rays than all elements do.

HWY_INLINE void add_rows(const Search<MeshTree>&, RayGroup&) {}

HWY_INLINE void add_numbers(const TreeSearch<MeshTree>&, const RayGroup&, SingleRay*) {}

HWY_INLINE void add_numbers(const TreeSearch<MeshTree>&, SingleRay&) {}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
