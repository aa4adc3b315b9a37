// SPDX-License-Identifier: Apache-2.0
// What the searches of a tree of boxes share: see tree_search.cpp. Compiled once for each
// instruction set.

#if defined(VERA_ACCEL_TREE_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VERA_ACCEL_TREE_LANES_INL_H
#undef VERA_ACCEL_TREE_LANES_INL_H
#else
#define VERA_ACCEL_TREE_LANES_INL_H
#endif

#include "vera/accel/packet_query.h"
#include "vera/accel/tree_children-inl.h"
#include "vera/accel/tree_structures.h"

#include <array>
#include <cstdint>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Rays of a packet, as many as fit into a register.
using Lanes = hn::CappedTag<float, packet_size>;
/// Elements of a block that a ray is tested against together.
using Elements = hn::CappedTag<float, block_width>;

/// Which of the lanes from number first on are among the lanes of the set.
HWY_INLINE hn::Mask<Lanes> in_lanes(Lanes d, LaneMask set, std::size_t first) {
    const std::uint8_t bytes[8] = {
        static_cast<std::uint8_t>(set >> first), static_cast<std::uint8_t>(set >> first >> 8U)};
    return hn::LoadMaskBits(d, bytes);
}

/// Whether any of a register's lanes from number first on is in the set.
HWY_INLINE bool any_from(Lanes, LaneMask set, std::size_t first) {
    constexpr std::size_t width = hn::MaxLanes(Lanes());
    return (set >> first & ((LaneMask{1} << width) - 1)) != 0;
}

inline LaneMask bit_of(std::size_t lane) {
    return LaneMask{1} << lane;
}

inline const GeometryTree& tree_of(const Frame& frame) {
    return static_cast<const GeometryTree&>(*frame.local);
}

/// A packet's rays as boxes are tested against them. The slack is in the offsets: it moves the
/// planes of a box outward.
struct BoxRays {
    Frame::Row inverse[3];
    Frame::Row near_offset[3];
    Frame::Row far_offset[3];
    LaneMask backward[3]; ///< the lanes whose rays run backward along the axis
};

HWY_INLINE void fill_box_rays(const Frame& frame, BoxRays& rays) {
    const Lanes d;
    const auto slack = hn::Set(d, frame.box_slack);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        LaneMask backward = 0;
        for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d)) {
            const auto inverse = hn::LoadU(d, frame.inverse[axis].data() + i);
            const auto origin = hn::LoadU(d, frame.origin[axis].data() + i);
            const auto outward = hn::CopySign(slack, inverse);
            hn::StoreU(inverse, d, rays.inverse[axis].data() + i);
            hn::StoreU(
                hn::Neg(hn::Mul(hn::Add(origin, outward), inverse)),
                d,
                rays.near_offset[axis].data() + i);
            hn::StoreU(
                hn::Neg(hn::Mul(hn::Sub(origin, outward), inverse)),
                d,
                rays.far_offset[axis].data() + i);
            backward |= bits_of(d, hn::Lt(inverse, hn::Zero(d))) << i;
        }
        rays.backward[axis] = backward;
    }
}

/// The octant of a lane's ray: see octant_count.
inline std::size_t octant_of(const BoxRays& rays, std::size_t lane) {
    return (rays.backward[0] >> lane & 1U) | (rays.backward[1] >> lane & 1U) << 1U
        | (rays.backward[2] >> lane & 1U) << 2U;
}

/// Whether the lanes' rays are of one octant.
inline bool one_octant(const BoxRays& rays, LaneMask lanes) {
    for (const LaneMask backward : rays.backward)
        if ((backward & lanes) != 0 && (~backward & lanes) != 0)
            return false;
    return true;
}

/// In which order the rays of the query come to the children of a node.
inline std::size_t order_of(const PacketQuery& query, std::size_t octant) {
    return query.purpose == Purpose::any ? any_order : octant;
}

HWY_INLINE void fetch(const GeometryTree& tree, const TreeChild& child) {
    fetch(tree.nodes.data(), tree.rows.data(), sizeof(BlockRow), child);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#endif
