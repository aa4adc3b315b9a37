// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/scene_parts.h"
#include "vera/generate/stage.h"
#include "vera/generate/turned.h"

#include <cmath>
#include <memory>
#include <vector>

#include "make_output.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

struct Request {
    std::vector<double> profile; ///< r, h, r, h, ...
    bool smooth = false;
    MakeOutput output;
};

std::vector<ContourPiece::Point> profile_of(const std::vector<double>& numbers) {
    if (numbers.size() % 2 != 0)
        throw CommandLineError(fmt::format(
            "the profile has {} numbers, but is made of pairs: distance from the axis, height",
            numbers.size()));
    if (numbers.size() < 4)
        throw CommandLineError("a profile has at least two points: R H R H");
    std::vector<ContourPiece::Point> profile;
    for (std::size_t i = 0; i < numbers.size(); i += 2) {
        const ContourPiece::Point point = {numbers[i], numbers[i + 1]};
        constexpr double most = largest_reach / 1000; // the rest is for what stands round it
        if (!(point.r >= 0 && point.r <= most && std::abs(point.h) <= most))
            throw CommandLineError(fmt::format(
                "point {} of the profile is at {} {}; distances from the axis go from 0 to {:.0e}, "
                "heights from -{:.0e} to that",
                i / 2 + 1,
                point.r,
                point.h,
                most,
                most));
        profile.push_back(point);
    }
    return profile;
}

constexpr Stage turned_stage = {
    .azimuth_degrees = 25, .elevation_degrees = 22, .color = {0.44, 0.50, 0.60}, .mirror = 0.10};

void make_turned(const Request& request, const Console& console) {
    check_make_output(request.output);
    const RotationalShape shape = turned_shape(
        profile_of(request.profile), request.smooth ? ProfileForm::smooth : ProfileForm::straight);
    if (shape.contour.empty())
        throw CommandLineError("all points of the profile are the same, or on the axis; give a "
                               "distance from it to one of them");
    Scene scene;
    add(scene.geometry, shape);
    if (!request.output.bare)
        scene = staged(std::move(scene), "turned", turned_stage);
    write_made_scene(scene, request.output, console);
}

} // namespace

/// vera make turned R H R H ... -o SCENE
void add_make_turned(CLI::App& make, Console& console) {
    const auto request = std::make_shared<Request>();
    CLI::App* command =
        make.add_subcommand("turned", "a shape turned from a profile: a vase, a wheel, a bottle");
    command
        ->add_option(
            "PROFILE",
            request->profile,
            "points, each as distance from the axis and height; from the axis to it for a solid")
        ->required()
        ->type_name("R H R H ...");
    command->add_flag(
        "--smooth",
        request->smooth,
        "curves through the points, instead of straight lines; a point that is given twice is a "
        "corner");
    add_make_output_options(*command, request->output);
    add_console_options(*command, console);
    command->footer("Examples:\n"
                    "  vera make turned 0 0 3 0 3 1 1 1 1 2 0 2 -o wheel.vera\n"
                    "  vera make turned 0 0 1.2 0 1.2 0 2 2 0.8 4 1.3 5 1.3 5 1.15 5 1.15 5 0.65 4 "
                    "1.85 2 0 0.2 \\\n"
                    "       --smooth -o vase.vera");
    command->callback([request, &console] { make_turned(*request, console); });
}

} // namespace vera
