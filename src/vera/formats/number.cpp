// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/number.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
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
    std::int64_t digit_count = 0; ///< without leading zeros; past 19, digits is not valid
    std::int64_t exponent = 0;
    const char* end = nullptr;
};

/// Reads digits, as further ones of the decimal, and returns their end.
const char* take_digits(const char* p, const char* end, Decimal& decimal) {
    for (; p != end && is_digit(*p); ++p) {
        if (*p == '0' && decimal.digit_count == 0)
            continue;
        if (decimal.digit_count < 19)
            decimal.digits = 10 * decimal.digits + static_cast<std::uint64_t>(*p - '0');
        ++decimal.digit_count;
    }
    return p;
}

/// Reads an exponent into the decimal, if there is one, and returns its end; else p.
const char* take_exponent(const char* p, const char* end, Decimal& decimal) {
    if (p == end || (*p != 'e' && *p != 'E'))
        return p;
    const char* digit = p + 1;
    const bool negative = digit != end && *digit == '-';
    if (digit != end && (*digit == '-' || *digit == '+'))
        ++digit;
    if (digit == end || !is_digit(*digit))
        return p;

    // Far more than a file has digits to make up for it.
    constexpr std::int64_t enough = 100'000'000'000'000'000;
    std::int64_t written = 0;
    for (; digit != end && is_digit(*digit); ++digit)
        if (written < enough)
            written = 10 * written + (*digit - '0');
    decimal.exponent += negative ? -written : written;
    return digit;
}

/// Nothing to be read at all when the end is the beginning.
Decimal scan_decimal(const char* begin, const char* end) {
    Decimal decimal;
    const char* p = take_digits(begin, end, decimal);
    bool any_digit = p != begin;
    if (p != end && *p == '.') {
        const char* const fraction = p + 1;
        const char* const rest = take_digits(fraction, end, decimal);
        if (any_digit || rest != fraction) {
            any_digit = true;
            decimal.exponent = fraction - rest;
            p = rest;
        }
    }
    decimal.end = any_digit ? take_exponent(p, end, decimal) : begin;
    return decimal;
}

/// The digits at the beginning of eight bytes.
struct FewDigits {
    std::uint64_t value = 0;
    unsigned count = 0;
};

/// All at once: how many there are is hard to guess for a processor that branches at each.
FewDigits few_digits(const char* p) {
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, p, 8);
    if constexpr (std::endian::native == std::endian::big)
        bytes = __builtin_bswap64(bytes);
    // Digits are 0x30 to 0x39, without threes 0 to 9. Adding sets the highest bit of what is more;
    // what it carries goes to later bytes only.
    constexpr std::uint64_t threes = 0x3030'3030'3030'3030;
    constexpr std::uint64_t highest_bits = 0x8080'8080'8080'8080;
    constexpr std::uint64_t above_nine = 0x7676'7676'7676'7676;
    bytes ^= threes;
    const std::uint64_t others = ((bytes + above_nine) | bytes) & highest_bits;
    FewDigits digits;
    digits.count = static_cast<unsigned>(std::countr_zero(others)) / 8;
    if (digits.count == 0)
        return digits;
    // Zeros before them make them eight. Neighbours are put together: digits to pairs, pairs to
    // fours, fours to the whole.
    bytes <<= 8 * (8 - digits.count);
    bytes = (10 * bytes + (bytes >> 8U)) & 0x00ff'00ff'00ff'00ffU;
    bytes = (100 * bytes + (bytes >> 16U)) & 0x0000'ffff'0000'ffffU;
    digits.value = (10'000 * bytes + (bytes >> 32U)) & 0xffff'ffffU;
    return digits;
}

constexpr std::array<std::uint64_t, 9> whole_powers_of_ten = {
    1, 10, 100, 1'000, 10'000, 100'000, 1'000'000, 10'000'000, 100'000'000};

/// Numbers of any length and size.
ScannedNumber scan_any_number(const char* begin, const char* end) {
    const char* p = begin;
    const bool negative = p != end && *p == '-';
    if (p != end && (*p == '-' || *p == '+'))
        ++p;
    const Decimal decimal = scan_decimal(p, end);
    if (decimal.end == p)
        return {0, begin, ScannedNumber::Outcome::not_a_number};

    // As below, with exponents.
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

} // namespace

// Numbers of at most 19 digits without exponent, as almost all are, end here; others are read again
// from their beginning.
ScannedNumber detail::scan_longer_number(const char* begin, const char* end) {
    constexpr std::ptrdiff_t most_digits = 19;
    const char* p = begin;
    const bool negative = p != end && *p == '-';
    if (p != end && (*p == '-' || *p == '+'))
        ++p;
    std::uint64_t digits = 0;
    const char* const whole = p;
    for (; p != end && is_digit(*p); ++p)
        digits = 10 * digits + static_cast<std::uint64_t>(*p - '0');
    std::ptrdiff_t count = p - whole;
    std::size_t places = 0;
    if (p != end && *p == '.') {
        const char* const fraction = ++p;
        while (end - p >= 8) {
            const FewDigits few = few_digits(p);
            digits = whole_powers_of_ten[few.count] * digits + few.value;
            p += few.count;
            if (few.count < 8)
                break;
        }
        for (; p != end && is_digit(*p); ++p)
            digits = 10 * digits + static_cast<std::uint64_t>(*p - '0');
        places = static_cast<std::size_t>(p - fraction);
        count += p - fraction;
    }
    // With more digits, the sum above has overflowed.
    if (count == 0 || count > most_digits || (p != end && (*p == 'e' || *p == 'E')))
        return scan_any_number(begin, end);

    // Digits below 2^53 and powers of ten up to 10^22 are exact doubles, so that one division
    // rounds correctly (Clinger 1990).
    constexpr std::uint64_t largest_exact = std::uint64_t{1} << 53U;
    double value = static_cast<double>(digits) / powers_of_ten[places];
    if (digits > largest_exact)
        std::from_chars(whole, p, value);
    return {negative ? -value : value, p, ScannedNumber::Outcome::good};
}

} // namespace vera
