// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/complaints.h"
#include "vera/scene/geometry.h"

namespace vera {

/// The place of the statement that made an item, in the text that it was read from. Items keep
/// their line alone: of its words, the first that makes such an item is the likeliest, else the
/// first.
WordPlace item_place(const Item& item, const SourceText& text);

} // namespace vera
