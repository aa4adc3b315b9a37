// SPDX-License-Identifier: Apache-2.0
// What faces are part of, in names: objects of the main scene, what is in them, and its material.
#include "vera/drawing/drawing_file.h"
#include "vera/scene/surface.h"
#include "vera/visible/draw_scene.h"
#include "vera/visible/object_groups.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "accel/random_scene.h"
#include "visible/cameras.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

/// "object-3 [ball, line 4] red > part-5 [...] ...", from the outermost on.
std::string text_of(const DrawingGroup* group) {
    std::string text;
    for (; group != nullptr; group = group->parent.get()) {
        std::string one = group->id + " [" + group->name + "]";
        if (group->material)
            one += " " + group->material->name + " ." + group->material->css_class;
        text = text.empty() ? one : one + " > " + text;
    }
    return text;
}

Item item(ItemKind kind, std::uint32_t line, MaterialId material = inherited_material) {
    Item made;
    made.kind = kind;
    made.line = line;
    made.material = material;
    return made;
}

/// A sphere, a mesh of two triangles, and twice a pair of a sphere of the caller's material and a
/// green one.
Scene scene_of_pairs() {
    Scene scene;
    for (const char* name : {"red", "", "a.b c", "a-b c"})
        scene.materials.emplace_back().name = name;
    Geometry& pair = scene.subscenes.emplace_back();
    pair.name = "pair";
    pair.spheres.resize(2);
    pair.items = {item(ItemKind::sphere, 2), item(ItemKind::sphere, 3, MaterialId{2})};
    pair.items[1].index = 1;
    Geometry& main = scene.geometry;
    main.spheres.resize(1);
    Mesh& mesh = main.meshes.emplace_back();
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
    mesh.position_indices = {0, 1, 2, 1, 3, 2};
    main.calls.resize(2);
    main.items = {
        item(ItemKind::sphere, 6),
        item(ItemKind::mesh, 7, MaterialId{0}),
        item(ItemKind::subscene_call, 8, MaterialId{1}),
        item(ItemKind::subscene_call, 9, MaterialId{3})};
    main.items[3].index = 1;
    number_primitives(scene);
    return scene;
}

TEST(ObjectGroups, AreStatementsOfTheMainSceneAndWhatTheyCall) {
    const Scene scene = scene_of_pairs();
    const auto materials = drawing_materials(scene);
    ObjectGroups groups(scene, materials);
    const std::vector<std::string> expected = {
        "object-1 [sphere, line 6]",
        "object-2 [mesh, line 7] red .material-red",
        "object-2 [mesh, line 7] red .material-red",
        "object-4 [pair, line 8] > part-4 [sphere of pair, line 2] material-2 .material-2",
        "object-4 [pair, line 8] > part-5 [sphere of pair, line 3] a.b c .material-a-b-c",
        "object-6 [pair, line 9] > part-6 [sphere of pair, line 2] a-b c .material-a-b-c-2",
        "object-6 [pair, line 9] > part-7 [sphere of pair, line 3] a.b c .material-a-b-c"};
    for (std::uint64_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(text_of(groups.of(i).get()), expected[i]) << i;
}

TEST(ObjectGroups, KeepTheirIdsWhereSomethingIsNotSeen) {
    const Scene scene = scene_of_pairs();
    const auto materials = drawing_materials(scene);
    ObjectGroups groups(scene, materials);
    EXPECT_EQ(text_of(groups.of(2).get()), "object-2 [mesh, line 7] red .material-red");
    EXPECT_EQ(
        text_of(groups.of(6).get()),
        "object-6 [pair, line 9] > part-7 [sphere of pair, line 3] a.b c .material-a-b-c");
}

TEST(ObjectGroups, OfAStatementThatIsCalledAgainAndAgainAreOne) {
    Scene scene;
    scene.subscenes.resize(2);
    Geometry& leaf = scene.subscenes[0];
    leaf.name = "leaf";
    leaf.spheres.resize(1);
    leaf.items = {item(ItemKind::sphere, 2)};
    Geometry& tree = scene.subscenes[1];
    tree.name = "tree";
    for (std::uint32_t i = 0; i < 3; ++i) {
        tree.calls.emplace_back().subscene = SubsceneId{0};
        tree.items.push_back(item(ItemKind::subscene_call, 4));
        tree.items.back().index = i;
    }
    scene.geometry.calls.emplace_back().subscene = SubsceneId{1};
    scene.geometry.items = {item(ItemKind::subscene_call, 7)};
    number_primitives(scene);
    const auto materials = drawing_materials(scene);
    ObjectGroups groups(scene, materials);
    const auto first = groups.of(0);
    EXPECT_EQ(text_of(first.get()), "object-1 [tree, line 7] > part-1 [sphere of leaf, line 2]");
    EXPECT_EQ(groups.of(1), first);
    ObjectGroups copy = groups;
    EXPECT_EQ(copy.of(2), first);
}

TEST(ObjectGroups, OfStatementsThatStandInNoTextAreOneOfAKindAndMaterial) {
    Scene scene;
    scene.materials.resize(1);
    scene.geometry.spheres.resize(4);
    for (const std::uint32_t line : {0U, 0U, 0U, 7U})
        scene.geometry.items.push_back(item(ItemKind::sphere, line));
    scene.geometry.items[2].material = MaterialId{0};
    number_primitives(scene);
    const auto materials = drawing_materials(scene);
    ObjectGroups groups(scene, materials);
    const std::vector<std::string> expected = {
        "object-1 [sphere]",
        "object-1 [sphere]",
        "object-3 [sphere] material-1 .material-1",
        "object-4 [sphere, line 7]"};
    for (std::uint64_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(text_of(groups.of(i).get()), expected[i]) << i;
}

Mesh mesh_of(std::size_t triangles) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    for (std::size_t i = 0; i < triangles; ++i)
        mesh.position_indices.insert(mesh.position_indices.end(), {0, 1, 2});
    return mesh;
}

/// Meshes of 4 red triangles and 2 blue ones: the first is in no part, then an object with a group
/// of two and two of its own, one of them blue, then another object.
void add_named_meshes(Geometry& geometry) {
    geometry.meshes = {mesh_of(4), mesh_of(2)};
    geometry.items = {
        item(ItemKind::mesh, 3, MaterialId{0}), item(ItemKind::mesh, 7, MaterialId{1})};
    geometry.items[1].index = 1;
    geometry.named_parts = {
        {"chair", {0, 1}, {1, 1}}, {"legs", {0, 1}, {0, 3}, 0}, {"table", {1, 1}, {2, 0}}};
}

std::vector<std::string> texts_of(const Scene& scene) {
    const auto materials = drawing_materials(scene);
    ObjectGroups groups(scene, materials);
    std::vector<std::string> texts;
    for (std::uint64_t i = 0; i < scene.geometry.primitive_count; ++i)
        texts.push_back(text_of(groups.of(i).get()));
    return texts;
}

TEST(ObjectGroups, AreTheNamedPartsOfAFile) {
    Scene scene;
    scene.materials.emplace_back().name = "red";
    scene.materials.emplace_back().name = "blue";
    add_named_meshes(scene.geometry);
    number_primitives(scene);
    const std::vector<std::string> expected = {
        "object-1 [mesh, line 3] red .material-red",
        "object-2 [chair] > part-2 [legs] red .material-red",
        "object-2 [chair] > part-2 [legs] red .material-red",
        "object-2 [chair] > part-4 [red] red .material-red",
        "object-2 [chair] > part-5 [blue] blue .material-blue",
        "object-6 [table] blue .material-blue"};
    EXPECT_EQ(texts_of(scene), expected);
    // Also of one that is not seen from its first primitive on; and one object stays one.
    const auto materials = drawing_materials(scene);
    ObjectGroups groups(scene, materials);
    const auto legs = groups.of(2);
    EXPECT_EQ(text_of(legs.get()), expected[2]);
    EXPECT_EQ(groups.of(4)->parent, legs->parent);
    EXPECT_EQ(text_of(groups.of(5).get()), expected[5]);
    // For scripts, the names of the file and no others.
    ObjectGroups again(scene, materials);
    EXPECT_EQ(again.of(0)->given, "");
    EXPECT_EQ(again.of(1)->given, "legs");
    EXPECT_EQ(again.of(3)->given, "");
    EXPECT_EQ(again.of(3)->parent->given, "chair");
}

TEST(ObjectGroups, OfNamedPartsStandInTheCallsOfTheirFile) {
    Scene scene;
    scene.materials.emplace_back().name = "red";
    scene.materials.emplace_back().name = "blue";
    Geometry& file = scene.subscenes.emplace_back();
    file.name = "a.obj";
    add_named_meshes(file);
    scene.geometry.calls.resize(2);
    scene.geometry.items = {item(ItemKind::subscene_call, 8), item(ItemKind::subscene_call, 9)};
    scene.geometry.items[1].index = 1;
    number_primitives(scene);
    const std::vector<std::string> expected = {
        "object-1 [a.obj, line 8] > part-1 [mesh of a.obj, line 3] red .material-red",
        "object-1 [a.obj, line 8] > part-2 [chair] > group-2 [legs] red .material-red",
        "object-1 [a.obj, line 8] > part-2 [chair] > group-2 [legs] red .material-red",
        "object-1 [a.obj, line 8] > part-2 [chair] > group-4 [red] red .material-red",
        "object-1 [a.obj, line 8] > part-2 [chair] > group-5 [blue] blue .material-blue",
        "object-1 [a.obj, line 8] > part-6 [table] blue .material-blue",
        "object-7 [a.obj, line 9] > part-7 [mesh of a.obj, line 3] red .material-red",
        "object-7 [a.obj, line 9] > part-8 [chair] > group-8 [legs] red .material-red",
        "object-7 [a.obj, line 9] > part-8 [chair] > group-8 [legs] red .material-red",
        "object-7 [a.obj, line 9] > part-8 [chair] > group-10 [red] red .material-red",
        "object-7 [a.obj, line 9] > part-8 [chair] > group-11 [blue] blue .material-blue",
        "object-7 [a.obj, line 9] > part-12 [table] blue .material-blue"};
    EXPECT_EQ(texts_of(scene), expected);
}

/// Meshes of two materials in turn, and parts of their triangles, some with one within, up to which
/// they go on. Returns the triangles, and what is behind them.
std::vector<Element> add_random_parts(std::mt19937& random, Geometry& geometry) {
    std::vector<Element> elements;
    const std::size_t meshes = 1 + random() % 3;
    for (std::uint32_t i = 0; i < meshes; ++i) {
        geometry.meshes.push_back(mesh_of(1 + random() % 5));
        geometry.items.push_back(item(ItemKind::mesh, i + 1, MaterialId{i % 2}));
        geometry.items.back().index = i;
        for (std::uint32_t k = 0; k < geometry.meshes.back().triangle_count(); ++k)
            elements.push_back({i, k});
    }
    elements.push_back({static_cast<std::uint32_t>(meshes), 0});
    for (std::size_t i = 0; i + 1 < elements.size();) {
        const std::size_t end = std::min(elements.size() - 1, i + 1 + random() % 5);
        const auto whole = static_cast<std::uint32_t>(geometry.named_parts.size());
        if (random() % 3 != 0) {
            geometry.named_parts.push_back({"whole", elements[i], elements[end]});
            const std::size_t from = i + random() % (end - i);
            if (random() % 2 == 0)
                geometry.named_parts.push_back({"within", elements[from], elements[end], whole});
        }
        i = end;
    }
    return elements;
}

/// "[whole][within]", the names of the parts with an element.
std::string names_of(const Geometry& geometry, Element element) {
    std::string names;
    for (const NamedPart& part : geometry.named_parts)
        if (part.first <= element && element < part.end)
            names.append("[").append(part.name).append("]");
    return names;
}

/// The same in the text of a group.
std::string names_in(const std::string& text) {
    std::string names;
    for (std::size_t at = text.find("[w"); at != std::string::npos; at = text.find("[w", at + 1))
        names += text.substr(at, text.find(']', at) + 1 - at);
    return names;
}

/// Each group is there once, and none goes on as the innermost one of what stands beside it.
void expect_faces_or_groups(const std::vector<std::string>& texts) {
    std::set<std::string> ended;
    for (std::size_t i = 1; i < texts.size(); ++i) {
        if (texts[i] == texts[i - 1])
            continue;
        ended.insert(texts[i - 1]);
        EXPECT_FALSE(ended.contains(texts[i])) << texts[i];
        EXPECT_FALSE(texts[i].starts_with(texts[i - 1] + " > ")) << texts[i];
        EXPECT_FALSE(texts[i - 1].starts_with(texts[i] + " > ")) << texts[i];
    }
}

TEST(ObjectGroups, OfRandomPartsHoldFacesOrGroups) {
    std::mt19937 random(31);
    std::size_t deepest = 0;
    for (int round = 0; round < 600; ++round) {
        Scene scene;
        scene.materials.resize(2);
        const std::vector<Element> elements = add_random_parts(random, scene.geometry);
        number_primitives(scene);
        const std::vector<std::string> texts = texts_of(scene);
        for (std::size_t i = 0; i < texts.size(); ++i) {
            EXPECT_EQ(names_in(texts[i]), names_of(scene.geometry, elements[i])) << texts[i];
            EXPECT_TRUE(
                texts[i].ends_with(elements[i].item % 2 == 0 ? " .material-1" : " .material-2"));
            deepest += std::ranges::count(texts[i], '>') == 2 ? 1 : 0;
        }
        expect_faces_or_groups(texts);
    }
    EXPECT_GT(deepest, 100U);
}

/// Of random scenes, in which subscenes are called by others, every face stands in the groups that
/// the way to it in the scene tells; and no id is there twice.
TEST(ObjectGroups, OfDrawingsAreThoseOfTheWaysToTheirFaces) {
    std::size_t nested = 0;
    for (int number = 0; number < 6; ++number) {
        testing::RandomSceneSettings random;
        random.items = 14;
        random.curved = number % 2 == 0;
        const Scene scene = testing::random_scene(static_cast<std::uint64_t>(number), random);
        PictureSettings picture;
        picture.width = picture.height = 100;
        DrawSettings settings;
        settings.deviation = 1;
        const Drawing drawing =
            draw_scene(scene, testing::camera_number(number), picture, settings).drawing;
        std::map<std::string, std::string> ids; // of groups, and all that they tell
        std::set<std::string> closed;
        std::string open;
        for (const FilledOutline& fill : drawing.fills) {
            if (!fill.id.starts_with("face-"))
                continue;
            const PrimitivePath path = path_to(scene, std::stoull(fill.id.substr(5)) - 1);
            ASSERT_TRUE(fill.group);
            EXPECT_EQ(fill.group->parent != nullptr, !path.in_main_scene);
            EXPECT_EQ(fill.group->id.starts_with("part-"), !path.in_main_scene);
            nested += path.in_main_scene ? 0 : 1;
            EXPECT_EQ(
                fill.group->material ? fill.group->material->name : "",
                path.material == inherited_material
                    ? ""
                    : "material-" + std::to_string(static_cast<std::size_t>(path.material) + 1));
            const std::uint32_t line = path.geometry->items[path.element.item].line;
            EXPECT_TRUE(line == 0 || fill.group->name.ends_with("line " + std::to_string(line)));
            // Each id is of one group, which does not begin again once another has.
            const std::string text = text_of(fill.group.get());
            EXPECT_EQ(ids.try_emplace(fill.group->id, text).first->second, text);
            if (fill.group->id != open) {
                closed.insert(open);
                EXPECT_FALSE(closed.contains(fill.group->id)) << fill.group->id;
                open = fill.group->id;
            }
        }
    }
    EXPECT_GT(nested, 50U);
}

} // namespace
} // namespace vera
