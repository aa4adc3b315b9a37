// SPDX-License-Identifier: Apache-2.0
#include "bench_command.h"

#include "command.h"
#include <CLI/CLI.hpp>

namespace vera {

/// vera bench curve ..., vera bench figure ...
void add_bench_command(CLI::App& app, Console& console) {
    CLI::App* command = app.add_subcommand(
        "bench", "what the paper proves, counted and drawn: growth beside bounds, and figures");
    command->require_subcommand(1);
    command->footer("Examples:\n"
                    "  vera bench curve --list\n"
                    "  vera bench curve conjugation-tree -o nodes.svg\n"
                    "  vera bench figure A1 -o graph.svg");
    add_bench_curve(*command, console);
    add_bench_figure(*command, console);
}

} // namespace vera
