// SPDX-License-Identifier: Apache-2.0
#include "usage.h"

#include "vera/base/similar_words.h"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "formula_words.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

/// The subcommand in use, or of subcommands the innermost one, or the program itself.
const CLI::App& command_in_use(const CLI::App& app) {
    const auto used = app.get_subcommands();
    return used.empty() ? app : command_in_use(*used.front());
}

/// "vera make balls"
std::string full_name(const CLI::App& command) {
    const CLI::App* const parent = command.get_parent();
    return parent == nullptr ? command.get_name() : full_name(*parent) + " " + command.get_name();
}

std::vector<std::string> command_names(const CLI::App& command) {
    std::vector<std::string> names;
    for (const CLI::App* subcommand : command.get_subcommands([](const CLI::App*) { return true; }))
        names.push_back(subcommand->get_name());
    return names;
}

/// "auto, grid or brute"
std::string list_of(const std::vector<std::string>& words) {
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i)
        list += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
    return list;
}

std::vector<std::string> known_words(const CLI::App& command) {
    std::vector<std::string> words = command_names(command);
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames())
            words.push_back("--" + name);
    return words;
}

/// "-o"
std::string short_name(const CLI::Option& option) {
    return option.get_snames().empty() ? option.get_name() : "-" + option.get_snames().front();
}

/// "-o PICTURE", "SCENE"
std::string written(const CLI::Option& option) {
    const std::string type = option.get_type_name();
    if (option.get_positional())
        return type.empty() ? option.get_name() : type;
    return short_name(option) + (type.empty() ? "" : " " + type);
}

/// "vera explain SCENE X Y": what the command cannot do without.
std::string synopsis(const CLI::App& command) {
    std::string text = full_name(command);
    for (const bool positional : {true, false})
        for (const CLI::Option* option : command.get_options())
            if (option->get_required() && option->get_positional() == positional)
                text += " " + written(*option);
    return text;
}

/// Whether other programs take the size of a picture by this word: "--width", "-W640", and "+W640"
/// of POV-Ray.
bool is_size_elsewhere(const std::string& word) {
    constexpr std::array<std::string_view, 12> names = {
        "--width",
        "--height",
        "--size",
        "--resolution",
        "--res",
        "-w",
        "-W",
        "-H",
        "+w",
        "+W",
        "+h",
        "+H"};
    const std::string name = word.substr(0, word.find_last_not_of("0123456789xX") + 1);
    return std::ranges::find(names, name) != names.end();
}

/// "unknown option '--rastr'; did you mean '--raster'?"
std::string unknown_word(const CLI::App& command, const std::string& word) {
    const bool option = word.size() > 1 && word.front() == '-';
    const bool takes_commands = !command_names(command).empty();
    const char* const what = option ? "option" : takes_commands ? "command" : "argument";
    // Of "--rastr=5x5" the name; "-=5" is what stands behind a short option that takes no value.
    const std::string name = word.starts_with("-=") ? word : word.substr(0, word.find('='));
    const std::string problem = fmt::format("unknown {} '{}'", what, name);
    if (is_size_elsewhere(name) && command.get_option_no_throw("--raster") != nullptr)
        return problem + "; the size is given by --raster, as in --raster 640x480";
    if (const auto similar = most_similar(name, known_words(command)))
        return fmt::format("{}; did you mean '{}'?", problem, *similar);
    if (option && command.get_option_no_throw(name) != nullptr)
        return fmt::format(
            "{} before the command; write it behind: {} {}", problem, full_name(command), name);
    if (takes_commands && !option)
        return fmt::format("{}; it is one of {}", problem, list_of(command_names(command)));
    return option ? problem : fmt::format("{}; write {}", problem, synopsis(command));
}

/// The option that the library's message is about, whose name stands at its beginning.
const CLI::Option* option_in(const CLI::App& command, std::string_view problem) {
    constexpr std::string_view before = "Could not convert: ";
    if (problem.starts_with(before))
        problem.remove_prefix(before.size());
    const std::string name(problem.substr(0, problem.find_first_of(": ")));
    const CLI::Option* const option = command.get_option_no_throw(name);
    return option != nullptr ? option : command.get_option_no_throw("--" + name);
}

/// "auto", "grid" and "brute" of an option that takes one of these; else nothing.
std::vector<std::string> choices_of(const CLI::Option& option) {
    std::vector<std::string> choices;
    std::string type = option.get_type_name();
    for (std::size_t bar = 0; bar != std::string::npos; type.erase(0, bar + 1)) {
        bar = type.find('|');
        choices.push_back(type.substr(0, bar));
    }
    // "NAME|FILE" are kinds of values.
    const bool are_words =
        choices.size() > 1 && choices.front() == CLI::detail::to_lower(choices.front());
    return are_words ? choices : std::vector<std::string>();
}

/// "--index takes auto, grid or brute; found 'gird'; did you mean 'grid'?"
std::string wrong_choice(const CLI::Option& option, const std::vector<std::string>& choices) {
    const std::string problem = fmt::format("{} takes {}", option.get_name(), list_of(choices));
    for (const std::string& found : option.results()) {
        if (std::ranges::find(choices, found) != choices.end())
            continue;
        const auto similar = most_similar(found, choices);
        return fmt::format(
            "{}; found '{}'{}",
            problem,
            found,
            similar ? fmt::format("; did you mean '{}'?", *similar) : "");
    }
    return problem + "; found none";
}

/// "'1', '2' and '3'"
std::string quoted_list(const std::vector<std::string>& words) {
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i)
        list += fmt::format(
            "{}'{}'",
            i == 0                      ? ""
                : i + 1 == words.size() ? " and "
                                        : ", ",
            words[i]);
    return list;
}

/// "--sky R G B (colour of the sky overhead) takes 3 values"
std::string what_it_takes(const CLI::Option& option, const char* what) {
    const int count = option.get_items_expected_min();
    const std::string many = count > 1        ? fmt::format("{} {}s", count, what)
        : option.get_items_expected_max() > 1 ? fmt::format("{}s", what)
                                              : fmt::format("a {}", what);
    const std::string type = option.get_type_name();
    return fmt::format(
        "{}{} ({}) takes {}",
        option.get_positional() && !type.empty() ? type : option.get_name(),
        option.get_positional() || type.empty() ? "" : " " + type,
        option.get_description(),
        many);
}

std::string wrong_count(const CLI::Option& option) {
    const std::vector<std::string>& found = option.results();
    const bool too_many = found.size() > static_cast<std::size_t>(option.get_items_expected_max());
    if (too_many && option.get_items_expected_max() == 1)
        return fmt::format(
            "{} is given {} times, with {}; give it once",
            option.get_name(),
            found.size(),
            quoted_list(found));
    return fmt::format(
        "{}; found {}{}",
        what_it_takes(option, "value"),
        found.empty() ? "none" : std::to_string(found.size()) + ": ",
        quoted_list(found));
}

std::string wrong_number(const CLI::Option& option) {
    const std::string takes = what_it_takes(option, "number");
    for (const std::string& found : option.results())
        if (double number = 0; !CLI::detail::lexical_cast(found, number))
            return fmt::format("{}; found '{}'", takes, found);
    return fmt::format("{}; found {}", takes, quoted_list(option.results()));
}

/// Whether it is none whatever the option is for: nothing, as of a variable of a shell that is not
/// set, which would pass for an option that is not given; or "=a.png" of "-o=a.png".
bool is_odd(const CLI::Option& option, const std::string& value) {
    return value.empty() || (value.front() == '=' && !option.get_positional());
}

std::string odd_value(const CLI::Option& option) {
    for (const std::string& found : option.results())
        if (found.starts_with('=') && !option.get_positional())
            return fmt::format(
                "'=' is for long names; write {} {} or {}={}",
                short_name(option),
                found.substr(1),
                option.get_name(),
                found.substr(1));
    return fmt::format("{}; found '', which is empty", what_it_takes(option, "value"));
}

std::string
problem_of(const CLI::Option& option, const CLI::App& command, const CLI::ParseError& error) {
    if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
        return fmt::format("{} is missing; write {}", written(option), synopsis(command));
    if (dynamic_cast<const CLI::RequiresError*>(&error) != nullptr)
        for (const CLI::Option* needed : option.get_needs())
            if (needed->count() == 0)
                return fmt::format(
                    "{} is without effect alone; give {} too", option.get_name(), written(*needed));
    if (dynamic_cast<const CLI::ConversionError*>(&error) != nullptr)
        return wrong_number(option);
    if (option.get_items_expected_max() == 0)
        return fmt::format(
            "{} takes no value; leave out what stands behind '='", option.get_name());
    const auto most = static_cast<std::size_t>(option.get_items_expected_max());
    const std::vector<std::string> choices = choices_of(option);
    const bool any_odd = std::ranges::any_of(
        option.results(), [&](const std::string& value) { return is_odd(option, value); });
    if (!choices.empty() && option.results().size() <= most && !any_odd)
        return wrong_choice(option, choices);
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr
        || option.results().size() > most)
        return wrong_count(option);
    return odd_value(option);
}

class UsageFormatter : public CLI::Formatter {
public:
    std::string make_usage(const CLI::App* command, std::string name) const override {
        if (!command_names(*command).empty())
            return CLI::Formatter::make_usage(command, std::move(name));
        return fmt::format("Usage: {} [OPTIONS]\n", synopsis(*command));
    }
};

} // namespace

std::string with_help_hint(const CLI::App& app, std::string_view problem) {
    return fmt::format("{} ('{} --help' tells more)", problem, full_name(command_in_use(app)));
}

std::string usage_problem(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<std::string> unread = app.remaining(true);
    const bool extra_or_missing = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr
        || dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    if (extra_or_missing && !unread.empty())
        return with_help_hint(app, unknown_word(command_in_use(app), typed_word(unread.front())));
    if (&command_in_use(app) == &app && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
        return with_help_hint(app, "say what to do: " + list_of(command_names(app)));
    const CLI::App& command = command_in_use(app);
    if (const CLI::Option* const option = option_in(command, error.what()))
        return with_help_hint(app, problem_of(*option, command, error));
    std::string problem = error.what();
    for (char& letter : problem)
        letter = letter == '\n' ? ' ' : letter;
    return with_help_hint(app, problem);
}

void show_whole_usage(CLI::App& app) {
    app.formatter(std::make_shared<UsageFormatter>());
}

void refuse_odd_values(CLI::App& app) {
    for (CLI::Option* option : app.get_options())
        if (option->get_items_expected_max() > 0)
            option->check([option](const std::string& value) {
                return is_odd(*option, value) ? std::string("is none") : std::string();
            });
        else if (option->get_fnames().empty())
            option->disable_flag_override();
    for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        refuse_odd_values(*command);
}

} // namespace vera
