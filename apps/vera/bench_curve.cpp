// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"
#include "vera/base/progress_part.h"
#include "vera/base/similar_words.h"
#include "vera/theory/curve.h"
#include "vera/theory/curve_plot.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>

#include "bench_command.h"
#include "curve_report.h"
#include "interrupt.h"
#include "option_values.h"
#include "progress_display.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

constexpr const char* all_curves = "all";

struct Request {
    std::vector<std::string> names;
    std::vector<std::string> outputs;
    std::vector<double> sizes;
    std::optional<double> largest;
    double seed = 1;
    bool list = false;
    bool json = false;
};

/// An experiment, and where it is to be counted.
struct Chosen {
    const Experiment* experiment = nullptr;
    std::vector<std::size_t> sizes;
};

enum class CurveFormat { csv, svg };

/// A file of curves, opened before they are counted.
struct CurveFile {
    CurveFile(CurveFormat written_as, const std::string& path)
        : format(written_as)
        , file(path) {}

    CurveFormat format;
    OutputFile file;
};

void print_list() {
    for (const Experiment& experiment : experiments())
        fmt::print("{:<32} {}\n", full_name(experiment), experiment.input);
}

bool is_called(const Experiment& experiment, const std::string& name) {
    return name == all_curves || name == experiment.name || name == full_name(experiment);
}

void require_known(const std::string& name) {
    std::vector<std::string> known = {all_curves};
    for (const Experiment& experiment : experiments()) {
        if (is_called(experiment, name))
            return;
        known.push_back(experiment.name);
        known.push_back(full_name(experiment));
    }
    const auto similar = most_similar(name, known);
    throw CommandLineError(fmt::format(
        "there is no curve '{}'; {}'vera bench curve --list' names all",
        name,
        similar ? fmt::format("did you mean '{}'? ", *similar) : ""));
}

std::vector<std::size_t> sizes_of(const Request& request, const Experiment& experiment) {
    constexpr std::uint32_t most = 1U << 30;
    if (request.sizes.empty()) {
        const std::size_t last =
            request.largest ? whole_of("--largest", *request.largest, 2, most) : experiment.last;
        return sizes_up_to(experiment, last);
    }
    std::vector<std::size_t> sizes;
    for (const double size : request.sizes)
        sizes.push_back(whole_of("--sizes", size, 2, most));
    return sizes;
}

std::vector<Chosen> chosen(const Request& request) {
    if (request.names.empty())
        throw CommandLineError("name a curve, or all; 'vera bench curve --list' names them");
    if (!request.sizes.empty() && request.largest)
        throw CommandLineError("--sizes names every size: leave out --largest");
    for (const std::string& name : request.names)
        require_known(name);
    std::vector<Chosen> found;
    for (const Experiment& experiment : experiments()) {
        const auto is_meant = [&](const std::string& name) { return is_called(experiment, name); };
        if (std::none_of(request.names.begin(), request.names.end(), is_meant))
            continue;
        found.push_back({&experiment, sizes_of(request, experiment)});
        if (const std::string problem = problem_with_sizes(experiment, found.back().sizes);
            !problem.empty())
            throw CommandLineError(problem);
    }
    return found;
}

CurveFormat format_of(const std::string& path) {
    const std::filesystem::path file(path);
    if (path == "-" || file.extension() == ".csv")
        return CurveFormat::csv;
    if (file.extension() == ".svg")
        return CurveFormat::svg;
    throw CommandLineError(fmt::format(
        "{}'{}' tells no format: curves are written as .csv or .svg",
        similar_file(file, {".csv", ".svg"}),
        path));
}

std::vector<std::unique_ptr<CurveFile>> opened_files(const Request& request) {
    std::vector<std::unique_ptr<CurveFile>> files;
    for (const std::string& path : request.outputs) {
        if (path == "-" && request.json)
            throw CommandLineError(
                "--json and '-o -' would both write to standard output: leave out one of them");
        if (std::count(request.outputs.begin(), request.outputs.end(), path) > 1)
            throw CommandLineError(fmt::format("'{}' is named twice: leave out one", path));
        files.push_back(std::make_unique<CurveFile>(format_of(path), path));
    }
    return files;
}

/// One curve after the other; larger sizes count for more of the progress.
std::vector<Curve>
counted(const std::vector<Chosen>& wanted, std::uint64_t seed, const Console& console) {
    double total = 0;
    const auto weight = [](const Chosen& each) { return static_cast<double>(each.sizes.back()); };
    for (const Chosen& each : wanted)
        total += weight(each);
    ProgressDisplay display(console, "count");
    StageProgress stages(display.callback(), total);
    std::vector<Curve> curves;
    curves.reserve(wanted.size());
    try {
        for (const Chosen& each : wanted)
            curves.push_back(counted_curve(
                *each.experiment, each.sizes, seed, stages.next(weight(each)), &console.cancel));
    } catch (const std::invalid_argument& error) {
        throw CommandLineError(error.what());
    }
    return curves;
}

void write(CurveFile& file, const std::vector<Curve>& curves) {
    file.file.write(file.format == CurveFormat::csv ? curve_csv(curves) : curve_plot(curves));
    file.file.commit();
}

void count_curves(const Request& request, const Console& console) {
    const bool asks_for_counts = !request.names.empty() || !request.outputs.empty()
        || !request.sizes.empty() || request.largest || request.json;
    if (request.list && asks_for_counts)
        throw CommandLineError("--list only names the curves: give it alone");
    if (request.list)
        return print_list();
    const std::vector<Chosen> wanted = chosen(request);
    const std::uint32_t seed = whole_of("--seed", request.seed, 0, 1U << 31);
    const auto files = opened_files(request);
    std::vector<Curve> curves;
    {
        const CancellableWork work;
        curves = counted(wanted, seed, console);
    }
    for (const auto& file : files)
        write(*file, curves);
    if (request.json)
        fmt::print("{}\n", curve_json(curves, seed));
    else if (std::count(request.outputs.begin(), request.outputs.end(), "-") == 0)
        fmt::print("{}", curve_tables(curves));
}

} // namespace

/// vera bench curve NAME... [-o FILE]
void add_bench_curve(CLI::App& bench, Console& console) {
    const auto request = std::make_shared<Request>();

    CLI::App* command = bench.add_subcommand(
        "curve", "how counted steps and bytes grow, beside what the paper proves");
    command
        ->add_option(
            "names", request->names, "curves, as NAME for all families or NAME/FAMILY; or all")
        ->type_name("NAME...");
    command->add_flag("--list", request->list, "the names of all curves");
    command
        ->add_option(
            "-o,--output",
            request->outputs,
            "file for the points (.csv) or for a plot (.svg); - for points on standard output; may "
            "be repeated")
        ->type_name("FILE")
        ->allow_extra_args(false);
    command
        ->add_option(
            "--sizes",
            request->sizes,
            "what is counted at, 4 or more in ascending order, with commas")
        ->type_name("N,N,...")
        ->delimiter(',')
        ->allow_extra_args(false);
    command
        ->add_option(
            "--largest",
            request->largest,
            "go on to this size, each larger than the one before by 2 or its root")
        ->type_name("N");
    command->add_option("--seed", request->seed, "another one makes other inputs")
        ->type_name("N")
        ->capture_default_str();
    command->add_flag("--json", request->json, "everything as JSON instead of a table");
    add_console_options(*command, console);
    command->footer(
        "Steps are counted, not timed: they are the same on every machine. A power of the\n"
        "size is fitted to the upper half of the sizes, by least squares of the logarithms,\n"
        "with its interval of 95 %, which a bootstrap checks. A verdict says 'for certain'\n"
        "where chance makes it less than once in 20 times. Then follow the formulas that may\n"
        "be meant, by Akaike's criterion and by what each foretells of the two largest sizes\n"
        "from the smaller ones; and what counts have of each term of a bound of several.\n"
        "Examples:\n"
        "  vera bench curve --list\n"
        "  vera bench curve conjugation-tree/circle kd-tree -o nodes.svg\n"
        "  vera bench curve prop1-steps --largest 1024 -o steps.csv -o steps.svg\n"
        "  vera bench curve visible-sweep/grate --sizes 32,64,128,256 --json\n"
        "  vera bench curve all --seed 7");

    command->callback([request, &console] { count_curves(*request, console); });
}

} // namespace vera
