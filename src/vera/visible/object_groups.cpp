// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/object_groups.h"

#include "vera/drawing/document_text.h"
#include "vera/scene/item_names.h"
#include "vera/scene/primitive_location.h"
#include "vera/scene/surface.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace vera {

namespace {

/// What a statement is, and where it was written.
std::string name_of(const Scene& scene, const Geometry& geometry, const Item& item) {
    std::string name = name_of(item.kind);
    if (item.kind == ItemKind::subscene_call) {
        const SubsceneCall& call = geometry.calls[item.index];
        const std::string& called = scene.subscenes[static_cast<std::size_t>(call.subscene)].name;
        if (!called.empty())
            name = called;
    }
    if (!geometry.name.empty())
        name += " of " + geometry.name;
    return item.line == 0 ? name : name + ", line " + std::to_string(item.line);
}

} // namespace

std::vector<std::shared_ptr<const DrawingMaterial>> drawing_materials(const Scene& scene) {
    std::vector<std::shared_ptr<const DrawingMaterial>> materials;
    detail::UniqueIds ids;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const std::string& given = scene.materials[i].name;
        const std::string number = std::to_string(i + 1);
        std::string wanted = "material-" + (given.empty() ? number : given);
        // A dot would begin another class in CSS.
        std::replace(wanted.begin(), wanted.end(), '.', '-');
        materials.push_back(std::make_shared<const DrawingMaterial>(
            DrawingMaterial{given.empty() ? "material-" + number : given, ids.take(wanted)}));
    }
    return materials;
}

std::shared_ptr<const DrawingGroup> ObjectGroups::of(std::uint64_t primitive) {
    if (!statement_.contains(primitive))
        begin_statement(primitive);
    return group_;
}

void ObjectGroups::begin_statement(std::uint64_t primitive) {
    const bool is_other_object = !object_.contains(primitive);
    if (is_other_object)
        begin_object(primitive);
    const PrimitivePath path = path_to(*scene_, primitive);
    const Item& item = path.geometry->items[path.element.item];
    statement_.first = primitive - path.element.triangle;
    statement_.end = statement_.first
        + (item.kind == ItemKind::mesh ? path.geometry->meshes[item.index].triangle_count() : 1);
    const bool is_one = is_one_with_last(item, path.material, is_other_object);
    item_ = &item;
    material_ = path.material;
    if (is_one)
        return;
    DrawingGroup group;
    group.id = (object_group_ ? "part-" : "object-") + std::to_string(statement_.first + 1);
    group.name = name_of(*scene_, *path.geometry, item);
    if (material_ != inherited_material)
        group.material = (*materials_)[static_cast<std::size_t>(material_)];
    group.parent = object_group_;
    group_ = std::make_shared<const DrawingGroup>(std::move(group));
}

bool ObjectGroups::is_one_with_last(
    const Item& item, MaterialId material, bool is_other_object) const {
    if (!group_ || material != material_ || group_->parent != object_group_)
        return false;
    if (is_other_object)
        return !object_group_ && item.line == 0 && item_->line == 0 && item.kind == item_->kind;
    return &item == item_;
}

void ObjectGroups::begin_object(std::uint64_t primitive) {
    const Geometry& main = scene_->geometry;
    const PrimitiveLocation location = location_of(main, primitive);
    const Item& item = main.items[location.item];
    object_.first = primitive - location.within;
    object_.end = object_.first + 1;
    object_group_ = nullptr;
    if (item.kind == ItemKind::mesh)
        object_.end = object_.first + main.meshes[item.index].triangle_count();
    if (item.kind != ItemKind::subscene_call)
        return;
    const SubsceneCall& call = main.calls[item.index];
    object_.end =
        object_.first + scene_->subscenes[static_cast<std::size_t>(call.subscene)].primitive_count;
    object_group_ = std::make_shared<const DrawingGroup>(DrawingGroup{
        .id = "object-" + std::to_string(object_.first + 1), .name = name_of(*scene_, main, item)});
}

} // namespace vera
