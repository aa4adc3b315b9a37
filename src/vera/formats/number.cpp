// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/number.h"

#include <array>
#include <charconv>
#include <cstdint>
#include <limits>

namespace vera {

namespace {

constexpr std::array<double, 23> powers_of_ten = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                  1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                  1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

bool is_digit(char letter) {
    return letter >= '0' && letter <= '9';
}

/// The number's parts as they are written, without sign: digits * 10^exponent, if digits are few.
struct Decimal {
    std::uint64_t digits = 0;
    int digit_count = 0; ///< significant ones, without leading zeros; past 19, digits is not valid
    std::int64_t exponent = 0;
    const char* end = nullptr;
};

/// Nothing to be read at all when the end is the beginning.
Decimal scan_decimal(const char* begin, const char* end) {
    Decimal decimal;
    const char* p = begin;
    bool any_digit = false;
    const auto take_digit = [&](char letter) {
        any_digit = true;
        if (letter != '0' || decimal.digit_count > 0) {
            if (decimal.digit_count < 19)
                decimal.digits = 10 * decimal.digits + static_cast<std::uint64_t>(letter - '0');
            if (decimal.digit_count < 1000)
                ++decimal.digit_count;
        }
    };
    while (p != end && is_digit(*p))
        take_digit(*p++);
    if (p != end && *p == '.') {
        const char* const point = p++;
        while (p != end && is_digit(*p)) {
            take_digit(*p++);
            --decimal.exponent;
        }
        if (!any_digit)
            p = point;
    }
    if (!any_digit) {
        decimal.end = begin;
        return decimal;
    }
    decimal.end = p;
    if (p != end && (*p == 'e' || *p == 'E')) {
        ++p;
        const bool negative = p != end && *p == '-';
        if (p != end && (*p == '-' || *p == '+'))
            ++p;
        if (p != end && is_digit(*p)) {
            std::int64_t written = 0;
            for (; p != end && is_digit(*p); ++p)
                if (written < 1'000'000'000)
                    written = 10 * written + (*p - '0');
            decimal.exponent += negative ? -written : written;
            decimal.end = p;
        }
    }
    return decimal;
}

} // namespace

ScannedNumber scan_number(const char* begin, const char* end) {
    const char* p = begin;
    const bool negative = p != end && *p == '-';
    if (p != end && (*p == '-' || *p == '+'))
        ++p;
    const Decimal decimal = scan_decimal(p, end);
    if (decimal.end == p)
        return {0, begin, ScannedNumber::Outcome::not_a_number};

    // Digits below 2^53 and powers of ten up to 10^22 are exact doubles, so that one multiplication
    // or division rounds correctly (Clinger 1990). Almost every number ends here.
    constexpr std::uint64_t largest_exact = std::uint64_t{1} << 53U;
    double value = 0;
    if (decimal.digit_count <= 19 && decimal.digits <= largest_exact && decimal.exponent >= -22
        && decimal.exponent <= 22) {
        value = static_cast<double>(decimal.digits);
        if (decimal.exponent < 0)
            value /= powers_of_ten[static_cast<std::size_t>(-decimal.exponent)];
        else
            value *= powers_of_ten[static_cast<std::size_t>(decimal.exponent)];
    } else {
        const auto [rest, error] = std::from_chars(p, decimal.end, value);
        // from_chars says only that a number is out of range, not on which side.
        if (error == std::errc::result_out_of_range) {
            const bool large =
                decimal.digit_count > 0 && decimal.exponent + decimal.digit_count > 0;
            value = large ? std::numeric_limits<double>::infinity() : 0;
        }
    }
    const bool too_large = value > std::numeric_limits<double>::max();
    return {
        negative ? -value : value,
        decimal.end,
        too_large ? ScannedNumber::Outcome::too_large : ScannedNumber::Outcome::good};
}

} // namespace vera
