// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/theory/primitive_query_index.h"

#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

namespace vera {

/// What the generations of a picture took whose rays were found for each primitive: a list.
nlohmann::ordered_json generations_json(std::span<const GenerationCounts> generations);

/// The same in one line, all generations together.
std::string generations_text(std::span<const GenerationCounts> generations);

} // namespace vera
