// SPDX-License-Identifier: Apache-2.0
#include "vera/image/raster_tile.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace vera::detail {

namespace {

/// What holds a sample and differences of samples.
template <typename Sample>
using Wide = std::conditional_t<sizeof(Sample) == 1, std::int16_t, std::int32_t>;

/// A pixel in a register of 16 bytes, which every processor of 64 bits has: its samples, and lanes
/// that mean nothing. Vectors of the compiler, not Highway's, whose smallest x86 has SSSE3.
template <typename Sample>
constexpr std::size_t lanes = 16 / sizeof(Wide<Sample>);

template <typename Sample>
struct Vectors {
    using Pixel [[gnu::vector_size(16)]] = Wide<Sample>;
    using Narrow
        [[gnu::vector_size(lanes<Sample> * sizeof(Sample)), gnu::aligned(1), gnu::may_alias]] =
            Sample;
};

template <typename Pixel>
Pixel lesser(Pixel a, Pixel b) {
    return a < b ? a : b;
}

template <typename Pixel>
Pixel greater(Pixel a, Pixel b) {
    return a < b ? b : a;
}

template <typename Sample>
using Differences = std::array<Wide<Sample>, lanes<Sample>>;

/// The differences that the commands below small_end stand for, in samples.
template <typename Sample, std::size_t Channels>
std::array<Differences<Sample>, small_end> small_differences(int step) {
    std::array<Differences<Sample>, small_end> table = {};
    for (int command = 0; command < small_end; ++command) {
        Differences<Sample>& differences = table[static_cast<std::size_t>(command)];
        const auto scaled = [step](int steps) { return static_cast<Wide<Sample>>(steps * step); };
        if constexpr (Channels == 1) {
            differences[0] = scaled(command - small_end / 2);
        } else {
            constexpr int others = 2 * small_other + 1;
            const int green = command / (others * others) - small_green;
            differences[0] = scaled(command / others % others - small_other + green);
            differences[1] = scaled(green);
            differences[2] = scaled(command % others - small_other + green);
        }
    }
    return table;
}

template <typename Sample, std::size_t Channels>
class TileDecoder {
public:
    TileDecoder(
        const TileStreams& streams,
        TileShape shape,
        unsigned largest_error,
        Sample* samples,
        std::vector<ColorRun>* runs)
        : streams_(streams)
        , samples_(samples)
        , row_(Channels * shape.width)
        , end_(Channels * shape.pixels())
        , step_(static_cast<int>(2 * largest_error + 1))
        , small_(small_differences<Sample, Channels>(step_))
        , runs_(runs) {}

    bool decode() {
        const std::uint8_t* command = streams_.commands.data();
        const std::uint8_t* const last = command + streams_.commands.size();
        while (command != last) {
            if (at_ == end_)
                return false;
            if (*command < first_run_command) {
                command = decode_pixels(command, last);
                if (command == nullptr)
                    return false;
            } else if (!decode_run(*command++ - first_run_command)) {
                return false;
            }
            // Rows end here or within a run.
            while (at_ - row_start_ >= row_)
                row_start_ += row_;
        }
        return at_ == end_ && length_ == streams_.lengths.size() && values_used();
    }

private:
    using Pixel = typename Vectors<Sample>::Pixel;
    using Narrow = typename Vectors<Sample>::Narrow;

    bool values_used() const {
        for (std::size_t c = 0; c < Channels; ++c)
            if (value_[c] != streams_.values[c].size())
                return false;
        return true;
    }

    static Pixel load(const Sample* samples) {
        return __builtin_convertvector(*reinterpret_cast<const Narrow*>(samples), Pixel);
    }

    /// Writes over what stands behind the pixel: that comes later, or lies behind the last.
    static void store(Pixel pixel, Sample* sample) {
        const auto narrow = __builtin_convertvector(pixel, Narrow);
        std::memcpy(sample, &narrow, sizeof narrow);
    }

    /// Where there is a neighbour to the left and one above, or only one, or none.
    Pixel predicted_pixel() const {
        const Sample* sample = samples_ + at_;
        if (at_ == 0)
            return Pixel{};
        if (at_ < row_)
            return load(sample - Channels);
        return load(sample - row_);
    }

    /// Pixels of which each has its differences, up to the end of the row; null where the bytes are
    /// damaged. Here most pixels of a picture of smooth shades are decoded.
    const std::uint8_t* decode_pixels(const std::uint8_t* command, const std::uint8_t* last) {
        const bool edge = at_ < row_ || at_ == row_start_;
        const std::size_t rest = edge ? 1 : (row_start_ + row_ - at_) / Channels;
        const std::uint8_t* const stop =
            command + std::min(rest, static_cast<std::size_t>(last - command));
        Sample* sample = samples_ + at_;
        const Sample* above = sample - row_;
        Pixel left{};
        Pixel corner = left;
        if (!edge) {
            left = load(sample - Channels);
            corner = load(above - Channels);
        }
        for (; command != stop && *command < first_run_command; ++command) {
            Pixel prediction = left;
            if (edge) {
                prediction = predicted_pixel();
            } else {
                const Pixel up = load(above);
                const Pixel plane = left + (up - corner);
                prediction = greater(lesser(plane, greater(left, up)), lesser(left, up));
                corner = up;
            }
            Pixel difference;
            if (*command < small_end)
                std::memcpy(&difference, small_[*command].data(), sizeof difference);
            else if (!take_difference(*command, difference, prediction))
                return nullptr;
            left = lesser(greater(prediction + difference, Pixel{}), Pixel{} + full_scale);
            store(left, sample);
            sample += Channels;
            above += Channels;
        }
        at_ = static_cast<std::size_t>(sample - samples_);
        return command;
    }

    static Pixel pixel(const std::array<int, Channels>& values) {
        const auto wide = [&values](std::size_t c) { return static_cast<Wide<Sample>>(values[c]); };
        if constexpr (Channels == 1)
            return Pixel{wide(0)};
        else
            return Pixel{wide(0), wide(1), wide(2)};
    }

    /// A difference that is no small one; of a plain pixel, that from nothing.
    bool take_difference(int command, Pixel& difference, Pixel& prediction) {
        const bool plain = command == plain_command;
        if (!has_values(plain ? sizeof(Sample) : 1))
            return false;
        std::array<int, Channels> values = {};
        if (plain) {
            prediction = Pixel{};
            for (std::size_t c = 0; c < Channels; ++c)
                values[c] = take_sample(c);
        } else {
            for (std::size_t c = 0; c < Channels; ++c)
                values[c] = take_signed_byte(c);
            if constexpr (Channels == 3) {
                values[0] += values[1];
                values[2] += values[1];
            }
            for (int& value : values)
                value = std::clamp<int>(value * step_, -full_scale, full_scale);
        }
        difference = pixel(values);
        return true;
    }

    bool decode_run(int run) {
        std::size_t count = 0;
        if (run / run_commands >= run_kinds || !take_length(run % run_commands, count))
            return false;
        if (count > (end_ - at_) / Channels)
            return false;
        switch (static_cast<RunKind>(run / run_commands)) {
        case RunKind::constant:
            return decode_constant(count);
        case RunKind::above:
            return decode_above(Channels * count);
        case RunKind::across:
            return decode_across(Channels * count);
        default:
            return decode_along(count);
        }
    }

    bool take_length(int code, std::size_t& count) {
        const auto& lengths = streams_.lengths;
        if (code < short_lengths) {
            count = static_cast<std::size_t>(code) + 1;
            return true;
        }
        const std::size_t bytes = code == short_lengths ? 1 : 2;
        if (lengths.size() - length_ < bytes)
            return false;
        count = bytes == 1
            ? medium_length + lengths[length_]
            : long_length + lengths[length_] + (std::size_t{lengths[length_ + 1]} << 8);
        length_ += bytes;
        return true;
    }

    bool has_values(std::size_t bytes) const {
        for (std::size_t c = 0; c < Channels; ++c)
            if (streams_.values[c].size() - value_[c] < bytes)
                return false;
        return true;
    }

    int take_byte(std::size_t c) { return streams_.values[c][value_[c]++]; }

    int take_signed_byte(std::size_t c) {
        const int byte = take_byte(c);
        return byte < 128 ? byte : byte - 256;
    }

    int take_sample(std::size_t c) {
        const int low = take_byte(c);
        return sizeof(Sample) == 1 ? low : low | (take_byte(c) << 8);
    }

    int take_signed_sample(std::size_t c) {
        const int value = take_sample(c);
        constexpr int range = Sample(-1) + 1;
        return value < range / 2 ? value : value - range;
    }

    bool decode_constant(std::size_t count) {
        if (runs_ != nullptr)
            runs_->push_back({at_ / Channels, count});
        Sample* first = samples_ + at_;
        if (at_ == 0)
            std::fill_n(first, Channels, Sample(0));
        else
            std::copy_n(first - Channels, Channels, first);
        // What is there is copied behind itself, twice as much each time.
        const std::size_t samples = Channels * count;
        for (std::size_t done = Channels; done < samples; done *= 2)
            std::memcpy(first + done, first, sizeof(Sample) * std::min(done, samples - done));
        at_ += samples;
        return true;
    }

    bool decode_above(std::size_t samples) {
        if (at_ < row_)
            return false;
        // Rows that the run itself has made are copied on: in pieces that do not overlap.
        for (std::size_t done = 0; done < samples; done += row_)
            std::copy_n(
                samples_ + at_ + done - row_,
                std::min(row_, samples - done),
                samples_ + at_ + done);
        at_ += samples;
        return true;
    }

    bool decode_across(std::size_t samples) {
        if (at_ < 2 * row_)
            return false;
        for (Sample* sample = samples_ + at_; sample != samples_ + at_ + samples; ++sample)
            *sample = static_cast<Sample>(
                clamped_sample<Sample>(2 * *(sample - row_) - *(sample - 2 * row_)));
        at_ += samples;
        return true;
    }

    bool decode_along(std::size_t count) {
        const std::size_t x = (at_ - row_start_) / Channels;
        if (x == 0 || count > row_ / Channels - x || !has_values(sizeof(Sample)))
            return false;
        for (std::size_t c = 0; c < Channels; ++c) {
            Sample* sample = samples_ + at_ + c;
            const int from = *(sample - Channels);
            const std::int32_t slope = line_slope(take_signed_sample(c), count);
            for (std::size_t k = 1; k <= count; ++k, sample += Channels)
                *sample = static_cast<Sample>(clamped_sample<Sample>(from + line_rise(slope, k)));
        }
        at_ += Channels * count;
        return true;
    }

    static constexpr Wide<Sample> full_scale = Sample(-1);

    const TileStreams& streams_;
    Sample* samples_;
    std::size_t row_; ///< samples
    std::size_t end_;
    std::size_t row_start_ = 0;
    int step_;
    std::array<Differences<Sample>, small_end> small_;
    std::vector<ColorRun>* runs_;
    std::size_t at_ = 0; ///< the sample that comes next, and what is used of the other streams:
    std::size_t length_ = 0;
    std::array<std::size_t, Channels> value_ = {};
};

} // namespace

template <typename Sample>
bool decode_tile(
    std::span<const std::byte> bytes,
    TileShape shape,
    std::size_t channels,
    unsigned largest_error,
    std::vector<Sample>& samples,
    std::vector<ColorRun>* runs) {
    thread_local TileStreams streams;
    if (!unpack(bytes, sizeof(Sample) * shape.pixels(), streams))
        return false;
    samples.resize(channels * shape.pixels() + lanes<Sample> - 1);
    if (channels == 1)
        return TileDecoder<Sample, 1>(streams, shape, largest_error, samples.data(), runs).decode();
    return TileDecoder<Sample, 3>(streams, shape, largest_error, samples.data(), runs).decode();
}

template bool decode_tile(
    std::span<const std::byte>,
    TileShape,
    std::size_t,
    unsigned,
    std::vector<std::uint8_t>&,
    std::vector<ColorRun>*);
template bool decode_tile(
    std::span<const std::byte>,
    TileShape,
    std::size_t,
    unsigned,
    std::vector<std::uint16_t>&,
    std::vector<ColorRun>*);

} // namespace vera::detail
