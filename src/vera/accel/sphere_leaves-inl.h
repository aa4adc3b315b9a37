// SPDX-License-Identifier: Apache-2.0
// What rays do at the leaves of the tree of spheres: see float_search-inl.h. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_SPHERE_LEAVES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_SPHERE_LEAVES_INL_H
#undef VERA_ACCEL_SPHERE_LEAVES_INL_H
#else
#define VERA_ACCEL_SPHERE_LEAVES_INL_H
#endif

#include "vera/accel/float_beams-inl.h"
#include "vera/accel/float_leaves-inl.h"
#include "vera/accel/float_singles-inl.h"
#include "vera/accel/float_workspace-inl.h"
#include "vera/accel/sphere_tree.h"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Bounds of what is rounded: see sphere_crossing.h for how it is computed. Spheres and rays are
// exact. With u = 2^-24, the way f to the center and its length F, the direction d, of which the
// largest coordinate is between 1 and 2, and T = |m| |d|: F is at most T + r where the sphere is
// met.
//   f is off by u F, and m d by as much of its own, so that l is off by 3 u F across d. Along d it
//   is off by what m is, 9 u F at most, which adds its square to the square of l: (9 u F)^2. So r^2
//   - |l|^2 is off by no more than 2 r (3 u F) + (3 u F)^2 + (9 u F)^2 + 5 u r^2 of spheres that
//   are met, which is less than
constexpr float rest_rounding = 6.5F * 0x1p-24F; // times (T + 2 r) (r + 32 u T).
constexpr float far_rounding = 32 * 0x1p-24F;
//   Of one that is passed, l is longer, and is off by more; but not by so much more that it would
//   look shorter than r by more than this.
//   m is off by 10 u |m| + 4 u r / |d|, the square root by 4 u r / |d| beside what its argument is,
//   and the sum of both, and its square, by 2 u of themselves: together by less than
constexpr float t_rounding = 14 * 0x1p-24F; // times |m| + r / |d|.

/// More than what a length is rounded down by, as a part of it.
constexpr float length_rounding = 0x1p-20F;

// What is too small for a usual number loses digits, or all: squares may be off by this as well.
constexpr float square_underflow = 0x1p-110F;

/// Spheres as single precision sees them.
template <typename V>
struct Spheres {
    Vector<V> center;
    V radius;
};

/// Those from number i of a leaf on.
template <typename D>
HWY_INLINE Spheres<hn::Vec<D>> elements_at(
    const TreeSearch<SphereTree>&, D d, const float* rows, std::size_t size, std::size_t i) {
    const auto row = [&](std::size_t j) HWY_ATTR { return hn::LoadU(d, rows + j * size + i); };
    return {{row(0), row(1), row(2)}, row(3)};
}

/// Rays as they are tested against spheres.
template <typename V>
struct RaysAtSpheres {
    Vector<V> direction;
    V per_square; ///< 1 / the square of the direction's length, rounded
    V length;     ///< at least that length, and hardly more
    V t_min;
};

/// How rays meet spheres; the way leads from a ray's origin to the center.
template <typename D>
HWY_INLINE FloatMeeting<D> meeting_sphere(
    D d,
    const RaysAtSpheres<hn::Vec<D>>& rays,
    const Vector<hn::Vec<D>>& way,
    hn::Vec<D> radius,
    hn::Vec<D> limit) {
    using V = hn::Vec<D>;
    const V middle = hn::Mul(product(way, rays.direction), rays.per_square);
    const Vector<V> across = {
        hn::NegMulAdd(middle, rays.direction.x, way.x),
        hn::NegMulAdd(middle, rays.direction.y, way.y),
        hn::NegMulAdd(middle, rays.direction.z, way.z)};
    const V rest = hn::NegMulAdd(
        across.x,
        across.x,
        hn::NegMulAdd(
            across.y, across.y, hn::NegMulAdd(across.z, across.z, hn::Mul(radius, radius))));
    const V middle_size = hn::Abs(middle);
    const V far_off = hn::Mul(middle_size, rays.length);
    const V error = hn::MulAdd(
        hn::Mul(hn::Set(d, rest_rounding), hn::Add(far_off, hn::Add(radius, radius))),
        hn::MulAdd(hn::Set(d, far_rounding), far_off, radius),
        hn::Set(d, square_underflow));
    const V slack = hn::Mul(
        hn::Set(d, t_rounding),
        hn::MulAdd(radius, hn::Mul(rays.length, rays.per_square), middle_size));
    const V before = hn::Sub(middle, slack);
    const V behind = hn::Add(middle, slack);
    // Most often none is met between t_min and the limit, which is told without a root: half of the
    // chord reaches from the middle to there.
    const V most = hn::Mul(hn::Add(rest, error), rays.per_square);
    const V to_range =
        hn::Max(hn::Max(hn::Sub(before, limit), hn::Sub(rays.t_min, behind)), hn::Zero(d));
    const auto may = hn::Ge(most, hn::Mul(to_range, to_range));
    if (hn::AllFalse(d, may))
        return {may, may, middle, middle};
    // Half of the chord is between these; where it is not even met, the first is none.
    const V longest = hn::Sqrt(most);
    const V shortest =
        hn::Sqrt(hn::Mul(hn::Max(hn::Sub(rest, error), hn::Zero(d)), rays.per_square));
    const V enter_last = hn::Sub(behind, shortest);
    // The ray surely starts behind where it would enter.
    const auto inside = hn::Lt(enter_last, rays.t_min);
    const V near = hn::IfThenElse(inside, hn::Add(before, shortest), hn::Sub(before, longest));
    const V far = hn::IfThenElse(inside, hn::Add(behind, longest), enter_last);
    return {
        hn::And(may, hn::Le(near, limit)),
        hn::And(hn::Gt(rest, error), hn::And(hn::Gt(near, rays.t_min), hn::Lt(far, limit))),
        near,
        far};
}

/// All of the spheres, as bits: of none is sooner known that a ray does not pass through it.
HWY_INLINE std::uint32_t passed_through(const Spheres<hn::Vec<LeafLanes>>&, const SingleRay&) {
    return ~std::uint32_t{0};
}

/// How a ray meets the spheres.
HWY_INLINE FloatMeeting<LeafLanes>
meeting_single(const Spheres<hn::Vec<LeafLanes>>& spheres, const SingleRay& ray) {
    const LeafLanes d;
    return meeting_sphere(
        d,
        {same_for_all(d, ray.direction),
         hn::Set(d, ray.per_square),
         hn::Set(d, ray.length),
         hn::Set(d, ray.t_min)},
        difference(spheres.center, same_for_all(d, ray.origin)),
        spheres.radius,
        hn::Set(d, ray.limit));
}

/// The spheres of a leaf as they are seen from a place: the way to the center, and the radius.
struct SeenSpheres {
    std::uint32_t may = 0; ///< which of them the beam's rays may meet before its limit
    alignas(64) float rows[4][most_in_leaf];
};

/// The spheres of a leaf as they are seen from the beam's origin. Its directions lie round their
/// middle, so near that those to a sphere of the distance F pass its center, at the sphere, by no
/// more than F + r times that beside where the middle one does.
HWY_INLINE SeenSpheres seen_elements(
    const Search<SphereTree>& search, const float* rows, std::size_t size, const BeamWalk& beam) {
    const LeafLanes d;
    using V = hn::Vec<LeafLanes>;
    const float* const middle = beam.direction_middle;
    const float* const half = beam.direction_half;
    const float middle_square =
        middle[0] * middle[0] + middle[1] * middle[1] + middle[2] * middle[2];
    // Beside what is rounded.
    const float apart =
        std::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]) + 0x1p-18F;
    const float longest = std::sqrt(middle_square) * (1 + 0x1p-20F) + apart;
    SeenSpheres seen;
    std::uint32_t may = 0;
    for (std::size_t i = 0; i < size; i += hn::Lanes(d)) {
        const Spheres<V> spheres = elements_at(search, d, rows, size, i);
        const Vector<V> way = difference(spheres.center, same_for_all(d, beam.origin));
        hn::Store(way.x, d, seen.rows[0] + i);
        hn::Store(way.y, d, seen.rows[1] + i);
        hn::Store(way.z, d, seen.rows[2] + i);
        hn::Store(spheres.radius, d, seen.rows[3] + i);
        const Vector<V> moment = cross_product(way, same_for_all(d, middle));
        const V distance = hn::Sqrt(product(way, way));
        const V reach =
            hn::MulAdd(hn::Set(d, apart), hn::Add(distance, spheres.radius), spheres.radius);
        const auto in_beam = hn::Le(
            product(moment, moment),
            hn::MulAdd(
                hn::Mul(reach, reach),
                hn::Set(d, middle_square * (1 + 0x1p-18F)),
                hn::Set(d, square_underflow)));
        const auto before = hn::Le(
            hn::Sub(hn::Mul(distance, hn::Set(d, 1 - 0x1p-20F)), spheres.radius),
            hn::MulAdd(hn::Set(d, 0x1p-20F), spheres.radius, hn::Set(d, beam.limit * longest)));
        may |= bits_of(d, hn::And(in_beam, before)) << i;
    }
    seen.may = may & ((std::uint32_t{1} << size) - 1);
    return seen;
}

/// Of group rows from number i on.
HWY_INLINE RaysAtSpheres<hn::Vec<Rays>>
rays_at(const Search<SphereTree>&, const RayGroup& group, std::size_t i) {
    const Rays d;
    return {
        {hn::Load(d, group.direction[0].data() + i),
         hn::Load(d, group.direction[1].data() + i),
         hn::Load(d, group.direction[2].data() + i)},
        hn::Load(d, group.per_square.data() + i),
        hn::Load(d, group.length.data() + i),
        hn::Load(d, group.t_min.data() + i)};
}

/// How rays meet a sphere that was seen from their origin.
HWY_INLINE FloatMeeting<Rays> meeting_seen(
    Rays d,
    const RaysAtSpheres<hn::Vec<Rays>>& rays,
    const SeenSpheres& seen,
    std::size_t sphere,
    hn::Vec<Rays> limit) {
    const auto value = [&](std::size_t j) HWY_ATTR { return hn::Set(d, seen.rows[j][sphere]); };
    return meeting_sphere(d, rays, {value(0), value(1), value(2)}, value(3), limit);
}

/// Fills in what spheres ask of the rays beside what all elements do.
HWY_INLINE void add_rows(const Search<SphereTree>&, RayGroup& group) {
    const Rays d;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        const Vector<hn::Vec<Rays>> direction = {
            hn::Load(d, group.direction[0].data() + i),
            hn::Load(d, group.direction[1].data() + i),
            hn::Load(d, group.direction[2].data() + i)};
        const auto square = product(direction, direction);
        hn::Store(hn::Div(hn::Set(d, 1), square), d, group.per_square.data() + i);
        hn::Store(
            hn::Mul(hn::Sqrt(square), hn::Set(d, 1 + length_rounding)), d, group.length.data() + i);
    }
}

HWY_INLINE void add_numbers(const TreeSearch<SphereTree>&, const RayGroup& group, SingleRay* rays) {
    for (std::size_t lane = 0; lane < group_size; ++lane) {
        rays[lane].per_square = group.per_square[lane];
        rays[lane].length = group.length[lane];
    }
}

HWY_INLINE void add_numbers(const TreeSearch<SphereTree>&, SingleRay& ray) {
    const float* const direction = ray.direction;
    const float square =
        direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2];
    ray.per_square = 1 / square;
    ray.length = std::sqrt(square) * (1 + length_rounding);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
