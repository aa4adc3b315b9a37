// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/shaded_underlays.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/visible/covered_areas.h"
#include "vera/visible/gradient_fit.h"
#include "vera/visible/half_plane.h"
#include "vera/visible/region_light.h"
#include "vera/visible/without_cracks.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <span>
#include <utility>

namespace vera {

namespace {

/// Of one there is nothing to come through, but where it is cut (PaintedRegion::lies_on_underlay).
constexpr std::size_t least_regions = 2;

/// By how much an underlay may differ from the light in the middles of regions, 1 for 255. What
/// comes through of it is a quarter, where two edges share a pixel.
constexpr double rough = 8.0 / 255;

/// Up to which it is fitted: more stops would show nothing.
constexpr double fitted = 4.0 / 255;

DrawingPoint middle_of(const BorderRing& ring) {
    DrawingPoint middle;
    for (const BorderPoint& point : ring) {
        middle.x += point.x / static_cast<double>(ring.size());
        middle.y += point.y / static_cast<double>(ring.size());
    }
    return middle;
}

/// The longer side of the rectangle round the samples, as a unit vector.
DrawingPoint longer_side(std::span<const ColorSample> samples) {
    const auto extent = [&](double DrawingPoint::*axis) {
        const auto [least, most] = std::ranges::minmax(
            samples, {}, [&](const ColorSample& sample) { return sample.point.*axis; });
        return most.point.*axis - least.point.*axis;
    };
    return extent(&DrawingPoint::x) >= extent(&DrawingPoint::y) ? DrawingPoint{1, 0}
                                                                : DrawingPoint{0, 1};
}

/// Paints areas roughly as samples are: in one gradient, or cut between the samples, into parts
/// that have as many each. A part goes on below the next one by a pixel.
class UnderlayPainter {
public:
    UnderlayPainter(
        double tolerance, std::span<const DrawingEllipse> curves, const CancelFlag* cancel)
        : fitted_(std::max(fitted, tolerance))
        , rough_(std::max(rough, tolerance))
        , curves_(curves)
        , cancel_(cancel) {}

    /// Puts the samples in another order.
    void paint(const std::vector<BorderRing>& rings, std::span<ColorSample> samples) {
        stop_if_raised(cancel_);
        if (rings.empty())
            return;
        const FittedPaint best = best_fit(samples, fitted_);
        if (best.error <= rough_ || samples.size() < 2) {
            add(rings, best);
            return;
        }
        constexpr double overlap = 1; // pixels
        const DrawingPoint across = longer_side(samples);
        const auto way = [&](const ColorSample& sample) {
            return across.x * sample.point.x + across.y * sample.point.y;
        };
        std::ranges::stable_sort(samples, {}, way);
        const std::size_t half = samples.size() / 2;
        const double middle = 0.5 * (way(samples[half - 1]) + way(samples[half]));
        paint(cut_rings(rings, {across, middle + overlap}), samples.first(half));
        paint(cut_rings(rings, {{-across.x, -across.y}, -middle}), samples.subspan(half));
    }

    std::vector<FilledOutline> take() { return std::move(underlays_); }

private:
    void add(const std::vector<BorderRing>& rings, const FittedPaint& paint) {
        FilledOutline& underlay = underlays_.emplace_back();
        underlay.id = "underlay";
        underlay.color = paint.color;
        underlay.gradient = paint.gradient;
        for (const BorderRing& ring : rings)
            add_ring(ring, curves_, underlay);
    }

    double fitted_;
    double rough_;
    std::span<const DrawingEllipse> curves_;
    const CancelFlag* cancel_;
    std::vector<FilledOutline> underlays_;
};

/// The regions of each area, in their order.
class RegionsByArea {
public:
    RegionsByArea(const RegionOutlines& regions, const CoveredAreas& areas)
        : starts_(areas.outlines.size())
        , numbers_(regions.count()) {
        const auto area_of = [&](std::size_t region) {
            return areas.of_source[regions.rings(region).front().source];
        };
        for (std::size_t i = 0; i < regions.count(); ++i)
            ++starts_[area_of(i)];
        // Where each area ends, until all of its regions are in their places.
        std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
        for (std::size_t i = regions.count(); i-- > 0;)
            numbers_[--starts_[area_of(i)]] = static_cast<std::uint32_t>(i);
    }

    std::span<const std::uint32_t> of(std::size_t area) const {
        const std::size_t end = area + 1 < starts_.size() ? starts_[area + 1] : numbers_.size();
        return std::span(numbers_).subspan(starts_[area], end - starts_[area]);
    }

private:
    std::vector<std::uint32_t> starts_; ///< of the areas
    std::vector<std::uint32_t> numbers_;
};

} // namespace

ShadedUnderlays shaded_underlays(
    const FillSources& sources,
    const RegionOutlines& regions,
    const Progress& progress,
    const CancelFlag* cancel) {
    StageProgress stages(progress, 4);
    const CoveredAreas areas = covered_areas(regions.map(), stages.next(2), cancel);
    std::vector<PointColor> middles(regions.count());
    long_parallel_loop(regions.count(), stages.next(1), cancel, 64, [&](std::size_t i) {
        const std::uint32_t face = regions.rings(i).front().source;
        const RegionLight light(
            sources.scene,
            sources.camera,
            sources.picture,
            sources.facets,
            sources.faces.first_facet[face],
            ~sources.map.regions[i].unlit);
        const DrawingPoint middle = middle_of(regions.borders(i).front());
        middles[i] = {middle, light(middle)};
    });
    const RegionsByArea by_area(regions, areas);
    ShadedUnderlays all;
    all.has_one.resize(regions.count());
    for (std::size_t i = 0; i < areas.outlines.size(); ++i)
        for (const std::uint32_t number : by_area.of(i))
            all.has_one[number] = by_area.of(i).size() >= least_regions;
    std::vector<std::vector<FilledOutline>> underlays(areas.outlines.size());
    long_parallel_loop(underlays.size(), stages.next(1), cancel, 1, [&](std::size_t i) {
        const std::span<const std::uint32_t> numbers = by_area.of(i);
        if (numbers.size() < least_regions)
            return;
        std::vector<BorderRing> rings;
        for (const std::vector<std::uint32_t>& way : areas.outlines[i])
            if (BorderRing ring = without_cracks(regions.border(way)); !ring.empty())
                rings.push_back(std::move(ring));
        std::vector<ColorSample> samples;
        samples.reserve(numbers.size());
        for (const std::uint32_t number : numbers)
            samples.push_back({middles[number].point, middles[number].color});
        UnderlayPainter painter(sources.color_tolerance, regions.curves().all(), cancel);
        painter.paint(rings, samples);
        underlays[i] = painter.take();
    });
    for (std::vector<FilledOutline>& of_area : underlays)
        std::ranges::move(of_area, std::back_inserter(all.outlines));
    return all;
}

} // namespace vera
