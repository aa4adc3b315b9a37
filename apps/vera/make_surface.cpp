// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"
#include "vera/generate/formula_shapes.h"
#include "vera/generate/surface.h"
#include "vera/math/transform.h"

#include <optional>

#include "formula_words.h"
#include "interrupt.h"
#include "make_output.h"
#include "option_values.h"
#include "progress_display.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

struct Request {
    std::string x, y, z;
    std::vector<std::string> u = {"0", "1"};
    std::vector<std::string> v = {"0", "1"};
    std::vector<std::string> lets;
    std::optional<double> deviation;
    std::optional<double> pixels;
    double most_triangles = 2'000'000;
    double threads = 0;
    bool z_up = false;
    MakeOutput output;
};

/// What is wrong with a formula, shown as what is wrong with a line of a text.
InputError
formula_problem(const std::string& what, const std::string& text, const FormulaError& error) {
    return InputError(
        {{.severity = Severity::error,
          .place = {what, 1, error.offset + 1},
          .problem = error.what(),
          .remedy = error.remedy,
          .line = text,
          .length = error.length}});
}

template <typename Reader>
auto read_formula(const std::string& what, const std::string& text, const Reader& reader) {
    try {
        return reader(text);
    } catch (const FormulaError& error) {
        throw formula_problem(what, text, error);
    }
}

/// The two ends of a range.
std::pair<double, double>
range(const std::string& option, const std::vector<std::string>& ends, const FormulaNames& names) {
    const auto value = [&](const std::string& text) { return constant_value(text, names); };
    const double begin = read_formula(option, ends[0], value);
    const double end = read_formula(option, ends[1], value);
    if (!(begin < end))
        throw CommandLineError(fmt::format(
            "{} goes from {} to {}, but must go from a smaller to a larger number",
            option,
            begin,
            end));
    return {begin, end};
}

Surface surface_of(const Request& request) {
    FormulaNames names;
    for (const std::string& let : request.lets)
        read_formula("--let", let, [&](const std::string& text) {
            define_name(text, names);
            return 0;
        });
    const auto formula = [&](const std::string& text) { return Formula(text, names); };
    const auto [u_begin, u_end] = range("--u", request.u, names);
    const auto [v_begin, v_end] = range("--v", request.v, names);
    return {
        .x = read_formula("X", typed_word(request.x), formula),
        .y = read_formula("Y", typed_word(request.y), formula),
        .z = read_formula("Z", typed_word(request.z), formula),
        .u_begin = u_begin,
        .u_end = u_end,
        .v_begin = v_begin,
        .v_end = v_end};
}

constexpr Stage surface_stage = {
    .azimuth_degrees = 25, .elevation_degrees = 28, .color = {0.30, 0.46, 0.62}, .mirror = 0.08};

void make_surface(const Request& request, const Console& console) {
    if (request.deviation && request.pixels)
        throw CommandLineError("--deviation and --pixels exclude each other: give one of them");
    if (request.pixels && request.output.bare)
        throw CommandLineError(
            "--pixels needs the camera that --bare leaves out; give --deviation");
    if (request.deviation)
        number_of("--deviation", *request.deviation, 1e-100, 1e100);
    if (request.pixels)
        number_of("--pixels", *request.pixels, 1e-9, 1e9);
    const ThreadLimit limit = thread_limit(request.threads);
    whole_of("--most-triangles", request.most_triangles, 100, 100'000'000);
    const Surface surface = surface_of(request);
    const Affine3 placement = request.z_up ? z_up_to_y_up() : Affine3{};
    const Box3 box = sampled_bounds(surface);
    const double size = box.empty() ? 1 : length(box.upper - box.lower);

    const CancellableWork work;
    ProgressDisplay display(console, "surface");
    TessellationSettings settings = {
        .allowed = {},
        .most_triangles = static_cast<std::size_t>(request.most_triangles),
        .progress = display.callback(),
        .cancel = &console.cancel};
    const auto staged_surface = [&] {
        return staged(
            mesh_scene(tessellated(surface, settings), placement), "surface", surface_stage);
    };
    if (!request.pixels) {
        constexpr double standard = 1.0 / 2000; // of the size
        settings.allowed = deviation_of(request.deviation.value_or(standard * size));
        if (request.output.bare)
            return write_made_scene(
                mesh_scene(tessellated(surface, settings), placement), request.output, console);
        return write_made_scene(staged_surface(), request.output, console);
    }
    // The camera of a rough model, turned as the formulas are.
    constexpr double rough = 1.0 / 200;
    settings.allowed = deviation_of(rough * size);
    const Camera camera = *staged_surface().camera;
    Camera typed = camera;
    const Affine3 back = *inverse(placement);
    for (Vec3* const point :
         {&typed.viewpoint, &typed.lower_left, &typed.lower_right, &typed.upper_left})
        *point = transformed_point(back, *point);
    settings.allowed = deviation_of_pixels(*request.pixels, typed, stage_settings().width);
    Scene scene = staged_surface();
    scene.camera = camera;
    write_made_scene(scene, request.output, console);
}

void make_surface_or_tell(const Request& request, const Console& console) {
    const auto problem = [](const SurfaceError& error, const std::string& more) {
        return InputError(
            {{.severity = Severity::error,
              .place = {"surface", 0, 0},
              .problem = error.what(),
              .remedy = error.remedy + more}});
    };
    try {
        make_surface(request, console);
    } catch (const TooManyTriangles& error) {
        throw problem(
            error,
            request.pixels ? " (--pixels), or --most-triangles"
                           : " (--deviation), or --most-triangles");
    } catch (const SurfaceError& error) {
        throw problem(error, "");
    }
}

} // namespace

/// vera make surface X Y Z -o SCENE
void add_make_surface(CLI::App& make, Console& console) {
    const auto request = std::make_shared<Request>();
    CLI::App* command = make.add_subcommand("surface", "a surface whose formulas you type");
    command->add_option("X", request->x, "formula of x in u and v")->required()->type_name("");
    command->add_option("Y", request->y, "formula of y: up, unless --z-up")
        ->required()
        ->type_name("");
    command->add_option("Z", request->z, "formula of z")->required()->type_name("");
    command->add_option("--u", request->u, "range of u; numbers or formulas; if not given 0 1")
        ->expected(2)
        ->type_name("FROM TO");
    command->add_option("--v", request->v, "range of v")->expected(2)->type_name("FROM TO");
    command
        ->add_option(
            "--let", request->lets, "a name for a number, to be used in formulas; repeatable")
        ->expected(1)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->type_name("NAME=VALUE");
    command
        ->add_option(
            "--deviation",
            request->deviation,
            "length by which the triangles may lie off the surface; if not given, a 2000th of its "
            "size")
        ->type_name("LENGTH");
    command
        ->add_option(
            "--pixels",
            request->pixels,
            "the same in pixels of the picture that the control file asks for, as 0.02")
        ->type_name("P");
    command->add_option("--most-triangles", request->most_triangles, "refuse to make more")
        ->type_name("N")
        ->capture_default_str();
    command->add_flag("--z-up", request->z_up, "the formulas' z is up");
    add_make_output_options(*command, request->output);
    add_threads_option(*command, request->threads);
    add_console_options(*command, console);
    command->footer(fmt::format(
        "Formulas: numbers, u, v, pi, e, + - * / ^ and\n  {}.\n"
        "One that begins with -h, -o or -q, which are options, stands in brackets: "
        "\"(-omega*u)\".\n"
        "Examples:\n"
        "  vera make surface \"cos(u)*cos(v)\" \"sin(v)\" \"sin(u)*cos(v)\" \\\n"
        "       --u 0 2*pi --v -pi/2 pi/2 -o ball.vera\n"
        "  vera make surface u v \"sin(n*(u^2+v^2))/n\" --let n=5 --z-up \\\n"
        "       --u -1 1 --v -1 1 --pixels 0.02 -o waves.vera\n"
        "  vera make surface -v \"-u*v\" u --u -1 1 --v -1 1 -o saddle.vera",
        formula_function_names()));
    command->callback([request, &console] { make_surface_or_tell(*request, console); });
}

} // namespace vera
