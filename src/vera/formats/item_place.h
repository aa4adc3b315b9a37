// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/complaints.h"
#include "vera/formats/vera_keywords.h"
#include "vera/scene/geometry.h"

#include <optional>

namespace vera {

/// Whether such a statement may become an item of that kind.
bool makes(std::optional<Statement> statement, ItemKind kind);

/// The place of the statement that made an item, in the text that it was read from. Items keep
/// their line alone: of its words, the first that makes such an item is the likeliest, else the
/// first.
WordPlace item_place(const Item& item, const SourceText& text);

} // namespace vera
