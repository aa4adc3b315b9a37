// SPDX-License-Identifier: Apache-2.0
#include "usage.h"

#include "vera/base/similar_words.h"

#include <optional>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

/// The subcommand in use, or the program itself.
const CLI::App& command_in_use(const CLI::App& app) {
    const auto used = app.get_subcommands();
    return used.empty() ? app : *used.front();
}

std::vector<std::string> known_words(const CLI::App& command) {
    std::vector<std::string> words;
    for (const CLI::App* subcommand : command.get_subcommands([](const CLI::App*) { return true; }))
        words.push_back(subcommand->get_name());
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames())
            words.push_back("--" + name);
    return words;
}

/// "unknown option '--rastr'; did you mean '--raster'?"
std::string unknown_word(const CLI::App& command, const std::string& word) {
    const bool option = word.size() > 1 && word.front() == '-';
    const bool takes_commands =
        !command.get_subcommands([](const CLI::App*) { return true; }).empty();
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
    std::string list;
    for (std::size_t i = 0; i < choices.size(); ++i)
        list += (i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ") + choices[i];
    const std::string& found = option->results().back();
    const auto similar = most_similar(found, choices);
    return fmt::format(
        "{} takes {}; found '{}'{}",
        name,
        list,
        found,
        similar ? fmt::format("; did you mean '{}'?", *similar) : "");
}

} // namespace

std::string with_help_hint(const CLI::App& app, std::string_view problem) {
    const CLI::App& command = command_in_use(app);
    const std::string name =
        &command == &app ? app.get_name() : app.get_name() + " " + command.get_name();
    return fmt::format("{} ('{} --help' tells more)", problem, name);
}

std::string usage_problem(const CLI::App& app, const CLI::ParseError& error) {
    const std::vector<std::string> unread = app.remaining(true);
    const bool extra_or_missing = dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr
        || dynamic_cast<const CLI::RequiredError*>(&error) != nullptr;
    if (extra_or_missing && !unread.empty())
        return with_help_hint(app, unknown_word(command_in_use(app), unread.front()));
    if (&command_in_use(app) == &app && dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
        return with_help_hint(app, "say what to do: render, draw, check, info, explain or solve");
    if (const auto choice = wrong_choice(command_in_use(app), error.what()))
        return with_help_hint(app, *choice);
    std::string problem = error.what();
    for (char& letter : problem)
        letter = letter == '\n' ? ' ' : letter;
    return with_help_hint(app, problem);
}

} // namespace vera
