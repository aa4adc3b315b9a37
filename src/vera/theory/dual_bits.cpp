// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/dual_bits.h"

#include "vera/base/available_memory.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"

#include <algorithm>
#include <bit>
#include <string>

namespace vera {

namespace {

constexpr std::uint32_t bits_a_word = 64;

/// Finds set bits of two rows at once.
class CommonBits {
public:
    CommonBits(
        std::span<const std::uint64_t> first,
        std::span<const std::uint64_t> second,
        DualCounts& counts)
        : first_(first)
        , second_(second)
        , counts_(counts) {}

    /// The smallest one that is no smaller than `least`.
    std::optional<std::uint32_t> first_from(std::uint32_t least) const {
        std::uint64_t mask = ~std::uint64_t{0} << (least % bits_a_word);
        for (std::size_t i = least / bits_a_word; i < first_.size(); ++i, mask = ~std::uint64_t{0})
            if (const std::uint64_t word = common(i) & mask; word != 0)
                return static_cast<std::uint32_t>(bits_a_word * i)
                    + static_cast<std::uint32_t>(std::countr_zero(word));
        return std::nullopt;
    }

    /// The largest one that is smaller than `end`.
    std::optional<std::uint32_t> last_before(std::uint32_t end) const {
        if (end == 0)
            return std::nullopt;
        std::uint64_t mask = ~std::uint64_t{0} >> (bits_a_word - 1 - (end - 1) % bits_a_word);
        for (std::size_t i = (end - 1) / bits_a_word + 1; i-- > 0; mask = ~std::uint64_t{0})
            if (const std::uint64_t word = common(i) & mask; word != 0)
                return static_cast<std::uint32_t>(bits_a_word * i + bits_a_word - 1)
                    - static_cast<std::uint32_t>(std::countl_zero(word));
        return std::nullopt;
    }

private:
    std::uint64_t common(std::size_t i) const {
        ++counts_.words;
        return first_[i] & second_[i];
    }

    std::span<const std::uint64_t> first_;
    std::span<const std::uint64_t> second_;
    DualCounts& counts_;
};

} // namespace

DualBits::DualBits(
    std::span<const IsoRectangle> rectangles, const Progress& progress, const CancelFlag* cancel)
    : order_(rectangles)
    , words_((rectangles.size() + bits_a_word - 1) / bits_a_word) {
    require_memory(
        bytes_forecast(rectangles.size()),
        "the bits of the pairs of sides of " + std::to_string(rectangles.size()) + " rectangles",
        "fewer rectangles take less; nested trees take far less");
    StageProgress stages(progress, 4);
    along_y_ = SideProjection(rectangles, order_, SideProjection::Axis::x, stages.next(1), cancel);
    along_x_ = SideProjection(rectangles, order_, SideProjection::Axis::y, stages.next(1), cancel);
    stages.next(1);
    passed_x_ = passed(along_y_, cancel);
    stages.next(1);
    passed_y_ = passed(along_x_, cancel);
    if (progress)
        progress(1);
}

DualBits::Passed DualBits::passed(const SideProjection& side, const CancelFlag* cancel) const {
    Passed made;
    std::size_t size = 0;
    for (std::uint32_t line = 0; line < side.line_count(); ++line) {
        made.starts.push_back(size);
        size += side.ranges(line).place_count() * words_;
    }
    made.words.assign(size, 0);
    const LongLoop loop(side.line_count(), {}, cancel, 16);
    for (std::uint32_t line = 0; line < side.line_count(); ++line) {
        loop.turn(line);
        const std::span<const PivotRange> ranges = side.ranges(line).ranges();
        for (std::size_t rank = 0; rank < ranges.size(); ++rank)
            for (std::size_t place = ranges[rank].first; place <= ranges[rank].last; ++place)
                made.words[made.starts[line] + place * words_ + rank / bits_a_word] |= Word{1}
                    << (rank % bits_a_word);
    }
    return made;
}

std::span<const DualBits::Word>
DualBits::bits(const Passed& passed, SideProjection::Pivot pivot) const {
    return std::span(passed.words)
        .subspan(passed.starts[pivot.line] + pivot.place * words_, words_);
}

std::optional<std::uint32_t>
DualBits::first_rectangle(const WholeRay& ray, DualCounts* counts) const {
    require_ray(ray);
    DualCounts steps;
    DualCounts& taken = counts != nullptr ? *counts : steps;
    const auto in_x = along_y_.pivot(ray, taken);
    if (!in_x)
        return std::nullopt;
    const auto in_y = along_x_.pivot(ray, taken);
    if (!in_y)
        return std::nullopt;
    const CommonBits met(bits(passed_x_, *in_x), bits(passed_y_, *in_y), taken);
    const std::int32_t start = ray.origin[2];
    std::uint32_t least = order_.first_rank_from(start, taken);
    if (ray.direction[2] < 0) {
        const auto last = met.last_before(order_.first_rank_above(start, taken));
        if (!last)
            return std::nullopt;
        // Of those in its plane the one of the smallest number.
        least = order_.first_rank_from(order_.z(*last), taken);
    }
    const auto rank = met.first_from(least);
    return rank ? std::optional(order_.number(*rank)) : std::nullopt;
}

std::size_t DualBits::bytes() const {
    return order_.bytes() + along_y_.bytes() + along_x_.bytes()
        + (passed_x_.starts.capacity() + passed_y_.starts.capacity()) * sizeof(std::size_t)
        + (passed_x_.words.capacity() + passed_y_.words.capacity()) * sizeof(Word);
}

double DualBits::bytes_forecast(std::size_t rectangles) {
    const auto n = static_cast<double>(rectangles);
    const std::size_t words = (rectangles + bits_a_word - 1) / bits_a_word;
    const double row = static_cast<double>(words) * sizeof(Word);
    return 4 * n * sizeof(std::uint32_t) + 2 * SideProjection::bytes_forecast(rectangles)
        + 2 * 2 * n * (2 * sizeof(std::size_t) + (4 * n + 1) * row);
}

} // namespace vera
