// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <type_traits>
#include <vector>

namespace vera {

/// Gives the whole pages between these addresses back to the system; what stood there is lost.
/// Where the system cannot do that, nothing happens.
void give_back_pages(void* begin, void* end);

/// Gives back the room that the vector has behind its elements and does not use now, from 2 MiB
/// on: less is soon used again, and to be handed its pages anew takes longer than to fill them.
template <typename T>
void give_back_unused(std::vector<T>& vector) {
    constexpr std::size_t least = std::size_t{2} << 20U;
    if ((vector.capacity() - vector.size()) * sizeof(T) >= least)
        give_back_pages(vector.data() + vector.size(), vector.data() + vector.capacity());
}

/// Gives back the room of a vector's elements from first to before last, which nobody reads again
/// before the vector is freed.
template <typename T>
void give_back_spent(std::vector<T>& vector, std::size_t first, std::size_t last) {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    give_back_pages(vector.data() + first, vector.data() + last);
}

} // namespace vera
