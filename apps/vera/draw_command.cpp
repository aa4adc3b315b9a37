// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"
#include "vera/base/version.h"
#include "vera/drawing/drawing_file.h"
#include "vera/render/exposure.h"
#include "vera/visible/draw_scene.h"

#include <filesystem>
#include <memory>
#include <vector>

#include "command.h"
#include "interrupt.h"
#include "messages.h"
#include "option_values.h"
#include "prepared_scene.h"
#include "progress_display.h"
#include "scene_index.h"
#include "stopwatch.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vera {

namespace {

constexpr std::uint32_t most_threads = 1024;

struct Request {
    SceneRequest scene;
    std::string output;
    std::string format;
    std::string style = "flat";
    double precision = 0.01;
    double deviation = 0.1;
    double color_tolerance = 1;
    double page = 0;
    double threads = 0;
    bool json = false;
};

struct Report {
    double read_seconds = 0;
    double draw_seconds = 0;
    double write_seconds = 0;
    std::size_t bytes = 0;
};

DrawingFormat output_format(const Request& request) {
    if (!request.format.empty()) {
        if (const auto format = drawing_format_from_name(request.format))
            return *format;
        throw CommandLineError(fmt::format(
            "--format does not know '{}'; it knows {}", request.format, drawing_format_names()));
    }
    if (request.output == "-")
        throw CommandLineError("a drawing on standard output needs --format, as in --format svg");
    if (const auto format = drawing_format_from_extension(request.output))
        return *format;
    throw CommandLineError(fmt::format(
        "cannot tell the format of '{}' by its name; {}give --format with one of {}{}",
        request.output,
        similar_file(request.output, {".svg", ".pdf", ".eps"}),
        drawing_format_names(),
        request.output.ends_with(".png") ? ", or make a picture with 'vera render'" : ""));
}

DrawingStyle style_of(const Request& request) {
    if (request.style == "shaded")
        return DrawingStyle::shaded;
    if (request.style == "ids")
        return DrawingStyle::ids;
    return request.style == "lines" ? DrawingStyle::lines : DrawingStyle::flat;
}

/// Scales the light as EXPMES would for a picture.
void expose_as_picture(PreparedScene& prepared, const Console& console) {
    if (prepared.settings.exposure.value_or(0) <= 0)
        return;
    const CancellableWork work;
    const auto index = scene_index(prepared.scene, {}, {}, console.cancel);
    TracedScene traced = traced_scene(prepared.scene, *index, prepared.settings, &console.cancel);
    RenderStatistics statistics;
    expose(traced, prepared.camera, *prepared.settings.exposure, statistics);
    prepared.scene.lights = traced.illumination.lights;
    prepared.settings.ambient = traced.illumination.ambient;
}

void print_notes(const DrawnScene& drawn, const Console& console) {
    if (drawn.cut_nearness > 0)
        print_note(
            fmt::format(
                "what is nearer to the view point than {:.3g} of the image plane's distance is not "
                "drawn: the rest would be too coarse",
                drawn.cut_nearness),
            console);
    if (drawn.penetrating > 0)
        print_note(
            fmt::format(
                "{} pairs of facets still pass through each other after {} rounds of cutting: "
                "outlines there may be wrong",
                drawn.penetrating,
                drawn.cut_rounds),
            console);
}

nlohmann::ordered_json as_json(const Report& report, const DrawnScene& drawn) {
    return {
        {"version", 1},
        {"facets", drawn.facets},
        {"visible_faces", drawn.visible_faces},
        {"cut_rounds", drawn.cut_rounds},
        {"penetrating", drawn.penetrating},
        {"bytes", report.bytes},
        {"seconds",
         {{"read", report.read_seconds},
          {"draw", report.draw_seconds},
          {"write", report.write_seconds}}}};
}

void draw(const Request& request, const Console& console) {
    const DrawingFormat format = output_format(request);
    DrawSettings settings;
    settings.style = style_of(request);
    settings.deviation = number_of("--deviation", request.deviation, 1e-4, 100);
    settings.color_tolerance =
        number_of("--color-tolerance", request.color_tolerance, 0.6, 255) / 255;
    DrawingSettings file_settings;
    file_settings.precision = number_of("--precision", request.precision, 1e-6, 1);
    file_settings.page_width_millimeters = number_of("--page", request.page, 0, 1e5);
    const ThreadLimit limit(whole_of("--threads", request.threads, 0, most_threads));
    Report report;
    Stopwatch watch;

    PreparedScene prepared = prepared_scene(request.scene);
    print_diagnostics(prepared.warnings, console);
    // Opened before the long work, so that a folder that is not there shows at once.
    OutputFile file(request.output);
    report.read_seconds = watch.lap();

    if (settings.style == DrawingStyle::flat || settings.style == DrawingStyle::shaded)
        expose_as_picture(prepared, console);
    DrawnScene drawn;
    {
        const CancellableWork work;
        ProgressDisplay display(console, "draw");
        drawn = draw_scene(
            prepared.scene,
            prepared.camera,
            prepared.settings,
            settings,
            display.callback(),
            &console.cancel);
    }
    report.draw_seconds = watch.lap();

    drawn.drawing.title =
        request.scene.path == "-" ? "" : std::filesystem::path(request.scene.path).stem().string();
    drawn.drawing.description = fmt::format("Drawn by vera {}", version);
    write_drawing(drawn.drawing, file, format, file_settings);
    file.commit();
    report.write_seconds = watch.lap();
    // Of what is no file, as a pipe, nothing is told.
    std::error_code none;
    if (std::filesystem::is_regular_file(request.output, none))
        report.bytes = static_cast<std::size_t>(std::filesystem::file_size(request.output, none));

    print_notes(drawn, console);
    if (request.json)
        fmt::print(request.output == "-" ? stderr : stdout, "{}\n", as_json(report, drawn).dump(2));
    else
        print_note(
            fmt::format(
                "{}: {} faces seen of {} facets; {} to read, {} to draw, {} to write",
                request.output == "-" ? "standard output" : request.output,
                drawn.visible_faces,
                drawn.facets,
                duration_text(report.read_seconds),
                duration_text(report.draw_seconds),
                duration_text(report.write_seconds)),
            console);
}

} // namespace

/// vera draw SCENE -o DRAWING
void add_draw_command(CLI::App& app, Console& console) {
    const auto request = std::make_shared<Request>();

    CLI::App* command =
        app.add_subcommand("draw", "a vector drawing of a scene or mesh, every visible face exact");
    add_scene_options(*command, request->scene);
    command->add_option("-o,--output", request->output, "drawing to write; - for standard output")
        ->required()
        ->type_name("DRAWING");
    command
        ->add_option(
            "--format",
            request->format,
            "of the drawing, where its name does not tell: " + drawing_format_names())
        ->type_name("NAME");
    command
        ->add_option(
            "--style",
            request->style,
            "flat: the colours that the light gives, without shadows and mirrors; shaded: the same "
            "in gradients; ids: each primitive's number as a colour; lines: silhouettes and "
            "creases")
        ->type_name("flat|shaded|ids|lines")
        ->check(CLI::IsMember({"flat", "shaded", "ids", "lines"}).description(""))
        ->capture_default_str();
    command
        ->add_option("--precision", request->precision, "of the coordinates, in pixels of --raster")
        ->type_name("X")
        ->capture_default_str();
    command
        ->add_option(
            "--deviation",
            request->deviation,
            "how far the facets of curved surfaces may lie off these, in pixels")
        ->type_name("X")
        ->capture_default_str();
    command
        ->add_option(
            "--color-tolerance",
            request->color_tolerance,
            "how far the gradients of style shaded may be off the light, in steps of 255")
        ->type_name("X")
        ->capture_default_str();
    command
        ->add_option("--page", request->page, "width of the page in millimetres; 0: by the raster")
        ->type_name("MM")
        ->capture_default_str();
    command->add_option("--threads", request->threads, "0: one for each processor")
        ->type_name("N")
        ->capture_default_str();
    command->add_flag("--json", request->json, "counts and times as JSON on standard output");
    add_console_options(*command, console);
    command->footer("Examples:\n"
                    "  vera draw bracket.obj -o bracket.svg\n"
                    "  vera draw scene.vera -o scene.pdf --page 120\n"
                    "  vera draw scene.vera -o outlines.svg --style lines");

    command->callback([request, &console] { draw(*request, console); });
}

} // namespace vera
