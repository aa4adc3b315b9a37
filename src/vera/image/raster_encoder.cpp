// SPDX-License-Identifier: Apache-2.0
#include "vera/image/raster_tile.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace vera::detail {

namespace {

// A run is worth its command from so many pixels on, measured over the pictures of scenes/. Less
// than a command and a length it never costs; pixels of small differences cost a bit or two each.
constexpr std::size_t shortest_run = 8;
constexpr std::size_t shortest_line = 24;

struct Run {
    RunKind kind = RunKind::constant;
    std::size_t count = 0;
};

/// Goes through the pixels in the order of reading. decoded_ holds what the decoder will have up to
/// here: everything is predicted from that, so that no error adds up.
template <typename Sample, std::size_t Channels>
class TileEncoder {
public:
    TileEncoder(std::span<const Sample> wanted, TileShape shape, unsigned largest_error)
        : wanted_(wanted)
        , decoded_(wanted.size())
        , shape_(shape)
        , error_(static_cast<int>(largest_error)) {
        streams_.error = largest_error;
    }

    TileStreams streams() && {
        while (position_ < shape_.pixels()) {
            const Run run = best_run();
            const Colors slopes_end = line_end_;
            if (run.kind == RunKind::along && run.count > 0)
                add_line(run.count, slopes_end);
            else if (run.count > 0)
                add_run(run);
            else
                add_pixel();
        }
        return std::move(streams_);
    }

private:
    using Colors = std::array<int, Channels>;

    int wanted(std::size_t pixel, std::size_t c) const { return wanted_[Channels * pixel + c]; }

    int decoded(std::size_t pixel, std::size_t c) const { return decoded_[Channels * pixel + c]; }

    void set(std::size_t pixel, std::size_t c, int value) {
        decoded_[Channels * pixel + c] = static_cast<Sample>(value);
    }

    bool near(std::size_t pixel, std::size_t c, int value) const {
        return std::abs(wanted(pixel, c) - value) <= error_;
    }

    /// What a run gives pixel i of those from position_ on, where the pixels before are decoded.
    int run_value(RunKind kind, std::size_t pixel, std::size_t c) const {
        switch (kind) {
        case RunKind::constant:
            return position_ == 0 ? 0 : decoded(position_ - 1, c);
        case RunKind::above:
            return decoded(pixel - shape_.width, c);
        default:
            return clamped_sample<Sample>(
                2 * decoded(pixel - shape_.width, c) - decoded(pixel - 2 * shape_.width, c));
        }
    }

    /// Only pixels that are decoded already are looked at: `most` says where those end.
    std::size_t run_length(RunKind kind, std::size_t most) const {
        std::size_t count = 0;
        for (; count < most; ++count)
            for (std::size_t c = 0; c < Channels; ++c)
                if (!near(position_ + count, c, run_value(kind, position_ + count, c)))
                    return count;
        return count;
    }

    Run best_run() {
        const std::size_t rest = std::min(shape_.pixels() - position_, longest_run);
        Run best = {RunKind::constant, run_length(RunKind::constant, rest)};
        const auto offer = [&best](Run run) {
            if (run.count > best.count)
                best = run;
        };
        // A row above reaches up to where this run begins; a copy of a copy is not looked for.
        const std::size_t row = shape_.width;
        if (position_ >= row)
            offer({RunKind::above, run_length(RunKind::above, std::min(rest, row))});
        if (position_ >= 2 * row && best.count < row)
            offer({RunKind::across, run_length(RunKind::across, std::min(rest, row))});
        if (best.count < shortest_run)
            best.count = 0;
        const std::size_t line = line_length();
        if (line >= shortest_line && line > 2 * best.count)
            best = {RunKind::along, line};
        return best;
    }

    /// How far a straight line from the pixel before goes within its row, and where it ends.
    std::size_t line_length() {
        const std::size_t x = position_ % shape_.width;
        if (x == 0)
            return 0;
        Lines lines;
        std::size_t count = 0;
        while (x + count < shape_.width && narrow(lines, count + 1))
            ++count;
        for (; count >= shortest_line; --count)
            if (fits(lines, count))
                return count;
        return 0;
    }

    /// The slopes that pass within the error of all pixels up to some step.
    struct Lines {
        std::array<double, Channels> least;
        std::array<double, Channels> most;

        Lines() {
            least.fill(-1e9);
            most.fill(1e9);
        }
    };

    bool narrow(Lines& lines, std::size_t step) const {
        Lines next = lines;
        for (std::size_t c = 0; c < Channels; ++c) {
            const double rise = wanted(position_ + step - 1, c) - decoded(position_ - 1, c);
            const double reach = error_ + 0.5;
            const auto steps = static_cast<double>(step);
            next.least[c] = std::max(next.least[c], (rise - reach) / steps);
            next.most[c] = std::min(next.most[c], (rise + reach) / steps);
            if (next.least[c] > next.most[c])
                return false;
        }
        lines = next;
        return true;
    }

    /// Whether the line in the middle of the slopes holds the error as the decoder rounds it.
    bool fits(const Lines& lines, std::size_t count) {
        constexpr int reach = sizeof(Sample) == 1 ? 127 : 32767;
        for (std::size_t c = 0; c < Channels; ++c) {
            const int from = decoded(position_ - 1, c);
            const double rise = (lines.least[c] + lines.most[c]) / 2 * static_cast<double>(count);
            const int end = clamped_sample<Sample>(from + static_cast<int>(std::lround(rise)));
            if (std::abs(end - from) > reach)
                return false;
            line_end_[c] = end - from;
            const std::int32_t slope = line_slope(end - from, count);
            for (std::size_t k = 1; k <= count; ++k)
                if (!near(position_ + k - 1, c, from + line_rise(slope, k)))
                    return false;
        }
        return true;
    }

    void add_length(RunKind kind, std::size_t count) {
        const int first = first_run_command + static_cast<int>(kind) * run_commands;
        if (count <= short_lengths) {
            streams_.commands.push_back(
                static_cast<std::uint8_t>(first + static_cast<int>(count) - 1));
        } else if (count < long_length) {
            streams_.commands.push_back(static_cast<std::uint8_t>(first + short_lengths));
            streams_.lengths.push_back(static_cast<std::uint8_t>(count - medium_length));
        } else {
            streams_.commands.push_back(static_cast<std::uint8_t>(first + short_lengths + 1));
            streams_.lengths.push_back(static_cast<std::uint8_t>((count - long_length) & 255));
            streams_.lengths.push_back(static_cast<std::uint8_t>((count - long_length) >> 8));
        }
    }

    void add_run(Run run) {
        add_length(run.kind, run.count);
        const std::size_t first = position_;
        for (std::size_t pixel = first; pixel < first + run.count; ++pixel)
            for (std::size_t c = 0; c < Channels; ++c)
                set(pixel, c, run_value(run.kind, pixel, c));
        position_ += run.count;
    }

    void add_line(std::size_t count, const Colors& differences) {
        add_length(RunKind::along, count);
        for (std::size_t c = 0; c < Channels; ++c) {
            add_sample(c, differences[c]);
            const int from = decoded(position_ - 1, c);
            const std::int32_t slope = line_slope(differences[c], count);
            for (std::size_t k = 1; k <= count; ++k)
                set(position_ + k - 1, c, from + line_rise(slope, k));
        }
        position_ += count;
    }

    /// As many bytes as a sample has, the lower one first.
    void add_sample(std::size_t c, int value) {
        streams_.values[c].push_back(static_cast<std::uint8_t>(value & 255));
        if (sizeof(Sample) == 2)
            streams_.values[c].push_back(static_cast<std::uint8_t>((value >> 8) & 255));
    }

    Colors prediction() const {
        const std::size_t row = shape_.width;
        Colors colors = {};
        for (std::size_t c = 0; c < Channels; ++c) {
            if (position_ == 0)
                colors[c] = 0;
            else if (position_ < row)
                colors[c] = decoded(position_ - 1, c);
            else if (position_ % row == 0)
                colors[c] = decoded(position_ - row, c);
            else
                colors[c] = predicted(
                    decoded(position_ - 1, c),
                    decoded(position_ - row, c),
                    decoded(position_ - row - 1, c));
        }
        return colors;
    }

    /// The number of steps of 2 error + 1 that lead nearest.
    int steps_to(int difference) const {
        const int steps = (std::abs(difference) + error_) / (2 * error_ + 1);
        return difference < 0 ? -steps : steps;
    }

    void add_pixel() {
        const Colors from = prediction();
        Colors steps = {};
        for (std::size_t c = 0; c < Channels; ++c) {
            steps[c] = steps_to(wanted(position_, c) - from[c]);
            set(position_, c, clamped_sample<Sample>(from[c] + steps[c] * (2 * error_ + 1)));
        }
        if (!add_small(steps) && !add_differences(steps)) {
            streams_.commands.push_back(plain_command);
            for (std::size_t c = 0; c < Channels; ++c) {
                add_sample(c, wanted(position_, c));
                set(position_, c, wanted(position_, c));
            }
        }
        ++position_;
    }

    bool add_small(const Colors& steps) {
        int command = 0;
        if constexpr (Channels == 1) {
            if (std::abs(steps[0]) > small_end / 2)
                return false;
            command = steps[0] + small_end / 2;
        } else {
            const int green = steps[1];
            const int red = steps[0] - green;
            const int blue = steps[2] - green;
            if (std::abs(green) > small_green || std::abs(red) > small_other
                || std::abs(blue) > small_other)
                return false;
            constexpr int others = 2 * small_other + 1;
            command =
                ((green + small_green) * others + red + small_other) * others + blue + small_other;
        }
        streams_.commands.push_back(static_cast<std::uint8_t>(command));
        return true;
    }

    bool add_differences(Colors steps) {
        if constexpr (Channels == 3) {
            steps[0] -= steps[1];
            steps[2] -= steps[1];
        }
        for (const int value : steps)
            if (value < -128 || value > 127)
                return false;
        streams_.commands.push_back(difference_command);
        for (std::size_t c = 0; c < Channels; ++c)
            streams_.values[c].push_back(static_cast<std::uint8_t>(steps[c] & 255));
        return true;
    }

    std::span<const Sample> wanted_;
    std::vector<Sample> decoded_;
    TileShape shape_;
    int error_;
    std::size_t position_ = 0;
    Colors line_end_ = {};
    TileStreams streams_;
};

} // namespace

template <typename Sample>
std::vector<std::byte> encoded_tile(
    std::span<const Sample> samples,
    TileShape shape,
    std::size_t channels,
    unsigned largest_error) {
    const auto encoded = [&](unsigned error) {
        return packed(
            channels == 1 ? TileEncoder<Sample, 1>(samples, shape, error).streams()
                          : TileEncoder<Sample, 3>(samples, shape, error).streams());
    };
    std::vector<std::byte> bytes = encoded(largest_error);
    if (largest_error == 0)
        return bytes;
    // What zstd finds in a pattern that repeats may be lost with the last bits.
    std::vector<std::byte> exact = encoded(0);
    return exact.size() <= bytes.size() ? exact : bytes;
}

template std::vector<std::byte>
encoded_tile(std::span<const std::uint8_t>, TileShape, std::size_t, unsigned);
template std::vector<std::byte>
encoded_tile(std::span<const std::uint16_t>, TileShape, std::size_t, unsigned);

} // namespace vera::detail
