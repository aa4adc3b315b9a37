// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"
#include "vera/math/bounded_least_squares.h"
#include "vera/render/exposure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>

#include "command.h"
#include "layer_sources.h"
#include "messages.h"
#include "option_values.h"
#include "picture_options.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vera {

namespace {

constexpr double largest_factor = 1e6;

struct Request {
    std::string layers;
    std::string output;
    std::vector<double> places;
    std::vector<double> means;
    std::optional<double> exposure;
    std::vector<double> lights;
    bool ambient = false;
    std::optional<double> least;
    std::optional<double> most;

    double least_factor() const { return least.value_or(0); }

    double most_factor() const { return most.value_or(1000); }
};

/// That the light there have this value.
struct Wish {
    std::string name;
    std::vector<double> sources; ///< what each source gives, with factors of 1
    double fixed = 0;
    double value = 0;
};

/// A number of a list of options that was given as one list, with what it says.
std::uint32_t pixel_of(const char* option, double value, std::size_t size) {
    return whole_of(option, value, 0, static_cast<std::uint32_t>(size - 1));
}

void check_groups(const char* option, const std::vector<double>& values, const char* numbers) {
    if (values.size() % 5 != 0)
        throw CommandLineError(
            fmt::format("{} takes five numbers, {}; found {}", option, numbers, values.size()));
    for (const double value : values)
        if (!std::isfinite(value))
            throw CommandLineError(fmt::format("{} takes finite numbers", option));
}

Wish wish_of(const std::string& name, const SourceLight& light, double value, Color weight) {
    const auto weighted = [&](const Color& color) {
        return weight.r * color.r + weight.g * color.g + weight.b * color.b;
    };
    Wish wish;
    wish.name = name;
    for (const Color& source : light.sources)
        wish.sources.push_back(weighted(source));
    wish.fixed = weighted(light.fixed);
    wish.value = value;
    return wish;
}

void add_place(const LayerSources& layers, const double* values, std::vector<Wish>& wishes) {
    const std::uint32_t x = pixel_of("X of --place", values[0], layers.width());
    const std::uint32_t y = pixel_of("Y of --place", values[1], layers.height());
    const SourceLight light = layers.row(y)[x];
    const auto name = [&](const char* color) {
        return fmt::format("pixel {} {}, {}", x, y, color);
    };
    wishes.push_back(wish_of(name("red"), light, values[2], {1, 0, 0}));
    wishes.push_back(wish_of(name("green"), light, values[3], {0, 1, 0}));
    wishes.push_back(wish_of(name("blue"), light, values[4], {0, 0, 1}));
}

void add_mean(const LayerSources& layers, const double* values, std::vector<Wish>& wishes) {
    const std::uint32_t x = pixel_of("X of --mean", values[0], layers.width());
    const std::uint32_t y = pixel_of("Y of --mean", values[1], layers.height());
    const std::uint32_t width =
        whole_of("W of --mean", values[2], 1, static_cast<std::uint32_t>(layers.width() - x));
    const std::uint32_t height =
        whole_of("H of --mean", values[3], 1, static_cast<std::uint32_t>(layers.height() - y));
    SourceLight sum;
    sum.sources.resize(layers.light_count() + 1);
    for (std::uint32_t row = y; row < y + height; ++row) {
        const std::vector<SourceLight> pixels = layers.row(row);
        for (std::uint32_t column = x; column < x + width; ++column) {
            for (std::size_t i = 0; i < sum.sources.size(); ++i)
                sum.sources[i] += pixels[column].sources[i];
            sum.fixed += pixels[column].fixed;
        }
    }
    const double part = 1 / (3.0 * width * height);
    wishes.push_back(wish_of(
        fmt::format("mean of {} x {} pixels from {} {}", width, height, x, y),
        sum,
        values[4],
        {part, part, part}));
}

std::vector<Wish> wishes_of(const Request& request, const LayerSources& layers) {
    std::vector<Wish> wishes;
    for (std::size_t i = 0; i < request.places.size(); i += 5)
        add_place(layers, &request.places[i], wishes);
    for (std::size_t i = 0; i < request.means.size(); i += 5)
        add_mean(layers, &request.means[i], wishes);
    return wishes;
}

/// Which sources may change: the lights that were named, or all, and AMBIENT if that was asked for.
std::vector<bool> free_sources(const Request& request, const LayerSources& layers) {
    const std::size_t count = layers.light_count();
    std::vector<bool> free(count + 1, request.lights.empty());
    for (const double light : request.lights) {
        if (count == 0)
            throw CommandLineError("--lights names lights, but the scene has none");
        free[whole_of("--lights", light, 1, static_cast<std::uint32_t>(count)) - 1] = true;
    }
    free[count] = request.ambient;
    return free;
}

/// Factors of the sources for which the wishes are met as well as can be, and of all these the ones
/// that change least.
std::vector<double> factors_for(
    const std::vector<Wish>& wishes, const std::vector<bool>& free, double least, double most) {
    BoundedLeastSquares problem;
    problem.columns = free.size();
    double largest = 0;
    for (const Wish& wish : wishes) {
        for (const double source : wish.sources)
            largest = std::max(largest, std::abs(source));
        problem.matrix.insert(problem.matrix.end(), wish.sources.begin(), wish.sources.end());
        problem.right.push_back(wish.value - wish.fixed);
    }
    // So weak that its square is lost beside the wishes, and yet strong enough to decide where they
    // leave a choice.
    const double weak = largest > 0 ? 1e-6 * largest : 1;
    for (std::size_t i = 0; i < free.size(); ++i) {
        for (std::size_t j = 0; j < free.size(); ++j)
            problem.matrix.push_back(i == j ? weak : 0);
        problem.right.push_back(weak);
        problem.least.push_back(free[i] ? least : 1);
        problem.most.push_back(free[i] ? most : 1);
    }
    return solution(problem);
}

double value_of(const Wish& wish, const std::vector<double>& factors) {
    double sum = wish.fixed;
    for (std::size_t i = 0; i < factors.size(); ++i)
        sum += factors[i] * wish.sources[i];
    return sum;
}

/// One factor of all lights and AMBIENT, as EXPMES finds it, but from every pixel that sees
/// something.
std::vector<double> factors_for_exposure(const LayerSources& layers, double exposure) {
    std::vector<ExposureSample> samples;
    for (std::size_t y = 0; y < layers.height(); ++y)
        for (const SourceLight& pixel : layers.row(y)) {
            if (!pixel.sees)
                continue;
            ExposureSample sample = {{}, pixel.fixed};
            for (const Color& source : pixel.sources)
                sample.scaled += source;
            samples.push_back(sample);
        }
    const std::optional<double> factor = exposure_factor(samples, exposure);
    if (factor) {
        std::vector<double> all(layers.light_count() + 1, *factor);
        return all;
    }
    Diagnostic wrong;
    wrong.place.file = "--exposure";
    wrong.problem = fmt::format("no factor on the light brings the picture to {:.3g}", exposure);
    wrong.remedy = "what glows by itself or shows the sky does not change with the light";
    throw InputError({wrong});
}

void print_wishes(
    const std::vector<Wish>& wishes, const std::vector<double>& factors, const Console& console) {
    constexpr double half_a_byte = 0.5 / 255;
    double farthest = 0;
    for (const Wish& wish : wishes) {
        const double value = value_of(wish, factors);
        farthest = std::max(farthest, std::abs(value - wish.value));
        print_note(
            fmt::format("{}: wanted {:.6g}, gets {:.6g}", wish.name, wish.value, value), console);
    }
    if (farthest < half_a_byte)
        return;
    Diagnostic warning;
    warning.severity = Severity::warning;
    warning.place.file = "wishes";
    warning.problem = fmt::format(
        "they cannot all be met: the farthest is off by {:.3g}, of 1; this is the best", farthest);
    warning.remedy =
        "let more lights change (--lights, --ambient), or change more (--least, --most)";
    print_diagnostics({&warning, 1}, console);
}

void print_factors(
    const std::vector<double>& factors, const std::vector<bool>& changed, const Console& console) {
    for (std::size_t i = 0; i < factors.size(); ++i)
        if (changed[i])
            print_note(
                fmt::format(
                    "{} times {:.6g}",
                    i + 1 < factors.size() ? fmt::format("light {}", i + 1) : "AMBIENT",
                    factors[i]),
                console);
}

void check(const Request& request) {
    check_groups("--place", request.places, "X Y R G B");
    check_groups("--mean", request.means, "X Y W H VALUE");
    const bool has_wishes = !request.places.empty() || !request.means.empty();
    if (has_wishes && request.exposure)
        throw CommandLineError(
            "--exposure scales all light at once: give it alone, or --place and --mean");
    if (!has_wishes && !request.exposure)
        throw CommandLineError("say what is wanted: --place, --mean or --exposure");
    if (request.exposure
        && (!request.lights.empty() || request.ambient || request.least || request.most))
        throw CommandLineError("--exposure scales all light at once: leave out --lights, "
                               "--ambient, --least and --most");
    number_of("--least", request.least_factor(), 0, largest_factor);
    number_of("--most", request.most_factor(), 0, largest_factor);
    if (request.least_factor() > request.most_factor())
        throw CommandLineError("--least must not be more than --most");
    std::error_code none;
    if (std::filesystem::equivalent(request.layers, request.output, none))
        throw CommandLineError(fmt::format(
            "'{}' holds the layers: name another file for the control text", request.output));
}

void solve(const Request& request, const Console& console) {
    check(request);
    OutputFile file(request.output);
    const LayerSources layers(request.layers);
    std::vector<bool> changed(layers.light_count() + 1, true);
    std::vector<double> factors;
    if (request.exposure) {
        factors = factors_for_exposure(layers, number_of("--exposure", *request.exposure, 1e-6, 1));
    } else {
        changed = free_sources(request, layers);
        const std::vector<Wish> wishes = wishes_of(request, layers);
        factors = factors_for(wishes, changed, request.least_factor(), request.most_factor());
        print_wishes(wishes, factors, console);
    }
    print_factors(factors, changed, console);

    PictureSettings settings = layers.settings();
    for (std::size_t i = 0; i < layers.light_count(); ++i)
        settings.light_factors[i] *= factors[i];
    settings.ambient = factors.back() * settings.ambient;
    file.write("(* solved by 'vera solve' from layers *)\n" + control_text(settings) + "\n");
    file.commit();
}

} // namespace

/// vera solve LAYERS -o CONTROL
void add_solve_command(CLI::App& app, Console& console) {
    const auto request = std::make_shared<Request>();

    CLI::App* command =
        app.add_subcommand("solve", "lights for a wanted picture, found from its layers");
    command
        ->add_option("layers", request->layers, "EXR file that 'vera render --layers' has written")
        ->required()
        ->type_name("LAYERS");
    command
        ->add_option("-o,--output", request->output, "control file to write; - for standard output")
        ->required()
        ->type_name("CONTROL");
    command
        ->add_option(
            "--place",
            request->places,
            "colour that a pixel is to have, from 0 to 1; may be repeated")
        ->type_name("X Y R G B");
    command
        ->add_option(
            "--mean",
            request->means,
            "mean of all colours in a rectangle, from its upper left pixel; may be repeated")
        ->type_name("X Y W H VALUE");
    command
        ->add_option(
            "--exposure",
            request->exposure,
            "value that 95 % of the pixels are not to exceed, up to 1; scales all light")
        ->type_name("E");
    command->add_option("--lights", request->lights, "the lights that may change, else all of them")
        ->type_name("N...");
    command->add_flag("--ambient", request->ambient, "AMBIENT may change too");
    command->add_option("--least", request->least, "least factor of a light, else 0")
        ->type_name("F");
    command->add_option("--most", request->most, "largest factor of a light, else 1000")
        ->type_name("F");
    add_console_options(*command, console);
    command->footer(
        "The picture is not traced again: light adds up. Wishes are met as well as the\n"
        "factors allow (least squares), with as little change as that leaves.\n"
        "Examples:\n"
        "  vera render scene.vera -o scene.png --layers layers.exr\n"
        "  vera solve layers.exr -o solved.ctl --exposure 0.9\n"
        "  vera solve layers.exr -o solved.ctl --mean 0 0 256 256 0.5 --lights 2\n"
        "  vera solve layers.exr -o solved.ctl --place 100 80 0.9 0.8 0.7 --most 10\n"
        "  vera render scene.vera -c solved.ctl -o solved.png");

    command->callback([request, &console] { solve(*request, console); });
}

} // namespace vera
