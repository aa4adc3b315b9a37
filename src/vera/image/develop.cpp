// SPDX-License-Identifier: Apache-2.0
#include "vera/image/develop.h"

#include "vera/base/check.h"
#include "vera/math/elementary.h"

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace vera {

namespace {

/// round(largest * min(1, max(0, value))), halves up; 0 for what is not a number.
template <typename Sample>
Sample integer_sample(double value) {
    constexpr double largest = std::numeric_limits<Sample>::max();
    const double positive = value > 0 ? value : 0;
    const double scaled = largest * (positive < 1 ? positive : 1);
    // The sum with the largest number below a half reaches a whole number only from a half on: it
    // rounds up to it from there, and from no number below, which is farther off.
    constexpr double almost_half = 0x1.fffffffffffffp-2;
    return static_cast<Sample>(static_cast<std::int32_t>(scaled + almost_half));
}

/// The sRGB curve at a fraction of the time that srgb_decoded takes, to the same float.
class FloatDecoder {
public:
    FloatDecoder() {
        for (std::size_t i = 0; i < cells; ++i) {
            const double center = 1 + (static_cast<double>(i) + 0.5) / cells;
            inverse_centers_[i] = 1 / center;
            for (std::size_t j = 0; j < exponents; ++j) {
                const auto scale = std::bit_cast<double>((first_exponent + j) << 52);
                powers_[j][i] = power(scale * center, 2.4);
            }
        }
    }

    float decoded(double value) const {
        const double base = (value + 0.055) / 1.055;
        const auto bits = std::bit_cast<std::uint64_t>(base);
        const std::uint64_t exponent = (bits >> 52) - first_exponent;
        // Also for negative values, whose sign makes the exponent large.
        if (!(value > 0.04045) || exponent >= exponents)
            return static_cast<float>(srgb_decoded(value));

        // base = scale * center * (1 + u) with |u| <= 1/64; then base^2.4 is the power from the
        // table times the binomial series of (1 + u)^2.4. Its first term left out is below 1e-15.
        const std::size_t cell = (bits >> (52 - cell_bits)) & (cells - 1);
        const auto mantissa =
            std::bit_cast<double>((bits & ((one << 52) - 1)) | (std::uint64_t{1023} << 52));
        const double u = mantissa * inverse_centers_[cell] - 1;
        double sum = -0.0046592;
        sum = sum * u + 0.010752;
        sum = sum * u - 0.0336;
        sum = sum * u + 0.224;
        sum = sum * u + 1.68;
        sum = sum * u + 2.4;
        const double light = powers_[exponent][cell] * (1 + u * sum);

        // This and srgb_decoded are each within 1e-13 of the truth. If everything within 3e-13
        // rounds to one float, that is the float of srgb_decoded; if not, which is rare, ask it.
        const auto low = static_cast<float>(light * (1 - 3e-13));
        const auto high = static_cast<float>(light * (1 + 3e-13));
        return low == high ? low : static_cast<float>(srgb_decoded(value));
    }

private:
    static constexpr std::uint64_t one = 1;
    static constexpr int cell_bits = 5;
    static constexpr std::size_t cells = one << cell_bits;
    static constexpr std::uint64_t first_exponent = 1023 - 4; ///< 0.04045 has the base 0.0905
    static constexpr std::size_t exponents = 14;              ///< up to a base of 1024

    std::array<double, cells> inverse_centers_;
    std::array<std::array<double, cells>, exponents> powers_;
};

const FloatDecoder& float_decoder() {
    static const FloatDecoder decoder;
    return decoder;
}

} // namespace

void develop(std::span<const Color> colors, Image& image, std::size_t x, std::size_t y) {
    VERA_CHECK(y < image.height && x <= image.width && colors.size() <= image.width - x);
    std::visit(
        [&](auto& samples) {
            using Sample = typename std::decay_t<decltype(samples)>::value_type;
            Sample* sample = samples.data() + 3 * (y * image.width + x);
            const auto write = [&](const auto& developed) {
                for (const Color& color : colors)
                    for (const double value : {color.r, color.g, color.b})
                        *sample++ = developed(value);
            };
            if constexpr (std::is_same_v<Sample, float>)
                write(
                    [&decoder = float_decoder()](double value) { return decoder.decoded(value); });
            else
                write(integer_sample<Sample>);
        },
        image.samples);
}

std::uint8_t developed_byte(double value) {
    return integer_sample<std::uint8_t>(value);
}

} // namespace vera
