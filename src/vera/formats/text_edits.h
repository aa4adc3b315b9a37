// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace vera {

/// Other bytes in place of some of a text.
struct TextEdit {
    std::size_t offset = 0;
    std::size_t length = 0; ///< of what is replaced; 0 inserts
    std::string text = {};

    friend bool operator==(const TextEdit&, const TextEdit&) = default;
};

/// The edits by their places, without those that overlap one before them.
std::vector<TextEdit> in_order(std::vector<TextEdit> edits);

/// The text with all edits, which are in order.
std::string edited(std::string_view text, const std::vector<TextEdit>& edits);

/// The edits, which are in order, as a unified diff with three lines around each change, as patch
/// and git take it. Empty where nothing changes.
std::string unified_diff(
    std::string_view text,
    const std::vector<TextEdit>& edits,
    std::string_view name_before,
    std::string_view name_after);

} // namespace vera
