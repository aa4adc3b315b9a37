// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/box_tree_bins.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/box_tree_bins.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// What fits into a register of the numbers that are computed with together, which are always four:
/// every machine finds the same.
using Lanes = hn::CappedTag<float, 4>;
using V = hn::Vec<Lanes>;
constexpr std::size_t lanes = hn::MaxLanes(Lanes());

struct Four {
    V parts[4 / lanes];
};

/// The operation on each of the registers.
template <typename Operation, typename... Operands>
HWY_INLINE Four each(const Operation& operation, const Operands&... operands) {
    Four result;
    for (std::size_t i = 0; i < 4 / lanes; ++i)
        result.parts[i] = operation(operands.parts[i]...);
    return result;
}

HWY_INLINE Four load(const float* numbers) {
    Four result;
    for (std::size_t i = 0; i < 4 / lanes; ++i)
        result.parts[i] = hn::Load(Lanes(), numbers + i * lanes);
    return result;
}

HWY_INLINE void store(const Four& four, float* numbers) {
    for (std::size_t i = 0; i < 4 / lanes; ++i)
        hn::Store(four.parts[i], Lanes(), numbers + i * lanes);
}

HWY_INLINE Four min(const Four& a, const Four& b) {
    return each([](V x, V y) HWY_ATTR { return hn::Min(x, y); }, a, b);
}

/// Twice the middle of the reference's box; no number along an axis where it has no ends.
HWY_INLINE Four middle_of(const BoxReference& reference) {
    return each(
        [](V lower, V upper) HWY_ATTR { return hn::Add(lower, upper); },
        load(reference.lower.data()),
        load(reference.upper.data()));
}

/// 0 in place of what is no number.
HWY_INLINE Four known(const Four& middle) {
    return each([](V x) HWY_ATTR { return hn::IfThenElseZero(hn::Eq(x, x), x); }, middle);
}

HWY_INLINE Four negated(const Four& numbers) {
    return each([](V x) HWY_ATTR { return hn::Neg(x); }, numbers);
}

/// What holds points, as a RegisterBox does.
struct Bounds {
    Four lower;
    Four negated_upper;
};

HWY_INLINE Bounds no_bounds() {
    return {load(empty_box.numbers.data()), load(empty_box.numbers.data())};
}

HWY_INLINE Bounds grown(const Bounds& bounds, const Four& point) {
    return {min(bounds.lower, point), min(bounds.negated_upper, negated(point))};
}

HWY_INLINE void store(const Bounds& bounds, RegisterBox& box) {
    store(bounds.lower, box.numbers.data());
    store(bounds.negated_upper, box.numbers.data() + 4);
}

/// The eight numbers of a box, in registers as wide as there are.
using BoxLanes = hn::CappedTag<float, 8>;
constexpr std::size_t box_lanes = hn::MaxLanes(BoxLanes());

struct Box {
    hn::Vec<BoxLanes> parts[8 / box_lanes];
};

HWY_INLINE Box load(const RegisterBox& box) {
    Box result;
    for (std::size_t i = 0; i < 8 / box_lanes; ++i)
        result.parts[i] = hn::Load(BoxLanes(), box.numbers.data() + i * box_lanes);
    return result;
}

HWY_INLINE void store(const Box& box, RegisterBox& to) {
    for (std::size_t i = 0; i < 8 / box_lanes; ++i)
        hn::Store(box.parts[i], BoxLanes(), to.numbers.data() + i * box_lanes);
}

/// With what stands behind the corners.
HWY_INLINE Box box_of(const BoxReference& reference) {
    constexpr RegisterBox signs = {{0.0F, 0.0F, 0.0F, 0.0F, -0.0F, -0.0F, -0.0F, -0.0F}};
    const auto* const numbers = reinterpret_cast<const float*>(&reference);
    Box result = load(signs);
    for (std::size_t i = 0; i < 8 / box_lanes; ++i)
        result.parts[i] = hn::Xor(result.parts[i], hn::LoadU(BoxLanes(), numbers + i * box_lanes));
    return result;
}

HWY_INLINE Box together(const Box& a, const Box& b) {
    Box result;
    for (std::size_t i = 0; i < 8 / box_lanes; ++i)
        result.parts[i] = hn::Min(a.parts[i], b.parts[i]);
    return result;
}

void include_kernel(
    std::span<const BoxReference> references, RegisterBox& whole_box, RegisterBox& whole_middles) {
    Box box = load(whole_box);
    Bounds middles = no_bounds();
    for (const BoxReference& reference : references) {
        box = together(box, box_of(reference));
        middles = grown(middles, known(middle_of(reference)));
    }
    store(box, whole_box);
    RegisterBox own_middles;
    store(middles, own_middles);
    include(whole_middles, own_middles);
}

void fill_bins_kernel(
    std::span<const BoxReference> references, const Binning& binning, Bins& bins) {
    const Four start = load(binning.start.data());
    const Four bins_per_unit = load(binning.bins_per_unit.data());
    const V last = hn::Set(Lanes(), static_cast<float>(binning.count - 1));
    const Box empty = load(empty_box);
    for (std::size_t i = 0; i < binning.count; ++i) {
        for (RegisterBox& box : bins.boxes[i])
            store(empty, box);
        bins.counts[i] = {};
    }
    for (const BoxReference& reference : references) {
        const Four middle = middle_of(reference);
        alignas(16) std::int32_t numbers[4];
        for (std::size_t i = 0; i < 4 / lanes; ++i) {
            const V place =
                hn::Mul(hn::Sub(middle.parts[i], start.parts[i]), bins_per_unit.parts[i]);
            // No number counts as 0: a tiny length makes the factor infinite.
            const V in_bins =
                hn::IfThenElseZero(hn::Gt(place, hn::Zero(Lanes())), hn::Min(place, last));
            const hn::RebindToSigned<Lanes> integers;
            hn::Store(hn::ConvertTo(integers, in_bins), integers, numbers + i * lanes);
        }
        const Box own = box_of(reference);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto number = static_cast<std::uint32_t>(numbers[axis]);
            RegisterBox& box = bins.boxes[number][axis];
            store(together(load(box), own), box);
            ++bins.counts[number][axis];
        }
    }
}

/// Along each axis, half the surface of a box.
HWY_INLINE Four surfaces(const Box (&boxes)[3]) {
    alignas(16) float extents[16] = {};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        RegisterBox box;
        store(boxes[axis], box);
        const auto between = [](V lower, V negated_upper)
                                 HWY_ATTR { return hn::Neg(hn::Add(lower, negated_upper)); };
        store(
            each(between, load(box.numbers.data()), load(box.numbers.data() + 4)),
            extents + 4 * axis);
    }
    Four result;
    for (std::size_t i = 0; i < 4 / lanes; ++i) {
        V x;
        V y;
        V z;
        V fourth;
        hn::LoadInterleaved4(Lanes(), extents + 4 * i * lanes, x, y, z, fourth);
        result.parts[i] = hn::Add(hn::Add(hn::Mul(x, y), hn::Mul(y, z)), hn::Mul(z, x));
    }
    return result;
}

/// What is on a side of a cut, along each axis.
struct Side {
    Box boxes[3];
    std::array<std::int32_t, 4> counts;
};

HWY_INLINE Side empty_side() {
    const Box empty = load(empty_box);
    return {{empty, empty, empty}, {}};
}

HWY_INLINE void add_bin(const Bins& bins, std::size_t bin, Side& side) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        side.boxes[axis] = together(side.boxes[axis], load(bins.boxes[bin][axis]));
    for (std::size_t axis = 0; axis < 4; ++axis)
        side.counts[axis] += bins.counts[bin][axis];
}

/// Surface by number. Where there is nothing, it is infinite by 0, which is no number.
HWY_INLINE Four cost_of(const Side& side) {
    Four counts;
    for (std::size_t i = 0; i < 4 / lanes; ++i) {
        const hn::RebindToSigned<Lanes> integers;
        counts.parts[i] =
            hn::ConvertTo(Lanes(), hn::LoadU(integers, side.counts.data() + i * lanes));
    }
    return each([](V x, V y) HWY_ATTR { return hn::Mul(x, y); }, surfaces(side.boxes), counts);
}

Cut best_cut_kernel(const Bins& bins, const Binning& binning) {
    Four left_costs[most_bins];
    Side left = empty_side();
    for (std::size_t i = 1; i < binning.count; ++i) {
        add_bin(bins, i - 1, left);
        left_costs[i] = cost_of(left);
    }
    Four least = load(empty_box.numbers.data());
    Four least_bin = least;
    Side right = empty_side();
    for (std::size_t i = binning.count; i-- > 1;) {
        add_bin(bins, i, right);
        const Four right_cost = cost_of(right);
        const V bin = hn::Set(Lanes(), static_cast<float>(i));
        for (std::size_t j = 0; j < 4 / lanes; ++j) {
            const V cost = hn::Add(left_costs[i].parts[j], right_cost.parts[j]);
            const auto less = hn::Lt(cost, least.parts[j]);
            least.parts[j] = hn::IfThenElse(less, cost, least.parts[j]);
            least_bin.parts[j] = hn::IfThenElse(less, bin, least_bin.parts[j]);
        }
    }
    alignas(16) float costs[4];
    alignas(16) float cut_bins[4];
    store(least, costs);
    store(least_bin, cut_bins);
    Cut best;
    float best_cost = std::numeric_limits<float>::infinity();
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (costs[axis] < best_cost && binning.bins_per_unit[axis] > 0) {
            best.axis = axis;
            best.bin = static_cast<std::size_t>(cut_bins[axis]);
            best_cost = costs[axis];
        }
    if (best.axis == 3)
        return best;
    Box left_box = load(empty_box);
    Box right_box = left_box;
    for (std::size_t i = 0; i < best.bin; ++i)
        left_box = together(left_box, load(bins.boxes[i][best.axis]));
    for (std::size_t i = best.bin; i < binning.count; ++i)
        right_box = together(right_box, load(bins.boxes[i][best.axis]));
    store(left_box, best.left);
    store(right_box, best.right);
    return best;
}

/// The bounds grown by the point where the mask says so.
template <typename Mask>
HWY_INLINE Bounds grown_where(Mask mask, const Bounds& bounds, const Four& point) {
    const auto chosen = [&](V yes, V no) HWY_ATTR { return hn::IfThenElse(mask, yes, no); };
    const Bounds with = grown(bounds, point);
    return {
        each(chosen, with.lower, bounds.lower),
        each(chosen, with.negated_upper, bounds.negated_upper)};
}

Sides take_sides_kernel(
    std::span<BoxReference> references, const Binning& binning, const Cut& cut) {
    const hn::RebindToSigned<Lanes> integers;
    const std::size_t axis = cut.axis;
    const float start = binning.start[axis];
    const float bins_per_unit = binning.bins_per_unit[axis];
    const auto bin = static_cast<float>(cut.bin);
    Bounds left = no_bounds();
    Bounds right = no_bounds();
    std::size_t left_count = 0;
    for (BoxReference& reference : references) {
        // As in fill_bins_kernel. No branches, which would be guessed wrongly again and again.
        const float place = (reference.lower[axis] + reference.upper[axis] - start) * bins_per_unit;
        const bool is_left = !(place >= bin);
        const auto all_if_left = hn::Set(integers, -static_cast<std::int32_t>(is_left));
        const auto on_left = hn::MaskFromVec(hn::BitCast(Lanes(), all_if_left));
        const Four middle = known(middle_of(reference));
        left = grown_where(on_left, left, middle);
        right = grown_where(hn::Not(on_left), right, middle);
        const BoxReference other = references[left_count];
        references[left_count] = reference;
        reference = other;
        left_count += static_cast<std::size_t>(is_left);
    }
    Sides sides;
    store(left, sides.left);
    store(right, sides.right);
    sides.left_count = left_count;
    return sides;
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera::detail {

HWY_EXPORT(include_kernel);
HWY_EXPORT(fill_bins_kernel);
HWY_EXPORT(best_cut_kernel);
HWY_EXPORT(take_sides_kernel);

void include(std::span<const BoxReference> references, RegisterBox& box, RegisterBox& middles) {
    HWY_DYNAMIC_DISPATCH(include_kernel)(references, box, middles);
}

void fill_bins(std::span<const BoxReference> references, const Binning& binning, Bins& bins) {
    HWY_DYNAMIC_DISPATCH(fill_bins_kernel)(references, binning, bins);
}

Cut best_cut(const Bins& bins, const Binning& binning) {
    return HWY_DYNAMIC_DISPATCH(best_cut_kernel)(bins, binning);
}

Sides take_sides(std::span<BoxReference> references, const Binning& binning, const Cut& cut) {
    return HWY_DYNAMIC_DISPATCH(take_sides_kernel)(references, binning, cut);
}

} // namespace vera::detail

#endif
