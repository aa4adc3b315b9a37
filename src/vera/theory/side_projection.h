// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/theory/pivot_ranges.h"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// Rectangles in the order in which a ray upward along z meets them: by z, and by number.
class RectanglesByZ {
public:
    RectanglesByZ() = default;

    /// Throws std::invalid_argument as require_rectangles() does, or where there are more than
    /// most_rectangles.
    explicit RectanglesByZ(std::span<const IsoRectangle> rectangles);

    std::size_t size() const { return numbers_.size(); }

    std::uint32_t number(std::size_t rank) const { return numbers_[rank]; }

    std::int32_t z(std::size_t rank) const { return z_[rank]; }

    /// Of the first that is not below the z, and of the first that is above it. Take a search.
    std::uint32_t first_rank_from(std::int64_t z, DualCounts& counts) const;
    std::uint32_t first_rank_above(std::int64_t z, DualCounts& counts) const;

    std::size_t bytes() const {
        return (numbers_.capacity() + z_.capacity()) * sizeof(std::uint32_t);
    }

    static constexpr std::size_t most_rectangles = 16383; ///< places have 16 bits

private:
    std::vector<std::uint32_t> numbers_;
    std::vector<std::int32_t> z_;
};

/// All that is seen of rectangles from one side: the ends of their sides as lines of the dual
/// plane, and how a line may turn about each.
class SideProjection {
public:
    enum class Axis { x, y };

    SideProjection() = default;

    SideProjection(
        std::span<const IsoRectangle> rectangles,
        const RectanglesByZ& order,
        Axis axis,
        const Progress& progress = {},
        const CancelFlag* cancel = nullptr);

    /// The end that the ray's line meets first when it rises, and the place of its slope there.
    struct Pivot {
        std::uint32_t line = 0;
        PivotPlace place = 0;
    };

    /// Nothing where it meets none: then it passes no rectangle.
    std::optional<Pivot> pivot(const WholeRay& ray, DualCounts& counts) const;

    const DualArrangement& arrangement() const { return arrangement_; }

    /// Of each line of the arrangement; of each rectangle in its order.
    const PivotRanges& ranges(std::uint32_t line) const { return pivots_[line]; }

    std::size_t line_count() const { return pivots_.size(); }

    std::size_t bytes() const;

    static double bytes_forecast(std::size_t rectangles);

private:
    Axis axis_ = Axis::x;
    DualArrangement arrangement_;
    std::vector<PivotRanges> pivots_;
};

/// The ray's line as it is seen along the y axis, or along the x axis.
SideView side_view(const WholeRay& ray, SideProjection::Axis axis);

/// Throws std::invalid_argument as condition_half_planes() does.
void require_ray(const WholeRay& ray);

} // namespace vera
