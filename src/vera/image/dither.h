// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/palette.h"

#include <cstdint>
#include <memory>
#include <span>

namespace vera {

enum class Dither { none, floyd_steinberg, blue_noise };

/// Gives the pixels of a picture numbers of a palette's colours, row by row from the top, with
/// memory for a row or two. Without dithering colours are nearest in Oklab. With it they are
/// nearest as displayed, and what is off is spread in linear light, in which an eye that does not
/// see single pixels adds them up.
///
/// floyd_steinberg: R. W. Floyd and L. Steinberg, "An adaptive algorithm for spatial grey scale",
/// 1976, from left to right and from right to left in turn. blue_noise: each pixel by itself; of
/// the colours that together make its own, a fixed mask without low frequencies (R. Ulichney, "The
/// void-and-cluster method for dither array generation", 1993) chooses one, and so a picture that
/// moves does not flicker where it stands still.
class ColorReducer {
public:
    /// The palette must not be empty.
    ColorReducer(Palette palette, Dither dither, std::size_t width);
    ~ColorReducer();
    ColorReducer(const ColorReducer&) = delete;
    ColorReducer& operator=(const ColorReducer&) = delete;

    const Palette& palette() const { return palette_; }

    /// The next row: 3 * width samples in, width numbers out.
    void reduce(std::span<const std::uint8_t> row, std::span<std::uint8_t> numbers);

private:
    class Nearest;

    void reduce_plainly(std::span<const std::uint8_t> row, std::span<std::uint8_t> numbers);
    void spread_errors(std::span<const std::uint8_t> row, std::span<std::uint8_t> numbers);
    void choose_by_mask(std::span<const std::uint8_t> row, std::span<std::uint8_t> numbers);
    void find_mixture(Rgb8 color);

    Palette palette_;
    std::vector<LinearRgb> light_; ///< of the palette
    Dither dither_;
    std::size_t width_;
    std::size_t y_ = 0;
    std::unique_ptr<Nearest> nearest_;
    std::vector<LinearRgb> errors_;      ///< for this row, one pixel more at each end
    std::vector<LinearRgb> next_errors_; ///< for the next one
    Rgb8 mixed_ = {};                    ///< the colour that mixture_ makes
    std::vector<std::uint8_t> mixture_;  ///< numbers of colours, from dark to light
};

namespace detail {

constexpr std::size_t blue_noise_side = 64;

/// Each number below side * side once, row after row; repeated, it has no seams.
extern const std::array<std::uint16_t, blue_noise_side * blue_noise_side> blue_noise;

} // namespace detail

} // namespace vera
