// SPDX-License-Identifier: Apache-2.0
#include "vera/base/available_memory.h"
#include "vera/base/free_room.h"
#include "vera/base/held_memory.h"
#include "vera/base/output_file.h"
#include "vera/base/progress_part.h"
#include "vera/base/version.h"
#include "vera/drawing/drawing_file.h"
#include "vera/render/exposure.h"
#include "vera/visible/draw_scene.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "command.h"
#include "draw_report.h"
#include "drawing_verification.h"
#include "interrupt.h"
#include "line_options.h"
#include "messages.h"
#include "option_values.h"
#include "prepared_scene.h"
#include "progress_display.h"
#include "scene_index.h"
#include "stopwatch.h"
#include "time_limit.h"
#include "transparency_warning.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

constexpr std::uint32_t most_points = 1'000'000'000;

struct Request {
    SceneRequest scene;
    std::string output;
    std::string format;
    std::string style = "flat";
    std::string engine = "cells";
    double precision = 0.01;
    double deviation = 0.1;
    std::optional<double> color_tolerance;
    double page = 0;
    double threads = 0;
    double time_limit = 0;
    std::string memory_limit; ///< empty: what the machine has
    std::vector<std::string> lines;
    bool shadow_lines = false;
    double verify = 0; ///< points; 0: not at all
    bool json = false;
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
        similar_file(request.output, {".svg", ".pdf", ".eps", ".dxf"}),
        drawing_format_names(),
        request.output.ends_with(".png") ? ", or make a picture with 'vera render'" : ""));
}

constexpr std::pair<const char*, DrawingStyle> style_of_name[] = {
    {"flat", DrawingStyle::flat},
    {"shaded", DrawingStyle::shaded},
    {"ids", DrawingStyle::ids},
    {"lines", DrawingStyle::lines},
    {"hidden-lines", DrawingStyle::hidden_lines},
    {"toon", DrawingStyle::toon}};

DrawingStyle style_of(const Request& request) {
    for (const auto& [name, style] : style_of_name)
        if (request.style == name)
            return style;
    return DrawingStyle::flat; // not reached: the command line was checked
}

void check_style(const Request& request, DrawingStyle style, DrawingFormat format) {
    if (format == DrawingFormat::dxf && has_fills(style))
        throw CommandLineError(fmt::format(
            "DXF is for lines, and --style {} fills areas; take --style lines or hidden-lines, or "
            "another format",
            request.style));
    if (request.color_tolerance && style != DrawingStyle::shaded)
        throw CommandLineError(fmt::format(
            "--color-tolerance is for gradients, and --style {} has none; take --style shaded",
            request.style));
    if (!request.lines.empty() && !has_lines(style))
        throw CommandLineError(fmt::format(
            "--line is for styles with lines, and --style {} has none; take --style lines, "
            "hidden-lines or toon",
            request.style));
    if (request.shadow_lines && !has_lines(style))
        throw CommandLineError(fmt::format(
            "--shadow-lines is for styles with lines, and --style {} has none; take --style lines, "
            "hidden-lines or toon",
            request.style));
}

/// Scales the light as EXPMES would for a picture.
void expose_as_picture(PreparedScene& prepared, const Console& console, const Progress& progress) {
    const auto index = scene_index(prepared.scene, {}, progress, console.cancel);
    TracedScene traced = traced_scene(prepared.scene, *index, prepared.settings, &console.cancel);
    RenderStatistics statistics;
    expose(traced, prepared.camera, *prepared.settings.exposure, statistics);
    prepared.scene.lights = traced.illumination.lights;
    prepared.settings.ambient = traced.illumination.ambient;
}

/// Draws the scene and writes the drawing; the caller commits the file. Throws Cancelled.
DrawnScene draw_and_write(
    PreparedScene& prepared,
    DrawSettings settings,
    const DrawingSettings& file_settings,
    const Request& request,
    OutputFile& file,
    const Console& console,
    DrawReport& report) {
    const CancellableWork work;
    Stopwatch watch;
    const bool is_exposed = prepared.settings.exposure.value_or(0) > 0 && has_fills(settings.style)
        && settings.style != DrawingStyle::ids;
    ProgressDisplay display(console, "draw");
    StageProgress stages(display.callback(), is_exposed ? 12 : 10);
    if (is_exposed)
        expose_as_picture(prepared, console, stages.next(2));
    if (output_format(request) == DrawingFormat::svg)
        settings.outlines = FaceOutlines::later;
    DrawnScene drawn = draw_scene(
        std::move(prepared.scene),
        prepared.camera,
        prepared.settings,
        settings,
        stages.next(9),
        &console.cancel);
    report.draw_seconds = watch.lap() - report.verify_seconds;
    drawn.drawing.title =
        request.scene.path == "-" ? "" : std::filesystem::path(request.scene.path).stem().string();
    drawn.drawing.description = fmt::format("Drawn by vera {}", version);
    write_drawing(
        drawn.drawing,
        file,
        output_format(request),
        file_settings,
        stages.next(1),
        &console.cancel);
    stages.next(0); // tells that all are done
    console.cancel.throw_if_raised();
    report.write_seconds = watch.lap();
    return drawn;
}

/// Refuses a limit that is less than what there is already with what a small drawing takes, of
/// which there is no forecast.
void require_room_to_draw(std::uint64_t limit) {
    constexpr std::uint64_t mebibyte = std::uint64_t{1} << 20U;
    constexpr std::uint64_t of_small_drawing = 8 * mebibyte; // see require_memory()
    const std::uint64_t held = held_memory();
    if (held + of_small_drawing > limit)
        throw std::runtime_error(fmt::format(
            "the program and the scene take about {} MiB of memory, and a small drawing {} MiB "
            "more: --memory-limit must be {}M at least",
            held / mebibyte + 1,
            of_small_drawing / mebibyte,
            (held + of_small_drawing) / mebibyte + 1));
}

void draw(const Request& request, Console& console) {
    const DrawingFormat format = output_format(request);
    DrawSettings settings;
    settings.style = style_of(request);
    settings.shadow_lines = request.shadow_lines;
    settings.engine = request.engine == "sweep" ? VisibilityEngine::sweep : VisibilityEngine::cells;
    settings.deviation = number_of("--deviation", request.deviation, 1e-4, 100);
    settings.color_tolerance =
        number_of("--color-tolerance", request.color_tolerance.value_or(1), 0.6, 255) / 255;
    DrawingSettings file_settings;
    file_settings.precision = number_of("--precision", request.precision, 1e-6, 1);
    // What is below all faces keeps the background out: lines need only be as wide as a smoothed
    // edge, and are less likely to come out beyond something narrow.
    file_settings.seam_width = 1;
    file_settings.page_width_millimeters = number_of("--page", request.page, 0, 1e5);
    check_style(request, settings.style, format);
    for (const std::string& line : request.lines)
        apply_line_option(line, file_settings.line_styles);
    const std::uint32_t points = whole_of("--verify", request.verify, 0, most_points);
    give_back_freed_blocks(); // each stage takes about as much as the one before it has freed
    const ThreadLimit limit = thread_limit(request.threads);
    std::optional<MemoryLimit> memory;
    if (!request.memory_limit.empty())
        memory.emplace(bytes_of("--memory-limit", request.memory_limit));
    TimeLimit time(
        number_of("--time-limit", request.time_limit, 0, 1e7),
        fmt::format(
            "the drawing takes longer than --time-limit {} allows; nothing is written (a larger "
            "--deviation makes fewer facets)",
            request.time_limit),
        console);
    DrawReport report;
    Stopwatch watch;

    PreparedScene prepared = prepared_scene(request.scene);
    print_diagnostics(prepared.warnings, console);
    if (has_fills(settings.style) && settings.style != DrawingStyle::ids)
        if (const auto warning = transparency_warning(prepared.scene, format_of(request.scene)))
            print_diagnostics({&*warning, 1}, console);
    keep_what_was_read(request.scene, prepared.scene, "--output", request.output);
    if (memory)
        require_room_to_draw(bytes_of("--memory-limit", request.memory_limit));
    // Opened before the long work, so that a folder that is not there shows at once.
    OutputFile file(request.output);
    report.read_seconds = watch.lap();

    if (points > 0)
        settings.check = verification(points, settings.deviation, prepared, console, report);
    DrawnScene drawn;
    try {
        drawn = draw_and_write(prepared, settings, file_settings, request, file, console, report);
    } catch (const Cancelled&) {
        if (time.is_over())
            throw std::runtime_error(time.message());
        throw;
    }
    time.end();
    Stopwatch committing;
    file.commit();
    report.write_seconds += committing.lap();
    // Of what is no file, as a pipe, nothing is told.
    std::error_code none;
    if (std::filesystem::is_regular_file(request.output, none))
        report.bytes = static_cast<std::size_t>(std::filesystem::file_size(request.output, none));

    print_notes(drawn, console);
    if (points > 0)
        print_check(report.check, console);
    if (request.json)
        print_report(as_json(report, drawn).dump(2), request.output);
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
            "flat: the colours that the light gives, with shadows, without mirrors; shaded: the "
            "same in "
            "gradients; ids: each "
            "primitive's number as a colour; lines: silhouettes, creases and intersections; "
            "hidden-lines: and what of them lies behind something, dashed; toon: three tones of "
            "each colour, and lines")
        ->type_name("flat|shaded|ids|lines|hidden-lines|toon")
        ->check(CLI::IsMember({"flat", "shaded", "ids", "lines", "hidden-lines", "toon"})
                    .description(""))
        ->capture_default_str();
    command
        ->add_option(
            "--line",
            request->lines,
            "how a class of lines is drawn, lengths in pixels, as in "
            "silhouette:width=2,color=#333,dash=4-2; may be given several times")
        ->type_name("CLASS:PROPERTIES")
        ->allow_extra_args(false);
    command->add_flag(
        "--shadow-lines", request->shadow_lines, "lines where shadows end as well, class shadow");
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
            "how far the gradients of style shaded may be off the light, in steps of 255, else 1")
        ->type_name("X");
    command
        ->add_option("--page", request->page, "width of the page in millimetres; 0: by the raster")
        ->type_name("MM")
        ->capture_default_str();
    command
        ->add_option(
            "--engine",
            request->engine,
            "how what is seen is found; the drawing is the same. cells: fast, on all threads; "
            "sweep: "
            "by a plane sweep, which meets every crossing of edges, hidden ones as well")
        ->type_name("cells|sweep")
        ->check(CLI::IsMember({"cells", "sweep"}).description(""))
        ->capture_default_str();
    command
        ->add_option(
            "--time-limit",
            request->time_limit,
            "seconds after which the drawing is given up, with exit code 3; 0: none")
        ->type_name("S")
        ->capture_default_str();
    command
        ->add_option(
            "--memory-limit",
            request->memory_limit,
            "memory in all, as in 500M or 2.5G: a drawing that is expected to take more is given "
            "up "
            "before it does, with exit code 3; else what the machine has")
        ->type_name("SIZE");
    add_threads_option(*command, request->threads);
    command->add_flag(
        "--verify{100000}",
        request->verify,
        "compare the drawing with rays at that many points (--verify=N), and write none that "
        "differs");
    command->add_flag("--json", request->json, "counts and times as JSON on standard output");
    add_console_options(*command, console);
    command->footer(
        "Examples:\n"
        "  vera draw bracket.obj -o bracket.svg\n"
        "  vera draw scene.vera -o scene.pdf --page 120\n"
        "  vera draw scene.vera -o outlines.svg --style lines --line silhouette:width=3\n"
        "  vera draw scene.vera -o plan.dxf --style hidden-lines --page 200");

    command->callback([request, &console] { draw(*request, console); });
}

} // namespace vera
