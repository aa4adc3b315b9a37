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

/// Reads an optional sign, digits with an optional fraction ("54", "54.0", ".5", "5.") and an
/// optional exponent: correctly rounded, whatever the length. Does not read "nan", "inf" or
/// hexadecimal numbers. What is smaller than the smallest double is read as 0.
ScannedNumber scan_number(const char* begin, const char* end);

} // namespace vera
