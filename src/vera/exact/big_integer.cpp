// SPDX-License-Identifier: Apache-2.0
#include "vera/exact/big_integer.h"

#include <cstddef>
#include <utility>

namespace vera {

namespace {

constexpr unsigned limb_bits = 32;

void drop_zeros(std::vector<std::uint32_t>& limbs) {
    while (!limbs.empty() && limbs.back() == 0)
        limbs.pop_back();
}

} // namespace

BigInteger::BigInteger(std::int64_t value, unsigned shift)
    : is_negative_(value < 0) {
    const auto bits = static_cast<std::uint64_t>(value);
    const std::uint64_t magnitude = is_negative_ ? 0 - bits : bits;
    const unsigned within = shift % limb_bits;
    limbs_.assign(shift / limb_bits, 0);
    limbs_.push_back(static_cast<std::uint32_t>(magnitude << within));
    limbs_.push_back(static_cast<std::uint32_t>(magnitude >> (limb_bits - within)));
    limbs_.push_back(
        within == 0 ? 0 : static_cast<std::uint32_t>(magnitude >> (2 * limb_bits - within)));
    drop_zeros(limbs_);
}

int BigInteger::compare(const Limbs& a, const Limbs& b) {
    if (a.size() != b.size())
        return a.size() < b.size() ? -1 : 1;
    for (std::size_t i = a.size(); i-- > 0;)
        if (a[i] != b[i])
            return a[i] < b[i] ? -1 : 1;
    return 0;
}

BigInteger::Limbs BigInteger::sum(const Limbs& a, const Limbs& b) {
    const Limbs& longer = a.size() < b.size() ? b : a;
    const Limbs& shorter = a.size() < b.size() ? a : b;
    Limbs result(longer.size() + 1);
    std::uint64_t carry = 0;
    for (std::size_t i = 0; i < longer.size(); ++i) {
        carry += std::uint64_t{longer[i]} + (i < shorter.size() ? shorter[i] : 0);
        result[i] = static_cast<std::uint32_t>(carry);
        carry >>= limb_bits;
    }
    result.back() = static_cast<std::uint32_t>(carry);
    drop_zeros(result);
    return result;
}

BigInteger::Limbs BigInteger::difference(const Limbs& larger, const Limbs& smaller) {
    Limbs result(larger.size());
    std::uint64_t borrow = 0;
    for (std::size_t i = 0; i < larger.size(); ++i) {
        const std::uint64_t taken = borrow + (i < smaller.size() ? smaller[i] : 0);
        result[i] = static_cast<std::uint32_t>(larger[i] - taken);
        borrow = larger[i] < taken ? 1 : 0;
    }
    drop_zeros(result);
    return result;
}

BigInteger operator-(BigInteger a) {
    a.is_negative_ = !a.is_negative_;
    return a;
}

BigInteger operator+(const BigInteger& a, const BigInteger& b) {
    BigInteger result;
    if (a.is_negative_ == b.is_negative_) {
        result.limbs_ = BigInteger::sum(a.limbs_, b.limbs_);
        result.is_negative_ = a.is_negative_;
        return result;
    }
    const bool a_is_larger = BigInteger::compare(a.limbs_, b.limbs_) >= 0;
    const BigInteger& larger = a_is_larger ? a : b;
    result.limbs_ = BigInteger::difference(larger.limbs_, (a_is_larger ? b : a).limbs_);
    result.is_negative_ = larger.is_negative_;
    return result;
}

BigInteger operator-(const BigInteger& a, const BigInteger& b) {
    return a + -b;
}

BigInteger operator*(const BigInteger& a, const BigInteger& b) {
    BigInteger result;
    result.is_negative_ = a.is_negative_ != b.is_negative_;
    result.limbs_.assign(a.limbs_.size() + b.limbs_.size(), 0);
    for (std::size_t i = 0; i < a.limbs_.size(); ++i) {
        std::uint64_t carry = 0;
        for (std::size_t k = 0; k < b.limbs_.size(); ++k) {
            carry += std::uint64_t{a.limbs_[i]} * b.limbs_[k] + result.limbs_[i + k];
            result.limbs_[i + k] = static_cast<std::uint32_t>(carry);
            carry >>= limb_bits;
        }
        result.limbs_[i + b.limbs_.size()] = static_cast<std::uint32_t>(carry);
    }
    drop_zeros(result.limbs_);
    return result;
}

} // namespace vera
