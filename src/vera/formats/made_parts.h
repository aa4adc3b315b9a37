// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/word_reader.h"
#include "vera/generate/generator.h"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vera {

/// What a statement MK asks for, read but not made.
struct MadePart {
    std::string name;            ///< of the generator
    std::string key;             ///< the same for what is the same
    WordPlace place;             ///< of the generator's name
    std::function<Scene()> make; ///< throws SurfaceError
};

/// MK name {parameter value}; called when MK has been taken. Reads up to the first word that is no
/// parameter. Returns nothing, and has complained, when the statement cannot be used.
std::optional<MadePart> read_made_part(WordReader& words);

/// The words that could go on with MK and this name.
std::vector<std::string_view> parameter_words(std::string_view generator);

} // namespace vera
