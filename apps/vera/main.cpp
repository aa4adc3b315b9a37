// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/simd_level.h"
#include "vera/base/diagnostic.h"
#include "vera/base/large_pages.h"
#include "vera/base/version.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <new>
#include <string_view>
#include <system_error>

#include "command.h"
#include "formula_words.h"
#include "interrupt.h"
#include "messages.h"
#include "usage.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace {

using vera::Console;
using vera::ExitCode;

struct Command {
    std::string_view name;
    void (*add)(CLI::App& app, Console& console);
};

constexpr std::array<Command, 10> commands = {{
    {"render", vera::add_render_command},
    {"draw", vera::add_draw_command},
    {"convert", vera::add_convert_command},
    {"check", vera::add_check_command},
    {"info", vera::add_info_command},
    {"ladder", vera::add_ladder_command},
    {"explain", vera::add_explain_command},
    {"make", vera::add_make_command},
    {"solve", vera::add_solve_command},
    {"bench", vera::add_bench_command},
}};

/// Only the command that the first word names, or all where it names none: making the options of
/// them all takes longer than loading the program.
void add_commands(CLI::App& app, Console& console, std::string_view first_word) {
    const auto named = std::ranges::find(commands, first_word, &Command::name);
    if (named != commands.end())
        return named->add(app, console);
    for (const Command& command : commands)
        command.add(app, console);
}

ExitCode run(CLI::App& app, Console& console, int argc, char** argv) {
    try {
        vera::honour_simd_environment();
        app.parse(vera::words_to_parse(app, argc, argv));
        return ExitCode::good;
    } catch (const CLI::Success& help) {
        app.exit(help); // prints the help or the version
        return ExitCode::good;
    } catch (const CLI::ParseError& error) {
        vera::print_error(vera::usage_problem(app, error), console);
        return ExitCode::wrong_command_line;
    } catch (const vera::CommandLineError& error) {
        vera::print_error(vera::with_help_hint(app, error.what()), console);
        return ExitCode::wrong_command_line;
    } catch (const vera::InputError& error) {
        vera::print_diagnostics(error.diagnostics(), console);
        return ExitCode::wrong_input;
    } catch (const vera::Cancelled&) {
        vera::print_note("vera: interrupted", console);
        return ExitCode::interrupted;
    } catch (const std::bad_alloc&) {
        vera::print_error("out of memory; nothing was written", console);
        return ExitCode::machine_failed;
    } catch (const std::exception& error) {
        vera::print_error(error.what(), console);
        return ExitCode::machine_failed;
    }
}

} // namespace

int main(int argc, char** argv) {
    vera::begin_heap_in_large_pages();
    Console console;
    vera::occupy_standard_streams();
    vera::stop_on_interrupt(console);

    CLI::App app("VERA turns a scene file into a picture that can be trusted.", "vera");
    vera::show_whole_usage(app);
    app.set_version_flag("--version", std::string("vera ") + vera::version);
    app.require_subcommand(1);
    app.set_help_all_flag();
    app.footer("Examples:\n"
               "  vera render scene.vera -o picture.png\n"
               "  vera render bunny.obj -o bunny.png --raster 1024x1024\n"
               "  vera draw scene.vera -o drawing.svg\n"
               "  vera convert picture.png small.gif --colors 16\n"
               "  vera check scene.vera\n"
               "  vera info scene.vera\n"
               "  vera ladder scene.vera -o steps\n"
               "  vera explain scene.vera 256 300\n"
               "  vera make ficus -o ficus.vera\n"
               "  vera solve layers.exr -o solved.ctl --exposure 0.9\n"
               "  vera bench curve --list\n"
               "'vera COMMAND --help' tells more of a command.\n"
               "Exit codes: 0 good, 1 the input is wrong, 2 the command line is wrong,\n"
               "3 the machine failed, 130 interrupted.");
    add_commands(app, console, argc > 1 ? argv[1] : "");
    vera::refuse_odd_values(app);
    ExitCode code = run(app, console, argc, argv);
    // What was printed may still be on its way to a disk that is full.
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) {
        const std::error_code error(errno, std::generic_category());
        vera::print_error("cannot write standard output: " + error.message(), console);
        code = ExitCode::machine_failed;
    }
    return static_cast<int>(code);
}
