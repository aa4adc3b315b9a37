// SPDX-License-Identifier: Apache-2.0
#include "vera/base/check.h"
#include "vera/formats/number.h"

#include <charconv>
#include <cmath>
#include <cstdint>

/// scan_number stays within the text, and gives the bits that std::from_chars gives where both read
/// a number.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const char* begin = reinterpret_cast<const char*>(data);
    const char* end = begin + size;
    const vera::ScannedNumber number = vera::scan_number(begin, end);
    VERA_CHECK(number.end >= begin && number.end <= end);
    if (number.outcome != vera::ScannedNumber::Outcome::good)
        return 0;

    VERA_CHECK(number.end > begin && std::isfinite(number.value));
    const char* first = *begin == '+' ? begin + 1 : begin;
    double expected = 0;
    const auto [stop, error] = std::from_chars(first, number.end, expected);
    if (error == std::errc::result_out_of_range)
        VERA_CHECK(number.value == 0);
    else
        VERA_CHECK(error == std::errc{} && stop == number.end && number.value == expected);
    return 0;
}
