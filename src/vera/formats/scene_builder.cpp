// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/scene_builder.h"

#include "vera/formats/faces.h"
#include "vera/formats/inner_point_check.h"
#include "vera/formats/reserve_room.h"
#include "vera/formats/word_reader.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace vera {

void SceneBuilder::set_text(const SourceText& text) {
    const auto known = std::find(texts_.begin(), texts_.end(), &text);
    file_ = static_cast<std::uint16_t>(known - texts_.begin());
    if (known == texts_.end()) {
        texts_.push_back(&text);
        scene_.files.push_back(text.name());
    }
}

void SceneBuilder::begin_subscene(std::string_view name, const WordPlace& place) {
    end_subscene();
    const auto id = subscene_names_.defined(name, place, complaints_);
    discarded_ = {};
    Geometry* geometry = &discarded_;
    if (id) {
        subscenes_.resize(std::max<std::size_t>(subscenes_.size(), *id + 1));
        geometry = &subscenes_[*id];
        geometry->name = name;
    }
    subscene_ = {.geometry = geometry};
    current_ = &subscene_;
}

void SceneBuilder::end_subscene() {
    if (!in_subscene())
        return;
    check_inner_point(subscene_);
    current_ = &main_;
}

void SceneBuilder::reserve(const StatementCounts& counts) {
    Geometry& geometry = *current_->geometry;
    reserve_room(geometry.spheres, counts.spheres);
    reserve_room(geometry.triangles, counts.triangles);
    reserve_room(geometry.polygons, counts.polygons);
    reserve_room(geometry.corners, counts.corners);
    reserve_room(geometry.patches, counts.patches);
    reserve_room(geometry.items, counts.items());
}

void SceneBuilder::set_material(std::string_view name, const WordPlace& place) {
    current_->material = MaterialId{material_names_.used(name, place)};
}

void SceneBuilder::set_inner_point(Vec3 point) {
    check_inner_point(*current_);
    current_->inner_point = point;
    current_->first_with_inner_point = current_->geometry->items.size();
}

void SceneBuilder::set_camera(const Camera& camera, const WordPlace& place) {
    if (camera_place_) {
        const bool was_parallel = scene_.camera->projection == Camera::Projection::parallel;
        const bool is_parallel = camera.projection == Camera::Projection::parallel;
        const SourcePlace first = source_place(*camera_place_);
        complaints_.error(
            place,
            was_parallel == is_parallel
                ? fmt::format("{} is given twice", is_parallel ? "PARALLEL" : "PROJECTION")
                : std::string("PROJECTION and PARALLEL are both given"),
            fmt::format("a scene has one view; the first is at {}:{}", first.file, first.line));
        return;
    }
    camera_place_ = place;
    scene_.camera = camera;
}

void SceneBuilder::add_light(const PointLight& light) {
    scene_.lights.push_back(light);
}

Material& SceneBuilder::begin_material(std::string_view name, const WordPlace& place) {
    const auto id = material_names_.defined(name, place, complaints_);
    if (id)
        scene_.materials.resize(std::max<std::size_t>(scene_.materials.size(), *id + 1));
    Material& material = id ? scene_.materials[*id] : discarded_material_;
    material.name = name;
    return material;
}

void SceneBuilder::add_item(
    ItemKind kind, std::size_t index, const WordPlace& place, Outside outside) {
    auto& items = current_->geometry->items;
    if (items.size() >= limits_.items || index >= limits_.items
        || current_->geometry->corners.size() > limits_.items) {
        complaints_.error(
            place,
            fmt::format(
                "more than {} primitives or corners in one scene or subscene", limits_.items),
            "move parts of it into subscenes and call them");
        return;
    }
    items.push_back(
        {.kind = kind,
         .outside = outside,
         .file = file_,
         .index = static_cast<std::uint32_t>(index),
         .material = current_->material,
         .line = static_cast<std::uint32_t>(std::min<std::uint64_t>(place.line, 0xffffffff))});
}

void SceneBuilder::add(const Sphere& sphere, const WordPlace& place) {
    auto& spheres = current_->geometry->spheres;
    add_item(ItemKind::sphere, spheres.size(), place);
    spheres.push_back(sphere);
}

void SceneBuilder::warn_no_area(const WordPlace& place, std::string_view what) {
    complaints_.warn(
        "faces without area", place, fmt::format("{} has no area and is left out", what));
}

Outside SceneBuilder::outside(Vec3 normal, Vec3 first_corner, const WordPlace& place) {
    if (!current_->inner_point)
        return Outside::by_normal;
    const auto side = outside_of(normal, first_corner, *current_->inner_point);
    if (!side)
        complaints_.warn(
            "inner points in a face's plane",
            place,
            "the inner point lies in the plane of this face and is ignored",
            "give IP a point inside the solid, off all its faces");
    return side.value_or(Outside::by_normal);
}

void SceneBuilder::add(const Triangle& triangle, const WordPlace& place) {
    const auto normal = triangle_normal(triangle.corners);
    if (!normal)
        return warn_no_area(place, "this triangle");
    auto& triangles = current_->geometry->triangles;
    add_item(
        ItemKind::triangle, triangles.size(), place, outside(*normal, triangle.corners[0], place));
    triangles.push_back(triangle);
}

void SceneBuilder::add(const Patch& patch, const WordPlace& place) {
    const auto normal = triangle_normal(patch.corners);
    if (!normal)
        return warn_no_area(place, "this patch");
    auto& patches = current_->geometry->patches;
    add_item(ItemKind::patch, patches.size(), place, outside(*normal, patch.corners[0], place));
    patches.push_back(patch);
}

void SceneBuilder::add(RotationalShape shape, const WordPlace& place) {
    auto& shapes = current_->geometry->rotational_shapes;
    add_item(ItemKind::rotational_shape, shapes.size(), place);
    shapes.push_back(std::move(shape));
}

void SceneBuilder::add_mesh(const std::string& file, Geometry made, const WordPlace& place) {
    Geometry& geometry = *current_->geometry;
    const auto item = static_cast<std::uint32_t>(geometry.items.size());
    add_item(ItemKind::mesh, geometry.meshes.size(), place);
    geometry.meshes.push_back(std::move(made.meshes.front()));
    if (made.named_parts.empty())
        return;
    const auto whole = static_cast<std::uint32_t>(geometry.named_parts.size());
    geometry.named_parts.push_back({file, {item, 0}, {item + 1, 0}});
    for (NamedPart& part : made.named_parts) {
        part.first.item += item;
        part.end.item += item;
        part.parent = part.parent == NamedPart::none ? whole : part.parent + whole + 1;
        geometry.named_parts.push_back(std::move(part));
    }
}

void SceneBuilder::add_plane_polygon(
    const Vec3* corners,
    std::size_t count,
    Polygon::Shape shape,
    Vec3 normal,
    Outside outside,
    const WordPlace& place) {
    Geometry& geometry = *current_->geometry;
    const std::size_t first = geometry.corners.size();
    geometry.corners.insert(geometry.corners.end(), corners, corners + count);
    add_item(ItemKind::polygon, geometry.polygons.size(), place, outside);
    geometry.polygons.push_back(
        {static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), shape, normal});
}

void SceneBuilder::add_split_quadrangle(
    const std::array<Vec3, 4>& corners, const WordPlace& place) {
    complaints_.warn(
        "quadrangles that are not plane",
        place,
        "the corners are not in one plane: split into p1 p2 p3 and p1 p3 p4",
        "write two P3 to say where the fold is");
    const Triangle first = {{corners[0], corners[1], corners[2]}};
    const Triangle second = {{corners[0], corners[2], corners[3]}};
    const auto first_normal = triangle_normal(first.corners);
    const auto second_normal = triangle_normal(second.corners);
    // Where the inner point is on different sides of the two halves, or in the plane of one, each
    // is a face with a side of its own.
    const auto side = [&](const Triangle& half, const std::optional<Vec3>& normal) {
        return normal && current_->inner_point
            ? outside_of(*normal, half.corners[0], *current_->inner_point)
            : std::nullopt;
    };
    const auto first_side = side(first, first_normal);
    if (!first_normal || !second_normal || first_side != side(second, second_normal)) {
        add(first, place);
        add(second, place);
        return;
    }
    add_plane_polygon(
        corners.data(),
        4,
        Polygon::Shape::split_quadrangle,
        *first_normal,
        outside(*first_normal, corners[0], place),
        place);
}

namespace {

std::string crossing_problem(const PolygonForm& form, std::size_t count) {
    const auto [a, b] = form.crossing_sides;
    return fmt::format(
        "the sides from corner {} to {} and from corner {} to {} cross",
        a + 1,
        (a + 1) % count + 1,
        b + 1,
        (b + 1) % count + 1);
}

bool is_same(const Material& a, const Material& b) {
    return a.name == b.name && a.drf == b.drf && a.arf == b.arf && a.sdi == b.sdi && a.san == b.san
        && a.rab == b.rab && a.tab == b.tab && a.spc == b.spc && a.ref == b.ref;
}

} // namespace

void SceneBuilder::add_quadrangle(const std::array<Vec3, 4>& corners, const WordPlace& place) {
    const PolygonForm form = quadrangle_form(corners);
    switch (form.kind) {
    case PolygonForm::Kind::not_plane:
        return add_split_quadrangle(corners, place);
    case PolygonForm::Kind::no_area:
        return warn_no_area(place, "this quadrangle");
    case PolygonForm::Kind::crossing:
    case PolygonForm::Kind::too_involved:
        complaints_.error(
            place, crossing_problem(form, 4), "give the corners in their order round the face");
        return;
    case PolygonForm::Kind::convex:
    case PolygonForm::Kind::simple:
        break;
    }
    add_plane_polygon(
        corners.data(),
        4,
        form.kind == PolygonForm::Kind::convex ? Polygon::Shape::convex : Polygon::Shape::simple,
        form.normal,
        outside(form.normal, corners[0], place),
        place);
}

void SceneBuilder::add_polygon(const std::vector<Vec3>& corners, const WordPlace& place) {
    const PolygonForm form = polygon_form(corners, limits_.side_pairs);
    switch (form.kind) {
    case PolygonForm::Kind::not_plane:
        complaints_.error(
            place,
            "the polygon's corners are not in one plane",
            "they may be off it by a millionth of the polygon's size; split it into plane ones");
        return;
    case PolygonForm::Kind::no_area:
        return warn_no_area(place, "this polygon");
    case PolygonForm::Kind::crossing:
        complaints_.error(
            place,
            crossing_problem(form, corners.size()),
            "give the corners in their order round the polygon");
        return;
    case PolygonForm::Kind::too_involved:
        complaints_.error(
            place,
            "so many of the polygon's sides lie side by side that checking whether they cross "
            "takes too long",
            "split it into several");
        return;
    case PolygonForm::Kind::convex:
    case PolygonForm::Kind::simple:
        break;
    }
    add_plane_polygon(
        corners.data(),
        corners.size(),
        form.kind == PolygonForm::Kind::convex ? Polygon::Shape::convex : Polygon::Shape::simple,
        form.normal,
        outside(form.normal, corners[0], place),
        place);
}

void SceneBuilder::add_call(
    std::string_view name,
    const WordPlace& name_place,
    const Placement& placement,
    const WordPlace& place) {
    const std::uint32_t id = subscene_names_.used(name, name_place);
    add_call(SubsceneId{id}, placement, place);
}

void SceneBuilder::add_call(
    SubsceneId subscene, const Placement& placement, const WordPlace& place) {
    auto& calls = current_->geometry->calls;
    add_item(ItemKind::subscene_call, calls.size(), place);
    calls.push_back({subscene, placement.to_parent, placement.from_parent});
}

Geometry& SceneBuilder::new_unnamed_subscene(SubsceneId& id) {
    const std::uint32_t number = subscene_names_.unnamed();
    subscenes_.resize(std::max<std::size_t>(subscenes_.size(), number + 1));
    id = SubsceneId{number};
    return subscenes_[number];
}

const Material& SceneBuilder::standard_material(Material material, const WordPlace& place) {
    const std::string stem = material.name;
    for (std::size_t i = 2;; ++i) {
        const auto [known, is_new] =
            standard_materials_.try_emplace(material.name, material, place);
        if (is_new || is_same(known->second.first, material))
            return known->second.first;
        material.name = fmt::format("{}-{}", stem, i);
    }
}

SubsceneId SceneBuilder::add_made_subscene(std::string name, Scene made, const WordPlace& place) {
    std::vector<MaterialId> materials;
    for (Material& material : made.materials) {
        const Material& standard = standard_material(std::move(material), place);
        materials.push_back(MaterialId{material_names_.used(standard.name, place)});
    }
    std::vector<SubsceneId> ids(made.subscenes.size() + 1);
    for (std::size_t i = 0; i < made.subscenes.size(); ++i)
        new_unnamed_subscene(ids[i]) = std::move(made.subscenes[i]);
    made.geometry.name = std::move(name);
    new_unnamed_subscene(ids.back()) = std::move(made.geometry);
    const auto line = static_cast<std::uint32_t>(std::min<std::uint64_t>(place.line, 0xffffffff));
    for (const SubsceneId id : ids) {
        Geometry& geometry = subscenes_[static_cast<std::size_t>(id)];
        for (SubsceneCall& call : geometry.calls)
            call.subscene = ids[static_cast<std::size_t>(call.subscene)];
        for (Item& item : geometry.items) {
            item.file = file_;
            item.line = line;
            if (item.material != inherited_material)
                item.material = materials[static_cast<std::size_t>(item.material)];
        }
    }
    return ids.back();
}

void SceneBuilder::define_standard_materials() {
    for (const auto& [name, standard] : standard_materials_) {
        const auto& [material, place] = standard;
        if (material_names_.defined_by_default(material.name, place)) {
            const std::uint32_t id = material_names_.used(material.name, place);
            scene_.materials.resize(std::max<std::size_t>(scene_.materials.size(), id + 1));
            scene_.materials[id] = material;
        }
    }
}

} // namespace vera
