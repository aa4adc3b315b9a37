// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/inspection.h"

#include "vera/scene/bounds.h"
#include "vera/scene/crossings.h"
#include "vera/scene/support.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>

namespace vera {

std::vector<bool> used_materials(const Scene& scene) {
    std::vector<bool> used(scene.materials.size(), false);
    const auto mark = [&](const Geometry& geometry) {
        for (const Item& item : geometry.items)
            if (static_cast<std::size_t>(item.material) < used.size())
                used[static_cast<std::size_t>(item.material)] = true;
    };
    mark(scene.geometry);
    for (const Geometry& subscene : scene.subscenes)
        mark(subscene);
    return used;
}

namespace {

bool has_light(const Scene& scene, const PictureSettings& settings, const std::vector<bool>& used) {
    for (const PointLight& light : scene.lights)
        if (light.intensity != 0 && !is_black(light.color))
            return true;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i] && !(is_black(scene.materials[i].sdi) && is_black(scene.materials[i].san)))
            return true;
    if (!is_black(settings.ambient))
        return true;
    const auto& firmament = settings.firmament;
    return firmament
        && !(is_black(firmament->sky) && is_black(firmament->horizon)
             && is_black(firmament->earth));
}

bool is_closed(const RotationalShape& shape) {
    return !shape.contour.empty()
        && (shape.contour.back().end == shape.start
            || (shape.start.r == 0 && shape.contour.back().end.r == 0));
}

/// A box round the mesh, found in a small part of the time that testing its triangles takes.
Box3 bounds_of_positions(const Mesh& mesh) {
    Box3 box;
    for (const Vec3& position : mesh.positions)
        box = grown(box, position);
    return box;
}

/// Directions to the corners of a tetrahedron, turned so that no axis, edge or diagonal of what
/// people model runs along them.
constexpr std::array<Vec3, 4> probes = {
    Vec3{0.5321, 0.6127, 0.5843},
    Vec3{-0.6011, -0.5209, 0.6061},
    Vec3{-0.5527, 0.6301, -0.5455},
    Vec3{0.6217, -0.5479, -0.5597}};

/// Whether a ray in every direction leaves the item, which closes off the point then.
bool encloses(const Geometry& geometry, std::uint32_t item, std::uint32_t elements, Vec3 point) {
    return std::all_of(probes.begin(), probes.end(), [&](Vec3 direction) {
        const PreparedRay prepared({point, direction});
        std::size_t count = 0;
        for (std::uint32_t i = 0; i < elements; ++i)
            for_each_crossing(
                geometry, {item, i}, prepared, no_piece, [&](double, std::uint32_t) { ++count; });
        return count % 2 == 1;
    });
}

/// What the point lies in, for the kinds of item that enclose a space by themselves; or nullptr.
const char* enclosing_kind(const Geometry& geometry, std::uint32_t i, Vec3 point) {
    const Item& item = geometry.items[i];
    switch (item.kind) {
    case ItemKind::sphere: {
        const Sphere& sphere = geometry.spheres[item.index];
        return length(point - sphere.center) < sphere.radius ? "sphere" : nullptr;
    }
    case ItemKind::rotational_shape: {
        const RotationalShape& shape = geometry.rotational_shapes[item.index];
        return is_closed(shape) && contains(bounds(shape), point) && encloses(geometry, i, 1, point)
            ? "rotational shape"
            : nullptr;
    }
    case ItemKind::mesh: {
        const Mesh& mesh = geometry.meshes[item.index];
        const auto count = static_cast<std::uint32_t>(mesh.triangle_count());
        return contains(bounds_of_positions(mesh), point) && encloses(geometry, i, count, point)
            ? "mesh"
            : nullptr;
    }
    case ItemKind::triangle:
    case ItemKind::polygon:
    case ItemKind::patch:
    case ItemKind::subscene_call:
        break;
    }
    return nullptr;
}

/// Something that a point lies in.
struct Enclosure {
    Item item;
    std::string kind; ///< a word for it
};

/// The first object found that the point lies in, of those that are wanted.
template <typename Wanted>
std::optional<Enclosure> enclosing_object(
    const Scene& scene, Vec3 from, const std::vector<Box3>& boxes, const Wanted& wanted) {
    struct Visit {
        const Geometry* geometry;
        Vec3 point;
    };

    // Where copies lie in one another without number, looking must end somewhere.
    constexpr int most_visits = 100'000;
    std::vector<Visit> stack = {{&scene.geometry, from}};
    for (int visits = 0; !stack.empty() && visits < most_visits; ++visits) {
        const Visit visit = stack.back();
        stack.pop_back();
        const Geometry& geometry = *visit.geometry;
        for (std::uint32_t i = 0; i < geometry.items.size(); ++i) {
            const Item& item = geometry.items[i];
            if (item.kind == ItemKind::subscene_call) {
                const SubsceneCall& call = geometry.calls[item.index];
                const auto callee = static_cast<std::size_t>(call.subscene);
                const Vec3 point = transformed_point(call.from_parent, visit.point);
                if (contains(boxes[callee], point))
                    stack.push_back({&scene.subscenes[callee], point});
            } else if (wanted(item)) {
                if (const char* kind = enclosing_kind(geometry, i, visit.point))
                    return Enclosure{item, kind};
            }
        }
    }
    return std::nullopt;
}

std::optional<Finding> viewpoint_in_object(const Scene& scene, Vec3 viewpoint) {
    const auto around = enclosing_object(
        scene, viewpoint, subscene_bounds(scene), [](const Item&) { return true; });
    if (!around)
        return std::nullopt;
    return Finding{
        Finding::Kind::viewpoint_in_object,
        around->item,
        "the view point lies inside this " + around->kind,
        "move the view point, or remove what surrounds it"};
}

/// What keeps lights in.
std::vector<Finding> lights_in_objects(const Scene& scene) {
    constexpr std::size_t most_lights = 100;
    const std::vector<Box3> boxes = subscene_bounds(scene);
    const auto is_opaque = [&](const Item& item) {
        const auto number = static_cast<std::size_t>(item.material);
        return number < scene.materials.size() && is_black(scene.materials[number].tab);
    };
    std::vector<Finding> findings;
    for (std::size_t i = 0; i < scene.lights.size() && i < most_lights; ++i)
        if (const auto around = enclosing_object(scene, scene.lights[i].position, boxes, is_opaque))
            findings.push_back(
                {Finding::Kind::light_in_object,
                 around->item,
                 "a light lies inside this " + around->kind + ", which keeps it in",
                 "move the light, let light through (TAB), or leave out SHADOWS"});
    return findings;
}

std::optional<Finding> all_behind(const Scene& scene, const Camera& camera) {
    const SceneSupport support(scene);
    const Vec3 normal = normalized(
        cross(camera.lower_right - camera.lower_left, camera.upper_left - camera.lower_left));
    const double distance = dot(normal, camera.lower_left - camera.viewpoint);
    const Vec3 forward = distance < 0 ? -normal : normal;
    const auto farthest = support.farthest_point(forward);
    if (!farthest || dot(*farthest - camera.viewpoint, forward) > 0)
        return std::nullopt;
    return Finding{
        Finding::Kind::all_behind_viewer,
        {},
        "all geometry lies behind the view point",
        "turn the image plane of PROJECTION to the other side of the view point"};
}

} // namespace

std::vector<Finding> inspect(const Scene& scene, const PictureSettings& settings) {
    std::vector<Finding> findings;
    const std::vector<bool> used = used_materials(scene);
    if (!has_light(scene, settings, used))
        findings.push_back(
            {Finding::Kind::no_light,
             {},
             "there is no light and nothing luminous: the picture will be black",
             "add a light source (LI), AMBIENT or SKY"});
    if (settings.shadows)
        std::ranges::move(lights_in_objects(scene), std::back_inserter(findings));
    if (scene.camera && scene.camera->projection == Camera::Projection::perspective) {
        if (auto finding = viewpoint_in_object(scene, scene.camera->viewpoint))
            findings.push_back(std::move(*finding));
        if (auto finding = all_behind(scene, *scene.camera))
            findings.push_back(std::move(*finding));
    }
    return findings;
}

} // namespace vera
