// SPDX-License-Identifier: Apache-2.0
#include "strategy.h"

#include "vera/base/progress_part.h"
#include "vera/depth_buffer/depth_buffer.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/map_raster.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/projection.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "option_values.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

/// How far facets may lie off a curved surface, in pixels.
constexpr double largest_deviation = 1.0 / 64;

Facets
facets_of(const PreparedScene& prepared, const CameraMap& camera_map, const CancelFlag& cancel) {
    const PictureSettings& settings = prepared.settings;
    const Deviation deviation = deviation_in_pixels(
        camera_map, settings.width, settings.height, largest_deviation, FacetReach::seen);
    return facets(prepared.scene, deviation, &cancel);
}

/// Rectangles in a pixel, as many across as down, or twice as many.
DepthSamples depth_samples(const PictureSettings& settings) {
    DepthSamples samples = {settings.width, settings.height};
    if (settings.antialiasing.on) {
        const auto bits = static_cast<unsigned>(std::bit_width(settings.antialiasing.samples) - 1);
        samples.down = std::size_t{1} << bits / 2;
        samples.across = settings.antialiasing.samples / samples.down;
    }
    return samples;
}

SeenParts parts_of_depth_buffer(const PreparedScene& prepared, const CancelFlag& cancel) {
    const CameraMap camera_map(prepared.camera);
    SeenParts seen;
    seen.facets = std::make_unique<const Facets>(facets_of(prepared, camera_map, cancel));
    std::vector<std::uint32_t> sources(seen.facets->triangles.size());
    std::iota(sources.begin(), sources.end(), 0U);
    const ScreenScene screen = screen_scene(
        *seen.facets, camera_map, sources, std::numeric_limits<double>::infinity(), &cancel);
    seen.cut_nearness = screen.cut_nearness;
    std::vector<DepthTriangle> triangles;
    triangles.reserve(screen.triangles.size());
    for (const ScreenTriangle& triangle : screen.triangles)
        triangles.push_back({corners_of(screen, triangle), triangle.source});
    const auto buffer =
        std::make_shared<const DepthBuffer>(triangles, depth_samples(prepared.settings));
    seen.of_band = [buffer](std::size_t band, std::vector<PixelPart>& parts) {
        buffer->add_parts(band, parts);
    };
    return seen;
}

SeenParts
parts_of_map(const PreparedScene& prepared, const Progress& progress, const CancelFlag& cancel) {
    const CameraMap camera_map(prepared.camera);
    SeenParts seen;
    seen.facets = std::make_unique<const Facets>(facets_of(prepared, camera_map, cancel));
    DrawnFaces faces =
        drawn_faces(prepared.scene, *seen.facets, FaceUnit::plane, prepared.camera, &cancel);
    ScreenScene screen = screen_scene(
        *seen.facets, camera_map, faces.of_facet, std::numeric_limits<double>::infinity(), &cancel);
    seen.cut_nearness = screen.cut_nearness;
    sort_by_place(screen, &cancel);
    StageProgress stages(progress, 5);
    const WholePieces whole = whole_pieces(screen, stages.next(4), &cancel);
    seen.penetrating = whole.left;
    const auto raster = std::make_shared<const MapRaster>(
        visible_map(screen, whole.pieces, stages.next(1), &cancel),
        prepared.settings.width,
        prepared.settings.height,
        &cancel);
    seen.of_band = [raster,
                    first_facet = std::move(faces.first_facet),
                    has_areas = prepared.settings.antialiasing.on](
                       std::size_t band, std::vector<PixelPart>& parts) {
        const std::size_t first = parts.size();
        if (has_areas)
            raster->add_areas(band, parts);
        else
            raster->add_centers(band, parts);
        for (PixelPart& part : std::span(parts).subspan(first))
            if (part.source != PixelPart::background)
                part.source = first_facet[part.source];
    };
    return seen;
}

} // namespace

void add_strategy_option(CLI::App& command, StrategyRequest& request) {
    command
        .add_option(
            "--strategy",
            request.kind,
            "what finds the visible surfaces: rays; visible: their exact outlines, each filled by "
            "its exact part of a pixel; depth: a depth buffer; central: rays that are looked up in "
            "maps of what the viewer and each light sees, for scenes without mirrors and glass; "
            "primitive-query: rays, whole generations of them found for each primitive")
        ->type_name("rays|visible|depth|central|primitive-query")
        ->check(CLI::IsMember({"rays", "visible", "depth", "central", "primitive-query"})
                    .description(""))
        ->capture_default_str();
    command
        .add_option(
            "--queries",
            request.queries,
            "of primitive-query: sweep, one space sweep of all rays; groups, sweeps of rays that "
            "are near to one another; nested, these at the ends of nested trees; trees, nested "
            "trees alone; auto, sweep or groups as their crossings tell [auto]")
        ->type_name("auto|sweep|groups|nested|trees")
        ->check(CLI::IsMember({"auto", "sweep", "groups", "nested", "trees"}).description(""));
    command
        .add_option(
            "--generation-size",
            request.generation_size,
            "of primitive-query: rays at a time; 0: all of a generation [0]")
        ->type_name("N");
}

void check_options(
    const StrategyRequest& request, const IndexRequest& index, const PictureOptions& options) {
    if (request.is_by_primitive()) {
        if (index.kind != "auto")
            throw CommandLineError(fmt::format(
                "--index {} finds hits ray by ray, and --strategy primitive-query for each "
                "primitive: leave one of them out",
                index.kind));
        generation_size(request);
        return;
    }
    for (const auto& [option, is_given] :
         {std::pair{"--queries", !request.queries.empty()},
          std::pair{"--generation-size", request.generation_size.has_value()}})
        if (is_given)
            throw CommandLineError(fmt::format(
                "{0} is of --strategy primitive-query: give that, or leave {0} out", option));
    if (request.is_central() && index.kind != "auto")
        throw CommandLineError(
            "--strategy central looks rays up in maps and needs no index: leave --index out");
    if (request.is_rays())
        return;
    if (options.tolerance)
        throw CommandLineError(fmt::format(
            "--tolerance tells which pixels get more rays, and --strategy {} sends none through "
            "pixels: leave it out",
            request.kind));
    if (request.kind == "visible" && options.samples)
        throw CommandLineError("--strategy visible takes exact areas, not --samples: leave it out");
}

std::size_t generation_size(const StrategyRequest& request) {
    if (!request.is_by_primitive())
        return usual_generation_size;
    constexpr std::uint32_t most = 1'000'000'000;
    const std::uint32_t size =
        whole_of("--generation-size", request.generation_size.value_or(0), 0, most);
    return size == 0 ? whole_generations : size;
}

std::unique_ptr<PrimitiveQueryIndex> primitive_query_index(
    const StrategyRequest& request, const Scene& scene, const CancelFlag& cancel) {
    PrimitiveQuerySettings settings;
    for (const auto& [name, queries] :
         {std::pair{"sweep", RayQueries::sweep},
          std::pair{"groups", RayQueries::groups},
          std::pair{"nested", RayQueries::nested},
          std::pair{"trees", RayQueries::trees}})
        if (request.queries == name)
            settings.queries = queries;
    settings.cancel = &cancel;
    return std::make_unique<PrimitiveQueryIndex>(scene, std::move(settings));
}

SeenParts seen_parts(
    const StrategyRequest& request,
    const PreparedScene& prepared,
    const Progress& progress,
    const CancelFlag& cancel) {
    return request.kind == "depth" ? parts_of_depth_buffer(prepared, cancel)
                                   : parts_of_map(prepared, progress, cancel);
}

bool needs_index(const StrategyRequest& request, const PreparedScene& prepared) {
    const auto& materials = prepared.scene.materials;
    const bool sends_on = prepared.settings.depth > 1
        && std::any_of(materials.begin(), materials.end(), [](const Material& material) {
                              return !is_black(material.rab) || !is_black(material.tab);
                          });
    return request.is_rays() || prepared.settings.shadows || prepared.settings.exposure || sends_on;
}

} // namespace vera
