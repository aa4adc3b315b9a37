// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace vera {

/// How many letters must be inserted, left out, exchanged for others or swapped with their
/// neighbour to make one word of the other. Capitals and small letters differ by nothing.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The candidate most like the word, for "did you mean"; the first of several. Nothing when none is
/// alike: when more than a third of the letters would have to change.
std::optional<std::string>
most_similar(std::string_view word, std::span<const std::string> candidates);

} // namespace vera
