// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/raster_tile.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>

namespace vera::reference {

/// The samples of a tile, taken from its streams one by one as docs/raster-format.md tells it.
/// Nothing where the streams end too early or too late, or a run leaves the tile.
inline std::optional<std::vector<int>> decoded_tile(
    const detail::TileStreams& streams,
    detail::TileShape shape,
    int channels,
    int sample_bytes,
    int largest_error) {
    const int full = sample_bytes == 1 ? 255 : 65535;
    const int width = static_cast<int>(shape.width);
    const int pixels = static_cast<int>(shape.pixels());
    std::vector<int> samples;
    std::size_t next_length = 0;
    std::size_t next_value[3] = {};
    bool ended = false;

    const auto byte = [&ended](const std::vector<std::uint8_t>& stream, std::size_t& next) {
        if (next == stream.size()) {
            ended = true;
            return 0;
        }
        return int{stream[next++]};
    };
    const auto value = [&](int c) {
        return byte(streams.values[static_cast<std::size_t>(c)], next_value[c]);
    };
    const auto sample_value = [&](int c) {
        const int low = value(c);
        return sample_bytes == 1 ? low : low + 256 * value(c);
    };
    const auto is_signed = [](int number, int range) {
        return number >= range / 2 ? number - range : number;
    };
    const auto at = [&](int pixel, int c) {
        return samples[static_cast<std::size_t>(channels * pixel + c)];
    };
    const auto limited = [full](int number) { return std::clamp(number, 0, full); };
    const auto median = [](int a, int b, int c) {
        return std::max(std::min(a, b), std::min(std::max(a, b), c));
    };

    for (const int command : streams.commands) {
        const int pixel = static_cast<int>(samples.size()) / channels;
        if (pixel >= pixels || ended)
            return std::nullopt;
        if (command < 177) {
            std::vector<int> steps(static_cast<std::size_t>(channels));
            for (int c = 0; c < channels && command == 176; ++c)
                samples.push_back(sample_value(c));
            if (command == 176)
                continue;
            for (int c = 0; c < channels && command == 175; ++c)
                steps[static_cast<std::size_t>(c)] = is_signed(value(c), 256);
            if (command < 175 && channels == 1)
                steps[0] = command - 87;
            if (command < 175 && channels == 3)
                steps = {command / 5 % 5 - 2, command / 25 - 3, command % 5 - 2};
            if (channels == 3) {
                steps[0] += steps[1];
                steps[2] += steps[1];
            }
            for (int c = 0; c < channels; ++c) {
                int from = 0;
                if (pixel >= width && pixel % width != 0)
                    from = median(
                        at(pixel - 1, c),
                        at(pixel - width, c),
                        at(pixel - 1, c) + at(pixel - width, c) - at(pixel - width - 1, c));
                else if (pixel >= width)
                    from = at(pixel - width, c);
                else if (pixel > 0)
                    from = at(pixel - 1, c);
                samples.push_back(
                    limited(from + steps[static_cast<std::size_t>(c)] * (2 * largest_error + 1)));
            }
            continue;
        }
        const int kind = (command - 177) / 18;
        const int code = (command - 177) % 18;
        int count = code + 1;
        if (code == 16)
            count = 17 + byte(streams.lengths, next_length);
        if (code == 17) {
            count = 273 + byte(streams.lengths, next_length);
            count += 256 * byte(streams.lengths, next_length);
        }
        const int x = pixel % width;
        if (kind > 3 || ended || count > pixels - pixel || (kind == 1 && pixel < width)
            || (kind == 2 && pixel < 2 * width) || (kind == 3 && (x == 0 || count > width - x)))
            return std::nullopt;
        std::vector<int> difference;
        for (int c = 0; c < channels && kind == 3; ++c)
            difference.push_back(is_signed(sample_value(c), sample_bytes == 1 ? 256 : 65536));
        for (int k = 1; k <= count; ++k)
            for (int c = 0; c < channels; ++c) {
                const int here = pixel + k - 1;
                if (kind == 0)
                    samples.push_back(pixel == 0 ? 0 : at(pixel - 1, c));
                if (kind == 1)
                    samples.push_back(at(here - width, c));
                if (kind == 2)
                    samples.push_back(limited(2 * at(here - width, c) - at(here - 2 * width, c)));
                if (kind == 3) {
                    const double slope =
                        std::floor(65536.0 * difference[static_cast<std::size_t>(c)] / count);
                    samples.push_back(limited(
                        at(pixel - 1, c)
                        + static_cast<int>(std::floor((slope * k + 32768) / 65536))));
                }
            }
    }
    bool used = !ended && next_length == streams.lengths.size();
    for (int c = 0; c < channels; ++c)
        used = used && next_value[c] == streams.values[static_cast<std::size_t>(c)].size();
    if (!used || static_cast<int>(samples.size()) != channels * pixels)
        return std::nullopt;
    return samples;
}

} // namespace vera::reference
