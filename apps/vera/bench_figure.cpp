// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"
#include "vera/theory/figures.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>

#include "bench_command.h"
#include "command.h"
#include "messages.h"
#include "option_values.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

struct Request {
    std::string name;
    std::string output;
    bool list = false;
};

void print_list() {
    for (const Figure& figure : figures())
        fmt::print("{:<4} {}\n", figure.name, figure.title);
}

std::string in_small_letters(std::string word) {
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char letter) {
        return static_cast<char>(std::tolower(letter));
    });
    return word;
}

/// In capitals or not.
const Figure& figure_called(const std::string& name) {
    std::string names;
    for (const Figure& figure : figures()) {
        if (in_small_letters(figure.name) == in_small_letters(name))
            return figure;
        names += (names.empty() ? "" : &figure == &figures().back() ? " and " : ", ") + figure.name;
    }
    throw CommandLineError(fmt::format("there is no figure '{}'; there are {}", name, names));
}

void require_svg(const std::string& path) {
    const std::filesystem::path file(path);
    if (path != "-" && file.extension() != ".svg")
        throw CommandLineError(fmt::format(
            "{}'{}' is no name of an SVG: figures are written as .svg",
            similar_file(file, {".svg"}),
            path));
}

void draw_figure(const Request& request, const Console& console) {
    if (request.list && !(request.name.empty() && request.output.empty()))
        throw CommandLineError("--list only names the figures: give it alone");
    if (request.list)
        return print_list();
    if (request.name.empty())
        throw CommandLineError("name a figure; 'vera bench figure --list' tells which there are");
    const Figure& figure = figure_called(request.name);
    if (request.output.empty())
        throw CommandLineError(
            "--output is required: the file to draw into, or - for standard output");
    require_svg(request.output);
    OutputFile file(request.output);
    const DrawnFigure drawn = figure.drawn();
    file.write(drawn.svg);
    file.commit();
    std::string counts;
    for (const FigureCount& count : drawn.counts)
        counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", count.what, count.count);
    print_note(fmt::format("figure {}: {}", figure.name, counts), console);
}

} // namespace

/// vera bench figure NAME -o FILE
void add_bench_figure(CLI::App& bench, Console& console) {
    const auto request = std::make_shared<Request>();

    CLI::App* command =
        bench.add_subcommand("figure", "a diagram of the paper, drawn from the running structure");
    command->add_option("name", request->name, "3a, 3b, 3c, 3d, A1 or A2")->type_name("NAME");
    command->add_flag("--list", request->list, "what each figure shows");
    command->add_option("-o,--output", request->output, "SVG to write; - for standard output")
        ->type_name("FILE");
    add_console_options(*command, console);
    command->footer("What a figure shows was computed, and what its caption states was counted.\n"
                    "Examples:\n"
                    "  vera bench figure --list\n"
                    "  vera bench figure 3b -o tree.svg\n"
                    "  vera bench figure A1 -o graph.svg");

    command->callback([request, &console] { draw_figure(*request, console); });
}

} // namespace vera
