// SPDX-License-Identifier: Apache-2.0
#include <cstdint>
#include <map>

#include "command.h"
#include "option_values.h"
#include <CLI/CLI.hpp>

namespace vera {

void add_console_options(CLI::App& command, Console& console) {
    const std::map<std::string, Console::ProgressStyle> progress_styles = {
        {"auto", Console::ProgressStyle::automatic},
        {"none", Console::ProgressStyle::none},
        {"bar", Console::ProgressStyle::bar},
        {"json", Console::ProgressStyle::json}};
    const std::map<std::string, Console::ColorStyle> color_styles = {
        {"auto", Console::ColorStyle::automatic},
        {"always", Console::ColorStyle::always},
        {"never", Console::ColorStyle::never}};
    const char* const group = "Messages";
    command.add_flag("-q,--quiet", console.quiet, "say nothing but errors")->group(group);
    command.add_option("--progress", console.progress, "how to show how far the work is")
        ->transform(CLI::CheckedTransformer(progress_styles).description(""))
        ->type_name("auto|none|bar|json")
        ->group(group);
    command.add_option("--color", console.color, "colours in messages; auto heeds NO_COLOR")
        ->transform(CLI::CheckedTransformer(color_styles).description(""))
        ->type_name("auto|always|never")
        ->group(group);
}

void add_threads_option(CLI::App& command, double& threads) {
    command.add_option("--threads", threads, "0: one for each processor")
        ->type_name("N")
        ->capture_default_str();
}

ThreadLimit thread_limit(double threads) {
    constexpr std::uint32_t most = 1024;
    return ThreadLimit(whole_of("--threads", threads, 0, most));
}

} // namespace vera
