// SPDX-License-Identifier: Apache-2.0
#include "visible/drawn_shadows.h"

#include "vera/visible/penetrations.h"

#include "accel/random_scene.h"
#include "visible/map_turns.h"

namespace vera::testing {

DrawnShadows drawn_shadows(const Scene& scene, const Camera& camera) {
    const CameraMap map(camera);
    DrawnShadows drawn;
    drawn.facets = facets(scene, [](Vec3) { return 1.0; });
    drawn.faces = drawn_faces(scene, drawn.facets, FaceUnit::plane, camera);
    drawn.screen = screen_scene(drawn.facets, map, drawn.faces.of_facet);
    const WholePieces whole = whole_pieces(drawn.screen);
    drawn.without = visible_map(drawn.screen, whole.pieces);
    drawn.counts = add_shadows(
        {scene, drawn.facets, drawn.faces, camera, map, 512, 512, whole.pieces}, drawn.screen);
    drawn.map = visible_map(drawn.screen, cell_raster(drawn.screen));
    return drawn;
}

Scene scene_of_planes(std::uint64_t seed, double scale) {
    RandomSceneSettings settings;
    settings.items = 4 + seed % 4 * 5;
    settings.curved = false;
    settings.scale = scale;
    Scene scene = random_scene(seed, settings);
    scene.lights = {
        {.position = scale * Vec3{5.1, 3.2, 9.3}},
        {.position = scale * Vec3{0.31, -0.213, 0.737}},
        {.position = scale * Vec3{-4.07, -4.11, 2.03}}};
    return scene;
}

std::optional<VisibleMap::Region> region_at(const VisibleMap& map, double x, double y) {
    const auto turns = turns_about(map, x, y);
    if (turns.size() != 1)
        return std::nullopt;
    return map.regions[turns.begin()->first];
}

} // namespace vera::testing
