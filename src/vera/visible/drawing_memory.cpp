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

double curved_part_of(const Facets& facets) {
    constexpr std::size_t many = 32;
    const auto& triangles = facets.triangles;
    std::size_t curved = 0;
    for (std::size_t first = 0, end = 0; first < triangles.size(); first = end) {
        while (end < triangles.size() && triangles[end].primitive == triangles[first].primitive)
            ++end;
        curved += end - first >= many ? end - first : 0;
    }
    return triangles.empty() ? 0
                             : static_cast<double>(curved) / static_cast<double>(triangles.size());
}

namespace {

/// Of a surface as many as both together; of triangles that have nothing in common, three each.
double edges_of(const ScreenCounts& counts) {
    const std::size_t triangles = counts.surfaces + counts.shadows;
    return static_cast<double>(std::min(3 * triangles, triangles + counts.vertices));
}

} // namespace

double raster_bytes(const ScreenCounts& counts) {
    constexpr double per_surface = 131; // with eight entries in lists of cells
    constexpr double per_shadow = 125;
    constexpr double per_edge = 20;
    constexpr double per_cell = 12;
    double cells = 4; // as cells_of() has them
    while (cells < 1.5 * static_cast<double>(counts.surfaces))
        cells *= 4;
    return per_surface * static_cast<double>(counts.surfaces)
        + per_shadow * static_cast<double>(counts.shadows) + per_edge * edges_of(counts)
        + per_cell * cells;
}

double piece_bytes(double pieces, double pairs, PieceStorage storage) {
    // With a point, in parts and as one list; where parts are packed, most of the list takes the
    // place of what edges were compared with.
    const double per_piece = storage == PieceStorage::plain ? 55 : 30;
    constexpr double per_pair = 24;
    return per_piece * pieces + per_pair * pairs;
}

namespace {

/// Bytes that a style takes, by what it takes them for.
struct StyleBytes {
    double piece = 0;
    double curved_piece = 0; ///< beside these, along curved surfaces
    double region = 0;
    double curved_region = 0;  ///< in place of these, of curved surfaces
    double region_at_hand = 0; ///< of those whose outlines are made at a time
    double surface = 0;        ///< whose edges may be hidden lines
    double curved_surface = 0;
};

StyleBytes bytes_of(DrawingStyle style, FaceOutlines outlines) {
    const bool are_later = outlines == FaceOutlines::later;
    switch (style) {
    case DrawingStyle::flat:
        if (are_later)
            return {.piece = 130, .region_at_hand = 1500};
        // Regions of colours that are alike go on below the whole of each other: others take half.
        return {.piece = 160, .curved_piece = 630, .region = 770, .curved_region = 20};
    case DrawingStyle::shaded: // curved ones are smooth faces, or facets
        if (are_later)
            return {.piece = 140, .region_at_hand = 2000};
        return {.piece = 200, .curved_piece = 160, .region = 920, .curved_region = 80};
    case DrawingStyle::ids: // as areas that share their corners
        return {.piece = 75};
    case DrawingStyle::lines:
        return {.piece = are_later ? 130.0 : 220.0}; // without the text or with it
    case DrawingStyle::hidden_lines:                 // the edges of smooth ones are none
        return {.piece = 440, .surface = 530, .curved_surface = 150};
    case DrawingStyle::toon:
        if (are_later)
            return {.piece = 170, .region_at_hand = 1500};
        return {
            .piece = 295, .curved_piece = 120, .region = 730, .curved_region = 540, .surface = 70};
    }
    return {};
}

} // namespace

double drawing_bytes(
    double pieces, const ScreenCounts& counts, DrawingStyle style, FaceOutlines outlines) {
    const StyleBytes bytes = bytes_of(style, outlines);
    const auto surfaces = static_cast<double>(counts.surfaces);
    const auto curved = static_cast<double>(counts.curved);
    const double part = surfaces > 0 ? std::min(curved / surfaces, 1.0) : 0;
    // Each surface has one, and what shadows leave of it. Of its three sides and more two may have
    // each.
    const double regions = std::min(surfaces + static_cast<double>(counts.shadows), 2 * pieces / 3);
    constexpr double most_at_hand = 2048;
    return pieces * (bytes.piece + part * bytes.curved_piece)
        + std::min(regions, most_at_hand) * bytes.region_at_hand
        + regions * ((1 - part) * bytes.region + part * bytes.curved_region)
        + surfaces * ((1 - part) * bytes.surface + part * bytes.curved_surface);
}

void require_raster_memory(const ScreenScene& scene) {
    require_memory(
        raster_bytes(counts_of(scene)),
        "finding what is seen of " + std::to_string(scene.triangles.size()) + " triangles",
        remedy);
}

void require_piece_memory(double pieces, double pairs, PieceStorage storage) {
    const std::string penetrating =
        pairs < 1 ? "" : ", and triangles pass through each other about " + about(pairs) + " times";
    require_memory(
        piece_bytes(pieces, pairs, storage),
        "what is seen has borders of about " + about(pieces) + " pieces" + penetrating + ", which",
        remedy);
}

namespace {

/// The room in which pieces of one part of the edges are found before they are put beside those of
/// the others.
double room_bytes(double pieces, const ScreenCounts& counts) {
    constexpr double per_piece = 110;
    constexpr double edges_of_part = 4096;
    return per_piece * pieces * std::min(edges_of_part / std::max(edges_of(counts), 1.0), 1.0);
}

/// What is there now and is given back before the map is made. Forecasts may be half too large.
double given_back_bytes(double pieces, ScreenCounts counts) {
    if (counts.shadows == 0)
        return raster_bytes(counts) / 1.5;
    // Few shadows are there at a time, but a list of what throws them, and pieces of surfaces.
    constexpr double per_shadow = 8;
    const double list = per_shadow * static_cast<double>(counts.shadows);
    counts.shadows = 0;
    return raster_bytes(counts) / 1.5 + list + piece_bytes(pieces) / 2;
}

} // namespace

void require_drawing_memory(
    double pieces, const ScreenCounts& counts, DrawingStyle style, FaceOutlines outlines) {
    require_memory(
        std::max(
            piece_bytes(pieces) + room_bytes(pieces, counts),
            drawing_bytes(pieces, counts, style, outlines) - given_back_bytes(pieces, counts)),
        "the drawing would have about " + about(pieces) + " lines between what is seen, which",
        remedy);
}

void require_throw_memory(std::size_t throws) {
    // In two vectors while one grows, or as it is kept.
    constexpr double per_throw = 24;
    require_memory(
        per_throw * static_cast<double>(throws),
        "listing the " + std::to_string(throws) + " shadows of a light",
        "--shadows off leaves them out, " + std::string(remedy));
}

} // namespace vera
