// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"
#include "vera/base/output_file.h"
#include "vera/base/parallel.h"
#include "vera/image/compressed_raster.h"
#include "vera/image/image_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

#include "base/scratch_folder.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

namespace vera {
namespace {

namespace fs = std::filesystem;

class CompressedRasterFile : public testing::Test {
protected:
    std::vector<std::byte> written(
        const Image& image,
        const RasterWriteSettings& settings = {},
        const PictureMetadata& metadata = {}) const {
        const fs::path path = folder / "a.vra";
        OutputFile file(path);
        write_compressed_raster(image, file, metadata, settings);
        file.commit();
        std::ifstream stream(path, std::ios::binary);
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        const auto bytes = std::as_bytes(std::span(text));
        return {bytes.begin(), bytes.end()};
    }

    ScratchFolder scratch;
    fs::path folder = scratch.path();
};

/// Shaded balls over a floor: what pictures of scenes have, in little.
Image balls(std::size_t width, std::size_t height, SampleType type = SampleType::integer8) {
    Image image = blank_image(width, height, type);
    std::visit(
        [&](auto& samples) {
            using Sample = typename std::decay_t<decltype(samples)>::value_type;
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const std::size_t x = i / 3 % width;
                const std::size_t y = i / 3 / width;
                const std::size_t dx = x % 40;
                const std::size_t dy = y % 40;
                const bool inside = (dx - 20) * (dx - 20) + (dy - 20) * (dy - 20) < 300;
                const std::size_t value = inside ? 40 + 3 * dx + 2 * dy : 90 + x / 9 + i % 3;
                samples[i] = static_cast<Sample>(sizeof(Sample) == 1 ? value : 200 * value + x);
            }
        },
        image.samples);
    return image;
}

template <typename Sample>
int difference(const Image& a, const Image& b) {
    const auto& left = std::get<std::vector<Sample>>(a.samples);
    const auto& right = std::get<std::vector<Sample>>(b.samples);
    int most = left.size() == right.size() ? 0 : 1 << 30;
    for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i)
        most = std::max(most, std::abs(left[i] - right[i]));
    return most;
}

Image cut_out(const Image& image, const PixelRectangle& place) {
    Image part = blank_image(place.width, place.height, sample_type(image));
    const auto& from = std::get<std::vector<std::uint8_t>>(image.samples);
    auto to = std::get<std::vector<std::uint8_t>>(part.samples).begin();
    for (std::size_t y = place.y; y < place.y + place.height; ++y)
        to = std::copy_n(
            from.begin() + static_cast<std::ptrdiff_t>(3 * (y * image.width + place.x)),
            3 * place.width,
            to);
    return part;
}

std::string problem(std::span<const std::byte> bytes) {
    try {
        decoded_image(bytes, "a.vra");
    } catch (const InputError& error) {
        return error.diagnostics().front().problem;
    }
    return "";
}

TEST_F(CompressedRasterFile, KeepsEveryErrorAndLosesNothingWithoutOne) {
    for (const unsigned error : {0U, 1U, 3U, 16U, 127U}) {
        const Image image = balls(150, 97);
        const auto bytes = written(image, {.largest_error = error, .tile_side = 64});
        EXPECT_LE(
            difference<std::uint8_t>(decoded_image(bytes, "a"), image), static_cast<int>(error));
        const Image deep = balls(150, 97, SampleType::integer16);
        const auto deep_bytes = written(deep, {.largest_error = 257 * error, .tile_side = 64});
        EXPECT_LE(
            difference<std::uint16_t>(decoded_image(deep_bytes, "a"), deep),
            static_cast<int>(257 * error));
    }
}

TEST_F(CompressedRasterFile, GrowsSmallerWithTheErrorThatIsAllowed) {
    // A bowl, whose shades no step of a run repeats.
    Image image = blank_image(400, 300, SampleType::integer8);
    auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::size_t x = i / 3 % 400;
        const std::size_t y = i / 3 / 400;
        samples[i] = static_cast<std::uint8_t>((x * x + 2 * y * y) / 1700 + 20 * (i % 3));
    }
    std::size_t before = 400 * 300;
    for (const unsigned error : {0U, 1U, 2U, 8U}) {
        const std::size_t size = written(image, {.largest_error = error}).size();
        EXPECT_LT(size, before) << error;
        before = size;
    }
}

TEST_F(CompressedRasterFile, StoresGreyPicturesOnce) {
    Image image = balls(64, 64);
    auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = samples[i / 3 * 3];
    const auto bytes = written(image);
    EXPECT_EQ(std::to_integer<int>(bytes[11]), 1);
    EXPECT_EQ(difference<std::uint8_t>(decoded_image(bytes, "a"), image), 0);
}

TEST_F(CompressedRasterFile, TellsItsMetadataAndSizeWithoutDecoding) {
    const PictureMetadata metadata = {{"Software", "vera"}, {"", ""}, {"Title", "\xc3\xa4\n"}};
    const auto bytes = written(balls(50, 70), {.largest_error = 2, .tile_side = 32}, metadata);
    const CompressedRaster raster(bytes, "a.vra");
    EXPECT_EQ(raster.width(), 50U);
    EXPECT_EQ(raster.height(), 70U);
    EXPECT_EQ(raster.type(), SampleType::integer8);
    EXPECT_EQ(raster.largest_error(), 2U);
    EXPECT_EQ(raster.metadata(), metadata);
    EXPECT_EQ(raster.tile_count(), 6U);
    EXPECT_EQ(raster.tile_place(5), (PixelRectangle{32, 64, 18, 6}));
}

TEST_F(CompressedRasterFile, DecodesAnyPartAsCutFromTheWhole) {
    const Image image = balls(61, 47);
    const auto bytes = written(image, {.tile_side = 16});
    const CompressedRaster raster(bytes, "a.vra");
    std::mt19937 random(3);
    for (int round = 0; round < 300; ++round) {
        PixelRectangle place = {random() % 61, random() % 47, 0, 0};
        place.width = random() % (62 - place.x);
        place.height = random() % (48 - place.y);
        ASSERT_EQ(raster.part(place).samples, cut_out(image, place).samples) << round;
    }
}

TEST_F(CompressedRasterFile, DecodesTilesWithTheirRuns) {
    const Image image = balls(61, 47);
    const auto bytes = written(image, {.tile_side = 32});
    const CompressedRaster raster(bytes, "a.vra");
    Image tile = blank_image(0, 0, SampleType::float32);
    std::vector<ColorRun> runs;
    for (std::size_t i = 0; i < raster.tile_count(); ++i) {
        raster.decode(i, tile, runs);
        const Image expected = cut_out(image, raster.tile_place(i));
        EXPECT_EQ(tile.width, expected.width);
        EXPECT_EQ(tile.samples, expected.samples);
        for (std::size_t k = 1; k < runs.size(); ++k)
            EXPECT_LE(runs[k - 1].first + runs[k - 1].count, runs[k].first);
    }
}

TEST_F(CompressedRasterFile, IsTheSameForAnyNumberOfThreads) {
    const Image image = balls(300, 200);
    std::vector<std::byte> expected;
    for (const std::size_t threads : {1U, 2U, 7U}) {
        const ThreadLimit limit(threads);
        const auto bytes = written(image, {.tile_side = 32});
        if (expected.empty())
            expected = bytes;
        EXPECT_EQ(bytes, expected);
        EXPECT_EQ(decoded_image(bytes, "a").samples, image.samples);
    }
}

TEST_F(CompressedRasterFile, RefusesEveryChangedByteAndEveryEnd) {
    const auto bytes = written(balls(70, 50), {.tile_side = 32}, {{"Software", "vera"}});
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        auto changed = bytes;
        changed[i] ^= std::byte{16};
        ASSERT_NE(problem(changed), "") << i;
        ASSERT_NE(problem(std::span(bytes).first(i)), "") << i;
    }
    auto longer = bytes;
    longer.push_back(std::byte{0});
    EXPECT_NE(problem(longer), "");
}

TEST_F(CompressedRasterFile, SaysWhichTileIsDamagedAndReadsTheOthers) {
    auto bytes = written(balls(70, 50), {.tile_side = 32});
    bytes[bytes.size() - 4 - 6 * 8 - 2] ^= std::byte{1}; // in the last tile
    EXPECT_EQ(
        problem(bytes),
        "this is no picture that can be read: its tile at pixel 64, 32 is not "
        "what was written");
    const CompressedRaster raster(bytes, "a.vra");
    EXPECT_EQ(raster.part({0, 0, 64, 50}).width, 64U);
}

/// A header with the given numbers and a right checksum, and behind it nothing but zeros.
std::vector<std::byte> header_only(std::size_t width, std::size_t height, std::size_t side) {
    std::vector<std::byte> bytes;
    for (const char letter : std::string("\x89VRA\r\n\x1a\n\1\0\x08\3", 12))
        bytes.push_back(static_cast<std::byte>(letter));
    const auto append = [&bytes](std::size_t number, int size) {
        for (; size > 0; --size, number >>= 8)
            bytes.push_back(static_cast<std::byte>(number & 255));
    };
    append(width, 4);
    append(height, 4);
    append(side, 2);
    append(0, 2);
    append(0, 4);
    append(crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), 28), 4);
    bytes.resize(bytes.size() + 100);
    return bytes;
}

TEST_F(CompressedRasterFile, RefusesHostileSizesBeforeItTakesMemory) {
    using testing::HasSubstr;
    EXPECT_THAT(
        problem(header_only(0x7fffffff, 0x7fffffff, 512)),
        HasSubstr("132 bytes cannot hold the 2147483647 x 2147483647 pixels"));
    EXPECT_THAT(problem(header_only(0x7fffffff, 1, 1)), HasSubstr("cannot hold"));
    EXPECT_THAT(problem(header_only(0x80000000, 1, 1)), HasSubstr("it has 2147483648 x 1 pixels"));
    EXPECT_THAT(problem(header_only(0, 5, 16)), HasSubstr("it has 0 x 5 pixels"));
    EXPECT_THAT(problem(header_only(5, 5, 0)), HasSubstr("may have 1 to 512"));
    EXPECT_THAT(problem(header_only(5, 5, 513)), HasSubstr("may have 1 to 512"));
}

TEST_F(CompressedRasterFile, TellsALaterVersionApart) {
    auto bytes = written(balls(7, 5));
    bytes[8] = std::byte{2};
    EXPECT_THAT(problem(bytes), testing::HasSubstr("of version 2, and version 1 is known here"));
}

} // namespace
} // namespace vera
