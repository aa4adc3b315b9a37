// SPDX-License-Identifier: Apache-2.0
#include "vera/base/large_pages.h"
#include "vera/base/output_file.h"
#include "vera/drawing/drawing_file.h"
#include "vera/image/image_file.h"
#include "vera/render/render_scene.h"

#include <filesystem>
#include <optional>
#include <system_error>

#include "central_strategy.h"
#include "command.h"
#include "generation_report.h"
#include "interrupt.h"
#include "layers_output.h"
#include "messages.h"
#include "option_values.h"
#include "picture_metadata.h"
#include "prepared_scene.h"
#include "preview.h"
#include "progress_display.h"
#include "scene_index.h"
#include "stopwatch.h"
#include "strategy.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vera {

namespace {

constexpr double jpeg_quality_by_default = 95;

struct Request {
    SceneRequest scene;
    IndexRequest index;
    StrategyRequest strategy;
    std::string output;
    std::string format;
    std::string layers;
    std::optional<double> jpeg_quality;
    double threads = 0;
    bool json = false;
    PreviewStyle preview = PreviewStyle::automatic;
};

/// What a run did and what it cost, for people and as JSON.
struct Report {
    double read_seconds = 0;
    double surfaces_seconds = 0;
    double index_seconds = 0;
    double render_seconds = 0;
    double layers_seconds = 0; ///< to render and write them, where they were asked for
    double write_seconds = 0;
    std::size_t index_bytes = 0;
    RenderStatistics statistics;
    std::optional<Exposure> exposure;
    std::optional<std::vector<GenerationCounts>> generations; ///< where primitives find their rays
};

ImageFileFormat output_format(const Request& request) {
    if (!request.format.empty()) {
        if (const auto format = format_from_name(request.format))
            return *format;
        throw CommandLineError(fmt::format(
            "--format does not know '{}'; it knows {}", request.format, format_names()));
    }
    if (request.output == "-")
        throw CommandLineError("a picture on standard output needs --format, as in --format png");
    if (const auto format = format_from_extension(request.output))
        return *format;
    throw CommandLineError(fmt::format(
        "cannot tell the format of '{}' by its name; {}give --format with one of {}{}",
        request.output,
        similar_file(request.output, {".png", ".exr", ".jpg", ".jpeg", ".ppm", ".pfm", ".vra"}),
        format_names(),
        drawing_format_from_extension(request.output) ? ", or make a drawing with 'vera draw'"
                                                      : ""));
}

nlohmann::ordered_json as_json(const Report& report) {
    const RenderStatistics& counts = report.statistics;
    nlohmann::ordered_json json = {
        {"version", 1},
        {"rays",
         {{"view_rays", counts.view_rays},
          {"extra_view_rays", counts.extra_view_rays},
          {"probe_rays", counts.probe_rays},
          {"shadow_rays", counts.shadow_rays},
          {"mirrored_rays", counts.mirrored_rays},
          {"refracted_rays", counts.refracted_rays}}},
        {"parts", counts.parts},
        {"refined_pixels", counts.refined_pixels},
        {"tests", counts.queries.tests},
        {"cells", counts.queries.cells},
        {"index_bytes", report.index_bytes},
        {"seconds",
         {{"read", report.read_seconds},
          {"surfaces", report.surfaces_seconds},
          {"index", report.index_seconds},
          {"render", report.render_seconds},
          {"layers", report.layers_seconds},
          {"write", report.write_seconds}}}};
    if (report.generations)
        json["generations"] = generations_json(*report.generations);
    if (report.exposure)
        json["exposure"] = {
            {"rays", report.exposure->rays},
            {"target", report.exposure->target},
            {"brightness", report.exposure->brightness},
            {"part_too_bright", report.exposure->part_too_bright},
            {"factor", report.exposure->factor}};
    return json;
}

std::string as_text(const Report& report, const Request& request) {
    const RenderStatistics& counts = report.statistics;
    const bool is_by_rays = request.strategy.is_rays();
    const std::string seen = is_by_rays
        ? fmt::format(
            "{} view rays ({} of them for antialiasing), {} probe",
            counts.view_rays,
            counts.extra_view_rays,
            counts.probe_rays)
        : fmt::format("{} parts of pixels; rays: {} view", counts.parts, counts.view_rays);
    return fmt::format(
        "{}: {}, {} shadow, {} mirrored, {} refracted; {} to read, {}{} to index, {} to render",
        request.output == "-" ? "standard output" : request.output,
        seen,
        counts.shadow_rays,
        counts.mirrored_rays,
        counts.refracted_rays,
        duration_text(report.read_seconds),
        is_by_rays ? "" : duration_text(report.surfaces_seconds) + " for surfaces, ",
        duration_text(report.index_seconds),
        duration_text(report.render_seconds));
}

/// Layers are those of rays, and a file of their own.
void check_layers(const Request& request) {
    if (request.layers.empty())
        return;
    if (request.strategy.kind != "rays")
        throw CommandLineError(
            "--layers are those of rays: leave out --strategy, or give --strategy rays");
    check_layers_name(request.layers);
    const auto whole_path = [](const std::string& path) {
        std::error_code unknown;
        return std::filesystem::weakly_canonical(std::filesystem::absolute(path), unknown);
    };
    if (whole_path(request.output) == whole_path(request.layers))
        throw CommandLineError(fmt::format(
            "'{}' cannot hold both the picture and its layers; name two files", request.layers));
}

void print_notes(const SeenParts& seen, const Console& console) {
    if (seen.cut_nearness > 0)
        print_note(
            fmt::format(
                "what is nearer to the view point than {:.3g} of the image plane's distance is not "
                "shown: the rest would be too coarse; --strategy rays shows it",
                seen.cut_nearness),
            console);
    if (seen.penetrating > 0)
        print_note(
            fmt::format(
                "{} pairs of facets pass through each other uncut: their common edges may be "
                "wrong; --strategy rays or depth needs no cutting",
                seen.penetrating),
            console);
}

void print_notes(const CentralIndex& index, const Console& console) {
    const auto print_cut = [&](double distance, const char* point) {
        if (distance > 0)
            print_note(
                fmt::format(
                    "what is nearer to {} than {:.3g} is not seen from there: the rest would be "
                    "too coarse; --strategy rays sees it",
                    point,
                    distance),
                console);
    };
    print_cut(index.view_cut_distance(), "the view point");
    print_cut(index.light_cut_distance(), "a light");
    if (index.penetrating() > 0)
        print_note(
            fmt::format(
                "{} pairs of facets pass through each other uncut: their common edges may be "
                "wrong; --strategy rays needs no cutting",
                index.penetrating()),
            console);
}

/// What the exposure measurement found, as a photographer would want to hear it.
void print_exposure(const Exposure& exposure, const Console& console) {
    if (exposure.rays == 0) {
        print_note("exposure: no ray of the measurement hit anything", console);
        return;
    }
    const char* const verdict = exposure.brightness > 1 ? "too bright"
        : exposure.brightness < 0.5                     ? "too dark"
                                                        : "good";
    std::string text = fmt::format(
        "exposure: brightness {:.3g} of 1 ({}), {:.1f} % of the rays beyond full scale",
        exposure.brightness,
        verdict,
        100 * exposure.part_too_bright);
    if (exposure.target == 0 && exposure.full_factor)
        text += fmt::format(
            "; the light times {:.3g} would just fill the scale", *exposure.full_factor);
    if (exposure.target > 0 && exposure.reachable)
        text += fmt::format("; the light was multiplied by {:.6g}", exposure.factor);
    print_note(text, console);
    if (!exposure.reachable) {
        Diagnostic warning;
        warning.severity = Severity::warning;
        warning.place.file = "EXPMES";
        warning.problem = fmt::format(
            "no factor on the light brings the picture to {:.3g}; it stays as it is",
            exposure.target);
        warning.remedy = "what glows by itself or shows the sky does not change with the light";
        print_diagnostics({&warning, 1}, console);
    }
}

/// What is seen, where that is not left to rays.
SeenParts surfaces(const Request& request, const PreparedScene& prepared, const Console& console) {
    if (request.strategy.is_rays())
        return {};
    const CancellableWork work;
    ProgressDisplay display(console, "surfaces");
    SeenParts seen = seen_parts(request.strategy, prepared, display.callback(), console.cancel);
    print_notes(seen, console);
    return seen;
}

/// What answers the rays, and the same where each primitive is asked for its rays.
struct Answering {
    std::unique_ptr<RayIndex> index;
    PrimitiveQueryIndex* by_primitive = nullptr;
};

Answering index_for(const Request& request, const PreparedScene& prepared, const Console& console) {
    const CancellableWork work;
    if (request.strategy.is_central()) {
        ProgressDisplay display(console, "maps");
        auto index = central_index(prepared, display.callback(), console.cancel);
        print_notes(*index, console);
        return {std::move(index)};
    }
    ProgressDisplay display(console, "index");
    if (request.strategy.is_by_primitive()) {
        auto index = primitive_query_index(request.strategy, prepared.scene, console.cancel);
        PrimitiveQueryIndex* const by_primitive = index.get();
        return {std::move(index), by_primitive};
    }
    IndexRequest wanted = request.index;
    // It needs no building.
    if (!needs_index(request.strategy, prepared))
        wanted.kind = "brute";
    return {scene_index(prepared.scene, wanted, display.callback(), console.cancel), nullptr};
}

RenderResult rendered(
    const PreparedScene& prepared,
    const SeenParts& seen,
    const Answering& answering,
    const StrategyRequest& strategy,
    SampleType type,
    const Console& console) {
    const CancellableWork work;
    ProgressDisplay display(console, "render");
    const auto& [scene, settings, camera, warnings] = prepared;
    if (answering.by_primitive != nullptr) {
        // Whole generations have one tile, and so what tells how far they are is the index alone.
        const std::size_t size = generation_size(strategy);
        if (size == whole_generations)
            answering.by_primitive->set_progress(display.callback());
        RenderResult result = render_scene(
            scene,
            camera,
            *answering.index,
            settings,
            type,
            size == whole_generations ? Progress() : display.callback(),
            &console.cancel,
            size);
        answering.by_primitive->set_progress({});
        return result;
    }
    if (!seen.of_band)
        return render_scene(
            scene, camera, *answering.index, settings, type, display.callback(), &console.cancel);
    return render_parts(
        scene,
        camera,
        *answering.index,
        {*seen.facets, seen.of_band},
        settings,
        type,
        display.callback(),
        &console.cancel);
}

void render(const Request& request, const Console& console) {
    const ImageFileFormat format = output_format(request);
    if (request.jpeg_quality && format != ImageFileFormat::jpeg)
        throw CommandLineError("--quality is for JPEG; write a .jpg, or leave it out");
    const double jpeg_quality =
        number_of("--quality", request.jpeg_quality.value_or(jpeg_quality_by_default), 1, 100);
    if (request.strategy.kind == "rays")
        share_heap_among_threads();
    const ThreadLimit limit = thread_limit(request.threads);
    check_options(request.strategy, request.index, request.scene.picture);
    check_layers(request);
    Report report;
    Stopwatch watch;

    PreparedScene prepared = prepared_scene(request.scene);
    print_diagnostics(prepared.warnings, console);
    keep_what_was_read(request.scene, prepared.scene, "--output", request.output);
    keep_what_was_read(request.scene, prepared.scene, "--layers", request.layers);
    // Opened before the long work, so that a folder that is not there shows at once.
    OutputFile file(request.output);
    std::optional<OutputFile> layers_file;
    if (!request.layers.empty())
        layers_file.emplace(request.layers);
    report.read_seconds = watch.lap();

    const SeenParts seen = surfaces(request, prepared, console);
    report.surfaces_seconds = watch.lap();
    const Answering answering = index_for(request, prepared, console);
    report.index_bytes = answering.index->memory();
    report.index_seconds = watch.lap();

    const RenderResult result =
        rendered(prepared, seen, answering, request.strategy, sample_type(format), console);
    if (answering.by_primitive != nullptr)
        report.generations = answering.by_primitive->generations();
    report.statistics = result.statistics;
    report.exposure = result.exposure;
    if (report.exposure)
        print_exposure(*report.exposure, console);
    report.render_seconds = watch.lap();

    write_image(
        result.image,
        file,
        format,
        picture_metadata(prepared),
        {.jpeg_quality = static_cast<int>(jpeg_quality)});
    report.write_seconds = watch.lap();
    if (layers_file) {
        write_layers(prepared, *answering.index, picture_metadata(prepared), *layers_file, console);
        layers_file->commit();
        report.layers_seconds = watch.lap();
    }
    file.commit();
    report.write_seconds += watch.lap();
    show_preview(result.image, request.preview, console);

    if (request.json)
        print_report(as_json(report).dump(2), request.output);
    else
        print_note(as_text(report, request), console);
    if (report.generations && !request.json)
        print_note(generations_text(*report.generations), console);
}

} // namespace

/// vera render SCENE -o PICTURE
void add_render_command(CLI::App& app, Console& console) {
    const auto request = std::make_shared<Request>();

    CLI::App* command = app.add_subcommand("render", "a ray traced picture of a scene or mesh");
    add_scene_options(*command, request->scene);
    command->add_option("-o,--output", request->output, "picture to write; - for standard output")
        ->required()
        ->type_name("PICTURE");
    command
        ->add_option(
            "--format",
            request->format,
            "of the picture, where its name does not tell: " + format_names())
        ->type_name("NAME");
    command
        ->add_option(
            "--layers",
            request->layers,
            "EXR file to write beside the picture: its light by source and term")
        ->type_name("FILE");
    command->add_option("--quality", request->jpeg_quality, "of a JPEG picture, 1 to 100, else 95")
        ->type_name("Q");
    add_threads_option(*command, request->threads);
    add_index_options(*command, request->index);
    add_strategy_option(*command, request->strategy);
    command->add_flag("--json", request->json, "rays, tests and times as JSON on standard output");
    add_console_options(*command, console);
    add_preview_option(*command, request->preview);
    command->footer("Examples:\n"
                    "  vera render still_life.vera -c still_life.ctl -o still_life.png\n"
                    "  vera render scene.vera -o draft.png --raster 320x240 --antialias off\n"
                    "  vera render scene.vera -o exact.png --strategy visible\n"
                    "  vera render scene.vera -o maps.png --strategy central --depth 1\n"
                    "  vera render scene.vera -o scene.png --layers layers.exr\n"
                    "  vera render scene.vera -o same.png --strategy primitive-query\n"
                    "  vera render bunny.obj -o bunny.exr\n"
                    "  vera render balls.nff --format ppm -o - | display");

    command->callback([request, &console] { render(*request, console); });
}

} // namespace vera
