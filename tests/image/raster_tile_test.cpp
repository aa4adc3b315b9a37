// SPDX-License-Identifier: Apache-2.0
#include "vera/image/raster_tile.h"

#include <random>

#include "image/raster_reference.h"
#include <gtest/gtest.h>

namespace vera::detail {
namespace {

using Random = std::mt19937;

int below(Random& random, int count) {
    return static_cast<int>(random() % static_cast<unsigned>(count));
}

/// Areas, slopes, copies of rows and noise, of few values, so that each way to code them is taken.
template <typename Sample>
std::vector<Sample> some_samples(TileShape shape, std::size_t channels, Random& random) {
    constexpr int full = Sample(-1);
    constexpr int unit = full / 255;
    const int values[] = {0, 1, 2, unit, 100 * unit, 101 * unit, full - 1, full};
    std::vector<Sample> samples;
    int kind = 0;
    int slope = 0;
    int value = 0;
    for (std::size_t i = 0; i < channels * shape.pixels(); ++i) {
        const std::size_t row = channels * shape.width;
        if (random() % 40 == 0) {
            kind = below(random, 5);
            slope = below(random, 7) - 3;
        }
        if (kind == 0)
            value = values[below(random, 8)];
        else if (kind == 1 && i >= channels)
            value = samples[i - channels] + slope;
        else if (kind == 2 && i >= row)
            value = samples[i - row];
        else if (kind == 3 && i >= 2 * row)
            value = 2 * samples[i - row] - samples[i - 2 * row];
        else if (i >= channels)
            value = samples[i - channels];
        samples.push_back(static_cast<Sample>(std::clamp(value, 0, full)));
    }
    return samples;
}

TileShape some_shape(Random& random) {
    return {
        static_cast<std::size_t>(1 + below(random, random() % 4 == 0 ? 90 : 9)),
        static_cast<std::size_t>(1 + below(random, 20))};
}

template <typename Sample>
void code_and_compare(unsigned seed) {
    Random random(seed);
    const TileShape shape = some_shape(random);
    const std::size_t channels = random() % 3 == 0 ? 1 : 3;
    const unsigned errors[] = {0, 0, 1, 2, 5, sizeof(Sample) == 1 ? 127U : 32639U};
    const unsigned error = errors[random() % 6];
    const std::vector<Sample> samples = some_samples<Sample>(shape, channels, random);
    const std::vector<std::byte> bytes = encoded_tile<Sample>(samples, shape, channels, error);

    std::vector<Sample> decoded;
    std::vector<ColorRun> runs;
    ASSERT_TRUE(decode_tile<Sample>(bytes, shape, channels, error, decoded, &runs));
    for (std::size_t i = 0; i < samples.size(); ++i)
        ASSERT_LE(std::abs(decoded[i] - samples[i]), static_cast<int>(error)) << i;
    for (const ColorRun& run : runs)
        for (std::size_t i = channels * run.first; i < channels * (run.first + run.count); ++i)
            ASSERT_EQ(decoded[i], decoded[channels * run.first + i % channels]);

    TileStreams streams;
    ASSERT_TRUE(unpack(bytes, sizeof(Sample) * shape.pixels(), streams));
    const auto expected =
        reference::TileReader(streams, shape, static_cast<int>(channels), sizeof(Sample)).samples();
    ASSERT_TRUE(expected);
    for (std::size_t i = 0; i < samples.size(); ++i)
        ASSERT_EQ(decoded[i], (*expected)[i]) << i;
}

TEST(RasterTile, HoldsTheErrorAndIsDecodedAsTheFormatSays) {
    for (unsigned seed = 0; seed < 4000; ++seed) {
        SCOPED_TRACE(seed);
        if (seed % 3 == 0)
            code_and_compare<std::uint16_t>(seed);
        else
            code_and_compare<std::uint8_t>(seed);
        if (testing::Test::HasFatalFailure())
            return;
    }
}

void add_bytes(std::vector<std::uint8_t>& stream, int count, Random& random) {
    const std::uint8_t bytes[] = {0, 1, 2, 127, 128, 255};
    for (int i = 0; i < count; ++i)
        stream.push_back(bytes[random() % 6]);
}

int some_command(Random& random) {
    if (random() % 50 == 0)
        return below(random, 256);
    const int kind = below(random, 12);
    if (kind > 7)
        return 177 + 18 * below(random, 4) + below(random, 4);
    return kind < 4 ? below(random, 177) : 175 + below(random, 2);
}

/// Streams that no encoder writes: any commands, few values, now and then too many or too few.
TileStreams some_streams(TileShape shape, std::size_t channels, Random& random) {
    TileStreams streams;
    std::size_t pixels = 0;
    while (pixels < shape.pixels()) {
        const int command = some_command(random);
        streams.commands.push_back(static_cast<std::uint8_t>(command));
        if (command == 175 || command == 176 || command >= 231)
            for (std::size_t c = 0; c < channels; ++c)
                add_bytes(streams.values[c], 1, random);
        pixels += command < 177 ? 1 : static_cast<std::size_t>((command - 177) % 18 + 1);
    }
    if (random() % 20 == 0)
        add_bytes(streams.values[random() % 3], 1, random);
    if (random() % 20 == 0)
        add_bytes(streams.lengths, 1 + below(random, 2), random);
    return streams;
}

TEST(RasterTile, DecodesAnyStreamsAsTheReferenceDoesOrRefusesThem) {
    int whole = 0;
    for (unsigned seed = 0; seed < 60000; ++seed) {
        Random random(seed);
        const TileShape shape = {
            static_cast<std::size_t>(1 + below(random, 5)),
            static_cast<std::size_t>(1 + below(random, 4))};
        const std::size_t channels = random() % 2 == 0 ? 1 : 3;
        TileStreams streams = some_streams(shape, channels, random);
        streams.error = static_cast<unsigned>(below(random, 3));
        const auto expected =
            reference::TileReader(streams, shape, static_cast<int>(channels), 1).samples();
        std::vector<std::uint8_t> decoded;
        const bool good = decode_tile<std::uint8_t>(packed(streams), shape, channels, 2, decoded);
        ASSERT_EQ(good, expected.has_value()) << seed;
        if (!good)
            continue;
        ++whole;
        for (std::size_t i = 0; i < channels * shape.pixels(); ++i)
            ASSERT_EQ(decoded[i], (*expected)[i]) << seed << ' ' << i;
    }
    EXPECT_GT(whole, 5000);
}

TEST(RasterTile, RefusesBytesThatEndEarly) {
    Random random(5);
    const TileShape shape = {40, 30};
    const std::vector<std::byte> bytes =
        encoded_tile<std::uint8_t>(some_samples<std::uint8_t>(shape, 3, random), shape, 3, 0);
    std::vector<std::uint8_t> decoded;
    for (std::size_t size = 0; size < bytes.size(); ++size)
        ASSERT_FALSE(decode_tile<std::uint8_t>(std::span(bytes).first(size), shape, 3, 0, decoded));
}

TEST(RasterTile, RefusesAnErrorThatIsLargerThanAllowed) {
    const TileShape shape = {1, 1};
    TileStreams streams;
    streams.error = 2;
    streams.commands = {177};
    std::vector<std::uint8_t> decoded;
    EXPECT_TRUE(decode_tile<std::uint8_t>(packed(streams), shape, 3, 2, decoded));
    EXPECT_FALSE(decode_tile<std::uint8_t>(packed(streams), shape, 3, 1, decoded));
}

/// A small pattern of few values, again and again.
std::vector<std::uint8_t> pattern(TileShape shape, std::size_t channels, Random& random) {
    const auto across = static_cast<std::size_t>(2 + below(random, 15));
    const auto down = static_cast<std::size_t>(1 + below(random, 16));
    const int spread = 2 + below(random, 60);
    std::vector<std::uint8_t> cell;
    for (std::size_t i = 0; i < channels * across * down; ++i)
        cell.push_back(static_cast<std::uint8_t>(below(random, spread)));
    std::vector<std::uint8_t> samples;
    for (std::size_t y = 0; y < shape.height; ++y)
        for (std::size_t x = 0; x < shape.width; ++x)
            for (std::size_t c = 0; c < channels; ++c)
                samples.push_back(cell[channels * (y % down * across + x % across) + c]);
    return samples;
}

TEST(RasterTile, IsNeverLargerWithAnErrorThanWithout) {
    Random random(11);
    int exact = 0;
    for (int round = 0; round < 100; ++round) {
        const TileShape shape = {
            static_cast<std::size_t>(20 + below(random, 60)),
            static_cast<std::size_t>(20 + below(random, 60))};
        const std::size_t channels = random() % 3 == 0 ? 1 : 3;
        const auto samples = pattern(shape, channels, random);
        const auto largest = encoded_tile<std::uint8_t>(samples, shape, channels, 0).size();
        for (const unsigned error : {1U, 2U, 5U}) {
            const auto bytes = encoded_tile<std::uint8_t>(samples, shape, channels, error);
            ASSERT_LE(bytes.size(), largest) << round << ' ' << error;
            exact += bytes.front() == std::byte{0} ? 1 : 0;
        }
    }
    // Both ways are taken.
    EXPECT_GT(exact, 20);
    EXPECT_LT(exact, 280);
}

TEST(RasterTile, TakesOneRunForOneColourAndForRowsThatAreEqual) {
    const TileShape shape = {256, 256};
    std::vector<std::uint8_t> samples(3 * shape.pixels(), 200);
    EXPECT_LT(encoded_tile<std::uint8_t>(samples, shape, 3, 0).size(), 30U);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = static_cast<std::uint8_t>(i / 768);
    EXPECT_LT(encoded_tile<std::uint8_t>(samples, shape, 3, 0).size(), 60U);
}

} // namespace
} // namespace vera::detail
