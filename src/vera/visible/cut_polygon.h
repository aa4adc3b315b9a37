// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/visible/projection.h"

#include <array>
#include <cstddef>
#include <span>
#include <tuple>
#include <utility>

namespace vera {

/// A polygon of points of a picture, in homogeneous coordinates, that is cut side by side
/// (Sutherland and Hodgman 1974).
class CutPolygon {
public:
    // Each of six cuts adds one point at most; rounding may add others.
    static constexpr std::size_t most = 15; ///< points

    explicit CutPolygon(const std::array<ImagePoint, 3>& corners) {
        for (const ImagePoint& corner : corners)
            points_[count_++] = corner;
    }

    /// Leaves where inside(point), which is affine, is not negative. adjust(point) is called for
    /// new points, on which it is 0.
    template <typename Inside, typename Adjust>
    void cut(const Inside& inside, const Adjust& adjust) {
        const std::array<ImagePoint, most> from = points_;
        const std::size_t count = count_;
        count_ = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const ImagePoint& here = from[i];
            const ImagePoint& next = from[i + 1 == count ? 0 : i + 1];
            const double at_here = inside(here);
            const double at_next = inside(next);
            if (at_here >= 0)
                add(here);
            if ((at_here > 0 && at_next < 0) || (at_here < 0 && at_next > 0)) {
                ImagePoint point = between(here, next, at_here, at_next);
                adjust(point);
                add(point);
            }
        }
    }

    std::span<const ImagePoint> points() const { return std::span(points_).first(count_); }

    std::span<ImagePoint> points() { return std::span(points_).first(count_); }

private:
    void add(const ImagePoint& point) {
        if (count_ < most)
            points_[count_++] = point;
    }

    /// The same to the bit from either end, so that faces that share a side share its cuts.
    static ImagePoint between(ImagePoint a, ImagePoint b, double at_a, double at_b) {
        if (std::tie(b.x, b.y, b.w, b.depth) < std::tie(a.x, a.y, a.w, a.depth)) {
            std::swap(a, b);
            std::swap(at_a, at_b);
        }
        const double part = at_a / (at_a - at_b);
        const auto mixed = [&](double from, double to) { return from + part * (to - from); };
        return {mixed(a.x, b.x), mixed(a.y, b.y), mixed(a.w, b.w), mixed(a.depth, b.depth)};
    }

    std::array<ImagePoint, most> points_ = {};
    std::size_t count_ = 0;
};

} // namespace vera
