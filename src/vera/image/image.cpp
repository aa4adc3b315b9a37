// SPDX-License-Identifier: Apache-2.0
#include "vera/image/image.h"

#include "vera/base/available_memory.h"
#include "vera/base/large_pages.h"

#include <limits>
#include <new>
#include <stdexcept>

#include <fmt/format.h>

namespace vera {

namespace {

[[noreturn]] void throw_too_large(std::size_t width, std::size_t height, std::size_t pixel_bytes) {
    constexpr double gibibyte = 1 << 30;
    const double bytes =
        static_cast<double>(width) * static_cast<double>(height) * static_cast<double>(pixel_bytes);
    std::string problem = fmt::format(
        "a picture of {} x {} pixels takes {:.1f} GiB of memory", width, height, bytes / gibibyte);
    if (const auto available = available_memory())
        problem += fmt::format(
            ", of which {:.1f} GiB are free", static_cast<double>(*available) / gibibyte);
    const bool is_smallest = pixel_bytes <= 3 * size_of(SampleType::integer8);
    throw std::runtime_error(
        problem + "; make it smaller" + (is_smallest ? "" : " or choose a format of 8 bits"));
}

/// Zeros, for which the system is asked for large pages before they are written: it gives these
/// many times as fast.
template <typename Sample>
std::vector<Sample> black_samples(std::size_t count) {
    std::vector<Sample> samples;
    samples.reserve(count);
    prefer_large_pages(samples.data(), count * sizeof(Sample), Written::nothing);
    samples.resize(count);
    return samples;
}

} // namespace

SampleType sample_type(const Image& image) {
    return static_cast<SampleType>(image.samples.index());
}

std::size_t size_of(SampleType type) {
    switch (type) {
    case SampleType::integer8:
        return 1;
    case SampleType::integer16:
        return 2;
    default:
        return 4;
    }
}

Image blank_image(std::size_t width, std::size_t height, SampleType type) {
    const std::size_t pixel_bytes = 3 * size_of(type);
    constexpr std::size_t most_bytes = std::numeric_limits<std::ptrdiff_t>::max();
    if (width != 0 && height > most_bytes / pixel_bytes / width)
        throw_too_large(width, height, pixel_bytes);
    // Asked first, for the system may grant the memory now and end the process when it is used.
    const auto available = available_memory();
    if (available && *available < pixel_bytes * width * height)
        throw_too_large(width, height, pixel_bytes);

    Image image = {width, height, {}};
    const std::size_t count = 3 * width * height;
    try {
        if (type == SampleType::integer8)
            image.samples = black_samples<std::uint8_t>(count);
        else if (type == SampleType::integer16)
            image.samples = black_samples<std::uint16_t>(count);
        else
            image.samples = black_samples<float>(count);
    } catch (const std::bad_alloc&) {
        throw_too_large(width, height, pixel_bytes);
    }
    return image;
}

} // namespace vera
