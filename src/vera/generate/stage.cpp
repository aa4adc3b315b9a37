// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/stage.h"

#include "vera/generate/scene_parts.h"
#include "vera/math/elementary.h"
#include "vera/scene/framing.h"
#include "vera/scene/support.h"

#include <fmt/format.h>

namespace vera {

namespace {

constexpr std::uint32_t picture_side = 800; ///< pixels
constexpr Color soft_light = {0.12, 0.12, 0.13};
constexpr std::uint32_t levels = 5;

/// The unit vector that leads to the viewer.
Vec3 towards_viewer(double azimuth_degrees, double elevation_degrees) {
    const double across = cos_degrees(elevation_degrees);
    return {
        sin_degrees(azimuth_degrees) * across,
        sin_degrees(elevation_degrees),
        cos_degrees(azimuth_degrees) * across};
}

/// The ball round the model's box.
struct Extent {
    Vec3 center;
    double radius = 0;
    double floor = 0; ///< the lowest y
};

/// By the surfaces themselves: boxes of subscenes within subscenes would be far too large.
Extent extent(const Scene& scene) {
    const SceneSupport support(scene);
    if (support.bounds().empty())
        return {};
    Vec3 lower;
    Vec3 upper;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Vec3 along;
        along[axis] = 1;
        lower[axis] = (*support.farthest_point(-along))[axis];
        upper[axis] = (*support.farthest_point(along))[axis];
    }
    return {0.5 * (lower + upper), 0.5 * length(upper - lower), lower.y};
}

Camera stage_camera(const Scene& scene, const Extent& model, const Stage& stage) {
    constexpr double viewing_distance = 4; // radii
    const Vec3 back = towards_viewer(stage.azimuth_degrees, stage.elevation_degrees);
    const Vec3 right = normalized(cross({0, 1, 0}, back));
    const Vec3 up = cross(back, right);
    Camera camera;
    camera.viewpoint = model.center + viewing_distance * model.radius * back;
    const Vec3 corner = model.center - model.radius * (right + up);
    camera.lower_left = corner;
    camera.lower_right = corner + 2 * model.radius * right;
    camera.upper_left = corner + 2 * model.radius * up;
    return reframed_camera(
        scene,
        camera,
        {.width = picture_side, .height = picture_side, .margin = stage.margin, .pixel_aspect = 1});
}

/// A light so many radii away, seen from the viewer to the side and above, that gives surfaces that
/// it faces so much.
PointLight stage_light(
    const Extent& model,
    const Stage& stage,
    double side_degrees,
    double elevation_degrees,
    double strength,
    Color color) {
    // The sun is far away.
    const double distance = stage.ground == Stage::Ground::meadow ? 150 : 8;
    const Vec3 direction = towards_viewer(stage.azimuth_degrees + side_degrees, elevation_degrees);
    const double away = distance * model.radius;
    return {
        model.center + away * direction, strength * away * away, color, Falloff::inverse_square};
}

/// A floor that bends up into a wall all round: no edge shows.
RotationalShape studio_room(const Extent& model) {
    const double floor_radius = 8 * model.radius;
    const double bend = 6 * model.radius;
    const double half = bend * (1 - cos_degrees(45));
    RotationalShape room;
    room.base = {model.center.x, model.floor, model.center.z};
    room.axis = {0, 1, 0};
    room.start = {0, 0};
    room.contour.push_back({.end = {floor_radius, 0}});
    // A quarter of a circle, as a conic with its control point where the tangents meet.
    room.contour.push_back(
        {.kind = ContourPiece::Kind::conic,
         .control = {{{floor_radius + bend, 0}}},
         .weight = cos_degrees(45),
         .end = {floor_radius + bend, bend}});
    room.contour.push_back({.end = {floor_radius + bend, 4 * bend + half}});
    return room;
}

/// A disc of grass below a dome that shines by itself.
void add_meadow(Scene& scene, const Extent& model) {
    const double reach = 200 * model.radius;
    const MaterialId grass = add_material(scene, "meadow", {0.24, 0.32, 0.12});
    scene.materials.back().sdi = {0.11, 0.15, 0.06};
    const MaterialId sky = add_material(scene, "sky", {});
    scene.materials.back().sdi = {0.66, 0.79, 0.94};
    RotationalShape ground;
    ground.base = {model.center.x, model.floor, model.center.z};
    ground.axis = {0, 1, 0};
    ground.contour.push_back({.end = {reach, 0}});
    RotationalShape dome = ground;
    dome.start = {reach, 0};
    dome.contour = {
        {.kind = ContourPiece::Kind::conic,
         .control = {{{reach, reach}}},
         .weight = cos_degrees(45),
         .end = {0, reach}}};
    add(scene.geometry, ground, grass);
    add(scene.geometry, dome, sky);
}

void add_ground(Scene& scene, const Extent& model, const Stage& stage) {
    if (stage.ground == Stage::Ground::meadow)
        return add_meadow(scene, model);
    const MaterialId room = add_material(scene, "room", {0.60, 0.61, 0.64});
    // The wall is far from the lights.
    scene.materials.back().sdi = {0.17, 0.18, 0.20};
    add(scene.geometry, studio_room(model), room);
}

} // namespace

Scene staged(Scene model, const std::string& name, const Stage& stage) {
    number_primitives(model);
    const Extent size = extent(model);
    Scene scene = std::move(model);
    scene.camera = stage_camera(scene, size, stage);
    scene.lights = {
        stage_light(size, stage, -40, 50, 0.72, {1, 0.97, 0.9}),
        stage_light(size, stage, 55, 30, 0.34, {0.85, 0.92, 1}),
        stage_light(size, stage, 150, 65, 0.25, {1, 1, 1}),
        stage_light(size, stage, 5, 25, 0.22, {1, 1, 1})};
    scene.geometry.name = name;
    scene.subscenes.push_back(std::move(scene.geometry));
    scene.geometry = {};
    const auto number = static_cast<std::uint32_t>(scene.subscenes.size() - 1);
    add_ground(scene, size, stage);
    const MaterialId shape = add_material(scene, "shape", stage.color);
    scene.materials.back().rab = {stage.mirror, stage.mirror, stage.mirror};
    scene.materials.back().spc = 0.96;
    add_call(scene.geometry, SubsceneId{number}, {}, shape);
    number_primitives(scene);
    return scene;
}

PictureSettings stage_settings() {
    PictureSettings settings;
    settings.width = picture_side;
    settings.height = picture_side;
    settings.depth = levels;
    settings.ambient = soft_light;
    return settings;
}

std::string stage_control_text() {
    const PictureSettings settings = stage_settings();
    return fmt::format(
        "RASTER {} {}\nRTDEPTH {}\nAMBIENT {} {} {}\nSHADOWS\nANTI-ALIAS\n",
        settings.width,
        settings.height,
        settings.depth,
        settings.ambient.r,
        settings.ambient.g,
        settings.ambient.b);
}

} // namespace vera
