// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/image.h"

#include <string>

#include "command.h"

namespace vera {

enum class PreviewStyle { automatic, never, always };

/// --preview on a subcommand.
void add_preview_option(CLI::App& command, PreviewStyle& style);

/// Shows the picture on standard error, small: with the graphics protocol of kitty where the
/// terminal knows it, else in half blocks of 24 bits or 256 colours. Automatic means where standard
/// error is a terminal, unless the console is quiet or NO_COLOR is set. A failure to show is no
/// error.
void show_preview(const Image& image, PreviewStyle style, const Console& console);

} // namespace vera
