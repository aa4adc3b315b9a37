// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/drawing_memory.h"

#include "vera/base/available_memory.h"

#include <algorithm>
#include <cstdint>
#include <string>

namespace vera {

namespace {

constexpr char remedy[] =
    "a larger --deviation makes fewer facets, simpler meshes have fewer triangles, and a part of "
    "the picture shows less";

std::string about(double count) {
    return std::to_string(static_cast<std::uint64_t>(count));
}

} // namespace

ScreenCounts counts_of(const ScreenScene& scene) {
    ScreenCounts counts;
    for (const ScreenTriangle& triangle : scene.triangles)
        ++(triangle.is_shadow() ? counts.shadows : counts.surfaces);
    counts.vertices = scene.vertices.size();
    return counts;
}

double raster_bytes(const ScreenCounts& counts) {
    constexpr double per_surface = 230; // with 1.5 to 6 cells, of which shadows ask for none
    constexpr double per_shadow = 170;
    constexpr double per_edge = 34;
    constexpr double per_vertex = 8;
    const std::size_t triangles = counts.surfaces + counts.shadows;
    // Of a surface as many as both together; of triangles that have nothing in common, three each.
    const std::size_t edges = std::min(3 * triangles, triangles + counts.vertices);
    return per_surface * static_cast<double>(counts.surfaces)
        + per_shadow * static_cast<double>(counts.shadows) + per_edge * static_cast<double>(edges)
        + per_vertex * static_cast<double>(counts.vertices);
}

double piece_bytes(double pieces, double pairs) {
    constexpr double per_piece = 95; // with a point, in parts and as one list
    constexpr double per_pair = 24;
    return per_piece * pieces + per_pair * pairs;
}

double
drawing_bytes(double pieces, std::size_t surfaces, DrawingStyle style, FaceOutlines outlines) {
    const bool are_later = outlines == FaceOutlines::later;
    double per_piece = 0;
    double per_surface = 0;
    switch (style) {
    case DrawingStyle::flat:
        per_piece = are_later ? 250 : 705; // of curved surfaces, whose borders are arcs
        break;
    case DrawingStyle::shaded:
        per_piece = are_later ? 320 : 600;
        break;
    case DrawingStyle::ids:
        per_piece = 80; // as areas that share their corners
        break;
    case DrawingStyle::lines:
        per_piece = 450;
        break;
    case DrawingStyle::hidden_lines:
        per_piece = 650;
        per_surface = 400; // whose edges may be hidden lines
        break;
    case DrawingStyle::toon:
        per_piece = are_later ? 500 : 850;
        break;
    }
    return per_piece * pieces + per_surface * static_cast<double>(surfaces);
}

void require_raster_memory(const ScreenScene& scene) {
    require_memory(
        raster_bytes(counts_of(scene)),
        "finding what is seen of " + std::to_string(scene.triangles.size()) + " triangles",
        remedy);
}

void require_piece_memory(double pieces, double pairs) {
    const std::string penetrating =
        pairs < 1 ? "" : ", and triangles pass through each other about " + about(pairs) + " times";
    require_memory(
        piece_bytes(pieces, pairs),
        "what is seen has borders of about " + about(pieces) + " pieces" + penetrating + ", which",
        remedy);
}

void require_drawing_memory(
    double pieces, std::size_t surfaces, DrawingStyle style, FaceOutlines outlines) {
    require_memory(
        std::max(piece_bytes(pieces), drawing_bytes(pieces, surfaces, style, outlines)),
        "the drawing would have about " + about(pieces) + " lines between what is seen, which",
        remedy);
}

void ShadowMemory::require(std::size_t shadows) const {
    // The list of what throws which shadow, and the triangle, while vectors grow.
    constexpr double per_shadow = 16 + 2 * (sizeof(ScreenTriangle) + sizeof(ScreenVertex));
    // Its corners, before they are on the grid.
    constexpr double per_outline = 180;
    const auto count = static_cast<double>(shadows);
    const double raster =
        raster_bytes({before_.surfaces, before_.shadows + shadows, before_.vertices + shadows});
    require_memory(
        per_shadow * count + std::max(per_outline * count, raster),
        "drawing the " + std::to_string(shadows) + " shadows of a light",
        "--shadows off leaves them out, " + std::string(remedy));
}

} // namespace vera
