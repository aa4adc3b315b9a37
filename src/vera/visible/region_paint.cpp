// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/region_paint.h"

#include "vera/base/long_loop.h"
#include "vera/visible/near_border.h"
#include "vera/visible/region_samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <iterator>
#include <optional>
#include <span>
#include <utility>

namespace vera {

namespace {

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

constexpr double steep = 8.0 / 255;

/// Whether what is shown may change that much within that distance somewhere: not where its largest
/// change a pixel tells so.
bool may_be_steep(const Gradient& gradient, double distance) {
    const DrawingPoint a = gradient.axis;
    const DrawingPoint b = gradient.other_axis;
    const double size = a.x * a.x + a.y * a.y;
    // How far apart the levels 0 and 1 are at least: of an ellipse its half minor axis, or less.
    const double apart = gradient.shape == Gradient::Shape::linear
        ? std::sqrt(size)
        : std::abs(a.x * b.y - a.y * b.x) / std::sqrt(size + b.x * b.x + b.y * b.y);
    for (std::size_t i = 1; i < gradient.stops.size(); ++i) {
        const GradientStop& from = gradient.stops[i - 1];
        const GradientStop& to = gradient.stops[i];
        const int change = std::max(
            {std::abs(from.color.r - to.color.r),
             std::abs(from.color.g - to.color.g),
             std::abs(from.color.b - to.color.b)});
        if (change * distance > 255 * steep * apart * (to.offset - from.offset))
            return true;
    }
    return false;
}

bool is_steep(const FittedPaint& paint, DrawingPoint point, double distance) {
    const ColorField shown = [&](DrawingPoint at) { return color_at(paint, at); };
    return color_sample(point, shown, distance).slack > steep;
}

class RegionPainter {
public:
    RegionPainter(
        const PaintedRegion& whole,
        const ColorField& field,
        const PaintTolerance& tolerance,
        std::span<const DrawingEllipse> curves,
        const CancelFlag* cancel)
        : near_border_(whole.rings)
        , field_(field)
        , tolerance_(tolerance)
        , curves_(curves)
        , cancel_(cancel) {}

    void paint(PaintedRegion region, int cuts) {
        const double length = extent_of(region.rings).length();
        if (!(length > 0))
            return;
        std::vector<ColorSample> samples;
        const FittedPaint best = best_paint(region, length, cuts, samples);
        const std::optional<HalfPlane> half =
            fits(best) || cuts == most_cuts ? std::nullopt : best_cut(samples, best);
        if (!half) {
            finish(std::move(region), best);
            return;
        }
        if (cuts == 0 && !region.lies_on_underlay)
            finish(uncut(region), best);
        const HalfPlane rest = other_side(*half);
        PaintedRegion first = part_of(region, *half, moved(*half, overlap));
        std::ranges::move(strip_beyond(region.rings, *half), std::back_inserter(first.below));
        paint(std::move(first), cuts + 1);
        painted_beside_.push_back(rest);
        paint(part_of(region, rest, rest), cuts + 1);
        painted_beside_.pop_back();
    }

    std::vector<FilledOutline> take() { return std::move(painted_); }

private:
    static constexpr double shortest_cut = 1;       ///< pixels
    static constexpr double overlap = 1;            ///< pixels
    static constexpr double gap = 0.2;              ///< pixels: more than one decimal leaves
    static constexpr int most_cuts = 16;            ///< one after the other
    static constexpr std::uint64_t most_rounds = 6; ///< of places added to samples

    static constexpr std::size_t enough_off = 200; ///< places added in a round, at most

    /// Of the tolerance that which samples may take: between them colours are off by a little more.
    static constexpr double part_of_samples = 0.95;

    double tolerance_of_samples() const { return part_of_samples * tolerance_.color; }

    bool fits(const FittedPaint& paint) const { return paint.error <= tolerance_of_samples(); }

    /// The paint that fits best, and the samples that tell so: few where few suffice to see that
    /// none fits. One that fits is looked at in many more places; where it is off there, these are
    /// samples as well, and after some rounds it does not fit.
    FittedPaint best_paint(
        const PaintedRegion& region,
        double length,
        int cuts,
        std::vector<ColorSample>& samples) const {
        constexpr double pixel = 1;
        constexpr double closest = 0.4; // pixels
        const double fine = sample_spacing(length, area_of(region.rings));
        const double coarse = std::max(length / 12, fine);
        samples = samples_of(region, coarse);
        if (cuts == 0 && length < pixel)
            return flat_fit(samples);
        FittedPaint best = best_paint(samples);
        if (coarse > fine && fits(best)) {
            samples = samples_of(region, fine);
            best = best_paint(samples);
        }
        const double spacing = std::max(closest, 0.35 * fine);
        for (std::uint64_t round = 0; fits(best); ++round) {
            const std::vector<ColorSample> off = where_off(best, region, spacing, round);
            if (off.empty())
                break;
            samples.insert(samples.end(), off.begin(), off.end());
            if (round < most_rounds)
                best = best_paint(samples);
            else
                best.error = error_of(best, off.front());
        }
        return best;
    }

    std::vector<ColorSample> samples_of(const PaintedRegion& region, double spacing) const {
        stop_if_raised(cancel_);
        std::vector<ColorSample> samples;
        for (const DrawingPoint point : sample_points(region.rings, spacing))
            samples.push_back(sample_at(point));
        return samples;
    }

    ColorSample sample_at(DrawingPoint point) const {
        // Only where colours change fast is there a silhouette that asks for it.
        constexpr double fast = 3.0 / 255;
        const PointColor at = {point, field_(point)};
        if (tolerance_.at_border != tolerance_.within && near_border_.includes(point))
            if (ColorSample sample = color_sample(at, field_, tolerance_.at_border);
                sample.slack > fast)
                return sample;
        return color_sample(at, field_, tolerance_.within);
    }

    /// A point, and how far off the paint is there, slack or not.
    struct Place {
        DrawingPoint point;
        double error = 0;
    };

    /// Samples at some of the places where the paint does not fit: at none only if it fits
    /// everywhere. It is looked at in points so far apart; if it fits there, where it is steep in
    /// points a quarter of that apart, since what lies between two stops of very different colours
    /// is known at these alone; if it fits there too, in the worst places near to those where it is
    /// not far from that.
    std::vector<ColorSample> where_off(
        const FittedPaint& paint,
        const PaintedRegion& region,
        double spacing,
        std::uint64_t round) const {
        std::vector<Place> all;
        const auto look_at = [&](const std::vector<DrawingPoint>& points) {
            stop_if_raised(cancel_);
            const auto first = static_cast<std::ptrdiff_t>(all.size());
            for (const DrawingPoint point : points)
                all.push_back({point, error_of(paint, {point, field_(point)})});
            return samples_off(paint, std::span(all.begin() + first, all.end()));
        };
        std::vector<ColorSample> off = look_at(scattered_points(region.rings, spacing, round));
        if (off.empty() && paint.gradient && may_be_steep(*paint.gradient, spacing))
            off = look_at(steep_points(paint, region, spacing, round));
        if (off.empty())
            off = samples_off(paint, worst_places(paint, region, spacing, std::move(all)));
        return off;
    }

    /// Points a quarter of that apart where the paint is steep.
    static std::vector<DrawingPoint> steep_points(
        const FittedPaint& paint,
        const PaintedRegion& region,
        double spacing,
        std::uint64_t round) {
        constexpr double closest = 0.2; // pixels
        constexpr double part = 0.25;
        std::vector<DrawingPoint> points = scattered_points(
            region.rings, std::max(part * spacing, closest), most_rounds + 1 + round);
        std::erase_if(points, [&](DrawingPoint point) { return !is_steep(paint, point, spacing); });
        return points;
    }

    /// Samples at those places at which the paint is off, or at some of them: these tell the next
    /// fit as much.
    std::vector<ColorSample>
    samples_off(const FittedPaint& paint, std::span<const Place> places) const {
        // The slack of a sample, which takes three times as long, matters at few.
        std::vector<DrawingPoint> doubtful;
        for (const Place& place : places)
            if (place.error > tolerance_of_samples())
                doubtful.push_back(place.point);
        const std::size_t step = doubtful.size() / enough_off + 1;
        std::vector<ColorSample> off;
        for (std::size_t first = 0; first < step && off.empty(); ++first)
            for (std::size_t i = first; i < doubtful.size(); i += step) {
                const ColorSample sample = sample_at(doubtful[i]);
                if (error_of(paint, sample) > tolerance_of_samples())
                    off.push_back(sample);
            }
        return off;
    }

    /// The worst places near to those at which the paint is within the tolerance, but not by far.
    std::vector<Place> worst_places(
        const FittedPaint& paint,
        const PaintedRegion& region,
        double spacing,
        std::vector<Place> places) const {
        constexpr double much = 0.7; // of the tolerance
        std::erase_if(places, [&](const Place& place) {
            return place.error <= much * tolerance_.color || place.error > tolerance_of_samples();
        });
        if (places.empty())
            return places;
        const NearBorder border(region.rings);
        std::vector<Place> worst;
        for (const Place& place : worst_of_squares(std::move(places), spacing))
            worst.push_back(worst_nearby(paint, border, place, spacing));
        return worst;
    }

    /// Of the places in each square of that size the worst one.
    static std::vector<Place> worst_of_squares(std::vector<Place> places, double size) {
        const auto square_of = [&](const Place& place) {
            return std::pair(std::floor(place.point.y / size), std::floor(place.point.x / size));
        };
        std::ranges::stable_sort(places, std::greater<>{}, &Place::error);
        std::ranges::stable_sort(places, {}, square_of);
        const auto in_one = [&](const Place& a, const Place& b) {
            return square_of(a) == square_of(b);
        };
        places.erase(std::unique(places.begin(), places.end(), in_one), places.end());
        return places;
    }

    /// Goes to where the paint is farther off as long as there is such a place beside and it is
    /// within the tolerance, in smaller and smaller steps (Hooke and Jeeves 1961).
    Place worst_nearby(
        const FittedPaint& paint, const NearBorder& border, Place worst, double spacing) const {
        DrawingPoint along = paint.gradient ? paint.gradient->axis : DrawingPoint{1, 0};
        const double length = std::sqrt(along.x * along.x + along.y * along.y);
        along = {along.x / length, along.y / length};
        const DrawingPoint ways[] = {
            along, {-along.x, -along.y}, {-along.y, along.x}, {along.y, -along.x}};
        constexpr int most_moves = 8;
        for (double step = spacing / 2; step >= spacing / 8; step /= 2)
            for (int moves = 0; moves < most_moves; ++moves) {
                const DrawingPoint from = worst.point;
                for (const DrawingPoint way : ways) {
                    const DrawingPoint to = {from.x + step * way.x, from.y + step * way.y};
                    if (!border.encloses(to))
                        continue;
                    const double error = error_of(paint, {to, field_(to)});
                    if (error > worst.error)
                        worst = {to, error};
                }
                if (worst.error > tolerance_of_samples())
                    return worst;
                if (worst.point == from)
                    break;
            }
        return worst;
    }

    FittedPaint best_paint(std::span<const ColorSample> samples) const {
        stop_if_raised(cancel_);
        return best_fit(samples, tolerance_of_samples());
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
            worst =
                std::max(worst, part.empty() ? 1 : linear_fit(part, tolerance_of_samples()).error);
        return worst;
    }

    /// Where a part on one side of a cut goes on below the other one, which is painted later: a
    /// strip that begins on its own side of the cut, since if the two only met there, a gap might
    /// be left, as corners are rounded. It keeps as far from what was painted before the part as
    /// from the cut: at that edge of the other part, which is smoothed, it would come through.
    std::vector<BorderRing>
    strip_beyond(const std::vector<BorderRing>& rings, const HalfPlane& half) const {
        std::vector<BorderRing> strip =
            cut_rings(cut_rings(rings, moved(other_side(half), gap)), moved(half, overlap));
        for (const HalfPlane& rest : painted_beside_)
            strip = cut_rings(
                strip,
                {{half.normal.x + rest.normal.x, half.normal.y + rest.normal.y},
                 half.reach + rest.reach});
        return strip;
    }

    /// Neither its seams nor what goes on below others.
    static PaintedRegion uncut(const PaintedRegion& region) {
        PaintedRegion whole = unpainted(region);
        whole.rings = region.rings;
        return whole;
    }

    static PaintedRegion
    part_of(const PaintedRegion& region, const HalfPlane& half, const HalfPlane& half_below) {
        PaintedRegion part = unpainted(region);
        part.rings = cut_rings(region.rings, half);
        part.outline.seams = cut_lines(region.outline.seams, half);
        part.below = cut_rings(region.below, half_below);
        return part;
    }

    /// Nothing, with the region's names.
    static PaintedRegion unpainted(const PaintedRegion& region) {
        PaintedRegion nothing;
        nothing.outline.id = region.outline.id;
        nothing.outline.name = region.outline.name;
        nothing.outline.group = region.outline.group;
        return nothing;
    }

    void finish(PaintedRegion region, const FittedPaint& paint) {
        region.outline.color = paint.color;
        region.outline.gradient = paint.gradient;
        add_rings(region, curves_);
        painted_.push_back(std::move(region.outline));
    }

    NearBorder near_border_; ///< of the whole region
    const ColorField& field_;
    const PaintTolerance& tolerance_;
    std::span<const DrawingEllipse> curves_;
    const CancelFlag* cancel_;
    std::vector<FilledOutline> painted_;
    std::vector<HalfPlane> painted_beside_; ///< what the part lies in, earlier ones beyond it
};

} // namespace

void add_rings(PaintedRegion& region, std::span<const DrawingEllipse> curves) {
    for (const std::vector<BorderRing>* rings : {&region.rings, &region.below})
        for (const BorderRing& ring : *rings)
            add_ring(ring, curves, region.outline);
}

std::vector<FilledOutline> painted(
    PaintedRegion region,
    const ColorField& field,
    const PaintTolerance& tolerance,
    std::span<const DrawingEllipse> curves,
    const CancelFlag* cancel) {
    RegionPainter painter(region, field, tolerance, curves, cancel);
    painter.paint(std::move(region), 0);
    return painter.take();
}

} // namespace vera
