// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/object_groups.h"

#include "vera/drawing/document_text.h"
#include "vera/scene/item_names.h"
#include "vera/scene/named_parts.h"
#include "vera/scene/primitive_location.h"
#include "vera/scene/surface.h"

#include <algorithm>
#include <array>
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

/// Whether there are other parts in it or, as it is of several statements, several materials.
bool holds_groups(const Geometry& geometry, std::uint32_t number) {
    const NamedPart& part = geometry.named_parts[number];
    return has_parts_within(geometry, number) || part.end > Element{part.first.item + 1, 0};
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
    if (!run_.contains(primitive))
        begin_stretch(primitive);
    return group_;
}

void ObjectGroups::begin_stretch(std::uint64_t primitive) {
    const bool is_other_object = !object_.contains(primitive);
    if (is_other_object)
        begin_object(primitive);
    const PrimitivePath path = path_to(*scene_, primitive);
    const Geometry& geometry = *path.geometry;
    const Element element = path.element;
    const Item& item = geometry.items[element.item];
    const PartStretch stretch = stretch_of(geometry, element);
    run_.first = primitive - (element.triangle - stretch.first.triangle);
    run_.end = run_.first + 1;
    if (stretch.end.item == element.item)
        run_.end = run_.first + (stretch.end.triangle - stretch.first.triangle);
    else if (item.kind == ItemKind::mesh)
        run_.end = primitive + (geometry.meshes[item.index].triangle_count() - element.triangle);
    const Stretch next = {&item, stretch.first, stretch.part, path.material};
    const bool is_one = is_one_with_last(next, is_other_object);
    stretch_ = next;
    if (is_one)
        return;
    const bool is_leaf = stretch.part != NamedPart::none && !holds_groups(geometry, stretch.part);
    open_parts(geometry, primitive - primitive_number(geometry, element), is_leaf);
    if (is_leaf) {
        group_ = open_parts_.back().group;
        return;
    }
    const bool by_material = stretch.part != NamedPart::none && path.material != inherited_material;
    group_ = made_group(
        run_.first,
        by_material ? (*materials_)[static_cast<std::size_t>(path.material)]->name
                    : name_of(*scene_, geometry, item),
        path.material);
}

bool ObjectGroups::is_one_with_last(const Stretch& stretch, bool is_other_object) const {
    if (!group_ || stretch.material != stretch_.material)
        return false;
    if (!is_other_object)
        return stretch == stretch_;
    const auto stands_in_no_text = [](const Stretch& one) {
        return one.item->line == 0 && one.part == NamedPart::none;
    };
    return !call_ && !group_->parent && stands_in_no_text(stretch) && stands_in_no_text(stretch_)
        && stretch.item->kind == stretch_.item->kind;
}

void ObjectGroups::begin_object(std::uint64_t primitive) {
    const Geometry& main = scene_->geometry;
    const PrimitiveLocation location = location_of(main, primitive);
    const Item& item = main.items[location.item];
    object_.first = primitive - location.within;
    object_.end = object_.first + 1;
    if (call_ || item.kind == ItemKind::subscene_call)
        open_parts_.clear();
    call_ = nullptr;
    if (item.kind == ItemKind::mesh)
        object_.end = object_.first + main.meshes[item.index].triangle_count();
    if (item.kind != ItemKind::subscene_call)
        return;
    const SubsceneCall& call = main.calls[item.index];
    object_.end =
        object_.first + scene_->subscenes[static_cast<std::size_t>(call.subscene)].primitive_count;
    call_ = made_group(object_.first, name_of(*scene_, main, item), inherited_material);
}

/// Of the part of the stretch, and of those that it is within, the groups that are not open yet.
/// The origin is the primitive before the geometry's first. Parts are of triangles, so that their
/// first primitive and their number tell in which geometry they are, called at which place.
void ObjectGroups::open_parts(const Geometry& geometry, std::uint64_t origin, bool is_leaf) {
    const std::vector<std::uint32_t> way = parts_around(geometry, stretch_.part);
    const auto first_of = [&](std::uint32_t part) {
        return origin + primitive_number(geometry, geometry.named_parts[part].first);
    };
    std::size_t same = 0;
    while (same < std::min(way.size(), open_parts_.size()) && open_parts_[same].number == way[same]
           && open_parts_[same].first == first_of(way[same]))
        ++same;
    open_parts_.resize(same);
    for (; same < way.size(); ++same) {
        const bool has_material = is_leaf && same + 1 == way.size();
        const std::string& name = geometry.named_parts[way[same]].name;
        Group group = made_group(
            first_of(way[same]), name, has_material ? stretch_.material : inherited_material, name);
        open_parts_.push_back({way[same], first_of(way[same]), std::move(group)});
    }
}

/// Within those that are open; the number of these says what its id begins with.
ObjectGroups::Group ObjectGroups::made_group(
    std::uint64_t first, std::string name, MaterialId material, std::string given) const {
    constexpr std::array<const char*, 4> kinds = {"object-", "part-", "group-", "piece-"};
    const std::size_t depth = (call_ ? 1 : 0) + open_parts_.size();
    DrawingGroup group;
    group.id = kinds[std::min(depth, kinds.size() - 1)] + std::to_string(first + 1);
    group.name = std::move(name);
    group.given = std::move(given);
    if (material != inherited_material)
        group.material = (*materials_)[static_cast<std::size_t>(material)];
    group.parent = open_parts_.empty() ? call_ : open_parts_.back().group;
    return std::make_shared<const DrawingGroup>(std::move(group));
}

} // namespace vera
