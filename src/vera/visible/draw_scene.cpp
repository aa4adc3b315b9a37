// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/draw_scene.h"

#include "vera/base/diagnostic.h"
#include "vera/base/progress_part.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/outline_fills.h"
#include "vera/visible/outline_strokes.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/projection.h"
#include "vera/visible/shadows.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
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

/// Makes the larger faces the sources, and leaves out the pieces that parted one of them.
void join_sources(
    ScreenScene& screen, VisiblePieces& pieces, const DrawnFaces& before, const DrawnFaces& after) {
    for (ScreenTriangle& triangle : screen.triangles)
        triangle.source = after.of_facet[before.first_facet[triangle.source]];
    const auto source = [&](std::uint32_t triangle) {
        return triangle == no_triangle ? no_source : screen.triangles[triangle].source;
    };
    std::erase_if(pieces.pieces, [&](const VisiblePiece& piece) {
        return source(piece.left) == source(piece.right) && piece.left_unlit == piece.right_unlit;
    });
}

bool has_shadows(const PictureSettings& picture, const DrawSettings& settings) {
    return has_fills(settings.style) ? picture.shadows && settings.style != DrawingStyle::ids
                                     : settings.shadow_lines;
}

/// Of the screen after shadows were added to it behind its surfaces.
SceneChange added_shadows(const ScreenScene& screen, std::size_t surfaces) {
    SceneChange change;
    change.triangles.resize(screen.triangles.size() - surfaces);
    std::iota(
        change.triangles.begin(), change.triangles.end(), static_cast<std::uint32_t>(surfaces));
    return change;
}

} // namespace

DrawnScene draw_scene(
    const Scene& scene,
    const Camera& camera,
    const PictureSettings& picture,
    const DrawSettings& settings,
    const Progress& progress,
    const CancelFlag* cancel) {
    const CameraMap camera_map(camera);
    const auto deviation = [&](Vec3 point) {
        return settings.deviation * camera_map.size_of_pixel(picture.width, picture.height, point);
    };
    const Facets all = facets(scene, deviation, cancel);
    if (settings.style == DrawingStyle::ids)
        check_numbers(all);
    // Shadows fall on plane faces; these become larger ones after.
    DrawnFaces faces = drawn_faces(
        scene,
        all,
        settings.style == DrawingStyle::ids ? FaceUnit::primitive : FaceUnit::plane,
        camera);
    ScreenScene screen = screen_scene(all, camera_map, faces.of_facet);
    sort_by_place(screen);
    DrawnScene drawn;
    drawn.facets = all.triangles.size();
    drawn.cut_nearness = screen.cut_nearness;
    const bool is_shadowed = has_shadows(picture, settings);
    const std::size_t steps = is_shadowed ? 3 : 1;
    WholePieces whole =
        whole_pieces(screen, progress_part(progress, 0, steps), cancel, settings.engine);
    drawn.cut_rounds = static_cast<std::size_t>(whole.rounds - 1);
    drawn.penetrating = whole.left;
    if (is_shadowed) {
        const std::size_t surfaces = screen.triangles.size();
        drawn.shadows = add_shadows(
            {scene,
             all,
             faces,
             camera,
             camera_map,
             static_cast<double>(picture.width),
             static_cast<double>(picture.height),
             whole.pieces},
            screen,
            progress_part(progress, 1, steps),
            cancel);
        drawn.lights_without_shadows =
            scene.lights.size() - std::min<std::size_t>(scene.lights.size(), most_lights_of_a_set);
        whole.pieces = cell_raster_after(
            added_shadows(screen, surfaces),
            std::move(whole.pieces),
            screen,
            progress_part(progress, 2, steps),
            cancel);
    }
    if (settings.style == DrawingStyle::shaded) {
        DrawnFaces smooth = drawn_faces(scene, all, FaceUnit::smooth, camera);
        join_sources(screen, whole.pieces, faces, smooth);
        faces = std::move(smooth);
    }
    const VisibleMap map = visible_map(screen, whole.pieces);
    if (settings.check)
        settings.check({map, primitives_of(all, faces), screen.cut_nearness});

    drawn.drawing.width = picture.width;
    drawn.drawing.height = picture.height;
    if (has_fills(settings.style))
        add_fills(
            {scene,
             camera,
             picture,
             all,
             faces,
             map,
             settings.style,
             {settings.color_tolerance, settings.deviation}},
            cancel,
            drawn.drawing);
    if (has_lines(settings.style))
        add_strokes(
            {scene,
             camera,
             camera_map,
             picture,
             all,
             faces,
             screen,
             whole.pieces,
             map,
             settings.deviation},
            {.hidden = settings.style == DrawingStyle::hidden_lines,
             .shadows = settings.shadow_lines},
            drawn.drawing);
    for (std::size_t i = 0; i < map.rings.size(); ++i)
        drawn.visible_faces += i == 0 || map.rings[i].source != map.rings[i - 1].source ? 1 : 0;
    return drawn;
}

} // namespace vera
