// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"
#include "vera/generate/generator.h"
#include "vera/generate/surface.h"

#include "make_output.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

struct Request {
    std::vector<double> values; ///< in the order of the generator's parameters
    MakeOutput output;
};

ParameterValues checked_values(const Generator& generator, const std::vector<double>& given) {
    ParameterValues values(generator);
    for (std::size_t i = 0; i < given.size(); ++i)
        if (const auto problem = values.set(generator.parameters[i], given[i]))
            throw CommandLineError("--" + *problem); // it begins with the parameter's name
    return values;
}

Scene made(const Generator& generator, const ParameterValues& values) {
    try {
        return generator.make(values);
    } catch (const SurfaceError& error) {
        throw InputError(
            {{.severity = Severity::error,
              .place = {std::string(generator.name), 0, 0},
              .problem = error.what(),
              .remedy = error.remedy}});
    }
}

void add_generator(CLI::App& make, const Generator& generator, Console& console) {
    const auto request = std::make_shared<Request>();
    CLI::App* command =
        make.add_subcommand(std::string(generator.name), std::string(generator.summary));
    request->values.reserve(generator.parameters.size());
    for (const Parameter& parameter : generator.parameters) {
        double& value = request->values.emplace_back(parameter.standard);
        command
            ->add_option(
                fmt::format("--{}", parameter.name),
                value,
                fmt::format(
                    "{}; {} to {}, if not given {}",
                    parameter.meaning,
                    parameter.least,
                    parameter.most,
                    parameter.standard))
            ->type_name(parameter.whole ? "N" : "X");
    }
    add_make_output_options(*command, request->output);
    add_console_options(*command, console);
    const std::string name(generator.name);
    std::string changed;
    if (!generator.parameters.empty())
        changed = fmt::format(
            "\n  vera make {} --{} {} --bare -o -",
            name,
            generator.parameters.front().name,
            generator.parameters.front().standard);
    command->footer(fmt::format("Examples:\n  vera make {0} -o {0}.vera{1}", name, changed));
    command->callback([request, &generator, &console] {
        const ParameterValues values = checked_values(generator, request->values);
        check_make_output(request->output);
        Scene scene = made(generator, values);
        if (!request->output.bare)
            scene = staged(std::move(scene), std::string(generator.name), generator.stage);
        write_made_scene(scene, request->output, console);
    });
}

void print_list() {
    for (const Generator& generator : generators())
        fmt::print("{:<10}  {}\n", generator.name, generator.summary);
    fmt::print("{:<10}  {}\n", "surface", "a surface whose formulas you type");
    fmt::print("{:<10}  {}\n", "turned", "a shape turned from a profile that you type");
}

} // namespace

/// vera make NAME -o SCENE
void add_make_command(CLI::App& app, Console& console) {
    const auto list = std::make_shared<bool>(false);
    CLI::App* make = app.add_subcommand("make", "a scene made by a procedure: plants, gears, ...");
    make->require_subcommand(0, 1);
    make->add_flag("--list", *list, "the names of all procedures, with a line on each");
    make->footer("Examples:\n"
                 "  vera make --list\n"
                 "  vera make balls --help\n"
                 "  vera make balls --size 3 -o balls.vera");
    for (const Generator& generator : generators())
        add_generator(*make, generator, console);
    add_make_surface(*make, console);
    add_make_turned(*make, console);
    make->callback([make, list] {
        if (*list)
            return print_list();
        if (make->get_subcommands().empty())
            throw CommandLineError("say what to make; 'vera make --list' shows what there is");
    });
}

} // namespace vera
