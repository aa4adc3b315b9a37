// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"

#include <cstddef>
#include <utility>

namespace vera {

/// Throws Cancelled where there is a flag that is raised.
inline void stop_if_raised(const CancelFlag* cancel) {
    if (cancel != nullptr)
        cancel->throw_if_raised();
}

/// A loop in one thread that takes long: looks at the flag, and tells how far it is, once in so
/// many turns. That is cheap where a turn is: keep `every` a power of two.
class LongLoop {
public:
    explicit LongLoop(
        std::size_t turns,
        Progress progress = {},
        const CancelFlag* cancel = nullptr,
        std::size_t every = 1024)
        : turns_(turns)
        , every_(every)
        , progress_(std::move(progress))
        , cancel_(cancel) {}

    /// At the beginning of each turn, in their order. Throws Cancelled.
    void turn(std::size_t number) const {
        if (number % every_ == 0)
            look(number);
    }

private:
    void look(std::size_t number) const {
        stop_if_raised(cancel_);
        if (progress_)
            progress_(static_cast<double>(number) / static_cast<double>(turns_));
    }

    std::size_t turns_;
    std::size_t every_;
    Progress progress_;
    const CancelFlag* cancel_;
};

} // namespace vera
