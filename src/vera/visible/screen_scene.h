// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/exact/depth_plane.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vera {

/// Stands for no source: the background.
constexpr std::uint32_t no_source = ~std::uint32_t{0};

/// Stands for no triangle: the background, where something is seen.
constexpr std::uint32_t no_triangle = ~std::uint32_t{0};

/// Lights of a scene: bit i is light number i. Those beyond the most that a set tells apart are in
/// every set of lights that reach a place.
using LightSet = std::uint32_t;

constexpr std::uint32_t most_lights_of_a_set = 32;

constexpr LightSet all_lights = ~LightSet{0};

constexpr bool contains(LightSet lights, std::size_t number) {
    return number >= most_lights_of_a_set || (lights >> number & 1U) != 0;
}

/// Stands for no light: the triangle is a surface.
constexpr std::uint32_t no_light = ~std::uint32_t{0};

/// A triangle of the picture. Its corners go round to the left, and it has an area.
struct ScreenTriangle {
    std::array<std::uint32_t, 3> vertices = {}; ///< in ScreenScene::vertices
    std::uint32_t source = 0; ///< of what it is a part: of coincident ones the smaller is in front
    /// Of a shadow, the light that does not reach its source there. A shadow lies on its source,
    /// may reach beyond it, where it means nothing, and hides nothing.
    std::uint32_t light = no_light;
    /// Vertices that span its plane: those of the triangle that it was cut from, or its own. What
    /// the grid did to corners of a narrow part would tilt it.
    std::array<std::uint32_t, 3> plane = {};

    bool is_shadow() const { return light != no_light; }
};

/// A scene as the picture shows it: all within the frame, moved to the grid.
struct ScreenScene {
    std::vector<ScreenVertex> vertices;
    std::vector<ScreenTriangle> triangles;
    std::vector<LightSet> unlit; ///< by source, the lights that reach none of it; or empty: all do
    double cut_nearness = 0; ///< what was so much nearer than the image plane was cut away; or 0

    LightSet unlit_of(std::uint32_t source) const {
        return source < unlit.size() ? unlit[source] : 0;
    }
};

/// The points of the triangle's corners.
inline std::array<ScreenVertex, 3>
corners_of(const ScreenScene& scene, const ScreenTriangle& triangle) {
    return {
        scene.vertices[triangle.vertices[0]],
        scene.vertices[triangle.vertices[1]],
        scene.vertices[triangle.vertices[2]]};
}

inline DepthPlane plane_of(const ScreenScene& scene, const ScreenTriangle& triangle) {
    return depth_plane(
        {scene.vertices[triangle.plane[0]],
         scene.vertices[triangle.plane[1]],
         scene.vertices[triangle.plane[2]]});
}

/// Adds a triangle with these corners, turned to the left, which spans its own plane. One without
/// an area is left out: it is seen edge-on.
void add_triangle(
    ScreenScene& scene,
    std::array<std::uint32_t, 3> vertices,
    std::uint32_t source,
    std::uint32_t light = no_light);

/// The same of a part of that triangle, or of a shadow on it, which has its plane.
void add_part(
    ScreenScene& scene,
    std::array<std::uint32_t, 3> vertices,
    const ScreenTriangle& of,
    std::uint32_t light = no_light);

/// Turns the corners of triangles that have them in any order to the left, lets each span its own
/// plane, and leaves out those without an area.
void turn_to_left(ScreenScene& scene);

/// Sorts the triangles along a curve that fills the picture (Morton 1966), and the vertices by who
/// uses them first: neighbours then stand close together in memory. Of several surfaces between
/// the same vertices one of the smallest source is left. Throws Cancelled.
void sort_by_place(ScreenScene& scene, const CancelFlag* cancel = nullptr);

} // namespace vera
