// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <new>
#include <vector>

namespace vera {

/// Asks the machine for large pages where the memory is large enough to be worth it. Nothing else
/// changes.
void prefer_large_pages(void* memory, std::size_t size);

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
    prefer_large_pages(elements.data(), elements.capacity() * sizeof(Element));
}

} // namespace vera
