// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"
#include "vera/drawing/drawing_file.h"
#include "vera/render/raster.h"

#include <optional>

#include "command.h"
#include "explanation.h"
#include "interrupt.h"
#include "messages.h"
#include "option_values.h"
#include "prepared_scene.h"
#include "progress_display.h"
#include "scene_index.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vera {

namespace {

struct Request {
    SceneRequest scene;
    IndexRequest index;
    double x = 0;
    double y = 0;
    std::string svg;
    double threads = 0;
    bool visits = false;
    bool json = false;
};

TracedScene lit_scene(
    const PreparedScene& prepared,
    const RayIndex& index,
    std::optional<Exposure>& exposure,
    const CancelFlag& cancel) {
    TracedScene traced = traced_scene(prepared.scene, index, prepared.settings, &cancel);
    RenderStatistics statistics;
    if (prepared.settings.exposure)
        exposure = expose(traced, prepared.camera, *prepared.settings.exposure, statistics);
    return traced;
}

/// What is said of the pixel is more than anybody could read.
[[noreturn]] void
refuse(const PreparedScene& prepared, const std::string& problem, const std::string& remedy) {
    Diagnostic wrong;
    if (!prepared.scene.files.empty())
        wrong.place.file = prepared.scene.files.front();
    wrong.problem = problem;
    wrong.remedy = remedy;
    throw InputError({wrong});
}

RayTree tree_of(const TracedScene& traced, const PreparedScene& prepared, double x, double y) {
    const PictureSettings& settings = prepared.settings;
    const Raster raster = {ViewRays(prepared.camera), settings.width, settings.height};
    RayTree tree = ray_tree(traced, raster.ray(x, y));
    if (!tree.complete)
        refuse(
            prepared,
            fmt::format("the ray tree of this pixel has more than {} rays", RayTree::most_nodes),
            "follow fewer levels, as in --depth 8: the picture of that depth is explained");
    return tree;
}

std::vector<RayVisits> visits_of(
    const RayTree& tree,
    const RayIndex& index,
    const PreparedScene& prepared,
    const CancelFlag& cancel) {
    auto visits = ray_visits(tree, index, cancel);
    if (!visits)
        refuse(
            prepared,
            fmt::format(
                "the rays of this pixel visit more than {} cells or nodes and objects",
                RayVisits::most),
            "follow fewer levels, as in --depth 2, or leave out --visits");
    return *std::move(visits);
}

void explain(const Request& request, const Console& console) {
    if (request.visits && request.index.kind == "brute")
        throw CommandLineError("--visits lists cells or nodes, and --index brute has none; take "
                               "--index grid or --index bvh");
    const ThreadLimit limit = thread_limit(request.threads);
    PreparedScene prepared = prepared_scene(request.scene);
    print_diagnostics(prepared.warnings, console);
    const PictureSettings& settings = prepared.settings;
    const std::uint32_t x = whole_of("X", request.x, 0, settings.width - 1);
    const std::uint32_t y = whole_of("Y", request.y, 0, settings.height - 1);
    std::optional<OutputFile> svg;
    if (!request.svg.empty()) {
        if (request.svg != "-" && drawing_format_from_extension(request.svg) != DrawingFormat::svg)
            throw CommandLineError(
                fmt::format("--svg writes SVG; found '{}'; name it as in rays.svg", request.svg));
        keep_what_was_read(request.scene, prepared.scene, "--svg", request.svg);
        svg.emplace(request.svg);
    }

    const CancellableWork work;
    std::unique_ptr<RayIndex> index;
    {
        ProgressDisplay display(console, "index");
        index = scene_index(prepared.scene, request.index, display.callback(), console.cancel);
    }
    std::optional<Exposure> exposure;
    const TracedScene traced = lit_scene(prepared, *index, exposure, console.cancel);
    Explanation explanation = {
        .prepared = prepared,
        .traced = traced,
        .index = request.index.kind == "auto" ? "bvh" : request.index.kind,
        .exposure = exposure,
        .x = x,
        .y = y,
        .tree = tree_of(traced, prepared, request.x, request.y),
        .layers = picture_layers(traced),
        .samples = {},
        .visits = {}};
    if (request.visits)
        explanation.visits = visits_of(explanation.tree, *index, prepared, console.cancel);
    const RayTerms terms = {traced.illumination.lights.size()};
    explanation.samples = layer_samples(
        explanation.layers,
        ray_terms(explanation.tree, terms),
        explanation.tree.nodes.front().color);

    if (svg) {
        ProgressDisplay display(console, "draw");
        svg->write(explanation_svg(explanation, display.callback(), console.cancel));
        svg->commit();
    }
    if (request.json)
        // Names of materials are as their files have them.
        fmt::print(
            "{}\n",
            explanation_json(explanation)
                .dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    else if (request.svg != "-")
        fmt::print("{}", explanation_text(explanation));
}

} // namespace

/// vera explain SCENE X Y
void add_explain_command(CLI::App& app, Console& console) {
    const auto request = std::make_shared<Request>();

    CLI::App* command = app.add_subcommand("explain", "why a pixel has its colour");
    add_scene_options(*command, request->scene);
    command->add_option("x", request->x, "column of the pixel, 0 at the left")
        ->required()
        ->type_name("X");
    command->add_option("y", request->y, "row of the pixel, 0 at the top")
        ->required()
        ->type_name("Y");
    add_index_options(*command, request->index);
    command->add_flag(
        "--visits",
        request->visits,
        "for each ray the cells or nodes that it visits and the objects tested there");
    command->add_flag("--json", request->json, "the same as JSON, every number exact");
    command
        ->add_option("--svg", request->svg, "drawing of the rays to write; - for standard output")
        ->type_name("FILE");
    add_threads_option(*command, request->threads);
    add_console_options(*command, console);
    command->footer(
        "Shows each ray of the pixel's ray tree, what it meets, what every light gives\n"
        "there, every term of the lighting formula, and their sum to the byte.\n"
        "Examples:\n"
        "  vera explain still_life.vera 256 300 -c still_life.ctl\n"
        "  vera explain scene.vera 10 20 --raster 64x64 --json\n"
        "  vera explain scene.vera 10 20 --raster 64x64 --depth 1 --index grid --visits\n"
        "  vera explain scene.vera 256 300 --svg rays.svg");

    command->callback([request, &console] { explain(*request, console); });
}

} // namespace vera
