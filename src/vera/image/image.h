// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace vera {

/// What a sample of a picture is: the alternatives of Image::samples, in their order.
enum class SampleType { integer8, integer16, float32 };

/// A picture in red, green and blue. Rows run from the top down, pixels in a row from the left; a
/// pixel's three samples stand side by side, so that samples holds 3 * width * height of them.
/// 8 and 16 bit samples are display-referred (sRGB), floats are linear light (a float is the
/// display-referred value decoded by the sRGB curve).
struct Image {
    std::size_t width = 0;
    std::size_t height = 0;
    std::variant<std::vector<std::uint8_t>, std::vector<std::uint16_t>, std::vector<float>> samples;
};

/// What a picture tells of its making: names and values, in order ("Software", "vera 0.1.0").
using PictureMetadata = std::vector<std::pair<std::string, std::string>>;

SampleType sample_type(const Image& image);

/// Bytes of one sample.
std::size_t size_of(SampleType type);

/// A black picture. Throws std::runtime_error when it does not fit into the memory that is free.
Image blank_image(std::size_t width, std::size_t height, SampleType type);

} // namespace vera
