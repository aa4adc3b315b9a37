// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

namespace vera {

/// How many bytes the UTF-8 character at the beginning of the text has, which must not be empty; 0
/// when there is none.
std::size_t character_length(std::string_view text);

} // namespace vera
