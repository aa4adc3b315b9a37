// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/outline_fills.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/scene/item_names.h"
#include "vera/scene/surface.h"
#include "vera/visible/drawn_borders.h"
#include "vera/visible/face_color.h"
#include "vera/visible/region_outlines.h"
#include "vera/visible/shaded_outlines.h"
#include "vera/visible/shaded_underlays.h"
#include "vera/visible/trapping.h"
#include "vera/visible/underlays.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace vera {

namespace {

/// Of the item that holds the primitive: what it is, and where it was written.
std::string group_name(const Scene& scene, std::uint64_t primitive) {
    const PrimitivePath path = path_to(scene, primitive);
    const Item& item = path.geometry->items[path.element.item];
    std::string name = name_of(item.kind);
    if (!path.geometry->name.empty())
        name += " of " + path.geometry->name;
    return item.line == 0 ? name : name + ", line " + std::to_string(item.line);
}

/// Gives outlines the ids and groups of what they show.
class OutlineNames {
public:
    explicit OutlineNames(const Scene& scene)
        : scene_(scene) {}

    void name(std::uint64_t primitive, FilledOutline& outline) {
        if (group_.empty() || primitive != grouped_)
            group_ = group_name(scene_, primitive);
        grouped_ = primitive;
        outline.id = "face-" + std::to_string(primitive + 1);
        outline.group = group_;
    }

private:
    const Scene& scene_;
    std::uint64_t grouped_ = 0; ///< the primitive whose group the last one was
    std::string group_;
};

std::uint32_t facet_of(const FillSources& sources, const RegionOutlines& regions, std::size_t i) {
    return sources.faces.first_facet[regions.rings(i).front().source];
}

/// The firmament and, on it, the outlines as the light shades them.
void add_shaded(
    const FillSources& sources,
    const RegionOutlines& regions,
    const Progress& progress,
    const CancelFlag* cancel,
    Drawing& drawing) {
    StageProgress stages(progress, 10);
    OutlineNames names(sources.scene);
    std::vector<LitOutline> lit(regions.count());
    const LongLoop loop(regions.count(), stages.next(1), cancel, 16);
    for (std::size_t i = 0; i < regions.count(); ++i) {
        loop.turn(i);
        const std::uint32_t facet = facet_of(sources, regions, i);
        PaintedRegion region;
        names.name(sources.facets.triangles[facet].primitive, region.outline);
        region.rings = regions.borders(i);
        cover_seams_closely(regions, i, region);
        lit[i] = {std::move(region), facet, ~sources.map.regions[i].unlit};
    }
    const PaintTolerance tolerance = {sources.color_tolerance, sources.deviation};
    DrawnFirmament firmament = drawn_firmament(sources.camera, sources.picture, tolerance, cancel);
    drawing.background = firmament.background;
    drawing.fills = std::move(firmament.sky);
    std::ranges::move(
        shaded_underlays(sources, regions, lit, stages.next(1), cancel),
        std::back_inserter(drawing.fills));
    std::ranges::move(
        shaded_outlines(
            std::move(lit),
            {sources.scene,
             sources.camera,
             sources.picture,
             sources.facets,
             tolerance,
             regions.curves().all(),
             stages.next(8),
             cancel}),
        std::back_inserter(drawing.fills));
}

std::vector<DrawingColor> colors_of(
    const FillSources& sources,
    const RegionOutlines& regions,
    const Progress& progress,
    const CancelFlag* cancel) {
    std::vector<DrawingColor> colors(regions.count());
    long_parallel_loop(regions.count(), progress, cancel, 256, [&](std::size_t i) {
        colors[i] = region_color(sources, regions.rings(i));
    });
    return colors;
}

/// The outlines in one colour each, on underlays.
void add_flat(
    const FillSources& sources,
    const RegionOutlines& regions,
    const Progress& progress,
    const CancelFlag* cancel,
    Drawing& drawing) {
    StageProgress stages(progress, 10);
    OutlineNames names(sources.scene);
    const std::vector<float> widths = widths_of_regions(regions, stages.next(1), cancel);
    const std::vector<DrawingColor> colors = colors_of(sources, regions, stages.next(2), cancel);
    std::vector<FilledOutline> fills(regions.count());
    for (std::size_t i = 0; i < regions.count(); ++i) {
        fills[i].color = colors[i];
        names.name(sources.facets.triangles[facet_of(sources, regions, i)].primitive, fills[i]);
    }
    long_parallel_loop(regions.count(), stages.next(3), cancel, 256, [&](std::size_t i) {
        PaintedRegion region = {std::move(fills[i]), regions.borders(i), {}};
        cover_seams(regions, widths, colors, i, region);
        add_rings(region, regions.curves().all());
        fills[i] = std::move(region.outline);
    });
    drawing.fills = underlays(regions, fills, stages.next(4), cancel);
    drawing.fills.reserve(drawing.fills.size() + fills.size());
    std::ranges::move(fills, std::back_inserter(drawing.fills));
}

} // namespace

void add_fills(
    const FillSources& sources,
    const Progress& progress,
    const CancelFlag* cancel,
    Drawing& drawing) {
    drawing.background = background_color(sources);
    StageProgress stages(progress, 10);
    const RegionOutlines regions(sources.map, curved_borders(sources, stages.next(1), cancel));
    const Progress of_fills = stages.next(9);
    if (sources.style == DrawingStyle::shaded)
        add_shaded(sources, regions, of_fills, cancel, drawing);
    else
        add_flat(sources, regions, of_fills, cancel, drawing);
}

} // namespace vera
