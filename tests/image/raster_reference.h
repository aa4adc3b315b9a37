// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/raster_tile.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace vera::reference {

/// A tile whose samples are taken from its streams one by one, as docs/raster-format.md tells it.
class TileReader {
public:
    TileReader(
        const detail::TileStreams& streams, detail::TileShape shape, int channels, int sample_bytes)
        : streams_(streams)
        , width_(static_cast<int>(shape.width))
        , pixels_(static_cast<int>(shape.pixels()))
        , channels_(channels)
        , sample_bytes_(sample_bytes)
        , step_(2 * static_cast<int>(streams.error) + 1) {}

    /// Nothing where the streams end too early or too late, or a run leaves the tile.
    std::optional<std::vector<int>> samples() {
        for (const int command : streams_.commands) {
            if (!is_good_ || pixel() >= pixels_)
                return std::nullopt;
            if (command < 177)
                read_pixel(command);
            else
                read_run((command - 177) / 18, (command - 177) % 18);
        }
        is_good_ = is_good_ && pixel() == pixels_ && next_length_ == streams_.lengths.size();
        for (std::size_t c = 0; c < static_cast<std::size_t>(channels_); ++c)
            is_good_ = is_good_ && next_value_[c] == streams_.values[c].size();
        return is_good_ ? std::optional(samples_) : std::nullopt;
    }

private:
    int pixel() const { return static_cast<int>(samples_.size()) / channels_; }

    int at(int pixel, int c) const {
        const auto place = static_cast<std::size_t>(channels_ * pixel + c);
        return samples_[place];
    }

    int byte(const std::vector<std::uint8_t>& stream, std::size_t& next) {
        if (next < stream.size())
            return stream[next++];
        is_good_ = false;
        return 0;
    }

    int value(int c) {
        const auto channel = static_cast<std::size_t>(c);
        return byte(streams_.values[channel], next_value_[channel]);
    }

    int sample(int c) {
        const int low = value(c);
        return sample_bytes_ == 1 ? low : low + 256 * value(c);
    }

    static int as_signed(int number, int range) {
        return number >= range / 2 ? number - range : number;
    }

    void put(int number) {
        samples_.push_back(std::clamp(number, 0, sample_bytes_ == 1 ? 255 : 65535));
    }

    std::vector<int> steps(int command) {
        std::vector<int> steps;
        if (command == 175)
            for (int c = 0; c < channels_; ++c)
                steps.push_back(as_signed(value(c), 256));
        else if (channels_ == 1)
            steps = {command - 87};
        else
            steps = {command / 5 % 5 - 2, command / 25 - 3, command % 5 - 2};
        if (channels_ == 3) {
            steps[0] += steps[1];
            steps[2] += steps[1];
        }
        return steps;
    }

    int prediction(int pixel, int c) const {
        if (pixel == 0)
            return 0;
        if (pixel < width_)
            return at(pixel - 1, c);
        const int above = at(pixel - width_, c);
        if (pixel % width_ == 0)
            return above;
        const int left = at(pixel - 1, c);
        const int plane = left + above - at(pixel - width_ - 1, c);
        int values[] = {left, above, plane};
        std::sort(std::begin(values), std::end(values));
        return values[1];
    }

    void read_pixel(int command) {
        const int here = pixel();
        if (command == 176) {
            for (int c = 0; c < channels_; ++c)
                put(sample(c));
            return;
        }
        const std::vector<int> wanted = steps(command);
        for (int c = 0; c < channels_; ++c)
            put_step(prediction(here, c), wanted[static_cast<std::size_t>(c)]);
    }

    void put_step(int prediction, int steps) {
        const int range = sample_bytes_ == 1 ? 256 : 65536;
        if (step_ == 1)
            put((prediction + steps + 2 * range) % range);
        else
            put(prediction + steps * step_);
    }

    int run_length(int code) {
        if (code < 16)
            return code + 1;
        const int low = byte(streams_.lengths, next_length_);
        return code == 16 ? 17 + low : 273 + low + 256 * byte(streams_.lengths, next_length_);
    }

    void read_run(int kind, int code) {
        const int start = pixel();
        const int count = run_length(code);
        const int x = start % width_;
        is_good_ = is_good_ && kind <= 3 && count <= pixels_ - start;
        is_good_ = is_good_ && (kind == 0 || kind == 3 || start >= kind * width_);
        is_good_ = is_good_ && (kind != 3 || (x > 0 && count <= width_ - x));
        std::vector<int> differences;
        for (int c = 0; c < channels_ && kind == 3 && is_good_; ++c)
            differences.push_back(as_signed(sample(c), sample_bytes_ == 1 ? 256 : 65536));
        for (int k = 1; k <= count && is_good_; ++k)
            for (int c = 0; c < channels_; ++c)
                put(run_value(kind, start, k, c, count, differences));
    }

    int run_value(
        int kind, int start, int k, int c, int count, const std::vector<int>& differences) const {
        const int here = start + k - 1;
        const int before = start == 0 ? 0 : at(start - 1, c);
        if (kind == 0)
            return before;
        if (kind == 1)
            return at(here - width_, c);
        if (kind == 2)
            return 2 * at(here - width_, c) - at(here - 2 * width_, c);
        const double slope = std::floor(65536.0 * differences[static_cast<std::size_t>(c)] / count);
        return before + static_cast<int>(std::floor((slope * k + 32768) / 65536));
    }

    const detail::TileStreams& streams_;
    int width_;
    int pixels_;
    int channels_;
    int sample_bytes_;
    int step_;
    bool is_good_ = true;
    std::vector<int> samples_;
    std::size_t next_length_ = 0;
    std::array<std::size_t, 3> next_value_ = {};
};

} // namespace vera::reference
