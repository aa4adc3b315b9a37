// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/complaints.h"
#include "vera/formats/vera_keywords.h"
#include "vera/scene/geometry.h"

#include <cstdint>
#include <optional>

namespace vera {

/// Whether such a statement may become an item of that kind.
bool makes(std::optional<Statement> statement, ItemKind kind);

/// The place of the statement that made an item, in the text that it was read from. Items keep
/// their line alone: of its words, the first that makes such an item is the likeliest, else the
/// first.
WordPlace item_place(const Item& item, const SourceText& text);

/// The same of item `number` of the geometry: where its line makes several such items, the
/// statement in its turn.
WordPlace item_place(const Geometry& geometry, std::uint32_t number, const SourceText& text);

} // namespace vera
