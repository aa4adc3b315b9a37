// SPDX-License-Identifier: Apache-2.0
#include "picture_options.h"

#include "vera/formats/control_file.h"

#include <charconv>
#include <cmath>

#include "command.h"
#include "option_values.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace vera {

namespace {

/// "640x480"
std::pair<std::uint32_t, std::uint32_t> raster_of(const std::string& text) {
    constexpr std::uint32_t most = PictureLimits::longest_side;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    const char* const end = text.data() + text.size();
    const auto first = std::from_chars(text.data(), end, width);
    const bool separated =
        first.ec == std::errc() && first.ptr != end && (*first.ptr == 'x' || *first.ptr == 'X');
    const auto second = separated ? std::from_chars(first.ptr + 1, end, height) : first;
    const bool read = separated && second.ec == std::errc() && second.ptr == end;
    if (!read || width < 1 || height < 1 || width > most || height > most)
        throw CommandLineError(fmt::format(
            "--raster takes WIDTHxHEIGHT in pixels, from 1x1 to {0}x{0}, as in 640x480; found "
            "'{1}'",
            most,
            text));
    return {width, height};
}

bool switch_of(const char* option, const std::string& text) {
    if (text == "on")
        return true;
    if (text == "off")
        return false;
    throw CommandLineError(fmt::format("{} takes on or off; found '{}'", option, text));
}

double margin_of(double margin) {
    if (!(margin >= 0 && margin < PictureLimits::widest_margin))
        throw CommandLineError(fmt::format(
            "--frame takes the margin, at least 0 and less than {}; found {}",
            PictureLimits::widest_margin,
            margin));
    return margin;
}

Color color_of(const char* option, const std::vector<double>& values) {
    for (const double value : values)
        if (!std::isfinite(value))
            throw CommandLineError(
                fmt::format("{} takes three finite numbers; found {}", option, value));
    return {values[0], values[1], values[2]};
}

void override_light(const PictureOptions& options, PictureSettings& settings) {
    if (!options.ambient.empty())
        settings.ambient = color_of("--ambient", options.ambient);
    if (!options.sky.empty()) {
        const Color sky = color_of("--sky", options.sky);
        // The colours are replaced, the shape of the horizon stays.
        std::optional<HorizonProfile> profile;
        if (settings.firmament)
            profile = std::move(settings.firmament->profile);
        settings.firmament = Firmament{sky, sky, sky, std::move(profile)};
    }
    if (options.horizon.empty() && options.earth.empty())
        return;
    if (!settings.firmament)
        throw CommandLineError("--horizon and --earth need a sky: give --sky R G B too");
    if (!options.horizon.empty()) {
        settings.firmament->horizon = color_of("--horizon", options.horizon);
        if (!options.sky.empty())
            settings.firmament->earth = settings.firmament->horizon;
    }
    if (!options.earth.empty())
        settings.firmament->earth = color_of("--earth", options.earth);
}

void override_antialiasing(const PictureOptions& options, Antialiasing& antialiasing) {
    if (!options.antialias.empty())
        antialiasing.on = switch_of("--antialias", options.antialias);
    if (options.antialias == "off" && (options.samples || options.tolerance))
        throw CommandLineError(fmt::format(
            "{} is for smoothed edges, and --antialias off leaves them: give one of the two",
            options.samples ? "--samples" : "--tolerance"));
    if (options.samples) {
        antialiasing.samples =
            whole_of("--samples", *options.samples, 2, PictureLimits::most_samples);
        if ((antialiasing.samples & (antialiasing.samples - 1)) != 0)
            throw CommandLineError(fmt::format(
                "--samples takes a power of two from 2 to 256; found {}", antialiasing.samples));
    }
    if (options.tolerance)
        antialiasing.tolerance = number_of("--tolerance", *options.tolerance, 0, 1);
}

} // namespace

void add_picture_options(CLI::App& command, PictureOptions& options) {
    command
        .add_option(
            "-c,--control", options.control_file, "control file with the picture's settings")
        ->type_name("FILE");
    const char* const group = "Picture (each overrides the control file)";
    command.add_option("--raster", options.raster, "pixels across and down")
        ->type_name("WxH")
        ->group(group);
    command.add_option("--depth", options.depth, "levels of the ray tree; 1: no mirrors, no glass")
        ->type_name("N")
        ->group(group);
    command.add_option("--shadows", options.shadows, "whether objects cast shadows")
        ->type_name("on|off")
        ->group(group);
    command.add_option("--antialias", options.antialias, "whether edges are smoothed")
        ->type_name("on|off")
        ->group(group);
    command
        .add_option(
            "--samples",
            options.samples,
            "rays of a pixel that is refined, a power of two; where its colours differ much, up to "
            "twice as many")
        ->type_name("N")
        ->group(group);
    command
        .add_option(
            "--tolerance",
            options.tolerance,
            "difference between neighbours, 0 to 1, that refines a pixel")
        ->type_name("X")
        ->group(group);
    const auto color = [&](const char* name, std::vector<double>& value, const char* help) {
        command.add_option(name, value, help)->expected(3)->type_name("R G B")->group(group);
    };
    color("--ambient", options.ambient, "light that comes from everywhere");
    color("--sky", options.sky, "colour of the sky overhead");
    color("--horizon", options.horizon, "colour of the sky at the horizon");
    color("--earth", options.earth, "colour below the horizon");
    command
        .add_option(
            "--exposure", options.exposure, "0 measures the light; up to 1 scales it to that")
        ->type_name("E")
        ->group(group);
    command
        .add_option(
            "--frame",
            options.frame_margin,
            "frame the whole scene, with this part of the picture as margin")
        ->type_name("MARGIN")
        ->group(group);
    command
        .add_option("--aspect", options.pixel_aspect, "width of a pixel by its height, for framing")
        ->type_name("X")
        ->group(group);
}

PictureSettings picture_settings(
    const PictureOptions& options, const Scene& scene, std::vector<Diagnostic>& warnings) {
    PictureSettings settings = scene.defaults;
    if (!options.control_file.empty())
        settings = read_control_file(options.control_file, scene.defaults, warnings);
    if (!options.raster.empty())
        std::tie(settings.width, settings.height) = raster_of(options.raster);
    if (options.depth)
        settings.depth = whole_of("--depth", *options.depth, 1, PictureLimits::deepest);
    if (!options.shadows.empty())
        settings.shadows = switch_of("--shadows", options.shadows);
    override_antialiasing(options, settings.antialiasing);
    override_light(options, settings);
    if (options.exposure)
        settings.exposure = number_of("--exposure", *options.exposure, 0, 1);
    if (options.frame_margin)
        settings.frame_margin = margin_of(*options.frame_margin);
    if (options.pixel_aspect)
        settings.pixel_aspect = number_of(
            "--aspect",
            *options.pixel_aspect,
            1 / PictureLimits::largest_aspect,
            PictureLimits::largest_aspect);
    return settings;
}

namespace {

/// " PROFILE ...", from which the same profile is read.
std::string profile_text(const HorizonProfile& profile) {
    if (const auto& mountains = profile.mountains())
        return fmt::format(
            " PROFILE MOUNTAINS {} {} {}",
            mountains->seed,
            mountains->height_degrees,
            mountains->roughness);
    std::string text = fmt::format(" PROFILE {}", profile.points().size());
    for (const ProfilePoint& point : profile.points())
        text += fmt::format(" {} {}", point.azimuth_degrees, point.elevation_degrees);
    return text;
}

} // namespace

std::string control_text(const PictureSettings& settings) {
    const auto color = [](const char* name, Color value) {
        return fmt::format(" {} {} {} {}", name, value.r, value.g, value.b);
    };
    std::string text =
        fmt::format("RASTER {} {} RTDEPTH {}", settings.width, settings.height, settings.depth);
    if (settings.exposure)
        text += fmt::format(" EXPMES {}", *settings.exposure);
    text += color("AMBIENT", settings.ambient);
    if (!settings.light_factors.empty())
        text += fmt::format(" LIGHTS {}", fmt::join(settings.light_factors, " "));
    if (settings.firmament) {
        text += color("SKY", settings.firmament->sky);
        text += color("HORIZON", settings.firmament->horizon);
        text += color("EARTH", settings.firmament->earth);
        if (settings.firmament->profile)
            text += profile_text(*settings.firmament->profile);
    }
    if (settings.shadows)
        text += " SHADOWS";
    if (settings.antialiasing.on)
        text += fmt::format(
            " ANTI-ALIAS SAMPLES {} TOLERANCE {}",
            settings.antialiasing.samples,
            settings.antialiasing.tolerance);
    if (settings.frame_margin)
        text += fmt::format(" FRAME {} ASPECT {}", *settings.frame_margin, settings.pixel_aspect);
    return text;
}

} // namespace vera
