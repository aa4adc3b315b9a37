// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"
#include "vera/base/output_file.h"
#include "vera/image/image_file.h"
#include "vera/image/layers_file.h"

#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

#include "base/scratch_folder.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

namespace fs = std::filesystem;

/// An empty folder for a test, removed at its end.
class LayersFile : public ::testing::Test {
protected:
    std::string content(const char* name) const {
        std::ifstream file(folder / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    ScratchFolder scratch;
    fs::path folder = scratch.path();
};

constexpr std::size_t width = 5;
constexpr std::size_t height = 40;

const std::vector<LayerChannel> channels = {
    {"b.two.R", LayerChannel::Type::float32},
    {"a.R", LayerChannel::Type::float32},
    {"id", LayerChannel::Type::uint32}};

float sample(std::size_t channel, std::size_t x, std::size_t y) {
    if (channel == 2)
        return static_cast<float>(x + 7 * y);
    if (x == 4 && y == 3)
        return std::numeric_limits<float>::infinity();
    return static_cast<float>(channel) - 0.1F * static_cast<float>(x) + static_cast<float>(y) / 3;
}

std::uint32_t word(std::size_t channel, std::size_t x, std::size_t y) {
    const float value = sample(channel, x, y);
    return channel == 2 ? static_cast<std::uint32_t>(value) : std::bit_cast<std::uint32_t>(value);
}

/// In bands of that many rows.
void write_sample(OutputFile& file, std::size_t band) {
    LayersWriter writer(file, width, height, channels, {{"Settings", "RASTER 5 40"}});
    for (std::size_t y = 0; y < height; y += band) {
        const std::size_t rows = std::min(band, height - y);
        std::vector<std::uint32_t> words;
        for (std::size_t channel = 0; channel < channels.size(); ++channel)
            for (std::size_t row = 0; row < rows; ++row)
                for (std::size_t x = 0; x < width; ++x)
                    words.push_back(word(channel, x, y + row));
        writer.write_rows(rows, words);
    }
    writer.finish();
    file.commit();
}

TEST_F(LayersFile, IsReadAsItWasWritten) {
    OutputFile file(folder / "a.exr");
    write_sample(file, 32);
    const std::string bytes = content("a.exr");
    const LayersReader reader(std::as_bytes(std::span(bytes)), "a.exr");
    ASSERT_EQ(reader.width(), width);
    ASSERT_EQ(reader.height(), height);
    EXPECT_EQ(
        reader.channels(), (std::vector<LayerChannel>{channels[1], channels[0], channels[2]}));
    EXPECT_EQ(reader.text("Settings"), "RASTER 5 40");
    EXPECT_EQ(reader.text("compression"), "");
    const std::vector<std::string> names = {"b.two.R", "a.R", "id"};
    std::vector<float> samples(names.size() * width);
    for (const std::size_t y : {39U, 0U, 3U, 17U}) {
        reader.read_row(y, names, samples);
        for (std::size_t channel = 0; channel < names.size(); ++channel)
            for (std::size_t x = 0; x < width; ++x)
                ASSERT_EQ(samples[channel * width + x], sample(channel, x, y)) << y;
    }
}

TEST_F(LayersFile, HasTheSameBytesHoweverItsRowsCome) {
    OutputFile a(folder / "a.exr");
    write_sample(a, 32);
    OutputFile b(folder / "b.exr");
    write_sample(b, 1);
    EXPECT_EQ(content("a.exr"), content("b.exr"));
}

TEST_F(LayersFile, IsRefusedWhenItIsCutShortOrAnotherThing) {
    OutputFile file(folder / "a.exr");
    write_sample(file, 32);
    const std::string bytes = content("a.exr");
    std::vector<float> samples(width);
    const std::vector<std::string> names = {"a.R"};
    for (std::size_t size = 0; size < bytes.size(); size += 13) {
        const std::string cut = bytes.substr(0, size);
        try {
            const LayersReader reader(std::as_bytes(std::span(cut)), "cut.exr");
            reader.read_row(height - 1, names, samples);
            FAIL() << size << " bytes are not the whole file";
        } catch (const InputError& error) {
            EXPECT_EQ(error.diagnostics().front().place.file, "cut.exr");
        }
    }
}

TEST_F(LayersFile, OfADiskThatIsFullTellsSo) {
    if (!fs::exists("/dev/full"))
        GTEST_SKIP() << "there is no /dev/full";
    OutputFile file("/dev/full");
    EXPECT_THROW(write_sample(file, 32), std::exception);
}

} // namespace
} // namespace vera
