// SPDX-License-Identifier: Apache-2.0
#include "scenes.h"

#include "vera/base/check.h"
#include "vera/base/diagnostic.h"
#include "vera/formats/mesh_file.h"
#include "vera/formats/read_scene.h"
#include "vera/scene/framing.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <utility>

#include "meshes.h"
#include "round_shapes.h"

namespace vera {

namespace {

std::filesystem::path
folder_of_environment(const char* variable, const std::filesystem::path& usual) {
    const char* const value = std::getenv(variable);
    return value != nullptr ? std::filesystem::path(value) : usual;
}

/// A square picture of what lies round the target, from the eye; half_field is half its width at
/// the distance 1.
Camera camera_at(Vec3 eye, Vec3 target, double half_field, Vec3 up = {0, 1, 0}) {
    const Vec3 forward = normalized(target - eye);
    const Vec3 right = half_field * normalized(cross(forward, up));
    const Vec3 upward = half_field * normalized(cross(right, forward));
    Camera camera;
    camera.viewpoint = eye;
    camera.lower_left = eye + forward - right - upward;
    camera.lower_right = eye + forward + right - upward;
    camera.upper_left = eye + forward - right + upward;
    return camera;
}

/// Adds the item that the last thing of a kind is.
void add_item(Scene& scene, ItemKind kind, std::size_t count) {
    Item item;
    item.kind = kind;
    item.index = static_cast<std::uint32_t>(count - 1);
    scene.geometry.items.push_back(item);
}

Scene scene_of(Mesh mesh) {
    round_to_floats(mesh);
    Scene scene;
    scene.geometry.meshes.push_back(std::move(mesh));
    add_item(scene, ItemKind::mesh, 1);
    number_primitives(scene);
    return scene;
}

Scene seen_from(Scene scene, const Camera& camera, Vec3 light) {
    scene.camera = camera;
    scene.lights.push_back({light, 1, {1, 1, 1}, Falloff::none});
    return scene;
}

Scene scene_of(Mesh mesh, const Camera& camera, Vec3 light) {
    return seen_from(scene_of(std::move(mesh)), camera, light);
}

Scene scene_of(const std::vector<Sphere>& spheres) {
    Scene scene;
    for (const Sphere& sphere : spheres) {
        scene.geometry.spheres.push_back(sphere);
        add_item(scene, ItemKind::sphere, scene.geometry.spheres.size());
    }
    number_primitives(scene);
    return scene;
}

std::optional<Mesh> model(const char* name) {
    const auto path = folder_of_environment("VERA_MODELS", "../shared/models") / name;
    if (!std::filesystem::exists(path))
        return std::nullopt;
    std::vector<Diagnostic> warnings;
    return read_mesh(path, warnings);
}

std::optional<Scene> bunny(BenchSize) {
    auto mesh = model("stanford-bunny.obj");
    if (!mesh)
        return std::nullopt;
    Scene scene = scene_of(std::move(*mesh));
    scene.camera = framed_camera(scene, {});
    scene.lights = default_lights(scene, *scene.camera);
    return scene;
}

Camera camera_at_flake() {
    return camera_at({2.1, 1.3, 1.7}, {0, 0, 0.06}, 0.34, {0, 0, 1});
}

Scene flake(const Sphereflake& size) {
    return scene_of(tessellated(size), camera_at_flake(), {4, 3, 2});
}

std::optional<Scene> hall(BenchSize size) {
    return scene_of(
        hall_mesh(size == BenchSize::full ? 128 : 24),
        camera_at({-28, 5, -9}, {10, 6, 6}, 0.7),
        {2.5, 14, 3});
}

std::optional<Scene> stadium(BenchSize size) {
    const auto teapot = model("teapot.obj");
    if (!teapot)
        return std::nullopt;
    Mesh mesh = stadium_mesh(size == BenchSize::full ? 2000 : 200);
    const Vec3 place = {3, 0, 2};
    add_model(mesh, *teapot, 0.3, place);
    const Vec3 middle = place + Vec3{0, 0.09, 0};
    return scene_of(
        std::move(mesh), camera_at(middle + Vec3{0.2, 0.07, 0.5}, middle, 0.4), {40, 50, 30});
}

Scene mountain(std::size_t side) {
    return scene_of(
        mountain_mesh(side), camera_at({0.4, 1.1, 1.9}, {0.05, 0.05, 0.05}, 0.36), {2, 1.5, 0.5});
}

std::optional<Scene> tree(BenchSize size) {
    return scene_of(
        tree_mesh(size == BenchSize::full ? 9 : 6),
        camera_at({8, 7, 16}, {0, 5, 0}, 0.36),
        {15, 25, 10});
}

std::optional<Scene> standard_scene(const char* name) {
    const auto path = folder_of_environment("VERA_SCENES", "../shared/scenes") / "spd" / name;
    if (!std::filesystem::exists(path))
        return std::nullopt;
    Scene scene = read_scene(path).scene;
    for (Material& material : scene.materials)
        material.tab = {}; // any surface hides the light
    return scene;
}

/// Without what is no sphere, as the floor of balls_4: spheres are compared with spheres.
std::optional<Scene> spheres_of_standard_scene(const char* name) {
    std::optional<Scene> scene = standard_scene(name);
    if (scene) {
        std::erase_if(
            scene->geometry.items, [](const Item& item) { return item.kind != ItemKind::sphere; });
        number_primitives(*scene);
    }
    return scene;
}

std::optional<Scene> balls(BenchSize size) {
    return seen_from(
        scene_of(flake_spheres(size == BenchSize::full ? 5 : 3)), camera_at_flake(), {4, 3, 2});
}

std::optional<Scene> shells(BenchSize size) {
    return seen_from(
        scene_of(shell_spheres(size == BenchSize::full ? 8 : 5)),
        camera_at({-6, -60, 35}, {0, 8, -15}, 0.41, {0, 0, 1}),
        {-100, -100, 100});
}

std::optional<Scene> goblets(BenchSize size) {
    const std::size_t side = size == BenchSize::full ? 7 : 3;
    Scene scene;
    for (const RotationalShape& shape : goblet_shapes(side)) {
        scene.geometry.rotational_shapes.push_back(shape);
        add_item(scene, ItemKind::rotational_shape, scene.geometry.rotational_shapes.size());
    }
    const auto reach = static_cast<double>(side);
    scene.geometry.triangles = {
        {{Vec3{-reach, 0, -reach}, Vec3{-reach, 0, reach}, Vec3{reach, 0, reach}}},
        {{Vec3{-reach, 0, -reach}, Vec3{reach, 0, reach}, Vec3{reach, 0, -reach}}}};
    add_item(scene, ItemKind::triangle, 1);
    add_item(scene, ItemKind::triangle, 2);
    number_primitives(scene);
    return seen_from(
        std::move(scene),
        camera_at({0.6 * reach, 0.6 * reach, 0.9 * reach}, {0, 0.5, 0}, 0.4),
        {0.5 * reach, 1.5 * reach, 0.2 * reach});
}

/// How a scene is made, and whether it is measured unless another is named.
struct Recipe {
    const char* name;
    BenchSceneKind kind;
    bool usual;
    std::function<std::optional<Scene>(BenchSize)> make;
};

const std::vector<Recipe>& recipes() {
    using enum BenchSceneKind;
    static const std::vector<Recipe> all = {
        {"bunny", triangles, true, bunny},
        {"flake",
         triangles,
         true,
         [](BenchSize size) -> std::optional<Scene> {
             return flake({size == BenchSize::full ? 4U : 2U, 2});
         }},
        {"hall", triangles, true, hall},
        {"stadium", triangles, true, stadium},
        {"mountain",
         triangles,
         true,
         [](BenchSize size) -> std::optional<Scene> {
             return mountain(size == BenchSize::full ? 512 : 64);
         }},
        {"tree", triangles, true, tree},
        {"balls_4",
         spheres,
         true,
         [](BenchSize) { return spheres_of_standard_scene("balls_4.nff"); }},
        {"balls_5", spheres, true, balls},
        {"shells_5",
         spheres,
         true,
         [](BenchSize) { return spheres_of_standard_scene("shells_5.nff"); }},
        {"shells_8", spheres, true, shells},
        {"goblets", rotational, true, goblets},
        {"flake_large", triangles, false, [](BenchSize size) -> std::optional<Scene> {
             return flake({size == BenchSize::full ? 5U : 3U, 2});
         }}};
    return all;
}

} // namespace

const char* name_of(BenchSceneKind kind) {
    switch (kind) {
    case BenchSceneKind::triangles:
        return "triangles";
    case BenchSceneKind::spheres:
        return "spheres";
    case BenchSceneKind::rotational:
        return "rotational shapes";
    }
    VERA_CHECK(false);
    return "";
}

std::vector<std::string> bench_scene_names() {
    std::vector<std::string> names;
    for (const Recipe& recipe : recipes())
        names.emplace_back(recipe.name);
    return names;
}

std::vector<std::string> usual_bench_scene_names() {
    std::vector<std::string> names;
    for (const Recipe& recipe : recipes())
        if (recipe.usual)
            names.emplace_back(recipe.name);
    return names;
}

std::optional<BenchScene> bench_scene(const std::string& name, BenchSize size) {
    const auto recipe = std::find_if(
        recipes().begin(), recipes().end(), [&](const Recipe& each) { return each.name == name; });
    if (recipe == recipes().end())
        return std::nullopt;
    auto scene = recipe->make(size);
    if (!scene)
        return std::nullopt;
    BenchScene result;
    result.name = name;
    result.kind = recipe->kind;
    result.scene = std::move(*scene);
    // Flat sides lie within the round ones by up to 3e-4 of the radius, which is less than 0.5.
    if (result.kind == BenchSceneKind::rotational)
        result.beside = 2e-4;
    return result;
}

BenchScene mountain_of(std::size_t side) {
    return {"mountain", BenchSceneKind::triangles, mountain(side), {}, usually_beside};
}

BenchScene flake_of(const Sphereflake& size) {
    return {"flake", BenchSceneKind::triangles, flake(size), {}, usually_beside};
}

} // namespace vera
