// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vera {

/// A number at the beginning of a text.
struct ScannedNumber {
    enum class Outcome {
        good,
        not_a_number, ///< end is where the text began
        too_large     ///< written well, but beyond the largest double; value is infinite
    };

    double value = 0;
    const char* end = nullptr; ///< behind the last character of the number
    Outcome outcome = Outcome::not_a_number;
};

namespace detail {

/// What scan_number does with all but the shortest numbers.
ScannedNumber scan_longer_number(const char* begin, const char* end);

} // namespace detail

/// Reads an optional sign, digits with an optional fraction ("54", "54.0", ".5", "5.") and an
/// optional exponent: correctly rounded, whatever the length. Does not read "nan", "inf" or
/// hexadecimal numbers. What is smaller than the smallest double is read as 0.
inline ScannedNumber scan_number(const char* begin, const char* end) {
    // Zeros and ones are half of many files: a digit before a blank is read here and now.
    if (end - begin > 1 && static_cast<unsigned char>(begin[1]) <= ' ') {
        const int digit = begin[0] - '0';
        if (digit >= 0 && digit <= 9)
            return {static_cast<double>(digit), begin + 1, ScannedNumber::Outcome::good};
    }
    return detail::scan_longer_number(begin, end);
}

} // namespace vera
