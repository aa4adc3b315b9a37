// SPDX-License-Identifier: Apache-2.0
#include "make_output.h"

#include "vera/base/output_file.h"
#include "vera/formats/scene_writer.h"
#include "vera/generate/stage.h"

#include <filesystem>
#include <memory>

#include "interrupt.h"
#include "messages.h"
#include "progress_display.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

void add_make_output_options(CLI::App& command, MakeOutput& output) {
    command
        .add_option(
            "-o,--output",
            output.path,
            "scene text to write, with a control file beside it; - for standard output")
        ->required()
        ->type_name("SCENE");
    command.add_flag(
        "--bare", output.bare, "without ground, lights, camera and control file, to be included");
}

void check_make_output(const MakeOutput& output) {
    if (output.path != "-" && std::filesystem::path(output.path).extension() != ".vera")
        throw CommandLineError(fmt::format(
            "'{}' is no name of a scene text; take one that ends in .vera, or -", output.path));
}

void write_made_scene(const Scene& scene, const MakeOutput& output, const Console& console) {
    check_make_output(output);
    const std::filesystem::path path = output.path;
    const bool with_control = !output.bare && output.path != "-";
    const std::filesystem::path control_path =
        std::filesystem::path(path).replace_extension(".ctl");
    OutputFile file(path);
    std::unique_ptr<OutputFile> control;
    if (with_control)
        control = std::make_unique<OutputFile>(control_path);
    {
        const CancellableWork work;
        ProgressDisplay display(console, "write");
        const auto write = [&](std::string_view text) { file.write(text); };
        write_vera_scene(scene, write, display.callback(), &console.cancel);
    }
    file.commit();
    if (!with_control)
        return;
    control->write(stage_control_text());
    control->commit();
    print_note(
        fmt::format(
            "{0}, {1}: to be seen by 'vera render {0} -c {1} -o {2}'",
            path.string(),
            control_path.string(),
            std::filesystem::path(path).replace_extension(".png").string()),
        console);
}

} // namespace vera
