// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "command.h"
#include "messages.h"
#include "prepared_scene.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

struct Request {
    SceneRequest scene;
    bool json = false;
};

void check_scene(const Request& request, const Console& console) {
    std::vector<Diagnostic> diagnostics;
    try {
        diagnostics = prepared_scene(request.scene).warnings;
    } catch (const InputError& error) {
        if (request.json)
            fmt::print("{}\n", to_json(error.diagnostics()));
        throw;
    }
    if (request.json) {
        fmt::print("{}\n", to_json(diagnostics));
        return;
    }
    print_diagnostics(diagnostics, console);
    const std::size_t count = diagnostics.size();
    const std::string with = count == 0
        ? std::string()
        : fmt::format(", with {} warning{}", count, count == 1 ? "" : "s");
    if (!console.quiet)
        fmt::print("{}: good{}\n", request.scene.path, with);
}

} // namespace

/// vera check SCENE
void add_check_command(CLI::App& app, Console& console) {
    const auto request = std::make_shared<Request>();

    CLI::App* check = app.add_subcommand("check", "what is wrong or doubtful in a scene");
    add_scene_options(*check, request->scene);
    check->add_flag("--json", request->json, "the diagnostics as JSON, on standard output");
    add_console_options(*check, console);
    check->footer("Exits with 0 when the scene can be rendered, warnings or not, else with 1.\n"
                  "Examples:\n"
                  "  vera check scene.vera\n"
                  "  vera check scene.vera -c scene.ctl --json");

    check->callback([request, &console] { check_scene(*request, console); });
}

} // namespace vera
