// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

namespace vera {

/// A whole number of any size: sums, differences and products are exact. For the few cases that
/// rounded numbers with a bound cannot decide; each takes memory of its own.
class BigInteger {
public:
    BigInteger() = default;

    /// value times 2 to the power of shift.
    explicit BigInteger(std::int64_t value, unsigned shift = 0);

    int sign() const { return limbs_.empty() ? 0 : is_negative_ ? -1 : 1; }

    friend BigInteger operator-(BigInteger a);
    friend BigInteger operator+(const BigInteger& a, const BigInteger& b);
    friend BigInteger operator-(const BigInteger& a, const BigInteger& b);
    friend BigInteger operator*(const BigInteger& a, const BigInteger& b);

private:
    using Limbs = std::vector<std::uint32_t>; ///< the lowest first, the highest not 0

    static int compare(const Limbs& a, const Limbs& b);
    static Limbs sum(const Limbs& a, const Limbs& b);
    static Limbs difference(const Limbs& larger, const Limbs& smaller);

    Limbs limbs_;
    bool is_negative_ = false;
};

} // namespace vera
