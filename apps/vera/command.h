// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"

#include <string>

namespace CLI {
class App;
} // namespace CLI

namespace vera {

/// The process's exit codes.
enum class ExitCode : int {
    good = 0,
    wrong_input = 1,
    wrong_command_line = 2,
    machine_failed = 3,
    interrupted = 130
};

/// What holds for every subcommand: how it speaks, and what stops it.
struct Console {
    enum class ProgressStyle { automatic, none, bar, json };
    enum class ColorStyle { automatic, always, never };

    bool quiet = false;
    ProgressStyle progress = ProgressStyle::automatic;
    ColorStyle color = ColorStyle::automatic;
    CancelFlag cancel; ///< raised by Ctrl-C during cancellable work
};

/// The command line is wrong; what() is one line without the program's name.
class CommandLineError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// Each adds one subcommand, whose callback throws as the library does. The console outlives the
// app.
void add_render_command(CLI::App& app, Console& console);
void add_draw_command(CLI::App& app, Console& console);
void add_convert_command(CLI::App& app, Console& console);
void add_check_command(CLI::App& app, Console& console);
void add_info_command(CLI::App& app, Console& console);
void add_ladder_command(CLI::App& app, Console& console);
void add_explain_command(CLI::App& app, Console& console);
void add_make_command(CLI::App& app, Console& console);
void add_solve_command(CLI::App& app, Console& console);
void add_bench_command(CLI::App& app, Console& console);

/// --quiet, --color and --progress, on a subcommand.
void add_console_options(CLI::App& command, Console& console);

/// --threads, on a subcommand that computes with several.
void add_threads_option(CLI::App& command, double& threads);

/// The limit that --threads asks for, while it lives. Throws CommandLineError.
ThreadLimit thread_limit(double threads);

} // namespace vera
