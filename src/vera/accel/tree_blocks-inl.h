// SPDX-License-Identifier: Apache-2.0
// What rays do at the blocks of a tree of boxes: see tree_search.cpp. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_TREE_BLOCKS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_TREE_BLOCKS_INL_H
#undef VERA_ACCEL_TREE_BLOCKS_INL_H
#else
#define VERA_ACCEL_TREE_BLOCKS_INL_H
#endif

#include "vera/accel/element_tests-inl.h"
#include "vera/accel/packet_query.h"
#include "vera/accel/tree_lanes-inl.h"
#include "vera/accel/tree_structures.h"

#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

void search_tree(PacketQuery& query, Frame& frame, LaneMask lanes);

inline ElementRecord::Kind element_kind(const TreeChild& block) {
    return static_cast<ElementRecord::Kind>(block.kind());
}

inline std::uint32_t element_number(const BlockRow* rows, std::size_t i) {
    return std::bit_cast<std::uint32_t>(rows[0][i]);
}

template <typename D>
HWY_INLINE TestedRays<D> one_ray(D d, const Frame& frame, std::size_t lane) {
    return {
        {hn::Set(d, frame.origin[0][lane]),
         hn::Set(d, frame.origin[1][lane]),
         hn::Set(d, frame.origin[2][lane])},
        {hn::Set(d, frame.direction[0][lane]),
         hn::Set(d, frame.direction[1][lane]),
         hn::Set(d, frame.direction[2][lane])},
        {hn::Set(d, frame.inverse[0][lane]),
         hn::Set(d, frame.inverse[1][lane]),
         hn::Set(d, frame.inverse[2][lane])},
        hn::Set(d, frame.limit[lane]),
        frame.slack,
        frame.double_slack};
}

template <typename D>
HWY_INLINE TestedRays<D> rays_from(D d, const Frame& frame, std::size_t lane) {
    return {
        {hn::LoadU(d, frame.origin[0].data() + lane),
         hn::LoadU(d, frame.origin[1].data() + lane),
         hn::LoadU(d, frame.origin[2].data() + lane)},
        {hn::LoadU(d, frame.direction[0].data() + lane),
         hn::LoadU(d, frame.direction[1].data() + lane),
         hn::LoadU(d, frame.direction[2].data() + lane)},
        {hn::LoadU(d, frame.inverse[0].data() + lane),
         hn::LoadU(d, frame.inverse[1].data() + lane),
         hn::LoadU(d, frame.inverse[2].data() + lane)},
        hn::LoadU(d, frame.limit.data() + lane),
        frame.slack,
        frame.double_slack};
}

/// How a packet's rays meet an element, or one ray those of a block.
template <std::size_t Size>
struct MetRows {
    std::uint32_t may = 0;
    std::uint32_t sure = 0;
    alignas(64) std::array<float, Size> near; ///< of those that may
    alignas(64) std::array<float, Size> far;  ///< of those that surely do
};

/// Fills in what the places from number first on say.
template <std::size_t Size, typename D>
HWY_INLINE void
take_meeting(D d, const Meeting<D>& meeting, std::size_t first, MetRows<Size>& met) {
    met.may |= bits_of(d, meeting.may) << first;
    met.sure |= bits_of(d, meeting.sure) << first;
    hn::StoreU(meeting.near, d, met.near.data() + first);
    hn::StoreU(meeting.far, d, met.far.data() + first);
}

constexpr std::size_t triangle_values = value_count(ElementRecord::Kind::triangle);
constexpr std::size_t most_values = value_count(ElementRecord::Kind::quadrangle);

/// The triangles of a block, number by number.
struct BlockTriangles {
    static constexpr std::size_t count = sizeof(Face<float>) / sizeof(float);
    alignas(16) float rows[count][block_width];
};

HWY_INLINE BlockTriangles block_triangles(const BlockRow* rows) {
    const Elements d;
    BlockTriangles result;
    for (std::size_t i = 0; i < block_width; i += hn::Lanes(d)) {
        hn::Vec<Elements> values[triangle_values];
        for (std::size_t j = 0; j < triangle_values; ++j)
            values[j] = hn::LoadU(d, rows[1 + j].data() + i);
        const auto face = face_of(d, values);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            hn::Store(face.corner[axis], d, result.rows[axis] + i);
            hn::Store(face.e[axis], d, result.rows[3 + axis] + i);
            hn::Store(face.f[axis], d, result.rows[6 + axis] + i);
            hn::Store(face.normal[axis], d, result.rows[9 + axis] + i);
        }
        hn::Store(face.largest, d, result.rows[12] + i);
        hn::Store(face.normal_error, d, result.rows[13] + i);
    }
    return result;
}

/// How the lanes' rays meet triangle i.
HWY_INLINE void meet_triangle(
    const BlockTriangles& triangles,
    std::size_t i,
    const Frame& frame,
    LaneMask lanes,
    MetRows<packet_size>& met) {
    const Lanes d;
    const auto row = [&](std::size_t j) HWY_ATTR { return hn::Set(d, triangles.rows[j][i]); };
    const Face<hn::Vec<Lanes>> face = {
        {row(0), row(1), row(2)},
        {row(3), row(4), row(5)},
        {row(6), row(7), row(8)},
        {row(9), row(10), row(11)},
        row(12),
        row(13)};
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d)) {
        if (!any_from(d, lanes, lane))
            continue;
        const auto rays = rays_from(d, frame, lane);
        take_meeting(d, meeting_face(d, rays, triangle_place(d, rays, face)), lane, met);
    }
}

/// The values of element i of a block, each in all lanes; Count of them, or as many as the kind
/// has.
template <std::size_t Count, typename D>
HWY_INLINE void values_of_one(
    D d, const BlockRow* rows, std::size_t i, std::size_t count, hn::Vec<D> (&values)[Count]) {
    for (std::size_t j = 0; j < Count; ++j)
        values[j] = hn::Set(d, j < count ? rows[1 + j][i] : 0);
}

/// How the lanes' rays meet element i of a block of the kind.
template <ElementRecord::Kind OfKind>
HWY_INLINE void meet_element(
    const BlockRow* rows,
    std::size_t i,
    const Frame& frame,
    LaneMask lanes,
    MetRows<packet_size>& met) {
    const Lanes d;
    hn::Vec<Lanes> values[value_count(OfKind)];
    for (std::size_t j = 0; j < value_count(OfKind); ++j)
        values[j] = hn::Set(d, rows[1 + j][i]);
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d)) {
        if (!any_from(d, lanes, lane))
            continue;
        const auto rays = rays_from(d, frame, lane);
        // Most are passed by.
        if ((bits_of(d, may_come_near(d, rays, OfKind, values)) & lanes >> lane) != 0)
            take_meeting(d, meeting(d, rays, OfKind, values), lane, met);
    }
}

/// How one lane's ray meets the present elements of a block of the kind.
template <ElementRecord::Kind OfKind>
HWY_NOINLINE void meet_block(
    const BlockRow* rows,
    std::uint32_t present,
    const Frame& frame,
    std::size_t lane,
    MetRows<block_width>& met) {
    const Elements d;
    const auto ray = one_ray(d, frame, lane);
    for (std::size_t i = 0; i < block_width; i += hn::Lanes(d)) {
        hn::Vec<Elements> values[value_count(OfKind)];
        for (std::size_t j = 0; j < value_count(OfKind); ++j)
            values[j] = hn::LoadU(d, rows[1 + j].data() + i);
        if ((bits_of(d, may_come_near(d, ray, OfKind, values)) & present >> i) != 0)
            take_meeting(d, meeting(d, ray, OfKind, values), i, met);
    }
}

/// Of a call is asked whether its box is met.
constexpr ElementRecord::Kind tested_as(ElementRecord::Kind kind) {
    return kind == ElementRecord::Kind::call ? ElementRecord::Kind::box : kind;
}

/// Calls action(the kind as a constant).
template <typename Action>
HWY_INLINE void for_kind(ElementRecord::Kind kind, const Action& action) {
    using Kind = ElementRecord::Kind;
    switch (kind) {
    case Kind::sphere:
        return action(std::integral_constant<Kind, Kind::sphere>());
    case Kind::triangle:
        return action(std::integral_constant<Kind, Kind::triangle>());
    case Kind::quadrangle:
        return action(std::integral_constant<Kind, Kind::quadrangle>());
    case Kind::mantle:
        return action(std::integral_constant<Kind, Kind::mantle>());
    case Kind::cylinder:
        return action(std::integral_constant<Kind, Kind::cylinder>());
    case Kind::box:
        return action(std::integral_constant<Kind, Kind::box>());
    case Kind::call:
        return action(std::integral_constant<Kind, Kind::call>());
    }
}

/// The lanes whose rays surely do not meet element i of the block again, if they start on it.
inline HWY_NOINLINE LaneMask
leaving_element(const BlockRow* rows, ElementRecord::Kind kind, std::size_t i, const Frame& frame) {
    const Lanes d;
    hn::Vec<Lanes> values[most_values];
    values_of_one(d, rows, i, value_count(kind), values);
    LaneMask leaving = 0;
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d))
        leaving |= bits_of(d, surely_leaves(d, rays_from(d, frame, lane), kind, values)) << lane;
    return leaving;
}

/// The same for one lane.
inline HWY_NOINLINE bool leaves_element(
    const BlockRow* rows,
    ElementRecord::Kind kind,
    std::size_t i,
    const Frame& frame,
    std::size_t lane) {
    const Elements d;
    hn::Vec<Elements> values[most_values];
    values_of_one(d, rows, i, value_count(kind), values);
    return (bits_of(d, surely_leaves(d, one_ray(d, frame, lane), kind, values)) & 1U) != 0;
}

/// The lanes whose rays start on the element.
HWY_INLINE LaneMask starting_on(const Frame& frame, std::uint32_t element) {
    const hn::RebindToUnsigned<Lanes> d;
    LaneMask starting = 0;
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d))
        starting |=
            bits_of(d, hn::Eq(hn::LoadU(d, frame.start_element.data() + lane), hn::Set(d, element)))
            << lane;
    return starting;
}

/// Tests the lanes' rays against what the call holds.
inline HWY_NOINLINE void
visit_call(PacketQuery& query, Frame& frame, std::uint32_t element, LaneMask lanes) {
    if (lanes == 0)
        return;
    decide(query, frame, lanes);
    refresh_limits(query, frame, lanes);
    lanes &= query.active;
    if (too_deep(frame))
        return search_plainly(query, frame, element, lanes);
    const LaneMask entering = enter_call(query, frame, element, lanes);
    if (entering == 0)
        return;
    search_tree(query, query.frames[frame.depth + std::size_t{1}], entering);
    refresh_limits(query, frame, lanes);
}

/// Nothing counts any more behind far and the margin, for the lanes.
HWY_INLINE void
lower_limits(Frame& frame, LaneMask lanes, const std::array<float, packet_size>& far) {
    const Lanes d;
    const auto margin = hn::Set(d, margin_behind(frame));
    for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d)) {
        const auto limit = hn::LoadU(d, frame.limit.data() + i);
        const auto lower = hn::Min(limit, hn::Add(hn::LoadU(d, far.data() + i), margin));
        hn::StoreU(hn::IfThenElse(in_lanes(d, lanes, i), lower, limit), d, frame.limit.data() + i);
    }
}

HWY_INLINE void copy(const std::array<float, packet_size>& from, FloatRow& to) {
    const Lanes d;
    for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d))
        hn::StoreU(hn::LoadU(d, from.data() + i), d, to.data() + i);
}

/// Takes what is known of how the lanes' rays meet element i, which some may and which is not a
/// call.
inline HWY_NOINLINE void take_met(
    PacketQuery& query,
    Frame& frame,
    const BlockRow* rows,
    ElementRecord::Kind kind,
    std::size_t i,
    LaneMask lanes,
    const MetRows<packet_size>& met) {
    LaneMask may = met.may & lanes;
    const std::uint32_t element = element_number(rows, i);
    const LaneMask starting = starting_on(frame, element);
    if ((may & starting) != 0)
        may &= ~(starting & leaving_element(rows, kind, i, frame));
    const LaneMask sure = met.sure & may & ~starting;
    if (query.purpose == Purpose::nearest) {
        lower_limits(frame, sure, met.far);
    } else if (sure != 0 && ends_search(query, frame, element)) {
        block(query, frame, sure);
        may &= ~sure;
    }
    if (may == 0)
        return;
    if (!may_wait(kind))
        return test_exactly(query, frame, element, may);
    make_room_for_candidate(query, frame);
    copy(met.near, frame.candidates.near[frame.candidates.count]);
    add_candidate(frame, kind, element, may);
}

/// What the lanes' rays do at the elements of a block of the kind: meet(i, lanes, met) tells how
/// they meet element i.
template <ElementRecord::Kind OfKind, typename Meet>
HWY_INLINE void visit_elements(
    PacketQuery& query,
    Frame& frame,
    const BlockRow* rows,
    std::size_t count,
    LaneMask lanes,
    const Meet& meet) {
    for (std::size_t i = 0; i < count && lanes != 0; ++i) {
        MetRows<packet_size> met;
        meet(i, lanes, met);
        if constexpr (OfKind == ElementRecord::Kind::call) {
            visit_call(query, frame, element_number(rows, i), met.may & lanes);
        } else {
            query.counts.tests += static_cast<std::uint64_t>(std::popcount(lanes));
            if ((met.may & lanes) != 0)
                take_met(query, frame, rows, OfKind, i, lanes, met);
        }
        lanes &= query.active;
    }
}

template <ElementRecord::Kind OfKind>
HWY_NOINLINE void visit_block_of(
    PacketQuery& query, Frame& frame, const BlockRow* rows, std::size_t count, LaneMask lanes) {
    if constexpr (OfKind == ElementRecord::Kind::triangle) {
        const BlockTriangles triangles = block_triangles(rows);
        visit_elements<OfKind>(
            query,
            frame,
            rows,
            count,
            lanes,
            [&](std::size_t i, LaneMask those, MetRows<packet_size>& met)
                HWY_ATTR { meet_triangle(triangles, i, frame, those, met); });
    } else {
        visit_elements<OfKind>(
            query,
            frame,
            rows,
            count,
            lanes,
            [&](std::size_t i, LaneMask those, MetRows<packet_size>& met)
                HWY_ATTR { meet_element<tested_as(OfKind)>(rows, i, frame, those, met); });
    }
}

/// What the lanes' rays do at a block.
HWY_INLINE void
visit_block(PacketQuery& query, Frame& frame, const TreeChild& child, LaneMask lanes) {
    const BlockRow* const rows = tree_of(frame).rows.data() + child.first();
    for_kind(element_kind(child), [&](auto constant) HWY_ATTR {
        visit_block_of<constant.value>(query, frame, rows, child.count(), lanes);
    });
}

/// Takes what is known of how one lane's ray meets element i, which it may and which is not a call.
inline void take_met_alone(
    PacketQuery& query,
    Frame& frame,
    const BlockRow* rows,
    ElementRecord::Kind kind,
    std::size_t i,
    std::size_t lane,
    const MetRows<block_width>& met) {
    const std::uint32_t element = element_number(rows, i);
    if (element == frame.start_element[lane]) {
        if (leaves_element(rows, kind, i, frame, lane))
            return;
    } else if ((met.sure >> i & 1U) != 0) {
        if (query.purpose == Purpose::nearest)
            frame.limit[lane] = std::min(frame.limit[lane], met.far[i] + margin_behind(frame));
        else if (ends_search(query, frame, element))
            return block(query, frame, bit_of(lane));
    }
    if (!may_wait(kind))
        return test_exactly(query, frame, element, bit_of(lane));
    make_room_for_candidate(query, frame);
    frame.candidates.near[frame.candidates.count][lane] = met.near[i];
    add_candidate(frame, kind, element, bit_of(lane));
}

/// What one lane's ray does at a block.
inline void
visit_block_alone(PacketQuery& query, Frame& frame, const TreeChild& child, std::size_t lane) {
    const BlockRow* const rows = tree_of(frame).rows.data() + child.first();
    const ElementRecord::Kind kind = element_kind(child);
    const std::uint32_t present = (std::uint32_t{1} << child.count()) - 1;
    MetRows<block_width> met;
    for_kind(kind, [&](auto constant) HWY_ATTR {
        meet_block<tested_as(constant.value)>(rows, present, frame, lane, met);
    });
    if (kind != ElementRecord::Kind::call)
        query.counts.tests += child.count();
    for (std::uint32_t may = met.may & present; may != 0; may &= may - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(may));
        if (kind == ElementRecord::Kind::call)
            visit_call(query, frame, element_number(rows, i), bit_of(lane));
        else
            take_met_alone(query, frame, rows, kind, i, lane, met);
        if ((query.active & bit_of(lane)) == 0)
            return;
    }
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
