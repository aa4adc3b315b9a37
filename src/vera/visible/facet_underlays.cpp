// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/facet_underlays.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/visible/covered_areas.h"
#include "vera/visible/gradient_fit.h"
#include "vera/visible/region_light.h"

#include <cstddef>
#include <cstdint>
#include <utility>

namespace vera {

namespace {

/// With fewer regions a piece needs no underlay.
constexpr std::size_t few = 8;

/// The pieces that are seen, each by the number of its first face.
struct Pieces {
    std::vector<std::uint32_t> of_face;
    std::vector<std::size_t> region_counts; ///< of the piece that begins with the face
};

Pieces pieces_of(const FillSources& sources) {
    Pieces pieces;
    pieces.of_face.resize(sources.faces.first_facet.size());
    pieces.region_counts.resize(sources.faces.first_facet.size());
    const auto piece = [&](std::uint32_t face) {
        const Facets::Triangle& facet = sources.facets.triangles[sources.faces.first_facet[face]];
        return std::pair(facet.primitive, facet.piece);
    };
    std::uint32_t first = no_source;
    for (const VisibleMap::Region& region : sources.map.regions) {
        if (first == no_source || piece(region.source) != piece(first))
            first = region.source;
        pieces.of_face[region.source] = first;
        ++pieces.region_counts[first];
    }
    return pieces;
}

DrawingPoint middle_of(const BorderRing& ring) {
    DrawingPoint middle;
    for (const BorderPoint& point : ring) {
        middle.x += point.x / static_cast<double>(ring.size());
        middle.y += point.y / static_cast<double>(ring.size());
    }
    return middle;
}

} // namespace

std::vector<FilledOutline> facet_underlays(
    const FillSources& sources,
    const RegionOutlines& regions,
    const Progress& progress,
    const CancelFlag* cancel) {
    StageProgress stages(progress, 4);
    const Pieces pieces = pieces_of(sources);
    const CoveredAreas areas = covered_areas(regions.map(), pieces.of_face, stages.next(2), cancel);
    std::vector<std::vector<ColorSample>> samples(areas.outlines.size());
    const LongLoop loop(regions.count(), stages.next(1), cancel, 256);
    for (std::size_t i = 0; i < regions.count(); ++i) {
        loop.turn(i);
        const std::uint32_t face = regions.rings(i).front().source;
        if (pieces.region_counts[pieces.of_face[face]] < few)
            continue;
        const RegionLight light(
            sources.scene,
            sources.camera,
            sources.picture,
            sources.facets,
            sources.faces.first_facet[face],
            ~sources.map.regions[i].unlit);
        const DrawingPoint middle = middle_of(regions.borders(i).front());
        samples[areas.of_source[face]].push_back({middle, light(middle)});
    }
    std::vector<FilledOutline> underlays;
    const LongLoop of_areas(samples.size(), stages.next(1), cancel, 16);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        of_areas.turn(i);
        if (samples[i].size() < few)
            continue;
        const FittedPaint paint = best_fit(samples[i], sources.color_tolerance);
        FilledOutline& underlay = underlays.emplace_back();
        underlay.id = "underlay";
        underlay.color = paint.color;
        underlay.gradient = paint.gradient;
        for (const std::vector<std::uint32_t>& way : areas.outlines[i])
            regions.add_way(way, underlay);
    }
    return underlays;
}

} // namespace vera
