// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/draw_scene.h"

#include "vera/base/diagnostic.h"
#include "vera/base/free_room.h"
#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/visible/drawing_memory.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/numbered_areas.h"
#include "vera/visible/outline_fills.h"
#include "vera/visible/outline_strokes.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/piece_lists.h"
#include "vera/visible/projection.h"
#include "vera/visible/shadowed_raster.h"
#include "vera/visible/shadows.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

namespace vera {

namespace {

void check_numbers(const Facets& facets) {
    constexpr std::uint64_t most = (std::uint64_t{1} << 24U) - 1;
    if (facets.triangles.empty() || facets.triangles.back().primitive < most)
        return;
    Diagnostic problem;
    problem.problem = "style ids can tell 16 777 215 primitives apart, and the scene has more";
    problem.remedy = "draw a part of it, or take another style";
    throw InputError({problem});
}

std::vector<std::uint64_t> primitives_of(const Facets& facets, const DrawnFaces& faces) {
    std::vector<std::uint64_t> primitives;
    for (const std::uint32_t facet : faces.first_facet)
        primitives.push_back(facets.triangles[facet].primitive);
    return primitives;
}

/// The primitives of faces that other ones began.
std::vector<JoinedPrimitive> joined_primitives(const Facets& facets, const DrawnFaces& faces) {
    std::vector<JoinedPrimitive> joined;
    for (std::size_t i = 0; i < faces.of_facet.size(); ++i) {
        const std::uint32_t face = faces.of_facet[i];
        const std::uint64_t primitive = facets.triangles[i].primitive;
        if (primitive != facets.triangles[faces.first_facet[face]].primitive)
            joined.push_back({face, primitive});
    }
    std::sort(joined.begin(), joined.end());
    return joined;
}

bool has_shadows(const Scene& scene, const PictureSettings& picture, const DrawSettings& settings) {
    if (scene.lights.empty())
        return false;
    return has_fills(settings.style) ? picture.shadows && settings.style != DrawingStyle::ids
                                     : settings.shadow_lines;
}

/// How long the stages of a drawing take, about, by what seeing without shadows takes.
struct StageTimes {
    double facets = 0.2;
    double seeing = 1;
    double shadows = 0;
    double seeing_shadows = 0;
    double map = 0.3;
    double check = 0;
    double fills = 0;
    double lines = 0;

    double sum() const {
        return facets + seeing + shadows + seeing_shadows + map + check + fills + lines;
    }
};

StageTimes
stage_times(const Scene& scene, const PictureSettings& picture, const DrawSettings& settings) {
    StageTimes times;
    if (has_shadows(scene, picture, settings)) {
        times.shadows =
            static_cast<double>(std::min<std::size_t>(scene.lights.size(), most_lights_of_a_set));
        times.seeing_shadows = 1;
    }
    if (settings.check)
        times.check = 1;
    if (has_fills(settings.style))
        times.fills = settings.style == DrawingStyle::shaded ? 4 : 0.5;
    if (has_lines(settings.style))
        times.lines = 0.5;
    return times;
}

/// What is to be drawn, and what all stages have in common.
struct Request {
    const Scene& scene;
    Scene* given; ///< the same, where it need not be kept; or null
    const Camera& camera;
    const PictureSettings& picture;
    const DrawSettings& settings;
    const StageTimes times;
    const CameraMap camera_map;
    StageProgress stages;
    const CancelFlag* cancel;

    bool is_in_numbers() const { return settings.style == DrawingStyle::ids; }

    Progress next_stage(double time) {
        stop_if_raised(cancel);
        return stages.next(time);
    }

    /// Refuses a drawing that would not fit into memory.
    ExpectPieces
    expect_pieces(const ScreenScene& screen, double curved_part, std::size_t shadows = 0) const {
        return [&screen, curved_part, shadows, this](double pieces) {
            ScreenCounts counts = counts_of(screen);
            counts.shadows = shadows;
            counts.curved =
                static_cast<std::size_t>(curved_part * static_cast<double>(counts.surfaces));
            require_drawing_memory(pieces, counts, settings.style, settings.outlines);
        };
    }
};

/// A scene on the screen, and what is seen of it.
struct SeenScene {
    Facets facets;
    DrawnFaces faces;
    /// Of the faces, in style ids alone: all else of facets and faces is forgotten there, since
    /// what is seen needs their room.
    std::vector<std::uint64_t> primitives;
    std::size_t facet_count = 0;
    double curved_part = 0; ///< of the facets, about
    ScreenScene screen;     ///< whose sources are the faces
    ScreenScene uncut; ///< the same before what penetrates was cut, where hidden lines are drawn
    WholePieces whole;
};

SeenScene seen_scene(Request& request) {
    const PictureSettings& picture = request.picture;
    request.next_stage(request.times.facets);
    SeenScene seen;
    const bool throws_shadows = has_shadows(request.scene, picture, request.settings);
    const Deviation deviation = deviation_in_pixels(
        request.camera_map,
        picture.width,
        picture.height,
        request.settings.deviation,
        throws_shadows ? FacetReach::throwing : FacetReach::seen);
    // In style ids the scene may be gone before the facets.
    seen.facets = facets(
        request.scene,
        deviation,
        request.cancel,
        request.is_in_numbers() ? MeshCorners::copied : MeshCorners::shared);
    seen.facet_count = seen.facets.triangles.size();
    seen.curved_part = curved_part_of(seen.facets);
    if (request.is_in_numbers())
        check_numbers(seen.facets);
    // Shadows fall on plane faces; these become larger ones after.
    seen.faces = drawn_faces(
        request.scene,
        seen.facets,
        request.is_in_numbers() ? FaceUnit::primitive : FaceUnit::plane,
        request.camera,
        request.cancel);
    if (request.is_in_numbers()) {
        seen.primitives = primitives_of(seen.facets, seen.faces);
        if (request.given != nullptr && !request.settings.check)
            *request.given = {};
    }
    seen.screen = screen_scene(
        seen.facets,
        request.camera_map,
        seen.faces.of_facet,
        std::numeric_limits<double>::infinity(),
        request.cancel);
    if (request.is_in_numbers()) {
        seen.facets = {};
        seen.faces = {};
    }
    sort_by_place(seen.screen, request.cancel);
    if (request.settings.style == DrawingStyle::hidden_lines)
        seen.uncut = seen.screen;
    seen.whole = whole_pieces(
        seen.screen,
        request.next_stage(request.times.seeing),
        request.cancel,
        request.settings.engine,
        request.expect_pieces(seen.screen, seen.curved_part));
    return seen;
}

/// Adds the borders of shadows to what is seen.
ShadowCounts see_shadows(Request& request, SeenScene& seen) {
    ThrownShadows thrown(
        {request.scene,
         seen.facets,
         seen.faces,
         request.camera,
         request.camera_map,
         static_cast<double>(request.picture.width),
         static_cast<double>(request.picture.height),
         seen.whole.pieces},
        seen.screen,
        request.next_stage(request.times.shadows),
        request.cancel);
    ShadowCounts counts = thrown.counts();
    const ExpectPieces expect =
        request.expect_pieces(seen.screen, seen.curved_part, thrown.count());
    ShadowedPieces shadowed = shadowed_cell_raster(
        seen.screen,
        std::move(seen.whole.pieces),
        std::move(thrown),
        request.next_stage(request.times.seeing_shadows),
        request.cancel,
        expect);
    seen.whole.pieces = std::move(shadowed.pieces);
    counts.shadows = shadowed.shadows;
    return counts;
}

/// Numbers are of each triangle by itself.
void join_faces(const Request& request, SeenScene& seen) {
    if (request.is_in_numbers())
        return;
    DrawnFaces joined = drawn_faces(
        request.scene,
        seen.facets,
        request.settings.style == DrawingStyle::shaded ? FaceUnit::smooth : FaceUnit::flat,
        request.camera,
        request.cancel);
    if (joined.first_facet.size() == seen.faces.first_facet.size())
        return;
    join_sources(seen.screen, seen.whole.pieces, seen.faces, joined);
    join_sources(seen.uncut, seen.faces, joined);
    seen.faces = std::move(joined);
}

/// What a drawing is made of that was made for it alone.
struct KeptForDrawing {
    CameraMap camera_map;
    Facets facets;
    DrawnFaces faces;
    VisibleMap map;
};

/// Takes apart what is seen.
Drawing painted(Request& request, SeenScene& seen, VisibleMap map) {
    const DrawSettings& settings = request.settings;
    Drawing drawing;
    drawing.width = request.picture.width;
    drawing.height = request.picture.height;
    if (request.is_in_numbers()) {
        request.next_stage(request.times.fills);
        drawing.background = color_of_number(0);
        drawing.areas =
            numbered_areas(std::move(map), seen.primitives, request.picture, request.cancel);
        return drawing;
    }
    give_back_freed_memory();
    const auto kept = std::make_shared<KeptForDrawing>(KeptForDrawing{
        request.camera_map, std::move(seen.facets), std::move(seen.faces), std::move(map)});
    const MapSources sources = {
        request.scene,
        request.camera,
        kept->camera_map,
        request.picture,
        kept->facets,
        kept->faces,
        kept->map,
        settings.deviation};
    // First, as they are made of more, which is forgotten then.
    if (has_lines(settings.style))
        add_strokes(
            {sources, std::move(seen.screen), std::move(seen.whole.pieces), std::move(seen.uncut)},
            {.hidden = settings.style == DrawingStyle::hidden_lines,
             .shadows = settings.shadow_lines},
            request.next_stage(request.times.lines),
            request.cancel,
            drawing);
    if (has_fills(settings.style)) {
        const FillSources of_fills = {
            sources, settings.style, settings.color_tolerance, &kept->map};
        const Progress progress = request.next_stage(request.times.fills);
        if (settings.outlines == FaceOutlines::later)
            add_later_fills(of_fills, kept, progress, request.cancel, drawing);
        else
            add_fills(of_fills, progress, request.cancel, drawing);
    }
    free_room(kept->map.vertices);
    if (settings.style != DrawingStyle::shaded) {
        kept->facets = {};
        kept->faces = {};
    }
    give_back_freed_memory(); // what was freed in small blocks, before there is the text
    return drawing;
}

std::size_t count_seen_faces(const VisibleMap& map) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < map.rings.size(); ++i)
        count += i == 0 || map.rings[i].source != map.rings[i - 1].source ? 1 : 0;
    return count;
}

/// What is seen as regions. The pieces are kept where lines are drawn of them, and the screen too.
/// In style ids nothing asks what is seen across a ring, but for the check.
VisibleMap map_of(const Request& request, SeenScene& seen, const Progress& progress) {
    if (has_lines(request.settings.style)) { // which ask for faces alone, not for lights
        join_along_edges(seen.whole.pieces); // lines are made of pieces
        return visible_map_with_points_of(seen.whole.pieces, seen.screen, progress, request.cancel);
    }
    const bool asks_across = !request.is_in_numbers() || request.settings.check;
    return visible_map(
        std::move(seen.screen),
        std::move(seen.whole.pieces),
        asks_across ? RingDetail::with_across : RingDetail::without_across,
        progress,
        request.cancel);
}

DrawnScene drawn_scene(Request request) {
    const DrawSettings& settings = request.settings;
    const std::size_t lights = request.scene.lights.size();
    SeenScene seen = seen_scene(request);
    DrawnScene drawn;
    drawn.facets = seen.facet_count;
    drawn.cut_nearness = seen.screen.cut_nearness;
    drawn.cut_rounds = static_cast<std::size_t>(seen.whole.rounds - 1);
    drawn.penetrating = seen.whole.left;
    const bool with_shadows = has_shadows(request.scene, request.picture, settings);
    if (with_shadows) {
        drawn.shadows = see_shadows(request, seen);
        drawn.lights_without_shadows = lights - std::min<std::size_t>(lights, most_lights_of_a_set);
    }
    const Progress of_map = request.next_stage(request.times.map);
    join_faces(request, seen);
    give_back_freed_memory();
    VisibleMap map = map_of(request, seen, of_map);
    drawn.visible_faces = count_seen_faces(map);
    // At borders of shadows surfaces part what is seen along lines a step from each other: there a
    // long way is off by no more than that.
    if (!with_shadows)
        drawn.longest_join = map.longest_join / screen_size
            * static_cast<double>(std::max(request.picture.width, request.picture.height));
    if (settings.check)
        settings.check(
            {map,
             request.is_in_numbers() ? seen.primitives : primitives_of(seen.facets, seen.faces),
             drawn.cut_nearness,
             joined_primitives(seen.facets, seen.faces)},
            request.next_stage(request.times.check));
    drawn.drawing = painted(request, seen, std::move(map));
    request.next_stage(0); // tells that all are done
    return drawn;
}

Request request_for(
    const Scene& scene,
    Scene* given,
    const Camera& camera,
    const PictureSettings& picture,
    const DrawSettings& settings,
    const Progress& progress,
    const CancelFlag* cancel) {
    const StageTimes times = stage_times(scene, picture, settings);
    return {
        scene,
        given,
        camera,
        picture,
        settings,
        times,
        CameraMap(camera),
        StageProgress(progress, times.sum()),
        cancel};
}

} // namespace

DrawnScene draw_scene(
    const Scene& scene,
    const Camera& camera,
    const PictureSettings& picture,
    const DrawSettings& settings,
    const Progress& progress,
    const CancelFlag* cancel) {
    return drawn_scene(request_for(scene, nullptr, camera, picture, settings, progress, cancel));
}

DrawnScene draw_scene(
    Scene&& scene,
    const Camera& camera,
    const PictureSettings& picture,
    const DrawSettings& settings,
    const Progress& progress,
    const CancelFlag* cancel) {
    return drawn_scene(request_for(scene, &scene, camera, picture, settings, progress, cancel));
}

} // namespace vera
