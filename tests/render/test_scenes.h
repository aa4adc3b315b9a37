// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/scene.h"

#include <array>
#include <cstdint>
#include <initializer_list>
#include <span>

namespace vera {

/// Scenes as a reader would make them, statement by statement.
class SceneMaker {
public:
    MaterialId material(const Material& material) {
        scene.materials.push_back(material);
        current_ = MaterialId{static_cast<std::uint32_t>(scene.materials.size() - 1)};
        return current_;
    }

    void light(Vec3 position, double intensity, Color color = {1, 1, 1}) {
        scene.lights.push_back({position, intensity, color, Falloff::inverse_square});
    }

    void sphere(Vec3 center, double radius) {
        scene.geometry.spheres.push_back({center, radius});
        item(ItemKind::sphere, scene.geometry.spheres.size());
    }

    /// A convex plane polygon, its normal by the right-hand rule.
    void polygon(std::initializer_list<Vec3> corners, Outside outside = Outside::by_normal) {
        Geometry& geometry = scene.geometry;
        Polygon polygon;
        polygon.first_corner = static_cast<std::uint32_t>(geometry.corners.size());
        polygon.corner_count = static_cast<std::uint32_t>(corners.size());
        geometry.corners.insert(geometry.corners.end(), corners);
        const Vec3* corner = corners.begin();
        polygon.normal = normalized(cross(corner[1] - corner[0], corner[2] - corner[0]));
        geometry.polygons.push_back(polygon);
        item(ItemKind::polygon, geometry.polygons.size(), outside);
    }

    void patch(const std::array<Vec3, 3>& corners, const std::array<Vec3, 3>& normals) {
        scene.geometry.patches.push_back({corners, normals});
        item(ItemKind::patch, scene.geometry.patches.size());
    }

    /// The picture is the square of that half side round the origin in the plane z = 0, seen from
    /// above along -z.
    void look_down_in_parallel(double half) {
        Camera camera;
        camera.projection = Camera::Projection::parallel;
        camera.direction = {0, 0, -1};
        camera.lower_left = {-half, -half, 0};
        camera.lower_right = {half, -half, 0};
        camera.upper_left = {-half, half, 0};
        scene.camera = camera;
    }

    const Scene& finish() {
        number_primitives(scene);
        return scene;
    }

    Scene scene;

private:
    void item(ItemKind kind, std::size_t count, Outside outside = Outside::by_normal) {
        Item item;
        item.kind = kind;
        item.outside = outside;
        item.index = static_cast<std::uint32_t>(count - 1);
        item.material = current_;
        scene.geometry.items.push_back(item);
    }

    MaterialId current_ = inherited_material;
};

inline Material diffuse(Color color) {
    Material material;
    material.drf = color;
    return material;
}

inline Material luminous(Color color) {
    Material material;
    material.sdi = color;
    return material;
}

inline Material mirror(Color color) {
    Material material;
    material.rab = color;
    return material;
}

inline Material glass(Color color, double ref) {
    Material material;
    material.tab = color;
    material.ref = ref;
    return material;
}

/// Settings of a small picture with all that costs nothing to leave out left out.
inline PictureSettings plain_settings(std::uint32_t width, std::uint32_t height) {
    PictureSettings settings;
    settings.width = width;
    settings.height = height;
    settings.antialiasing.on = false;
    return settings;
}

} // namespace vera
