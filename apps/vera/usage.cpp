// SPDX-License-Identifier: Apache-2.0
#include "usage.h"

#include "vera/base/similar_words.h"

#include <optional>
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

/// "unknown option '--rastr'; did you mean '--raster'?"
std::string unknown_word(const CLI::App& command, const std::string& word) {
    const bool option = word.size() > 1 && word.front() == '-';
    const bool takes_commands = !command_names(command).empty();
    const char* const what = option ? "option" : takes_commands ? "command" : "argument";
    const std::string name = word.substr(0, word.find('='));
    if (const auto similar = most_similar(name, known_words(command)))
        return fmt::format("unknown {} '{}'; did you mean '{}'?", what, name, *similar);
    return fmt::format("unknown {} '{}'", what, name);
}

/// "--index takes auto, grid or brute; found 'gird'; did you mean 'grid'?", when the error begins
/// with the name of an option whose type is such a list.
std::optional<std::string> wrong_choice(const CLI::App& command, std::string_view problem) {
    const std::string name(problem.substr(0, problem.find(':')));
    const CLI::Option* const option = command.get_option_no_throw(name);
    if (option == nullptr || option->results().empty())
        return std::nullopt;
    std::vector<std::string> choices;
    std::string type = option->get_type_name();
    for (std::size_t bar = 0; bar != std::string::npos; type.erase(0, bar + 1)) {
        bar = type.find('|');
        choices.push_back(type.substr(0, bar));
    }
    if (choices.size() < 2)
        return std::nullopt;
    const std::string& found = option->results().back();
    const auto similar = most_similar(found, choices);
    return fmt::format(
        "{} takes {}; found '{}'{}",
        name,
        list_of(choices),
        found,
        similar ? fmt::format("; did you mean '{}'?", *similar) : "");
}

/// "--size is given more than once", when that is what is wrong.
std::optional<std::string> repeated_option(const CLI::ParseError& error) {
    const std::string_view problem = error.what();
    const std::size_t end = problem.find(": At Most 1 required");
    if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) == nullptr || end == std::string::npos)
        return std::nullopt;
    return fmt::format("{} is given more than once", problem.substr(0, end));
}

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
    if (const auto choice = wrong_choice(command_in_use(app), error.what()))
        return with_help_hint(app, *choice);
    if (const auto repeated = repeated_option(error))
        return with_help_hint(app, *repeated);
    std::string problem = error.what();
    for (char& letter : problem)
        letter = letter == '\n' ? ' ' : letter;
    return with_help_hint(app, problem);
}

} // namespace vera
