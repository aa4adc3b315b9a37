// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/scene_writer.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

/// A scene of every sort of thing that takes many statements: spheres, in a subscene as well, and a
/// mesh.
Scene many_statements() {
    Scene scene;
    scene.lights.emplace_back();
    scene.materials.emplace_back();
    scene.subscenes.emplace_back();
    constexpr std::uint32_t many = 5000;
    for (Geometry* const geometry : {&scene.geometry, &scene.subscenes[0]})
        for (std::uint32_t i = 0; i < many; ++i) {
            geometry->spheres.push_back({{static_cast<double>(i), 0, 0}, 1});
            geometry->items.push_back({.kind = ItemKind::sphere, .index = i});
        }
    Mesh& mesh = scene.geometry.meshes.emplace_back();
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (std::uint32_t i = 0; i < many; ++i)
        mesh.position_indices.insert(mesh.position_indices.end(), {0, 1, 2});
    scene.geometry.items.push_back({.kind = ItemKind::mesh, .index = 0});
    return scene;
}

TEST(SceneWriter, TellsHowMuchItHasWritten) {
    const Scene scene = many_statements();
    std::vector<double> told;
    std::string text;
    write_vera_scene(
        scene,
        [&](std::string_view part) { text += part; },
        [&](double done) { told.push_back(done); });
    EXPECT_EQ(text, vera_scene_text(scene));
    ASSERT_GT(told.size(), 3U);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_GT(told.front(), 0);
    EXPECT_LT(told.front(), 0.5);
    EXPECT_EQ(told.back(), 1);
    EXPECT_LT(told[told.size() - 2], 1);
}

TEST(SceneWriter, TellsNothingOfAnEmptyScene) {
    bool called = false;
    write_vera_scene(
        {}, [](std::string_view) {}, [&](double) { called = true; });
    EXPECT_FALSE(called);
}

TEST(SceneWriter, StopsSoonAfterItIsCancelled) {
    const Scene scene = many_statements();
    CancelFlag cancel;
    std::size_t pieces = 0;
    const auto write = [&](std::string_view) {
        if (++pieces == 2)
            cancel.raise();
    };
    EXPECT_THROW(write_vera_scene(scene, write, {}, &cancel), Cancelled);
    EXPECT_EQ(pieces, 2U);
}

} // namespace
} // namespace vera
