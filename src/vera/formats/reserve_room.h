// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/large_pages.h"

#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

namespace vera {

/// Makes room for more elements: exactly, unless that would mean to move everything again and
/// again. Most of the time in which short numbers are read is the machine's, handing out pages as
/// they are first touched: large ones take a small part of it. `more` is an estimate, and may be
/// far too large for the machine; then the vector grows as it must.
template <typename Element>
void reserve_room(std::vector<Element>& elements, std::size_t more) {
    const std::size_t needed = elements.size() + more;
    if (needed <= elements.capacity())
        return;
    try {
        elements.reserve(elements.empty() ? needed : std::max(needed, 2 * elements.capacity()));
    } catch (const std::bad_alloc&) {
        return;
    }
    // The last large page may stay empty but for a few bytes: at most an eighth of the whole.
    constexpr std::size_t worth_it = 16'000'000;
    if (const std::size_t bytes = elements.capacity() * sizeof(Element); bytes >= worth_it)
        prefer_large_pages(elements.data(), bytes, Written::nothing);
}

} // namespace vera
