// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/region_paint.h"

#include "vera/base/long_loop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <optional>
#include <span>
#include <utility>

namespace vera {

namespace {

/// Smallest rectangle along the axes.
struct Extent {
    DrawingPoint least = {
        std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    DrawingPoint most = {
        -std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};

    void add(DrawingPoint point) {
        least = {std::min(least.x, point.x), std::min(least.y, point.y)};
        most = {std::max(most.x, point.x), std::max(most.y, point.y)};
    }

    double length() const { return std::max(most.x - least.x, most.y - least.y); }
};

Extent extent_of(const std::vector<BorderRing>& rings) {
    Extent extent;
    for (const BorderRing& ring : rings)
        for (const DrawingPoint point : ring)
            extent.add(point);
    return extent;
}

double area_of(const std::vector<BorderRing>& rings) {
    double doubled = 0;
    for (const BorderRing& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const DrawingPoint next = ring[i + 1 == ring.size() ? 0 : i + 1];
            doubled += ring[i].x * next.y - ring[i].y * next.x;
        }
    return std::abs(doubled) / 2;
}

/// Calls sink(i) for all whole numbers i with from < step * (i + 1/2) < to.
template <typename Sink>
void for_each_step(double from, double to, double step, const Sink& sink) {
    for (double i = std::floor(from / step + 0.5); step * (i + 0.5) < to; ++i)
        if (step * (i + 0.5) > from)
            sink(step * (i + 0.5));
}

void add_border_points(
    const std::vector<BorderRing>& rings, double spacing, std::vector<DrawingPoint>& points) {
    for (const BorderRing& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const DrawingPoint from = ring[i];
            const DrawingPoint to = ring[i + 1 == ring.size() ? 0 : i + 1];
            const double x = to.x - from.x;
            const double y = to.y - from.y;
            const double parts = std::ceil(std::sqrt(x * x + y * y) / spacing);
            points.push_back(from);
            for (double part = 1; part < parts; ++part)
                points.push_back({from.x + part / parts * x, from.y + part / parts * y});
        }
}

void add_inner_points(
    const std::vector<BorderRing>& rings,
    const Extent& extent,
    double spacing,
    std::vector<DrawingPoint>& points) {
    // The rows' crossings with the sides, all sides once.
    const auto rows = static_cast<std::size_t>((extent.most.y - extent.least.y) / spacing) + 1;
    std::vector<std::vector<double>> crossings(rows);
    const double top = extent.least.y;
    for (const BorderRing& ring : rings)
        for (std::size_t i = 0; i < ring.size(); ++i) {
            DrawingPoint from = ring[i];
            DrawingPoint to = ring[i + 1 == ring.size() ? 0 : i + 1];
            if (from.y > to.y)
                std::swap(from, to);
            for_each_step(from.y - top, to.y - top, spacing, [&](double y) {
                const double part = (top + y - from.y) / (to.y - from.y);
                const auto row = static_cast<std::size_t>(y / spacing);
                if (row < rows)
                    crossings[row].push_back(from.x + part * (to.x - from.x));
            });
        }
    for (std::size_t row = 0; row < rows; ++row) {
        std::ranges::sort(crossings[row]);
        const double y = top + spacing * (static_cast<double>(row) + 0.5);
        for (std::size_t i = 0; i + 1 < crossings[row].size(); i += 2)
            for_each_step(
                crossings[row][i] - extent.least.x,
                crossings[row][i + 1] - extent.least.x,
                spacing,
                [&](double x) {
                    points.push_back({extent.least.x + x, y});
                });
    }
}

/// A line that cuts a region across that direction in the middle, as the half plane on one side of
/// it, and how long the region is in that direction.
struct Cut {
    HalfPlane half;
    double length = 0;
};

Cut middle_cut(std::span<const ColorSample> samples, DrawingPoint across) {
    const double size = std::sqrt(across.x * across.x + across.y * across.y);
    const DrawingPoint unit = {across.x / size, across.y / size};
    const auto way = [&](const ColorSample& sample) {
        return unit.x * sample.point.x + unit.y * sample.point.y;
    };
    const auto [first, last] = std::ranges::minmax(samples, {}, way);
    return {{unit, 0.5 * (way(first) + way(last))}, way(last) - way(first)};
}

HalfPlane other_side(const HalfPlane& half) {
    return {{-half.normal.x, -half.normal.y}, -half.reach};
}

HalfPlane moved(const HalfPlane& half, double pixels) {
    return {half.normal, half.reach + pixels};
}

/// Whether the gradient bends so sharply that samples so far apart tell little of where.
bool bends(const Gradient& gradient, double spacing) {
    constexpr double sharp = 16; // of 255
    const auto length_of = [](DrawingPoint way) {
        return std::sqrt(way.x * way.x + way.y * way.y);
    };
    const double axis = std::max(length_of(gradient.axis), length_of(gradient.other_axis));
    const auto slopes = [&](const GradientStop& from, const GradientStop& to) {
        const double way = (to.offset - from.offset) * axis;
        return std::array{
            (to.color.r - from.color.r) / way,
            (to.color.g - from.color.g) / way,
            (to.color.b - from.color.b) / way};
    };
    for (std::size_t i = 1; i + 1 < gradient.stops.size(); ++i) {
        const auto before = slopes(gradient.stops[i - 1], gradient.stops[i]);
        const auto after = slopes(gradient.stops[i], gradient.stops[i + 1]);
        for (std::size_t channel = 0; channel < 3; ++channel)
            if (std::abs(after[channel] - before[channel]) * spacing > sharp)
                return true;
    }
    return false;
}

class RegionPainter {
public:
    RegionPainter(
        const ColorField& field,
        const PaintTolerance& tolerance,
        std::span<const DrawingEllipse> curves,
        const CancelFlag* cancel)
        : field_(field)
        , tolerance_(tolerance)
        , curves_(curves)
        , cancel_(cancel) {}

    void paint(PaintedRegion region, int cuts) {
        const double length = extent_of(region.rings).length();
        if (!(length > 0))
            return;
        std::vector<ColorSample> samples;
        const FittedPaint best = best_paint(region, length, cuts, samples);
        const std::optional<HalfPlane> half = best.error <= tolerance_.color || cuts == most_cuts
            ? std::nullopt
            : best_cut(samples, best);
        if (!half) {
            finish(std::move(region), best);
            return;
        }
        const HalfPlane rest = other_side(*half);
        PaintedRegion first = part_of(region, *half, moved(*half, overlap));
        // It goes on below the other part, which is painted later.
        std::ranges::move(
            cut_rings(cut_rings(region.rings, rest), moved(*half, overlap)),
            std::back_inserter(first.below));
        paint(std::move(first), cuts + 1);
        paint(part_of(region, rest, rest), cuts + 1);
    }

    std::vector<FilledOutline> take() { return std::move(painted_); }

private:
    static constexpr double shortest_cut = 1; ///< pixels
    static constexpr double overlap = 1;      ///< pixels
    static constexpr int most_cuts = 16;      ///< one after the other

    /// The paint that fits best, and the samples that tell so: few where few suffice to see that
    /// none fits, more where a gradient bends between them.
    FittedPaint best_paint(
        const PaintedRegion& region,
        double length,
        int cuts,
        std::vector<ColorSample>& samples) const {
        constexpr double pixel = 1;
        const double fine = sample_spacing(length, area_of(region.rings));
        const double coarse = std::max(length / 12, fine);
        samples = samples_of(region, coarse);
        if (cuts == 0 && length < pixel)
            return flat_fit(samples);
        FittedPaint best = best_paint(samples);
        if (coarse > fine && best.error <= tolerance_.color) {
            samples = samples_of(region, fine);
            best = best_paint(samples);
        }
        if (best.error <= tolerance_.color && best.gradient && bends(*best.gradient, fine)) {
            samples = samples_of(region, fine / 3);
            best = best_paint(samples);
        }
        return best;
    }

    std::vector<ColorSample> samples_of(const PaintedRegion& region, double spacing) const {
        stop_if_raised(cancel_);
        return color_samples(sample_points(region.rings, spacing), field_, tolerance_.within);
    }

    FittedPaint best_paint(std::span<const ColorSample> samples) const {
        stop_if_raised(cancel_);
        return best_fit(samples, tolerance_.color);
    }

    /// Of a cut along the gradient that fits best and one across it, that whose parts fit better;
    /// where that is much the same, that which makes the longer side shorter. Nothing is cut into
    /// parts that are less than half a pixel wide.
    std::optional<HalfPlane>
    best_cut(std::span<const ColorSample> samples, const FittedPaint& best) const {
        const DrawingPoint axis = best.gradient ? best.gradient->axis : DrawingPoint{1, 0};
        Cut longer = middle_cut(samples, axis);
        Cut shorter = middle_cut(samples, {-axis.y, axis.x});
        if (longer.length < shorter.length)
            std::swap(longer, shorter);
        if (longer.length < shortest_cut)
            return std::nullopt;
        if (shorter.length < shortest_cut)
            return longer.half;
        constexpr double much_the_same = 0.9;
        const bool is_better =
            misfit(samples, shorter.half) < much_the_same * misfit(samples, longer.half);
        return is_better ? shorter.half : longer.half;
    }

    double misfit(std::span<const ColorSample> samples, const HalfPlane& half) const {
        std::vector<ColorSample> parts[2];
        for (const ColorSample& sample : samples) {
            const double way = half.normal.x * sample.point.x + half.normal.y * sample.point.y;
            parts[way <= half.reach ? 0 : 1].push_back(sample);
        }
        double worst = 0;
        for (const std::vector<ColorSample>& part : parts)
            worst = std::max(worst, part.empty() ? 1 : linear_fit(part, tolerance_.color).error);
        return worst;
    }

    static PaintedRegion
    part_of(const PaintedRegion& region, const HalfPlane& half, const HalfPlane& half_below) {
        PaintedRegion part;
        part.outline.id = region.outline.id;
        part.outline.name = region.outline.name;
        part.outline.group = region.outline.group;
        part.rings = cut_rings(region.rings, half);
        part.outline.seams = cut_lines(region.outline.seams, half);
        part.below = cut_rings(region.below, half_below);
        return part;
    }

    void finish(PaintedRegion region, const FittedPaint& paint) {
        region.outline.color = paint.color;
        region.outline.gradient = paint.gradient;
        add_rings(region, curves_);
        painted_.push_back(std::move(region.outline));
    }

    const ColorField& field_;
    const PaintTolerance& tolerance_;
    std::span<const DrawingEllipse> curves_;
    const CancelFlag* cancel_;
    std::vector<FilledOutline> painted_;
};

} // namespace

void add_rings(PaintedRegion& region, std::span<const DrawingEllipse> curves) {
    for (const std::vector<BorderRing>* rings : {&region.rings, &region.below})
        for (const BorderRing& ring : *rings)
            add_ring(ring, curves, region.outline);
}

double sample_spacing(double length, double area) {
    constexpr double widest = 6; // pixels: highlights are not much smaller
    const double across = std::max(area / length / 2, length / 64);
    return std::max(std::min({length / 4, across, widest}), length / 128);
}

std::vector<DrawingPoint> sample_points(const std::vector<BorderRing>& rings, double spacing) {
    std::vector<DrawingPoint> points;
    add_border_points(rings, spacing, points);
    add_inner_points(rings, extent_of(rings), spacing, points);
    return points;
}

std::vector<FilledOutline> painted(
    PaintedRegion region,
    const ColorField& field,
    const PaintTolerance& tolerance,
    std::span<const DrawingEllipse> curves,
    const CancelFlag* cancel) {
    RegionPainter painter(field, tolerance, curves, cancel);
    painter.paint(std::move(region), 0);
    return painter.take();
}

} // namespace vera
