// SPDX-License-Identifier: Apache-2.0
#include "drawing_verification.h"

#include "vera/base/diagnostic.h"
#include "vera/base/progress_part.h"
#include "vera/scene/item_names.h"
#include "vera/scene/surface.h"
#include "vera/visible/map_check.h"

#include <string>

#include "scene_index.h"
#include "stopwatch.h"
#include <fmt/format.h>

namespace vera {

namespace {

/// "face 7 (sphere, line 5)"
std::string thing_text(const Scene& scene, std::uint64_t primitive) {
    if (primitive == no_primitive)
        return "the background";
    const PrimitivePath path = path_to(scene, primitive);
    const Item& item = path.geometry->items[path.element.item];
    return fmt::format(
        "face {} ({}{})",
        primitive + 1,
        name_of(item.kind),
        item.line == 0 ? "" : fmt::format(", line {}", item.line));
}

[[noreturn]] void refuse(const Scene& scene, const MapCheck& check) {
    const MapDifference& first = *check.first_far;
    Diagnostic problem;
    if (!scene.files.empty())
        problem.place.file = scene.files.front();
    problem.problem = fmt::format(
        "the drawing is not what rays see, at {} of {} points: at pixel ({:.3f}, {:.3f}) it shows "
        "{}{}, and a ray sees {}",
        check.far,
        check.points,
        first.x,
        first.y,
        thing_text(scene, first.drawn),
        first.is_sound ? "" : " and more than that",
        thing_text(scene, first.traced));
    problem.remedy = "nothing was written; another --deviation or --raster may help, and a report "
                     "of this with the scene would";
    throw InputError({problem});
}

} // namespace

std::function<void(const PrimitiveMap&, const Progress&)> verification(
    std::size_t points,
    double deviation,
    const PreparedScene& prepared,
    const Console& console,
    DrawReport& report) {
    return [=, &prepared, &console, &report](const PrimitiveMap& map, const Progress& progress) {
        Stopwatch watch;
        StageProgress stages(progress, 2);
        const MapCheckSettings settings = {
            points,
            static_cast<double>(prepared.settings.width),
            static_cast<double>(prepared.settings.height),
            deviation};
        const auto index = scene_index(prepared.scene, {}, stages.next(1), console.cancel);
        report.check = check_map(
            map,
            prepared.scene,
            prepared.camera,
            *index,
            settings,
            stages.next(1),
            &console.cancel);
        report.verify_seconds = watch.lap();
        if (report.check.far > 0)
            refuse(prepared.scene, report.check);
    };
}

} // namespace vera
