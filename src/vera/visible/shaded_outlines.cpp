// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/shaded_outlines.h"

#include "vera/base/long_loop.h"
#include "vera/shade/firmament.h"
#include "vera/visible/gradient_fit.h"
#include "vera/visible/region_paint.h"
#include "vera/visible/sky_outline.h"

#include <algorithm>
#include <iterator>
#include <memory>
#include <span>
#include <utility>

namespace vera {

namespace {

std::vector<FilledOutline> shaded_outline(LitOutline lit, const ShadedScene& shaded) {
    const RegionLight light(
        shaded.scene, shaded.camera, shaded.picture, shaded.facets, lit.facet, lit.lights);
    PaintTolerance tolerance = shaded.tolerance;
    if (!light.is_smooth()) // most borders of facets are none of the surface
        tolerance.at_border = tolerance.within;
    return painted(std::move(lit.region), light, tolerance, shaded.curves, shaded.cancel);
}

/// Where the rays of the picture go up.
HalfPlane above_horizon(const Camera& camera, const PictureSettings& picture) {
    const ViewRays rays(camera);
    if (rays.projection == Camera::Projection::parallel)
        return {{0, 0}, rays.origin_or_direction.y};
    return {
        {-rays.across.y / picture.width, rays.up.y / picture.height}, rays.corner.y + rays.up.y};
}

/// Whether the rings are the frame and nothing else.
bool is_whole(const std::vector<BorderRing>& rings, const BorderRing& frame) {
    return rings.size() == 1 && rings.front().size() == frame.size()
        && std::ranges::all_of(rings.front(), [&](DrawingPoint point) {
               return std::find(frame.begin(), frame.end(), point) != frame.end();
           });
}

} // namespace

std::vector<FilledOutline>
shaded_outlines(std::vector<LitOutline> outlines, const ShadedScene& shaded) {
    std::vector<std::vector<FilledOutline>> parts(outlines.size());
    long_parallel_loop(outlines.size(), shaded.progress, shaded.cancel, 16, [&](std::size_t i) {
        parts[i] = shaded_outline(std::move(outlines[i]), shaded);
    });
    std::size_t count = 0;
    for (const std::vector<FilledOutline>& of_one : parts)
        count += of_one.size();
    std::vector<FilledOutline> all;
    all.reserve(count);
    for (std::vector<FilledOutline>& of_one : parts)
        std::ranges::move(of_one, std::back_inserter(all));
    return all;
}

DrawnFirmament drawn_firmament(
    const Camera& camera,
    const PictureSettings& picture,
    const PaintTolerance& tolerance,
    const CancelFlag* cancel) {
    DrawnFirmament drawn;
    if (!picture.firmament)
        return drawn;
    const Firmament& firmament = *picture.firmament;
    const ViewRays rays(camera);
    const double width = picture.width;
    const double height = picture.height;
    const ColorField sky = [&](DrawingPoint point) {
        return clamped(sky_color(firmament, rays.ray(point.x / width, point.y / height).direction));
    };
    const std::vector<BorderRing> frame = {{{0, 0}, {width, 0}, {width, height}, {0, height}}};
    const HalfPlane above = above_horizon(camera, picture);
    const HalfPlane below = {{-above.normal.x, -above.normal.y}, -above.reach};
    PaintedRegion region;
    region.outline.id = "sky";
    region.outline.group =
        std::make_shared<const DrawingGroup>(DrawingGroup{.id = "sky", .name = "sky"});
    region.rings = firmament.profile ? sky_outline(camera, *firmament.profile, width, height)
                                     : cut_rings(frame, above);
    const bool shows_earth = firmament.profile ? !is_whole(region.rings, frame.front())
                                               : !cut_rings(frame, below).empty();
    if (!region.rings.empty())
        drawn.sky = painted(std::move(region), sky, tolerance, {}, cancel);
    if (shows_earth) {
        const ColorSample earth = {{}, firmament.earth};
        drawn.background = flat_fit({&earth, 1}).color;
    } else if (!drawn.sky.empty()) {
        drawn.background = drawn.sky.front().color;
        if (drawn.sky.size() == 1 && !drawn.sky.front().gradient)
            drawn.sky.clear();
    }
    return drawn;
}

} // namespace vera
