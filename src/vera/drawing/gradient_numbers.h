// SPDX-License-Identifier: Apache-2.0
// Numbers for gradients that come one after the other, whose outlines are forgotten.
#pragma once

#include "vera/drawing/drawing.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace vera::detail {

/// Numbers the different gradients in the order in which they first come. Keeps what tells one from
/// another packed, in the order of its number, and finds it by a table of numbers with at least one
/// free place for each that is taken (open addressing).
class GradientNumbers {
public:
    struct Number {
        std::size_t number = 0;
        bool is_new = false;
    };

    Number of(const Gradient& gradient);

    std::size_t count() const { return ends_.size(); }

private:
    std::string_view packed(std::size_t number) const;
    /// Where the packed gradient stands in the table, or would.
    std::size_t place_of(std::string_view gradient) const;
    void grow();

    std::string bytes_;             ///< one gradient behind the other
    std::vector<std::size_t> ends_; ///< of each in bytes_
    std::vector<std::uint32_t> table_;
    std::string at_hand_;
};

} // namespace vera::detail
