// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/ray_segments.h"

#include "vera/base/available_memory.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace vera {

namespace {

using Numbers = std::vector<std::uint32_t>;
using Rays = std::span<const SlopedRay>;

/// What of the time the parts of building take: where rays are cut, in how many nodes they are,
/// their entries, and the range trees.
constexpr double cutting_part = 0.1;
constexpr double counting_part = 0.4;
constexpr double filling_part = 0.7;

/// No less than a / b.
std::int64_t quotient_rounded_up(std::int64_t a, std::int64_t b) {
    if (b < 0)
        return quotient_rounded_up(-a, -b);
    return a > 0 ? (a - 1) / b + 1 : -(-a / b);
}

/// The first whole z from which on two lines have changed places, where that is behind the given z
/// and rectangles may lie there.
std::optional<std::int32_t> change_of_places(PlanePoint a, PlanePoint b, std::int32_t behind) {
    if (a.x == b.x)
        return std::nullopt;
    const std::int64_t z = quotient_rounded_up(std::int64_t{b.y} - a.y, std::int64_t{a.x} - b.x);
    if (z <= behind || z > largest_plane_coordinate)
        return std::nullopt;
    return static_cast<std::int32_t>(z);
}

/// Those of two rays, where both have begun.
void append_changes(const SlopedRay& a, const SlopedRay& b, std::vector<std::int32_t>& changes) {
    const std::int32_t begun = std::max(a.first_z, b.first_z);
    if (const auto z = change_of_places(x_point(a), x_point(b), begun))
        changes.push_back(*z);
    if (const auto z = change_of_places(y_point(a), y_point(b), begun))
        changes.push_back(*z);
}

void sort_once_each(std::vector<std::int32_t>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

std::size_t range_tree_levels(std::size_t rays) {
    return static_cast<std::size_t>(std::bit_width(rays));
}

} // namespace

class RaySegmentsBuilder {
public:
    RaySegmentsBuilder(RaySegments& made, Progress progress, const CancelFlag* cancel)
        : made_(made)
        , progress_(std::move(progress))
        , cancel_(cancel) {}

    /// Where rays are cut, and how many entries that makes.
    void plan(Rays rays) {
        require_sloped_rays(rays);
        // Two crossings of each pair, in a list that takes three times as much while it grows.
        require_memory(
            3 * static_cast<double>(rays.size()) * static_cast<double>(rays.size())
                * sizeof(std::int32_t),
            "finding where " + std::to_string(rays.size()) + " rays cross each other",
            remedy);
        made_.rays_.assign(rays.begin(), rays.end());
        find_starts();
        made_.counts_.assign(2 * made_.leaves_, 0);
        for_each_entry(
            progress_between(progress_, cutting_part, counting_part),
            [&](std::size_t node, std::uint32_t /*ray*/) { ++made_.counts_[node]; });
        for (const std::uint32_t count : made_.counts_)
            made_.entry_count_ += count;
    }

    double bytes() const {
        double entries = 0;
        for (const std::uint32_t count : made_.counts_)
            entries += static_cast<double>(count) * static_cast<double>(range_tree_levels(count));
        return entries * sizeof(std::uint32_t)
            + static_cast<double>(made_.counts_.size())
            * (sizeof(std::uint32_t) + sizeof(std::uint64_t))
            + static_cast<double>(made_.starts_.capacity()) * sizeof(std::int32_t)
            + static_cast<double>(made_.rays_.size()) * sizeof(SlopedRay);
    }

    void require_enough_memory() const {
        require_memory(
            bytes() + static_cast<double>(made_.counts_.size()) * sizeof(std::uint32_t),
            "a segment tree of the " + std::to_string(made_.segment_count_) + " segments of "
                + std::to_string(made_.rays_.size()) + " rays",
            remedy);
    }

    void fill() {
        std::vector<std::uint64_t>& firsts = made_.firsts_;
        firsts.reserve(made_.counts_.size());
        std::uint64_t entries = 0;
        for (const std::uint32_t count : made_.counts_) {
            firsts.push_back(entries);
            entries += count * range_tree_levels(count);
        }
        made_.entries_.resize(entries);
        Numbers filled(made_.counts_.size());
        for_each_entry(
            progress_between(progress_, counting_part, filling_part),
            [&](std::size_t node, std::uint32_t ray) {
                made_.entries_[firsts[node] + filled[node]++] = ray;
            });
        long_parallel_loop(
            made_.counts_.size(),
            progress_between(progress_, filling_part, 1),
            cancel_,
            1024,
            [&](std::size_t node) {
                if (made_.counts_[node] > 0)
                    make_range_tree(node);
            });
    }

private:
    static constexpr const char* remedy =
        "fewer rays take less, half of them about a fifth; trees of a part of them each can be "
        "asked in turn";

    void find_starts() {
        const Rays rays = made_.rays_;
        std::vector<std::int32_t>& starts = made_.starts_;
        const LongLoop loop(rays.size(), progress_between(progress_, 0, cutting_part), cancel_, 1);
        for (std::size_t i = 0; i < rays.size(); ++i) {
            loop.turn(i);
            starts.push_back(rays[i].first_z);
            for (std::size_t j = 0; j < i; ++j)
                append_changes(rays[i], rays[j], starts);
        }
        sort_once_each(starts);
        starts.shrink_to_fit();
        made_.leaves_ = std::bit_ceil(std::max<std::size_t>(starts.size(), 1));
    }

    /// Calls use(node, ray) for each node that the segment tree names for each segment of each ray.
    template <typename Use>
    void for_each_entry(const Progress& progress, const Use& use) {
        const Rays rays = made_.rays_;
        const LongLoop loop(rays.size(), progress, cancel_, 1);
        std::vector<std::int32_t> cuts;
        made_.segment_count_ = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            loop.turn(i);
            cuts = {rays[i].first_z};
            for (std::size_t j = 0; j < rays.size(); ++j)
                append_changes(rays[i], rays[j], cuts);
            sort_once_each(cuts);
            made_.segment_count_ += cuts.size();
            std::size_t begin = leaf_from(cuts.front());
            for (std::size_t cut = 1; cut <= cuts.size(); ++cut) {
                const std::size_t end =
                    cut < cuts.size() ? leaf_from(cuts[cut]) : made_.starts_.size();
                for_each_node_of(begin, end, [&](std::size_t node) {
                    use(node, static_cast<std::uint32_t>(i));
                });
                begin = end;
            }
        }
    }

    std::size_t leaf_from(std::int32_t start) const {
        const std::vector<std::int32_t>& starts = made_.starts_;
        return static_cast<std::size_t>(
            std::lower_bound(starts.begin(), starts.end(), start) - starts.begin());
    }

    /// The largest nodes that have the leaves from begin to end, and no others.
    template <typename Use>
    void for_each_node_of(std::size_t begin, std::size_t end, const Use& use) const {
        std::size_t first = begin + made_.leaves_;
        std::size_t last = end + made_.leaves_;
        for (; first < last; first /= 2, last /= 2) {
            if (first % 2 != 0)
                use(first++);
            if (last % 2 != 0)
                use(--last);
        }
    }

    std::int32_t first_z(std::size_t node) const {
        while (node < made_.leaves_)
            node *= 2;
        return made_.starts_[node - made_.leaves_];
    }

    void make_range_tree(std::size_t node) const {
        const std::int32_t z = first_z(node);
        const std::size_t count = made_.counts_[node];
        std::uint32_t* const along_x = &made_.entries_[made_.firsts_[node]];
        // Those that are at one place there part behind it, if they do, by their slopes.
        const auto before = [z](PlanePoint a, PlanePoint b) {
            const std::int64_t at_a = value_at(a, z);
            const std::int64_t at_b = value_at(b, z);
            return at_a != at_b ? at_a < at_b : a.x < b.x;
        };
        std::sort(along_x, along_x + count, [&](std::uint32_t a, std::uint32_t b) {
            return before(x_point(made_.rays_[a]), x_point(made_.rays_[b]));
        });
        std::uint32_t* shorter = along_x;
        for (std::size_t level = 1; level < range_tree_levels(count); ++level) {
            const std::size_t length = std::size_t{1} << level;
            for (std::size_t i = 0; i < count; i += length) {
                const std::size_t middle = std::min(i + length / 2, count);
                const std::size_t end = std::min(i + length, count);
                std::merge(
                    shorter + i,
                    shorter + middle,
                    shorter + middle,
                    shorter + end,
                    shorter + count + i,
                    [&](std::uint32_t a, std::uint32_t b) {
                        return before(y_point(made_.rays_[a]), y_point(made_.rays_[b]));
                    });
            }
            shorter += count;
        }
    }

    RaySegments& made_;
    Progress progress_;
    const CancelFlag* cancel_;
};

RaySegments::RaySegments(
    std::span<const SlopedRay> rays, const Progress& progress, const CancelFlag* cancel) {
    RaySegmentsBuilder builder(*this, progress, cancel);
    builder.plan(rays);
    builder.require_enough_memory();
    builder.fill();
}

double RaySegments::bytes_forecast(std::span<const SlopedRay> rays, const CancelFlag* cancel) {
    RaySegments planned;
    RaySegmentsBuilder builder(planned, {}, cancel);
    builder.plan(rays);
    return builder.bytes();
}

std::size_t RaySegments::height() const {
    return static_cast<std::size_t>(std::bit_width(leaves_));
}

std::size_t RaySegments::bytes() const {
    return rays_.capacity() * sizeof(SlopedRay) + starts_.capacity() * sizeof(std::int32_t)
        + counts_.capacity() * sizeof(std::uint32_t) + firsts_.capacity() * sizeof(std::uint64_t)
        + entries_.capacity() * sizeof(std::uint32_t);
}

namespace {

/// The part of a sorted row of rays that lies from lower to upper.
template <typename Place>
std::span<const std::uint32_t> rays_between(
    std::span<const std::uint32_t> row,
    std::int64_t lower,
    std::int64_t upper,
    StepCounts& counts,
    const Place& place) {
    ++counts.searches;
    const auto first = std::partition_point(row.begin(), row.end(), [&](std::uint32_t ray) {
        ++counts.points;
        return place(ray) < lower;
    });
    const auto last = std::partition_point(first, row.end(), [&](std::uint32_t ray) {
        ++counts.points;
        return place(ray) <= upper;
    });
    return {first, last};
}

} // namespace

void RaySegments::search(
    std::size_t node, const IsoRectangle& rectangle, Numbers& found, StepCounts& counts) const {
    ++counts.nodes;
    const std::size_t rays = counts_[node];
    const auto entries = std::span(entries_).subspan(firsts_[node], rays * range_tree_levels(rays));
    if (rays == 0)
        return;
    const auto in_x = rays_between(
        entries.first(rays), rectangle.lower_x, rectangle.upper_x, counts, [&](std::uint32_t ray) {
            return value_at(x_point(rays_[ray]), rectangle.z);
        });
    // The largest rows sorted along y that together are these rays.
    auto begin = static_cast<std::size_t>(in_x.data() - entries.data());
    const std::size_t end = begin + in_x.size();
    while (begin < end) {
        const std::size_t fitting = range_tree_levels(end - begin) - 1;
        const std::size_t level =
            std::min(fitting, static_cast<std::size_t>(std::countr_zero(begin)));
        const std::size_t length = std::size_t{1} << level;
        const auto met = rays_between(
            entries.subspan(level * rays + begin, length),
            rectangle.lower_y,
            rectangle.upper_y,
            counts,
            [&](std::uint32_t ray) { return value_at(y_point(rays_[ray]), rectangle.z); });
        found.insert(found.end(), met.begin(), met.end());
        begin += length;
    }
}

Numbers RaySegments::rays_met(const IsoRectangle& rectangle, StepCounts* counts) const {
    require_rectangles({&rectangle, 1});
    StepCounts steps;
    Numbers found;
    const auto behind = std::upper_bound(starts_.begin(), starts_.end(), rectangle.z);
    if (behind == starts_.begin())
        return found;
    const auto leaf = static_cast<std::size_t>(behind - starts_.begin()) - 1;
    // The nodes of which it is a part, up to the root: a ray is in one of them at most.
    for (std::size_t node = leaf + leaves_; node > 0; node /= 2)
        search(node, rectangle, found, counts != nullptr ? *counts : steps);
    std::sort(found.begin(), found.end());
    return found;
}

} // namespace vera
