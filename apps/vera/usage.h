// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace CLI {
class App;
class ParseError;
} // namespace CLI

namespace vera {

/// One line on what is wrong with the command line, with "did you mean" for a word that is like one
/// of ours, and a hint at the help.
std::string usage_problem(const CLI::App& app, const CLI::ParseError& error);

/// The problem, and the command whose help tells more.
std::string with_help_hint(const CLI::App& app, std::string_view problem);

/// Makes the help of the app, and of the commands that are added to it from now on, begin with a
/// line of what cannot be left out: "Usage: vera explain SCENE X Y [OPTIONS]".
void show_whole_usage(CLI::App& app);

/// Makes all options of the app and its commands refuse what no value can be: nothing, "=a" of
/// "-o=a", and a value of a flag. Called once, when all of them are added.
void refuse_odd_values(CLI::App& app);

} // namespace vera
