// SPDX-License-Identifier: Apache-2.0
#include "vera/image/raster_pixel.h"
#include "vera/image/raster_tile.h"

#include <algorithm>
#include <cstring>

namespace vera::detail {

namespace {

/// So many samples behind a tile's last may be written: what is copied goes in pieces.
constexpr std::size_t room_behind = 64;

template <typename Pixels>
using Differences = std::array<typename Pixels::Lane, Pixels::lanes>;

/// The differences that the commands below small_end stand for, in samples.
template <typename Pixels, std::size_t Channels>
std::array<Differences<Pixels>, small_end> small_differences(int step) {
    std::array<Differences<Pixels>, small_end> table = {};
    for (int command = 0; command < small_end; ++command) {
        Differences<Pixels>& differences = table[static_cast<std::size_t>(command)];
        const auto scaled = [step](int steps) {
            return static_cast<typename Pixels::Lane>(steps * step);
        };
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

template <typename Sample, std::size_t Channels, typename Pixels>
class TileDecoder {
public:
    TileDecoder(
        const TileStreams& streams, TileShape shape, Sample* samples, std::vector<ColorRun>* runs)
        : streams_(streams)
        , samples_(samples)
        , row_(Channels * shape.width)
        , end_(Channels * shape.pixels())
        , step_(static_cast<int>(2 * streams.error + 1))
        , small_(small_differences<Pixels, Channels>(step_))
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
    using Pixel = typename Pixels::Pixel;

    bool values_used() const {
        for (std::size_t c = 0; c < Channels; ++c)
            if (value_[c] != streams_.values[c].size())
                return false;
        return true;
    }

    /// Pixels of which each has its differences, up to the end of the row; null where the bytes are
    /// damaged. Here most pixels of a picture of smooth shades are decoded.
    const std::uint8_t* decode_pixels(const std::uint8_t* command, const std::uint8_t* last) {
        if (at_ < row_ || at_ == row_start_)
            return decode_at_edge(*command) ? command + 1 : nullptr;
        const std::size_t rest = (row_start_ + row_ - at_) / Channels;
        const std::uint8_t* const stop =
            command + std::min(rest, static_cast<std::size_t>(last - command));
        // What is written here might be this class's own, as far as the compiler knows.
        const std::size_t row = row_;
        Sample* sample = samples_ + at_;
        Pixel left = Pixels::load(sample - Channels);
        Pixel above_left = Pixels::load(sample - row - Channels);
        for (; command != stop && *command < first_run_command; ++command) {
            const Pixel above = Pixels::load(sample - row);
            if (!take_pixel(*command, left, [&](Pixel difference) {
                    return Pixels::next(left, above, above_left, difference);
                }))
                return nullptr;
            Pixels::store(left, sample);
            above_left = above;
            sample += Channels;
        }
        at_ = static_cast<std::size_t>(sample - samples_);
        return command;
    }

    /// A pixel in the first row or column, where there is one neighbour or none.
    bool decode_at_edge(int command) {
        Sample* sample = samples_ + at_;
        Pixel pixel{};
        if (at_ > 0)
            pixel = Pixels::load(sample - (at_ < row_ ? Channels : row_));
        if (!take_pixel(
                command, pixel, [&](Pixel difference) { return Pixels::sum(pixel, difference); }))
            return false;
        Pixels::store(pixel, sample);
        at_ += Channels;
        return true;
    }

    /// Makes the pixel what `next` makes of its difference, or of nothing where it is plain.
    template <typename Next>
    bool take_pixel(int command, Pixel& pixel, const Next& next) {
        if (command < small_end) [[likely]] {
            const auto& difference = small_[static_cast<std::size_t>(command)];
            pixel = next(Pixels::load_difference(difference.data()));
            return true;
        }
        std::array<int, Channels> values = {};
        if (command == plain_command) {
            if (!take_samples(values))
                return false;
            pixel = pixel_of(values);
        } else {
            if (!take_differences(values))
                return false;
            pixel = next(pixel_of(values));
        }
        return true;
    }

    static Pixel pixel_of(const std::array<int, Channels>& values) {
        const auto lane = [&values](std::size_t c) { return Pixels::lane(values[c]); };
        if constexpr (Channels == 1)
            return Pixel{lane(0)};
        else
            return Pixel{lane(0), lane(1), lane(2)};
    }

    bool take_samples(std::array<int, Channels>& values) {
        if (!has_values(sizeof(Sample)))
            return false;
        for (std::size_t c = 0; c < Channels; ++c)
            values[c] = take_sample(c);
        return true;
    }

    bool take_differences(std::array<int, Channels>& values) {
        if (!has_values(1))
            return false;
        for (std::size_t c = 0; c < Channels; ++c)
            values[c] = step_ * take_signed_byte(c);
        if constexpr (Channels == 3) {
            values[0] += values[1];
            values[2] += values[1];
        }
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
        const Pixel pixel = at_ == 0 ? Pixel{} : Pixels::load(first - Channels);
        // Some are written one by one, and these then copied.
        constexpr std::size_t some = 16;
        for (std::size_t k = 0; k < some; ++k)
            Pixels::store(pixel, first + Channels * k);
        std::array<Sample, Channels * some> colors;
        std::memcpy(colors.data(), first, sizeof colors);
        for (std::size_t k = some; k < count; k += some)
            std::memcpy(first + Channels * k, colors.data(), sizeof colors);
        at_ += Channels * count;
        return true;
    }

    /// Makes each of count samples, and some behind, what `piece` makes of Size samples at a time
    /// from the row above. In a shorter row, whose own samples come up again, `single` makes each.
    template <std::size_t Size, typename Piece, typename Single>
    void fill_from_above(std::size_t count, const Piece& piece, const Single& single) {
        Sample* const first = samples_ + at_;
        Sample* const last = first + count;
        if (row_ >= Size)
            for (Sample* sample = first; sample < last; sample += Size)
                piece(sample);
        else
            for (Sample* sample = first; sample < last; ++sample)
                single(sample);
        at_ += count;
    }

    bool decode_above(std::size_t count) {
        if (at_ < row_)
            return false;
        constexpr std::size_t size = 16 / sizeof(Sample);
        const std::size_t row = row_;
        fill_from_above<size>(
            count,
            [row](Sample* sample) {
                std::array<Sample, size> above;
                std::memcpy(above.data(), sample - row, sizeof above);
                std::memcpy(sample, above.data(), sizeof above);
            },
            [row](Sample* sample) { *sample = *(sample - row); });
        return true;
    }

    bool decode_across(std::size_t count) {
        if (at_ < 2 * row_)
            return false;
        using Limited = LimitedPixels<Sample>;
        const std::size_t row = row_;
        fill_from_above<Limited::lanes>(
            count,
            [row](Sample* sample) {
                const auto above = Limited::load(sample - row);
                const auto step = above - Limited::load(sample - 2 * row);
                Limited::store(Limited::sum(above, step), sample);
            },
            [row](Sample* sample) {
                *sample = static_cast<Sample>(
                    clamped_sample<Sample>(2 * *(sample - row) - *(sample - 2 * row)));
            });
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

    const TileStreams& streams_;
    Sample* samples_;
    std::size_t row_; ///< samples
    std::size_t end_;
    std::size_t row_start_ = 0;
    int step_;
    std::array<Differences<Pixels>, small_end> small_;
    std::vector<ColorRun>* runs_;
    std::size_t at_ = 0; ///< the sample that comes next, and what is used of the other streams:
    std::size_t length_ = 0;
    std::array<std::size_t, Channels> value_ = {};
};

template <typename Sample, std::size_t Channels>
bool decode_streams(
    const TileStreams& streams, TileShape shape, Sample* samples, std::vector<ColorRun>* runs) {
    if (streams.error == 0)
        return TileDecoder<Sample, Channels, ExactPixels<Sample>>(streams, shape, samples, runs)
            .decode();
    return TileDecoder<Sample, Channels, LimitedPixels<Sample>>(streams, shape, samples, runs)
        .decode();
}

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
    if (!unpack(bytes, sizeof(Sample) * shape.pixels(), streams) || streams.error > largest_error)
        return false;
    samples.resize(channels * shape.pixels() + room_behind);
    if (channels == 1)
        return decode_streams<Sample, 1>(streams, shape, samples.data(), runs);
    return decode_streams<Sample, 3>(streams, shape, samples.data(), runs);
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
