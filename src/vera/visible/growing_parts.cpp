// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/growing_parts.h"

#include "vera/visible/piece_lists.h"

#include <iterator>
#include <utility>

namespace vera {

VisiblePieces GrowingParts::take_from(std::size_t first) {
    const auto these = parts.begin() + static_cast<std::ptrdiff_t>(first);
    VisiblePieces one = joined({std::move_iterator(these), std::move_iterator(parts.end())});
    parts.erase(these, parts.end());
    return one;
}

void GrowingParts::add(VisiblePieces list) {
    parts.emplace_back(std::move(list), storage_);
}

void GrowingParts::join() {
    constexpr std::size_t many = 65536;
    std::size_t pieces = 0;
    for (std::size_t i = first_; i < parts.size(); ++i)
        pieces += parts[i].size();
    if (pieces < many)
        return;
    add(take_from(first_));
    first_ = parts.size();
}

} // namespace vera
