// SPDX-License-Identifier: Apache-2.0
// Counts every byte that a program takes by new. It replaces operator new, and so is linked only
// into programs of their own that ask for it.
#pragma once

#include <cstddef>

namespace vera::testing {

/// From when it is made on. One at a time.
class MemoryWatch {
public:
    MemoryWatch();

    /// The most bytes that were held at once beside those of before.
    std::size_t most_bytes() const;

private:
    std::size_t before_;
};

} // namespace vera::testing
