// SPDX-License-Identifier: Apache-2.0
#include "preview.h"

#include "vera/image/terminal_picture.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string_view>

#include <CLI/CLI.hpp>
#include <sys/ioctl.h>
#include <unistd.h>

namespace vera {

namespace {

std::string_view variable(const char* name) {
    const char* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

/// By what terminals say of themselves. They are not asked: an answer would come from the keyboard,
/// where it could be taken for what somebody types.
bool knows_kitty_graphics() {
    // Between us and the terminal, these pass nothing on that they do not know.
    if (!variable("TMUX").empty() || variable("TERM").starts_with("screen"))
        return false;
    return variable("TERM") == "xterm-kitty" || variable("TERM") == "xterm-ghostty"
        || !variable("KITTY_WINDOW_ID").empty();
}

bool knows_all_colors() {
    const std::string_view colors = variable("COLORTERM");
    return colors == "truecolor" || colors == "24bit";
}

struct Cells {
    std::size_t columns = 80;
    std::size_t rows = 24;
};

Cells terminal_cells() {
    winsize size = {};
    if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0 || size.ws_row == 0)
        return {};
    return {size.ws_col, size.ws_row};
}

bool is_shown(PreviewStyle style, const Console& console) {
    if (style != PreviewStyle::automatic)
        return style == PreviewStyle::always;
    return !console.quiet && isatty(STDERR_FILENO) == 1 && variable("NO_COLOR").empty()
        && variable("TERM") != "dumb";
}

std::string graphics(const Image& image) {
    constexpr std::size_t most_side = 480;
    const auto [width, height] = fitted_size(image, most_side, most_side);
    return kitty_graphics(shrunk_image(image, width, height));
}

std::string blocks(const Image& image) {
    // Some lines are left for what stands above.
    constexpr std::size_t other_rows = 4;
    constexpr std::size_t most_columns = 80;
    constexpr std::size_t most_rows = 30;
    const Cells cells = terminal_cells();
    const std::size_t rows = std::min(most_rows, std::max(cells.rows, other_rows + 1) - other_rows);
    const auto [width, height] =
        fitted_size(image, std::min(most_columns, cells.columns), 2 * rows);
    return half_blocks(
        shrunk_image(image, width, height),
        knows_all_colors() ? TerminalColors::rgb24 : TerminalColors::indexed256);
}

} // namespace

void add_preview_option(CLI::App& command, PreviewStyle& style) {
    const std::map<std::string, PreviewStyle> styles = {
        {"auto", PreviewStyle::automatic},
        {"never", PreviewStyle::never},
        {"always", PreviewStyle::always}};
    command
        .add_option("--preview", style, "the picture, small, on a terminal; auto heeds NO_COLOR")
        ->transform(CLI::CheckedTransformer(styles).description(""))
        ->type_name("auto|never|always")
        ->group("Messages");
}

void show_preview(const Image& image, PreviewStyle style, const Console& console) {
    if (!is_shown(style, console))
        return;
    const std::string text = knows_kitty_graphics() ? graphics(image) : blocks(image);
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

} // namespace vera
