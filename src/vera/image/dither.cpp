// SPDX-License-Identifier: Apache-2.0
#include "vera/image/dither.h"

#include "vera/base/check.h"
#include "vera/math/elementary.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vera {

namespace {

/// Bits of a channel by which nearest colours are kept. What a coarser place makes wrong goes into
/// the error that is spread.
constexpr int place_bits = 6;
constexpr int place_shift = 8 - place_bits;

/// Light with the errors spread to it is kept within these, lest what the palette cannot mix be
/// carried far into what it can.
constexpr double least_light = -0.05;
constexpr double most_light = 1.05;

/// sRGB of 8 bits of light from 0 to 1, by a table: within 1 of the true one.
std::uint8_t encoded_by_table(double light) {
    constexpr int steps = 4096;
    static const std::vector<std::uint8_t> table = [] {
        std::vector<std::uint8_t> encoded;
        for (int i = 0; i <= steps; ++i)
            encoded.push_back(static_cast<std::uint8_t>(
                std::lround(255 * srgb_encoded(static_cast<double>(i) / steps))));
        return encoded;
    }();
    const double limited = light > 0 ? (light < 1 ? light : 1) : 0;
    return table[static_cast<std::size_t>(std::lround(limited * steps))];
}

Rgb8 pixel_of(std::span<const std::uint8_t> row, std::size_t x) {
    return {row[3 * x], row[3 * x + 1], row[3 * x + 2]};
}

} // namespace

/// Nearest colours, found when first asked for.
class ColorReducer::Nearest {
public:
    explicit Nearest(const Palette& palette)
        : palette_(palette)
        , coarse_(std::size_t{1} << (3 * place_bits), unknown) {
        for (const Rgb8 color : palette)
            colors_.push_back(oklab(color));
    }

    /// Of exactly this colour.
    std::uint8_t to(Rgb8 color) const {
        return static_cast<std::uint8_t>(nearest_color(colors_, oklab(color)));
    }

    /// Of the middle of a place of colours.
    std::uint8_t near(const LinearRgb& light) {
        Rgb8 color = {};
        std::size_t place = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            const unsigned step = unsigned{encoded_by_table(light[c])} >> place_shift;
            place = place << place_bits | step;
            // From 0 to 255: so that black and white are in places of their own.
            color[c] = static_cast<std::uint8_t>(step * 255 / ((1U << place_bits) - 1));
        }
        std::uint16_t& number = coarse_[place];
        if (number == unknown)
            number = to_mix(color);
        return static_cast<std::uint8_t>(number);
    }

private:
    /// For colours that are mixed with others, nearest as displayed: there a channel that has too
    /// much is answered by a colour with less of it. In Oklab an error can make itself grow.
    std::uint8_t to_mix(Rgb8 color) const {
        constexpr std::array<int, 3> weights = {2, 4, 1};
        std::size_t nearest = 0;
        int least = std::numeric_limits<int>::max();
        for (std::size_t i = 0; i < palette_.size(); ++i) {
            int distance = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                const int difference = int{palette_[i][c]} - int{color[c]};
                distance += weights[c] * difference * difference;
            }
            if (distance < least) {
                least = distance;
                nearest = i;
            }
        }
        return static_cast<std::uint8_t>(nearest);
    }

    static constexpr std::uint16_t unknown = 0xffff;
    Palette palette_;
    std::vector<Oklab> colors_;
    std::vector<std::uint16_t> coarse_;
};

ColorReducer::ColorReducer(Palette palette, Dither dither, std::size_t width)
    : palette_(std::move(palette))
    , dither_(dither)
    , width_(width) {
    VERA_CHECK(!palette_.empty() && palette_.size() <= 256);
    nearest_ = std::make_unique<Nearest>(palette_);
    for (const Rgb8 color : palette_)
        light_.push_back(linear_light(color));
    if (dither_ == Dither::floyd_steinberg) {
        errors_.assign(width + 2, {});
        next_errors_.assign(width + 2, {});
    }
}

ColorReducer::~ColorReducer() = default;

void ColorReducer::reduce(std::span<const std::uint8_t> row, std::span<std::uint8_t> numbers) {
    VERA_CHECK(row.size() == 3 * width_ && numbers.size() == width_);
    if (dither_ == Dither::floyd_steinberg)
        spread_errors(row, numbers);
    else if (dither_ == Dither::blue_noise)
        choose_by_mask(row, numbers);
    else
        reduce_plainly(row, numbers);
    ++y_;
}

void ColorReducer::reduce_plainly(
    std::span<const std::uint8_t> row, std::span<std::uint8_t> numbers) {
    // Neighbours are often equal.
    Rgb8 last = pixel_of(row, 0);
    std::uint8_t number = nearest_->to(last);
    for (std::size_t x = 0; x < width_; ++x) {
        if (const Rgb8 color = pixel_of(row, x); color != last) {
            last = color;
            number = nearest_->to(color);
        }
        numbers[x] = number;
    }
}

void ColorReducer::spread_errors(
    std::span<const std::uint8_t> row, std::span<std::uint8_t> numbers) {
    std::fill(next_errors_.begin(), next_errors_.end(), LinearRgb{});
    const bool backward = y_ % 2 == 1;
    for (std::size_t i = 0; i < width_; ++i) {
        const std::size_t x = backward ? width_ - 1 - i : i;
        // Of pixel x the errors are at x + 1.
        const std::size_t ahead = backward ? x : x + 2;
        const std::size_t behind = backward ? x + 2 : x;
        LinearRgb wanted = linear_light(pixel_of(row, x));
        for (std::size_t c = 0; c < 3; ++c)
            wanted[c] = std::clamp(wanted[c] + errors_[x + 1][c], least_light, most_light);
        numbers[x] = nearest_->near(wanted);
        for (std::size_t c = 0; c < 3; ++c) {
            const double error = wanted[c] - light_[numbers[x]][c];
            errors_[ahead][c] += 7.0 / 16 * error;
            next_errors_[behind][c] += 3.0 / 16 * error;
            next_errors_[x + 1][c] += 5.0 / 16 * error;
            next_errors_[ahead][c] += 1.0 / 16 * error;
        }
    }
    std::swap(errors_, next_errors_);
}

/// The colours whose mean is nearly this one: each is the nearest to it and to what those before
/// left undone (the pattern dithering of T. Knoll).
void ColorReducer::find_mixture(Rgb8 color) {
    constexpr std::size_t parts = 32;
    const LinearRgb wanted = linear_light(color);
    LinearRgb left = {};
    mixture_.clear();
    for (std::size_t i = 0; i < parts; ++i) {
        LinearRgb sought = {};
        for (std::size_t c = 0; c < 3; ++c)
            sought[c] = wanted[c] + left[c];
        const std::uint8_t number = nearest_->near(sought);
        mixture_.push_back(number);
        for (std::size_t c = 0; c < 3; ++c)
            left[c] += wanted[c] - light_[number][c];
    }
    const auto luminance = [this](std::uint8_t number) {
        const LinearRgb& light = light_[number];
        return 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2];
    };
    std::sort(mixture_.begin(), mixture_.end(), [&](std::uint8_t a, std::uint8_t b) {
        const double first = luminance(a);
        const double second = luminance(b);
        return first < second || (first == second && a < b);
    });
    mixed_ = color;
}

void ColorReducer::choose_by_mask(
    std::span<const std::uint8_t> row, std::span<std::uint8_t> numbers) {
    using detail::blue_noise_side;
    for (std::size_t x = 0; x < width_; ++x) {
        if (const Rgb8 color = pixel_of(row, x); mixture_.empty() || color != mixed_)
            find_mixture(color);
        const std::size_t rank =
            detail::blue_noise[y_ % blue_noise_side * blue_noise_side + x % blue_noise_side];
        numbers[x] = mixture_[rank * mixture_.size() / (blue_noise_side * blue_noise_side)];
    }
}

} // namespace vera
