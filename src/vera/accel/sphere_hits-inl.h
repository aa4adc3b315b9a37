// SPDX-License-Identifier: Apache-2.0
// What the rays of a search of spheres have met: see float_search-inl.h. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_SPHERE_HITS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_SPHERE_HITS_INL_H
#undef VERA_ACCEL_SPHERE_HITS_INL_H
#else
#define VERA_ACCEL_SPHERE_HITS_INL_H
#endif

#include "vera/accel/float_hits-inl.h"
#include "vera/accel/float_leaves-inl.h"
#include "vera/accel/float_workspace-inl.h"
#include "vera/accel/sphere_tree.h"
#include "vera/base/check.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// A sphere's center and radius for each lane.
using GroupSpheres = std::array<GroupRow<float>, 4>;

/// The t of first_covered() of sphere_crossings(), to the bit: what is multiplied here by a power
/// of two is divided by it. No number for lanes that do not meet their spheres.
HWY_INLINE void
cross_spheres(const RayGroup& group, const GroupSpheres& spheres, GroupRow<float>& t) {
    const DecidingLanes d;
    const hn::Rebind<float, DecidingLanes> f;
    using V = hn::Vec<DecidingLanes>;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        const auto row = [&](const GroupRow<float>& values)
                             HWY_ATTR { return hn::PromoteTo(d, hn::Load(f, values.data() + i)); };
        const auto vector = [&](const GroupRow<float>* rows) HWY_ATTR {
            return Vector<V>{row(rows[0]), row(rows[1]), row(rows[2])};
        };
        const Vector<V> direction = vector(group.direction);
        const Vector<V> way = difference(vector(spheres.data()), vector(group.origin));
        const V radius = row(spheres[3]);
        const V per_square = hn::Div(hn::Set(d, 1), dot_in_order(direction, direction, d));
        const V middle = hn::Mul(dot_in_order(way, direction, d), per_square);
        const Vector<V> across = difference(
            way,
            {hn::Mul(middle, direction.x),
             hn::Mul(middle, direction.y),
             hn::Mul(middle, direction.z)});
        const V rest = hn::Sub(hn::Mul(radius, radius), dot_in_order(across, across, d));
        const V half = hn::Sqrt(hn::Mul(rest, per_square));
        const V enter = hn::Sub(middle, half);
        const V first =
            hn::IfThenElse(hn::Ge(enter, row(group.t_min)), enter, hn::Add(middle, half));
        hn::Store(
            hn::Add(hn::DemoteTo(f, hn::Mul(first, row(group.per_t_scale))), hn::Zero(f)),
            f,
            t.data() + i);
    }
}

/// The hits of what was surely met, and nothing elsewhere.
HWY_INLINE void
take_sure_hits(const Search<SphereTree>& search, const RayGroup& group, SphereHit* hits) {
    const GroupMask met = lanes_with_place(group);
    std::fill(hits, hits + group.rays.size(), SphereHit{});
    if (met == 0)
        return;
    GroupSpheres spheres = {};
    for (GroupMask rest = met; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const std::uint32_t place = group.place[lane];
        const std::size_t size = place >> 8U;
        const float* const numbers = numbers_at(search.tree, group.leaf[lane], place);
        for (std::size_t row = 0; row < spheres.size(); ++row)
            spheres[row][lane] = numbers[row * size];
        hits[lane].sphere = std::bit_cast<std::uint32_t>(numbers[4 * size]);
    }
    GroupRow<float> t;
    cross_spheres(group, spheres, t);
    for (GroupMask rest = met; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        hits[lane].t = t[lane];
    }
}

/// Spheres are not ruled out any sooner than they are decided.
HWY_INLINE bool
ruled_out(const TreeSearch<SphereTree>&, const SingleRay&, std::uint32_t, std::uint32_t) {
    return false;
}

/// The same for a ray that was followed alone, and surely meets something.
HWY_INLINE SphereHit
sure_hit(const TreeSearch<SphereTree>& search, const SingleRay& ray, float per_t_scale) {
    const std::size_t size = ray.place >> 8U;
    const float* const numbers = numbers_at(search.tree, ray.leaf, ray.place);
    const SphereRay scaled(
        {{ray.origin[0], ray.origin[1], ray.origin[2]},
         ray.t_min,
         {ray.direction[0], ray.direction[1], ray.direction[2]}});
    const auto crossings =
        sphere_crossings(scaled, {numbers[0], numbers[size], numbers[2 * size], numbers[3 * size]});
    VERA_CHECK(crossings.has_value());
    const double t = crossings->enter >= scaled.t_min ? crossings->enter : crossings->leave;
    return sphere_hit(
        t * static_cast<double>(per_t_scale), std::bit_cast<std::uint32_t>(numbers[4 * size]));
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
