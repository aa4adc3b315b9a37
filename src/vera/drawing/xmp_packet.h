// SPDX-License-Identifier: Apache-2.0
// What a document tells of itself, in the form that programs which sort and search files read.
#pragma once

#include <string>
#include <string_view>

namespace vera::detail {

/// An XMP packet (ISO 16684-1) of a PDF: its format, title, description, each where there is one,
/// and what made it. Read-only, and without a date: the same for the same document.
std::string xmp_packet(std::string_view title, std::string_view description);

} // namespace vera::detail
