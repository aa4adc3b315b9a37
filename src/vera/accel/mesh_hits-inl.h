// SPDX-License-Identifier: Apache-2.0
// What the rays of a search of a mesh have met: see float_search-inl.h. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_MESH_HITS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_MESH_HITS_INL_H
#undef VERA_ACCEL_MESH_HITS_INL_H
#else
#define VERA_ACCEL_MESH_HITS_INL_H
#endif

#include "vera/accel/float_hits-inl.h"
#include "vera/accel/float_leaves-inl.h"
#include "vera/accel/float_workspace-inl.h"
#include "vera/accel/mesh_crossing.h"
#include "vera/accel/mesh_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The corners of a triangle for each lane.
using CornerRows = std::array<std::array<GroupRow<float>, 3>, 3>;

struct HitRows {
    GroupRow<float> t;
    GroupRow<float> u;
    GroupRow<float> v;
};

/// mesh_hit() of plane_crossing(), to the bit: what is multiplied here by a power of two is divided
/// by it. That of a MeshHit that is none for lanes that do not meet their triangles.
HWY_INLINE void
cross_planes(const RayGroup& group, const CornerRows& corners, GroupMask met, HitRows& hits) {
    const DecidingLanes d;
    const MeshHit none;
    const hn::Rebind<float, DecidingLanes> f;
    using V = hn::Vec<DecidingLanes>;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        const auto row = [&](const GroupRow<float>& values)
                             HWY_ATTR { return hn::PromoteTo(d, hn::Load(f, values.data() + i)); };
        const auto vector = [&](const auto& rows) HWY_ATTR {
            return Vector<V>{row(rows[0]), row(rows[1]), row(rows[2])};
        };
        const Vector<V> a = vector(corners[0]);
        const Vector<V> direction = vector(group.direction);
        const Vector<V> e = difference(vector(corners[1]), a);
        const Vector<V> g = difference(vector(corners[2]), a);
        const Vector<V> to_a = difference(a, vector(group.origin));
        const Vector<V> normal = cross_in_order(e, g, d);
        const Vector<V> moment = cross_in_order(to_a, direction, d);
        const V one = hn::Set(d, 1);
        const V per_speed = hn::Div(one, dot_in_order(normal, direction, d));
        const std::uint8_t bits[8] = {static_cast<std::uint8_t>(met >> i)};
        const auto counts = hn::LoadMaskBits(f, bits);
        const auto part = [&](V value) HWY_ATTR {
            return hn::IfThenElseZero(
                counts,
                hn::DemoteTo(f, hn::Add(hn::Min(hn::Max(value, hn::Zero(d)), one), hn::Zero(d))));
        };
        const V t = hn::Mul(dot_in_order(normal, to_a, d), per_speed);
        hn::Store(
            hn::IfThenElse(
                counts,
                hn::Add(hn::DemoteTo(f, hn::Mul(t, row(group.per_t_scale))), hn::Zero(f)),
                hn::Set(f, none.t)),
            f,
            hits.t.data() + i);
        hn::Store(part(hn::Mul(dot_in_order(moment, g, d), per_speed)), f, hits.u.data() + i);
        hn::Store(
            part(hn::Neg(hn::Mul(dot_in_order(moment, e, d), per_speed))), f, hits.v.data() + i);
    }
}

/// The hits of what was surely met, and nothing elsewhere.
HWY_INLINE void
take_sure_hits(const Search<MeshTree>& search, const RayGroup& group, MeshHit* hits) {
    const Rays d;
    const GroupMask met = lanes_with_place(group);
    if (met == 0) {
        std::fill(hits, hits + group.rays.size(), MeshHit{});
        return;
    }
    CornerRows corners;
    GroupRow<float> triangles; // the bits of their numbers
    for (GroupMask rest = met; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        const std::uint32_t place = group.place[lane];
        const std::size_t size = place >> 8U;
        const float* const rows = numbers_at(search.tree, group.leaf[lane], place);
        corners[0][0][lane] = rows[0];
        corners[0][1][lane] = rows[size];
        corners[0][2][lane] = rows[2 * size];
        corners[1][0][lane] = rows[3 * size];
        corners[1][1][lane] = rows[4 * size];
        corners[1][2][lane] = rows[5 * size];
        corners[2][0][lane] = rows[6 * size];
        corners[2][1][lane] = rows[7 * size];
        corners[2][2][lane] = rows[8 * size];
        triangles[lane] = rows[9 * size];
    }
    HitRows found;
    cross_planes(group, corners, met, found);
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d)) {
        const auto numbers = hn::Load(d, triangles.data() + i);
        const auto none = hn::BitCast(d, hn::Set(hn::RebindToUnsigned<Rays>(), no_triangle));
        hn::Store(hn::IfThenElse(in_group(d, met, i), numbers, none), d, triangles.data() + i);
    }
    if (group.rays.size() < group_size) {
        for (std::size_t lane = 0; lane < group.rays.size(); ++lane)
            hits[lane] = {
                found.t[lane],
                std::bit_cast<std::uint32_t>(triangles[lane]),
                found.u[lane],
                found.v[lane]};
        return;
    }
    static_assert(sizeof(MeshHit) == 4 * sizeof(float));
    for (std::size_t lane = 0; lane < group_size; lane += 4)
        transpose(
            {&found.t[lane], &triangles[lane], &found.u[lane], &found.v[lane]},
            {&hits[lane].t, &hits[lane + 1].t, &hits[lane + 2].t, &hits[lane + 3].t});
}

/// The corners of a triangle as they stand in its leaf.
inline std::array<Vec3, 3>
corners_in_leaf(const MeshTree& tree, std::uint32_t leaf, std::uint32_t place) {
    const std::size_t size = place >> 8U;
    const float* const rows = numbers_at(tree, leaf, place);
    const auto corner = [&](std::size_t number) {
        return in_double(
            {rows[3 * number * size],
             rows[(3 * number + 1) * size],
             rows[(3 * number + 2) * size]});
    };
    return {corner(0), corner(1), corner(2)};
}

/// Whether double precision at once rules out that a ray, which was followed alone, meets the
/// triangle: as mesh_crossing() begins, to the bit. What is multiplied here by powers of two is so
/// on both sides of each comparison.
HWY_INLINE bool ruled_out(
    const TreeSearch<MeshTree>& search,
    const SingleRay& ray,
    std::uint32_t leaf,
    std::uint32_t place) {
    const auto [a, b, c] = corners_in_leaf(search.tree, leaf, place);
    const Vec3 origin = in_double({ray.origin[0], ray.origin[1], ray.origin[2]});
    const Vec3 direction = in_double({ray.direction[0], ray.direction[1], ray.direction[2]});
    const double t = plane_crossing(origin, direction, a, b, c).t;
    return is_well_known(direction, a, b, c)
        && !(static_cast<double>(ray.t_min) <= t && t <= static_cast<double>(ray.limit));
}

/// The same for a ray that was followed alone, and surely meets something.
HWY_INLINE MeshHit
sure_hit(const TreeSearch<MeshTree>& search, const SingleRay& ray, float per_t_scale) {
    const auto [a, b, c] = corners_in_leaf(search.tree, ray.leaf, ray.place);
    // As cross_planes() does it.
    MeshCrossing crossing = plane_crossing(
        in_double({ray.origin[0], ray.origin[1], ray.origin[2]}),
        in_double({ray.direction[0], ray.direction[1], ray.direction[2]}),
        a,
        b,
        c);
    crossing.t *= static_cast<double>(per_t_scale);
    return mesh_hit(crossing, element_at(search.tree, ray.leaf, ray.place));
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
