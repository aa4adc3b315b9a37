// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/vera_keywords.h"

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace vera {

/// Where a word stands in a text.
struct WordSpan {
    std::size_t offset = 0;
    std::size_t length = 0;
};

/// The words of a statement of a scene text, the keyword first, without comments.
struct StatementWords {
    Statement statement = Statement::projection;
    std::uint64_t line = 0; ///< of the keyword, from 1
    std::uint32_t section =
        0; ///< 0: of the main scene; else of the subscene that begins so-manieth
    std::vector<WordSpan> words;
};

/// The statements of a text that was read without errors, in order. For those who change a text and
/// keep the rest of it: what the words mean is for the reader to say.
std::vector<StatementWords> statement_words(std::string_view text);

} // namespace vera
