// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/drawing_file.h"

#include <string_view>
#include <vector>

namespace vera {

/// Changes the style of one class as a --line option says:
/// "silhouette:width=2,color=#333,dash=4-2". Throws CommandLineError.
void apply_line_option(std::string_view text, std::vector<LineStyle>& styles);

} // namespace vera
