// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/underlays.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/visible/covered_areas.h"
#include "vera/visible/without_cracks.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace vera {

namespace {

/// The colours of an area's regions, each as often as its own area is large.
struct ColorSum {
    double r = 0;
    double g = 0;
    double b = 0;
    double area = 0;
    std::size_t regions = 0;

    void add(DrawingColor color, double weight) {
        r += weight * color.r;
        g += weight * color.g;
        b += weight * color.b;
        area += weight;
        ++regions;
    }

    DrawingColor mean() const {
        const auto byte = [this](double value) {
            return static_cast<std::uint8_t>(
                std::clamp(std::floor(value / area + 0.5), 0.0, 255.0));
        };
        return {byte(r), byte(g), byte(b)};
    }
};

} // namespace

std::vector<FilledOutline> underlays(
    const RegionOutlines& regions,
    std::span<const DrawingColor> colors,
    const Progress& progress,
    const CancelFlag* cancel) {
    StageProgress stages(progress, 4);
    const CoveredAreas areas = covered_areas(regions.map(), stages.next(2), cancel);
    std::vector<ColorSum> sums(areas.outlines.size());
    const LongLoop loop(regions.count(), stages.next(1), cancel);
    for (std::size_t number = 0; number < regions.count(); ++number) {
        loop.turn(number);
        double area = 0;
        for (const VisibleMap::Ring& ring : regions.rings(number))
            area += doubled_area(regions.map(), ring);
        sums[areas.of_source[regions.rings(number).front().source]].add(colors[number], area);
    }
    std::vector<FilledOutline> result;
    const LongLoop of_areas(sums.size(), stages.next(1), cancel);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        of_areas.turn(i);
        if (sums[i].regions < 2 || sums[i].area <= 0)
            continue;
        FilledOutline& underlay = result.emplace_back();
        underlay.id = "underlay";
        underlay.color = sums[i].mean();
        for (const std::vector<std::uint32_t>& ring : areas.outlines[i])
            add_ring(without_cracks(regions.border(ring)), regions.curves().all(), underlay);
    }
    return result;
}

} // namespace vera
