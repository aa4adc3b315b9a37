// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

namespace vera {

/// Leaves what a vector makes without a value as it is.
template <typename T>
class LeaveUnfilled : public std::allocator<T> {
public:
    static_assert(std::is_trivially_copyable_v<T>, "its bytes alone are the value");

    template <typename U>
    struct rebind {
        using other = LeaveUnfilled<U>;
    };

    LeaveUnfilled() = default;

    template <typename U>
    LeaveUnfilled(const LeaveUnfilled<U>&) noexcept {}

    template <typename U>
    void construct(U*) noexcept {}

    template <typename U, typename Value>
    void construct(U* place, Value&& value) {
        std::construct_at(place, std::forward<Value>(value));
    }
};

/// For lists that all threads fill as soon as they are there: resize() leaves what it adds
/// unfilled. Otherwise one thread would write zeros first, and be handed all pages of memory
/// meanwhile.
template <typename T>
using UnfilledVector = std::vector<T, LeaveUnfilled<T>>;

} // namespace vera
