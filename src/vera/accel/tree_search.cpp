// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/packet_query.h"
#include "vera/accel/tree_structures.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/tree_search.cpp"
#include <hwy/foreach_target.h>
// Behind the line above, which includes this file once for each instruction set.
#include "vera/accel/element_tests-inl.h"

#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Rays of a packet, as many as fit into a register.
using Lanes = hn::CappedTag<float, packet_size>;
/// Children of a node that a ray is tested against together.
using Children = hn::CappedTag<float, tree_width>;
/// Elements of a block that a ray is tested against together.
using Elements = hn::CappedTag<float, block_width>;

template <typename D>
HWY_INLINE std::uint32_t bits_of(D d, hn::Mask<D> mask) {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(d, mask, bytes);
    const std::uint32_t all = bytes[0] | std::uint32_t{bytes[1]} << 8U;
    return all & ((std::uint32_t{1} << hn::Lanes(d)) - 1);
}

/// Which of the lanes from number first on are among the lanes of the set.
HWY_INLINE hn::Mask<Lanes> in_lanes(Lanes d, LaneMask set, std::size_t first) {
    const std::uint8_t bytes[8] = {
        static_cast<std::uint8_t>(set >> first), static_cast<std::uint8_t>(set >> first >> 8U)};
    return hn::LoadMaskBits(d, bytes);
}

inline const GeometryTree& tree_of(const Frame& frame) {
    return static_cast<const GeometryTree&>(*frame.local);
}

constexpr TreeChild root = TreeChild::of(0, ChildKind::node, 0);

void search_tree(PacketQuery& query, Frame& frame, LaneMask lanes);

void visit_call(PacketQuery& query, Frame& frame, std::uint32_t element, LaneMask lanes) {
    if (too_deep(frame))
        return search_plainly(query, frame, element, lanes);
    const LaneMask entering = enter_call(query, frame, element, lanes);
    if (entering == 0)
        return;
    search_tree(query, query.frames[frame.depth + std::size_t{1}], entering);
    refresh_limits(query, frame, lanes);
}

void visit_element(
    PacketQuery& query,
    Frame& frame,
    ElementRecord::Kind kind,
    std::uint32_t element,
    LaneMask lanes) {
    if (kind == ElementRecord::Kind::call)
        visit_call(query, frame, element, lanes);
    else
        test_exactly(query, frame, element, lanes);
}

inline ElementRecord::Kind element_kind(const TreeChild& child) {
    return static_cast<ElementRecord::Kind>(child.kind() - ChildKind::first_block);
}

/// A packet's rays as boxes are tested against them. The slack is in the offsets: it moves the
/// planes of a box outward.
struct BoxRays {
    Frame::Row inverse[3];
    Frame::Row near_offset[3];
    Frame::Row far_offset[3];
    std::array<std::uint8_t, packet_size> octant; ///< see octant_count
    bool one_octant = true;                       ///< of the lanes asked about
};

HWY_INLINE void fill_box_rays(const Frame& frame, LaneMask lanes, BoxRays& rays) {
    const Lanes d;
    const auto slack = hn::Set(d, 2 * frame.slack);
    rays.octant.fill(0);
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
        for (std::size_t lane = 0; lane < packet_size; ++lane)
            rays.octant[lane] |=
                static_cast<std::uint8_t>((backward >> lane & 1U) << static_cast<unsigned>(axis));
        rays.one_octant = rays.one_octant && ((backward & lanes) == 0 || (~backward & lanes) == 0);
    }
}

inline std::uint32_t
element_number(const GeometryTree& tree, const TreeChild& child, std::size_t i) {
    return std::bit_cast<std::uint32_t>(tree.rows[child.first()][i]);
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
        frame.slack};
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
        frame.slack};
}

/// How one ray meets the elements of a block.
struct BlockMeeting {
    std::uint32_t may = 0;
    std::uint32_t sure = 0;
    std::uint32_t starts = 0; ///< it starts on these
    float nearest_far = 0;    ///< of the sure ones
    alignas(16) std::array<float, block_width> near;
};

template <typename Meet>
HWY_INLINE void meet_block(
    const GeometryTree& tree,
    const TreeChild& child,
    const Frame& frame,
    std::size_t lane,
    std::size_t values,
    BlockMeeting& result,
    const Meet& meet) {
    const Elements d;
    const hn::RebindToUnsigned<Elements> du;
    const BlockRow* rows = tree.rows.data() + child.first();
    auto far = hn::Set(d, frame.limit[lane]);
    for (std::size_t i = 0; i < block_width; i += hn::Lanes(d)) {
        hn::Vec<Elements> value[11];
        for (std::size_t j = 0; j < 11; ++j)
            value[j] = j < values ? hn::LoadU(d, rows[1 + j].data() + i) : hn::Zero(d);
        const auto meeting = meet(d, one_ray(d, frame, lane), value);
        const auto number = hn::BitCast(du, hn::LoadU(d, rows[0].data() + i));
        result.may |= bits_of(d, meeting.may) << i;
        result.sure |= bits_of(d, meeting.sure) << i;
        result.starts |= bits_of(du, hn::Eq(number, hn::Set(du, frame.start_element[lane]))) << i;
        hn::StoreU(meeting.near, d, result.near.data() + i);
        far = hn::Min(far, hn::IfThenElse(meeting.sure, meeting.far, far));
    }
    const std::uint32_t present = (std::uint32_t{1} << child.count()) - 1;
    result.may &= present;
    result.sure &= present & ~result.starts;
    result.nearest_far = hn::GetLane(hn::MinOfLanes(d, far));
}

/// Whether the ray, which starts on element i of the block, may meet it again.
HWY_NOINLINE bool may_return(
    const GeometryTree& tree,
    const TreeChild& child,
    const Frame& frame,
    std::size_t lane,
    std::size_t i) {
    const Lanes d;
    const ElementRecord::Kind kind = element_kind(child);
    const BlockRow* rows = tree.rows.data() + child.first() + 1;
    hn::Vec<Lanes> values[11];
    for (std::size_t value = 0; value < 11; ++value)
        values[value] = hn::Set(d, value < value_count(kind) ? rows[value][i] : 0);
    return (bits_of(d, surely_leaves(d, one_ray(d, frame, lane), kind, values)) & 1U) == 0;
}

HWY_NOINLINE void meet_other_block(
    const GeometryTree& tree,
    const TreeChild& child,
    const Frame& frame,
    std::size_t lane,
    BlockMeeting& result) {
    const ElementRecord::Kind kind = element_kind(child);
    meet_block(
        tree,
        child,
        frame,
        lane,
        value_count(kind),
        result,
        [&](auto d, const auto& rays, const auto* values) {
            return meeting(d, rays, kind, values);
        });
}

/// Margin behind which nothing counts, of a crossing that is surely before a local distance.
inline float behind(const Frame& frame) {
    return 16 * frame.slack + 64 * (frame.slack - static_cast<float>(least_slack));
}

void visit_block_alone(PacketQuery& query, Frame& frame, const TreeChild& child, std::size_t lane) {
    const GeometryTree& tree = tree_of(frame);
    const ElementRecord::Kind kind = element_kind(child);
    BlockMeeting met;
    if (kind == ElementRecord::Kind::triangle)
        meet_block(
            tree,
            child,
            frame,
            lane,
            9,
            met,
            [](auto d, const auto& rays, const auto* values)
                HWY_ATTR { return meeting_face(d, rays, triangle_place(d, rays, values)); });
    else
        meet_other_block(tree, child, frame, lane, met);
    if (kind == ElementRecord::Kind::call) {
        for (; met.may != 0 && (query.active >> lane & 1U) != 0; met.may &= met.may - 1) {
            decide(query, frame, LaneMask{1} << lane);
            visit_call(
                query,
                frame,
                element_number(tree, child, static_cast<std::size_t>(std::countr_zero(met.may))),
                LaneMask{1} << lane);
        }
        return;
    }
    query.counts.tests += child.count();
    if (met.may == 0)
        return;
    std::uint32_t may = met.may;
    if (std::uint32_t starts = may & met.starts; starts != 0)
        for (; starts != 0; starts &= starts - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(starts));
            if (!may_return(tree, child, frame, lane, i))
                may &= ~(std::uint32_t{1} << i);
        }
    if ((met.sure & may) != 0) {
        if (query.purpose == Purpose::any)
            return block(query, frame, LaneMask{1} << lane);
        if (query.purpose == Purpose::nearest)
            frame.limit[lane] = std::min(frame.limit[lane], met.nearest_far + behind(frame));
    }
    for (; may != 0; may &= may - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(may));
        add_candidate(query, frame, kind, element_number(tree, child, i), lane, met.near[i]);
    }
    if (query.purpose == Purpose::transmittance)
        decide(query, frame, LaneMask{1} << lane);
}

/// Where the planes are, in a node, that rays of each octant come to first and last along each
/// axis: in numbers from the first plane on.
constexpr auto plane_places = [] {
    std::array<std::array<std::uint8_t, 6>, octant_count> places = {};
    for (std::size_t octant = 0; octant < octant_count; ++octant)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool backward = (octant >> axis & 1U) != 0;
            places[octant][axis] =
                static_cast<std::uint8_t>((backward ? axis + 3 : axis) * tree_width);
            places[octant][3 + axis] =
                static_cast<std::uint8_t>((backward ? axis : axis + 3) * tree_width);
        }
    return places;
}();

/// Rays on their ways down a tree, each by itself.
struct Walks {
    std::array<TreeChild, packet_size> next;      ///< where each is
    std::array<TreeChild*, packet_size> children; ///< what waits for each; the next one is on top
    std::array<float*, packet_size> near;         ///< and where the ray enters it
    std::array<std::uint32_t, packet_size> size = {};
};

#undef VERA_COMPRESS_CHILDREN
#if HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
#define VERA_COMPRESS_CHILDREN 1
#else
#define VERA_COMPRESS_CHILDREN 0
#endif

/// Puts the children of the node onto a stack for which near is not behind far, the nearest on top
/// for the octant's rays; returns how many. near_at(i) and far_at(i) are those of a register full
/// of children from number i on. Whole registers are stored.
template <typename NearAt, typename FarAt>
HWY_INLINE std::uint32_t put_met_children(
    const WideNode& node,
    [[maybe_unused]] std::size_t octant,
    const NearAt& near_at,
    const FarAt& far_at,
    TreeChild* children,
    float* nears) {
#if VERA_COMPRESS_CHILDREN
    const __m256 near = near_at(0).raw;
    const __m256 far = far_at(0).raw;
    const __m512i all = _mm512_load_si512(node.children.data());
    const __m256i turn = _mm512_cvtepi64_epi32(_mm512_srl_epi64(
        all,
        _mm_cvtsi32_si128(
            static_cast<int>(TreeChild::order_shift + TreeChild::order_width * (7 - octant)))));
    const __m256 near_in_turn = _mm256_permutevar8x32_ps(near, turn);
    const __m256 far_in_turn = _mm256_permutevar8x32_ps(far, turn);
    const __m512i in_turn = _mm512_permutexvar_epi64(_mm512_cvtepu32_epi64(turn), all);
    const __mmask8 met = _mm256_cmp_ps_mask(near_in_turn, far_in_turn, _CMP_LE_OQ);
    _mm512_storeu_si512(children, _mm512_maskz_compress_epi64(met, in_turn));
    _mm256_storeu_ps(nears, _mm256_maskz_compress_ps(met, near_in_turn));
    return static_cast<std::uint32_t>(std::popcount(static_cast<std::uint32_t>(met)));
#else
    const Children d;
    std::uint32_t met = 0;
    alignas(64) float near[tree_width];
    for (std::size_t i = 0; i < tree_width; i += hn::Lanes(d)) {
        const auto enters = near_at(i);
        hn::StoreU(enters, d, near + i);
        met |= bits_of(d, hn::Le(enters, far_at(i))) << i;
    }
    std::uint32_t size = 0;
    for (; met != 0; met &= met - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(met));
        std::size_t place = size++;
        for (; place > 0 && nears[place - 1] < near[i]; --place) {
            children[place] = children[place - 1];
            nears[place] = nears[place - 1];
        }
        children[place] = node.children[i];
        nears[place] = near[i];
    }
    return size;
#endif
}

/// Lets the children of the node wait whose boxes the lane's ray meets before its limit.
HWY_INLINE void add_met_children(
    const WideNode& node, const BoxRays& rays, const Frame& frame, Walks& walks, std::size_t lane) {
    const Children d;
    const std::size_t octant = rays.octant[lane];
    const float* const planes = node.planes[0].data();
    const auto& places = plane_places[octant];
    const auto enter = [&](std::size_t axis, std::size_t i) HWY_ATTR {
        return hn::MulAdd(
            hn::Load(d, planes + places[axis] + i),
            hn::Set(d, rays.inverse[axis][lane]),
            hn::Set(d, rays.near_offset[axis][lane]));
    };
    const auto leave = [&](std::size_t axis, std::size_t i) HWY_ATTR {
        return hn::MulAdd(
            hn::Load(d, planes + places[3 + axis] + i),
            hn::Set(d, rays.inverse[axis][lane]),
            hn::Set(d, rays.far_offset[axis][lane]));
    };
    const auto near_at = [&](std::size_t i) HWY_ATTR {
        return hn::Max(hn::Max(enter(0, i), enter(1, i)), hn::Max(enter(2, i), hn::Zero(d)));
    };
    const auto far_at = [&](std::size_t i) HWY_ATTR {
        return hn::Min(
            hn::Min(leave(0, i), leave(1, i)), hn::Min(leave(2, i), hn::Set(d, frame.limit[lane])));
    };
    walks.size[lane] += put_met_children(
        node,
        octant,
        near_at,
        far_at,
        walks.children[lane] + walks.size[lane],
        walks.near[lane] + walks.size[lane]);
}

/// Drops what waits for the lane behind its limit.
HWY_INLINE void drop_behind(Walks& walks, std::size_t lane, float limit) {
    TreeChild* const children = walks.children[lane];
    float* const nears = walks.near[lane];
    const std::uint32_t size = walks.size[lane];
    std::uint32_t kept = 0;
#if VERA_COMPRESS_CHILDREN
    for (std::uint32_t i = 0; i < size; i += tree_width) {
        const __m256 near = _mm256_loadu_ps(nears + i);
        const __m512i child = _mm512_loadu_si512(children + i);
        const std::uint32_t there = size - i < tree_width ? (1U << (size - i)) - 1 : 0xffU;
        const auto before = static_cast<__mmask8>(
            there & _mm256_cmp_ps_mask(near, _mm256_set1_ps(limit), _CMP_LE_OQ));
        _mm256_storeu_ps(nears + kept, _mm256_maskz_compress_ps(before, near));
        _mm512_storeu_si512(children + kept, _mm512_maskz_compress_epi64(before, child));
        kept += static_cast<std::uint32_t>(std::popcount(static_cast<std::uint32_t>(before)));
    }
#else
    for (std::uint32_t i = 0; i < size; ++i)
        if (nears[i] <= limit) {
            children[kept] = children[i];
            nears[kept++] = nears[i];
        }
#endif
    walks.size[lane] = kept;
}

/// Moves the lane's ray to the next child that waits for it, and lets the processor fetch that;
/// false when there is none.
HWY_INLINE bool move_on(const GeometryTree& tree, Walks& walks, std::size_t lane) {
    if (walks.size[lane] == 0)
        return false;
    const std::uint32_t size = --walks.size[lane];
    const TreeChild next = walks.children[lane][size];
    walks.next[lane] = next;
    // Without a branch, which would be guessed wrongly again and again.
    const auto nodes = reinterpret_cast<std::uintptr_t>(tree.nodes.data());
    const auto rows = reinterpret_cast<std::uintptr_t>(tree.rows.data());
    const std::uintptr_t first = next.first();
    const std::uintptr_t if_node = std::uintptr_t{next.is_block()} - 1;
    const auto* const place = reinterpret_cast<const char*>(
        rows + first * sizeof(BlockRow)
        + (if_node & (nodes - rows + first * (sizeof(WideNode) - sizeof(BlockRow)))));
    hwy::Prefetch(place);
    hwy::Prefetch(place + 64);
    hwy::Prefetch(place + 128);
    hwy::Prefetch(place + 192);
    return true;
}

/// What waits for one ray, or for a packet, is at most this much: at each level less than a node's
/// children; and whole registers are stored.
inline std::size_t waiting_depth(const GeometryTree& tree) {
    return tree_width * (tree.levels + 2);
}

/// Follows each of the lanes' rays down from a node, or a block, by itself: the nearest boxes
/// first. The rays take steps in turn, so that what each needs next arrives while the others work.
void search_apart(
    PacketQuery& query, Frame& frame, const BoxRays& rays, LaneMask lanes, const TreeChild& from) {
    const GeometryTree& tree = tree_of(frame);
    const std::size_t depth = waiting_depth(tree);
    Waiting& waiting = frame.waiting;
    Walks walks;
    std::array<std::uint8_t, packet_size + 1> at_node;
    std::array<std::uint8_t, packet_size + 1> at_block;
    std::size_t nodes = 0;
    std::size_t blocks = 0;
    const auto sort_in = [&](std::size_t lane) {
        at_node[nodes] = static_cast<std::uint8_t>(lane);
        at_block[blocks] = static_cast<std::uint8_t>(lane);
        const std::size_t is_block = walks.next[lane].is_block();
        nodes += 1 - is_block;
        blocks += is_block;
    };
    for (LaneMask rest = lanes; rest != 0; rest &= rest - 1) {
        const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
        walks.children[lane] = waiting.children.data() + lane * depth;
        walks.near[lane] = waiting.near.data() + lane * depth;
        walks.next[lane] = from;
        sort_in(lane);
    }
    while (nodes + blocks > 0) {
        std::size_t count = nodes;
        nodes = 0;
        query.counts.cells += count;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t lane = at_node[i];
            add_met_children(tree.nodes[walks.next[lane].first()], rays, frame, walks, lane);
            if (move_on(tree, walks, lane))
                sort_in(lane);
        }
        count = blocks;
        blocks = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t lane = at_block[i];
            const float limit = frame.limit[lane];
            visit_block_alone(query, frame, walks.next[lane], lane);
            if (frame.limit[lane] < limit)
                drop_behind(walks, lane, frame.limit[lane]);
            if (move_on(tree, walks, lane))
                sort_in(lane);
        }
    }
}

/// The lanes that meet the box of a node's child before their limits. All rays are of the octant.
HWY_INLINE LaneMask meeting_child(
    const WideNode& node,
    std::size_t child,
    const BoxRays& rays,
    std::size_t octant,
    const Frame::Row& limit) {
    const Lanes d;
    const float* const planes = node.planes[0].data() + child;
    const auto& places = plane_places[octant];
    LaneMask met = 0;
    for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d)) {
        auto near = hn::Zero(d);
        auto far = hn::LoadU(d, limit.data() + i);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto inverse = hn::LoadU(d, rays.inverse[axis].data() + i);
            near = hn::Max(
                near,
                hn::MulAdd(
                    hn::Set(d, planes[places[axis]]),
                    inverse,
                    hn::LoadU(d, rays.near_offset[axis].data() + i)));
            far = hn::Min(
                far,
                hn::MulAdd(
                    hn::Set(d, planes[places[3 + axis]]),
                    inverse,
                    hn::LoadU(d, rays.far_offset[axis].data() + i)));
        }
        met |= bits_of(d, hn::Le(near, far)) << i;
    }
    return met;
}

/// How a packet's rays meet an element.
struct PacketMeeting {
    LaneMask may = 0;
    LaneMask sure = 0;
    LaneMask starts = 0; ///< they start on it
    Frame::Row near;
    Frame::Row far;
};

template <typename Meet>
HWY_INLINE void meet_element(
    const GeometryTree& tree,
    const TreeChild& child,
    std::size_t i,
    const Frame& frame,
    std::size_t values,
    PacketMeeting& result,
    const Meet& meet) {
    const Lanes d;
    const hn::RebindToUnsigned<Lanes> du;
    const BlockRow* rows = tree.rows.data() + child.first();
    hn::Vec<Lanes> value[11];
    for (std::size_t j = 0; j < 11; ++j)
        value[j] = hn::Set(d, j < values ? rows[1 + j][i] : 0);
    const auto number = hn::Set(du, element_number(tree, child, i));
    for (std::size_t lane = 0; lane < packet_size; lane += hn::Lanes(d)) {
        const auto meeting = meet(d, rays_from(d, frame, lane), value);
        result.may |= bits_of(d, meeting.may) << lane;
        result.sure |= bits_of(d, meeting.sure) << lane;
        result.starts |=
            bits_of(du, hn::Eq(hn::LoadU(du, frame.start_element.data() + lane), number)) << lane;
        hn::StoreU(meeting.near, d, result.near.data() + lane);
        hn::StoreU(meeting.far, d, result.far.data() + lane);
    }
}

HWY_NOINLINE void meet_other_element(
    const GeometryTree& tree,
    const TreeChild& child,
    std::size_t i,
    const Frame& frame,
    PacketMeeting& result) {
    const ElementRecord::Kind kind = element_kind(child);
    meet_element(
        tree,
        child,
        i,
        frame,
        value_count(kind),
        result,
        [&](auto d, const auto& rays, const auto* values) {
            return meeting(d, rays, kind, values);
        });
}

/// Nothing counts any more behind far and the margin, for the lanes.
HWY_INLINE void lower_limits(Frame& frame, LaneMask lanes, const Frame::Row& far, float margin) {
    const Lanes d;
    for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d)) {
        const auto limit = hn::LoadU(d, frame.limit.data() + i);
        const auto lower =
            hn::Min(limit, hn::Add(hn::LoadU(d, far.data() + i), hn::Set(d, margin)));
        hn::StoreU(hn::IfThenElse(in_lanes(d, lanes, i), lower, limit), d, frame.limit.data() + i);
    }
}

void visit_block(PacketQuery& query, Frame& frame, const TreeChild& child, LaneMask lanes) {
    const GeometryTree& tree = tree_of(frame);
    const ElementRecord::Kind kind = element_kind(child);
    const float margin = behind(frame);
    for (std::size_t i = 0; i < child.count() && lanes != 0; ++i) {
        PacketMeeting met;
        if (kind == ElementRecord::Kind::triangle)
            meet_element(
                tree,
                child,
                i,
                frame,
                9,
                met,
                [](auto d, const auto& rays, const auto* values)
                    HWY_ATTR { return meeting_face(d, rays, triangle_place(d, rays, values)); });
        else
            meet_other_element(tree, child, i, frame, met);
        LaneMask may = met.may & lanes;
        if (kind == ElementRecord::Kind::call) {
            if (may != 0) {
                decide(query, frame, may);
                visit_call(query, frame, element_number(tree, child, i), may & query.active);
                lanes &= query.active;
            }
            continue;
        }
        query.counts.tests += static_cast<std::uint64_t>(std::popcount(lanes));
        if (may == 0)
            continue;
        for (LaneMask starts = may & met.starts; starts != 0; starts &= starts - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(starts));
            if (!may_return(tree, child, frame, lane, i))
                may &= ~(LaneMask{1} << lane);
        }
        const LaneMask sure = met.sure & may & ~met.starts;
        if (query.purpose == Purpose::any) {
            block(query, frame, sure);
            may &= ~sure;
            lanes &= ~sure;
        } else if (query.purpose == Purpose::nearest) {
            lower_limits(frame, sure, met.far, margin);
        }
        const std::uint32_t element = element_number(tree, child, i);
        for (LaneMask rest = may; rest != 0; rest &= rest - 1) {
            const auto lane = static_cast<std::size_t>(std::countr_zero(rest));
            add_candidate(query, frame, kind, element, lane, met.near[lane]);
        }
        if (query.purpose == Purpose::transmittance) {
            decide(query, frame, may);
            lanes &= query.active;
        }
    }
}

/// What holds all rays of a packet: none comes to a plane earlier than the earlier of two lines in
/// the plane's place does, nor later than the later of the two.
struct Beam {
    float inverse[3][2];
    float near_offset[3][2];
    float far_offset[3][2];
};

/// Of the lanes' rays, which are all of one octant.
HWY_INLINE Beam beam_of(const Frame& frame, const BoxRays& rays, LaneMask lanes) {
    const Lanes d;
    Beam beam;
    const std::size_t octant = rays.octant[static_cast<std::size_t>(std::countr_zero(lanes))];
    const float inward = 2 * frame.slack;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        auto least_inverse = hn::Set(d, std::numeric_limits<float>::max());
        auto most_inverse = hn::Neg(least_inverse);
        auto least_origin = least_inverse;
        auto most_origin = most_inverse;
        for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d)) {
            const auto counts = in_lanes(d, lanes, i);
            const auto inverse = hn::LoadU(d, frame.inverse[axis].data() + i);
            const auto origin = hn::LoadU(d, frame.origin[axis].data() + i);
            least_inverse = hn::Min(least_inverse, hn::IfThenElse(counts, inverse, least_inverse));
            most_inverse = hn::Max(most_inverse, hn::IfThenElse(counts, inverse, most_inverse));
            least_origin = hn::Min(least_origin, hn::IfThenElse(counts, origin, least_origin));
            most_origin = hn::Max(most_origin, hn::IfThenElse(counts, origin, most_origin));
        }
        beam.inverse[axis][0] = hn::GetLane(hn::MinOfLanes(d, least_inverse));
        beam.inverse[axis][1] = hn::GetLane(hn::MaxOfLanes(d, most_inverse));
        const float least = hn::GetLane(hn::MinOfLanes(d, least_origin));
        const float most = hn::GetLane(hn::MaxOfLanes(d, most_origin));
        const bool backward = (octant >> axis & 1U) != 0;
        const float first = backward ? least - inward : most + inward;
        const float last = backward ? most + inward : least - inward;
        for (std::size_t i = 0; i < 2; ++i) {
            beam.near_offset[axis][i] = -first * beam.inverse[axis][i];
            beam.far_offset[axis][i] = -last * beam.inverse[axis][i];
        }
    }
    return beam;
}

/// The largest limit of the lanes.
HWY_INLINE float largest_limit(const Frame& frame, LaneMask lanes) {
    const Lanes d;
    auto largest = hn::Set(d, static_cast<float>(-farthest));
    for (std::size_t i = 0; i < packet_size; i += hn::Lanes(d))
        largest = hn::Max(
            largest,
            hn::IfThenElse(in_lanes(d, lanes, i), hn::LoadU(d, frame.limit.data() + i), largest));
    return hn::GetLane(hn::MaxOfLanes(d, largest));
}

/// Lets the children of the node wait whose boxes the beam meets before the limit.
HWY_INLINE std::uint32_t put_children_in_beam(
    const WideNode& node,
    const Beam& beam,
    std::size_t octant,
    float limit,
    TreeChild* children,
    float* nears) {
    const Children d;
    const float* const planes = node.planes[0].data();
    const auto& places = plane_places[octant];
    const auto line = [&](std::size_t place,
                          const float(&inverse)[2],
                          const float(&offset)[2],
                          std::size_t which) HWY_ATTR {
        return hn::MulAdd(
            hn::Load(d, planes + place), hn::Set(d, inverse[which]), hn::Set(d, offset[which]));
    };
    const auto enter = [&](std::size_t axis, std::size_t i) HWY_ATTR {
        const auto place = places[axis] + i;
        return hn::Min(
            line(place, beam.inverse[axis], beam.near_offset[axis], 0),
            line(place, beam.inverse[axis], beam.near_offset[axis], 1));
    };
    const auto leave = [&](std::size_t axis, std::size_t i) HWY_ATTR {
        const auto place = places[3 + axis] + i;
        return hn::Max(
            line(place, beam.inverse[axis], beam.far_offset[axis], 0),
            line(place, beam.inverse[axis], beam.far_offset[axis], 1));
    };
    const auto near_at = [&](std::size_t i) HWY_ATTR {
        return hn::Max(hn::Max(enter(0, i), enter(1, i)), hn::Max(enter(2, i), hn::Zero(d)));
    };
    const auto far_at = [&](std::size_t i) HWY_ATTR {
        return hn::Min(hn::Min(leave(0, i), leave(1, i)), hn::Min(leave(2, i), hn::Set(d, limit)));
    };
    return put_met_children(node, octant, near_at, far_at, children, nears);
}

/// Which child of the node it is.
HWY_INLINE std::size_t place_of(const WideNode& node, const TreeChild& child) {
#if VERA_COMPRESS_CHILDREN
    return static_cast<std::size_t>(
        std::countr_zero(static_cast<std::uint32_t>(_mm512_cmpeq_epi64_mask(
            _mm512_load_si512(node.children.data()),
            _mm512_set1_epi64(static_cast<long long>(child.bits))))));
#else
    std::size_t i = 0;
    while (node.children[i].bits != child.bits)
        ++i;
    return i;
#endif
}

/// Follows a packet of rays of one octant down from the root. Where few of its rays are left, each
/// goes on alone.
void search_together(PacketQuery& query, Frame& frame, const BoxRays& rays, LaneMask lanes) {
    const GeometryTree& tree = tree_of(frame);
    const std::size_t octant = rays.octant[static_cast<std::size_t>(std::countr_zero(lanes))];
    const std::size_t depth = waiting_depth(tree);
    TreeChild* const children = frame.waiting.children.data() + packet_size * depth;
    float* const nears = frame.waiting.near.data() + packet_size * depth;
    std::uint32_t* const parents = frame.waiting.parent.data();
    Beam beam = beam_of(frame, rays, lanes);
    float limit = largest_limit(frame, lanes);
    std::uint32_t size = 0;
    LaneMask met = lanes;
    TreeChild next = root;
    while (true) {
        if (next.is_block() != 0) {
            visit_block(query, frame, next, met);
            if ((lanes & ~query.active) != 0) {
                lanes &= query.active;
                if (lanes == 0)
                    return;
                beam = beam_of(frame, rays, lanes);
            }
            limit = largest_limit(frame, lanes);
        } else if (std::popcount(met) <= few_lanes) {
            search_apart(query, frame, rays, met, next);
            lanes &= query.active;
            if (lanes == 0)
                return;
        } else {
            query.counts.cells += static_cast<std::uint64_t>(std::popcount(met));
            const std::uint32_t count = put_children_in_beam(
                tree.nodes[next.first()], beam, octant, limit, children + size, nears + size);
            for (std::uint32_t i = 0; i < tree_width; ++i)
                parents[size + i] = next.first();
            size += count;
        }
        do {
            if (size == 0)
                return;
            next = children[--size];
            const WideNode& parent = tree.nodes[parents[size]];
            met = lanes & meeting_child(parent, place_of(parent, next), rays, octant, frame.limit);
        } while (met == 0);
    }
}

void search_tree(PacketQuery& query, Frame& frame, LaneMask lanes) {
    lanes &= query.active;
    frame.candidates.count.fill(0);
    const std::size_t places = (packet_size + 1) * waiting_depth(tree_of(frame));
    Waiting& waiting = frame.waiting;
    if (waiting.children.size() < places) {
        waiting.children.resize(places);
        waiting.near.resize(places);
        waiting.parent.resize(waiting_depth(tree_of(frame)));
    }
    BoxRays rays;
    fill_box_rays(frame, lanes, rays);
    if (std::popcount(lanes) > few_lanes && rays.one_octant)
        search_together(query, frame, rays, lanes);
    else
        search_apart(query, frame, rays, lanes, root);
    decide(query, frame, lanes);
}

void search_trees_kernel(PacketQuery& query) {
    const LaneMask lanes = enter_scene(query);
    if (lanes != 0)
        search_tree(query, query.frames.front(), lanes);
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera::detail {

HWY_EXPORT(search_trees_kernel);

void search_trees(PacketQuery& query) {
    HWY_DYNAMIC_DISPATCH(search_trees_kernel)(query);
}

} // namespace vera::detail

#endif
