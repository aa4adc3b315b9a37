// SPDX-License-Identifier: Apache-2.0
// What the rays of a search of a mesh have met: see mesh_search.cpp. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_MESH_HITS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_MESH_HITS_INL_H
#undef VERA_ACCEL_MESH_HITS_INL_H
#else
#define VERA_ACCEL_MESH_HITS_INL_H
#endif

#include "vera/accel/mesh_crossing.h"
#include "vera/accel/mesh_leaves-inl.h"
#include "vera/accel/mesh_workspace-inl.h"

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

/// As many as one byte has mask bits.
using Doubles = hn::CappedTag<double, 8>;

template <typename D>
HWY_INLINE hn::Vec<D> dot_in_order(const Vector<hn::Vec<D>>& a, const Vector<hn::Vec<D>>& b, D) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}

template <typename D>
HWY_INLINE Vector<hn::Vec<D>>
cross_in_order(const Vector<hn::Vec<D>>& a, const Vector<hn::Vec<D>>& b, D) {
    return {
        hn::Sub(hn::Mul(a.y, b.z), hn::Mul(a.z, b.y)),
        hn::Sub(hn::Mul(a.z, b.x), hn::Mul(a.x, b.z)),
        hn::Sub(hn::Mul(a.x, b.y), hn::Mul(a.y, b.x))};
}

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
    const Doubles d;
    const MeshHit none;
    const hn::Rebind<float, Doubles> f;
    using V = hn::Vec<Doubles>;
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

/// The lanes that surely meet something.
HWY_INLINE GroupMask lanes_with_place(const RayGroup& group) {
    const hn::RebindToUnsigned<Rays> d;
    GroupMask lanes = 0;
    for (std::size_t i = 0; i < group_size; i += hn::Lanes(d))
        lanes |= bits_of(d, hn::Ne(hn::Load(d, group.place.data() + i), hn::Set(d, no_place))) << i;
    return lanes;
}

/// The hits of what was surely met, and nothing elsewhere.
HWY_INLINE void take_sure_hits(const MeshTree& tree, const RayGroup& group, MeshHit* hits) {
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
        const float* const rows =
            tree.leaves.data() + mesh_leaf_rows * group.leaf[lane] + (place & 0xffU);
        corners[0][0][lane] = rows[0];
        corners[0][1][lane] = rows[size];
        corners[0][2][lane] = rows[2 * size];
        corners[1][0][lane] = rows[3 * size];
        corners[1][1][lane] = rows[4 * size];
        corners[1][2][lane] = rows[5 * size];
        corners[2][0][lane] = rows[6 * size];
        corners[2][1][lane] = rows[7 * size];
        corners[2][2][lane] = rows[8 * size];
        triangles[lane] = rows[mesh_number_row * size];
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

/// The hit of a ray that may meet more than it surely meets, if it surely meets anything.
HWY_NOINLINE MeshHit decide_doubtful(
    const Search& search,
    const MeshRay& ray,
    std::uint32_t leaf,
    std::uint32_t place,
    std::uint32_t last_doubtful) {
    const PreparedRay prepared = prepared_mesh_ray(ray);
    NearestCrossing nearest;
    const auto consider = [&](std::uint32_t triangle) {
        if (const auto crossing = crossing_with(search.tree.mesh, prepared, triangle))
            nearest.add(*crossing, triangle);
    };
    if (place != no_place)
        consider(triangle_at(search.tree, leaf, place));
    for (std::uint32_t i = last_doubtful; i != no_doubtful; i = search.space.doubtful[i].before)
        consider(search.space.doubtful[i].triangle);
    return nearest.hit();
}

/// The lanes of rays that single precision cannot follow.
HWY_INLINE GroupMask not_followed(const RayGroup& group) {
    return ((GroupMask{1} << group.rays.size()) - 1) & ~group.followed;
}

/// The hits of the groups that were searched for.
HWY_INLINE void take_hits(const Search& search, std::size_t groups, std::span<MeshHit> hits) {
    const Workspace& space = search.space;
    for (std::size_t i = 0; i < groups; ++i) {
        const RayGroup& group = space.groups[i];
        MeshHit* const of_group = hits.data() + i * group_size;
        take_sure_hits(search.tree, group, of_group);
        for (GroupMask rest = group.in_doubt; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            of_group[lane] = decide_doubtful(
                search,
                group.rays[lane],
                group.leaf[lane],
                group.place[lane],
                group.doubtful[lane]);
        }
        for (GroupMask rest = not_followed(group); rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            of_group[lane] = nearest_plainly(search.tree, group.rays[lane]);
        }
    }
}

HWY_INLINE void take_met(const Search& search, std::size_t groups, std::span<std::uint8_t> met) {
    for (std::size_t i = 0; i < groups; ++i) {
        const RayGroup& group = search.space.groups[i];
        std::uint8_t* const of_group = met.data() + i * group_size;
        for (std::size_t lane = 0; lane < group.rays.size(); ++lane)
            of_group[lane] = static_cast<std::uint8_t>(group.met >> lane & 1U);
        for (GroupMask rest = not_followed(group); rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            of_group[lane] = meets_any_plainly(search.tree, group.rays[lane]) ? 1 : 0;
        }
    }
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
