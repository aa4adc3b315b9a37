// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"
#include "vera/image/image_file.h"

#include <cerrno>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <system_error>

#include "base/scratch_folder.h"
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vera {
namespace {

namespace fs = std::filesystem;
using namespace std::string_literals;
using testing::HasSubstr;
using testing::StartsWith;

constexpr ImageFileFormat all_formats[] = {
    ImageFileFormat::png8,
    ImageFileFormat::png16,
    ImageFileFormat::exr_half,
    ImageFileFormat::exr_float,
    ImageFileFormat::jpeg,
    ImageFileFormat::ppm8,
    ImageFileFormat::ppm16,
    ImageFileFormat::pfm,
    ImageFileFormat::vra8,
    ImageFileFormat::vra16};

/// An empty folder for a test, removed at its end.
class ImageFile : public testing::Test {
protected:
    ScratchFolder scratch;
    fs::path folder = scratch.path();
};

std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

std::span<const std::byte> as_bytes(const std::string& text) {
    return std::as_bytes(std::span(text));
}

/// Smooth in one direction, random in the other; halves hold its floats exactly.
Image sample_image(SampleType type, std::size_t width, std::size_t height) {
    std::mt19937 random(7);
    Image image = blank_image(width, height, type);
    std::visit(
        [&](auto& samples) {
            using Sample = typename std::decay_t<decltype(samples)>::value_type;
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const std::size_t value = i / 3 % width + random() % 8;
                if constexpr (std::is_same_v<Sample, float>)
                    samples[i] = static_cast<float>(value) / 16 - 1;
                else
                    samples[i] = static_cast<Sample>(value * (sizeof(Sample) == 1 ? 3U : 777U));
            }
        },
        image.samples);
    return image;
}

TEST_F(ImageFile, ComesBackAsItWasWrittenInEveryFormatWithoutLoss) {
    const fs::path path = folder / "picture";
    for (const ImageFileFormat format : all_formats) {
        if (format == ImageFileFormat::jpeg)
            continue;
        for (const std::size_t height : {1U, 16U, 37U}) {
            const Image image = sample_image(sample_type(format), 53, height);
            write_image(image, path, format, {{"Software", "vera"}});
            const Image read = read_image(path);
            ASSERT_EQ(read.width, image.width);
            ASSERT_EQ(read.height, image.height);
            ASSERT_EQ(read.samples, image.samples) << static_cast<int>(format);
        }
    }
}

TEST_F(ImageFile, ComesBackAlmostAsItWasWrittenFromJpeg) {
    Image image = blank_image(40, 30, SampleType::integer8);
    auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
    for (std::size_t i = 0; i < samples.size(); ++i)
        samples[i] = static_cast<std::uint8_t>(5 * (i / 3 % 40) + 40 * (i % 3 == 1 ? 1 : 0));
    write_image(image, folder / "a.jpg", ImageFileFormat::jpeg);
    const Image read = read_image(folder / "a.jpg");
    const auto& read_samples = std::get<std::vector<std::uint8_t>>(read.samples);
    ASSERT_EQ(read_samples.size(), samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i)
        ASSERT_NEAR(read_samples[i], samples[i], 4);
}

TEST_F(ImageFile, HasTheSameBytesEachTime) {
    for (const ImageFileFormat format : all_formats) {
        const Image image = sample_image(sample_type(format), 64, 40);
        write_image(image, folder / "a", format, {{"Title", "x"}});
        write_image(image, folder / "b", format, {{"Title", "x"}});
        EXPECT_EQ(content(folder / "a"), content(folder / "b")) << static_cast<int>(format);
    }
}

TEST_F(ImageFile, LeavesNothingButThePicture) {
    for (const ImageFileFormat format : all_formats)
        write_image(sample_image(sample_type(format), 5, 5), folder / "picture", format);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1);
}

TEST_F(ImageFile, IsAPpmByteForByte) {
    Image image = {2, 1, std::vector<std::uint8_t>{1, 2, 3, 254, 255, 0}};
    write_image(image, folder / "a.ppm", ImageFileFormat::ppm8, {{"Software", "vera 1\nx"}});
    EXPECT_EQ(
        content(folder / "a.ppm"),
        "P6\n# Software: vera 1\n# x\n2 1\n255\n\x01\x02\x03\xfe\xff\x00"s);

    image.samples = std::vector<std::uint16_t>{1, 256, 65535, 0, 0x1234, 7};
    write_image(image, folder / "b.ppm", ImageFileFormat::ppm16);
    EXPECT_EQ(
        content(folder / "b.ppm"),
        "P6\n2 1\n65535\n\x00\x01\x01\x00\xff\xff\x00\x00\x12\x34\x00\x07"s);
}

TEST_F(ImageFile, IsAPfmFromTheBottomUp) {
    const Image image = {1, 2, std::vector<float>{0, 0, 0, 1, 1, 1}};
    write_image(image, folder / "a.pfm", ImageFileFormat::pfm);
    const std::string one = "\x00\x00\x80\x3f"s;
    EXPECT_EQ(
        content(folder / "a.pfm"), "PF\n1 2\n-1.0\n" + one + one + one + std::string(12, '\0'));
}

TEST_F(ImageFile, ComesBackFromPngAtEveryCompressionWhateverItsRowsAreLike) {
    std::mt19937 random(1988);
    constexpr std::uint16_t values[] = {0, 1, 2, 127, 128, 255, 256, 65535};
    for (int round = 0; round < 60; ++round) {
        // Up to some chunks of data; rows that repeat pixels, or the row above.
        const std::size_t width = 1 + random() % (round % 6 == 0 ? 300 : 5);
        const std::size_t height = 1 + random() % (round % 6 == 0 ? 300 : 5);
        std::vector<std::uint16_t> samples(3 * width * height);
        for (std::size_t i = 0; i < samples.size(); ++i)
            samples[i] = i >= 3 * width && random() % 2 == 0 ? samples[i - 3 * width]
                : i >= 3 && random() % 2 == 0                ? samples[i - 3]
                                                             : values[random() % 8];
        const ImageWriteSettings settings = {.png_compression = round % 10};
        const Image image = {width, height, samples};
        write_image(image, folder / "a.png", ImageFileFormat::png16, {}, settings);
        EXPECT_EQ(read_image(folder / "a.png").samples, image.samples) << "round " << round;

        const Image small = {
            width, height, std::vector<std::uint8_t>(samples.begin(), samples.end())};
        write_image(small, folder / "a.png", ImageFileFormat::png8, {}, settings);
        EXPECT_EQ(read_image(folder / "a.png").samples, small.samples) << "round " << round;
    }
}

TEST_F(ImageFile, HasTheHighByteFirstInPng) {
    const Image image = {1, 1, std::vector<std::uint16_t>{0x1234, 7, 0xfffe}};
    write_image(image, folder / "a.png", ImageFileFormat::png16, {}, {.png_compression = 0});
    EXPECT_THAT(content(folder / "a.png"), HasSubstr("\x12\x34\x00\x07\xff\xfe"s));
}

TEST_F(ImageFile, PngRowsAreDifferencesFromTheLeftOrFromAboveWhicheverAreSmaller) {
    constexpr std::size_t side = 64;
    std::mt19937 random(1996);
    for (const SampleType type : {SampleType::integer8, SampleType::integer16}) {
        Image like_above = blank_image(side, side, type);
        Image like_left = blank_image(side, side, type);
        std::visit(
            [&](auto& samples) {
                using Sample = typename std::decay_t<decltype(samples)>::value_type;
                auto& left = std::get<std::decay_t<decltype(samples)>>(like_left.samples);
                for (std::size_t i = 0; i < 3 * side; ++i) {
                    const auto sample = static_cast<Sample>(random());
                    for (std::size_t j = 0; j < side; ++j) {
                        // So that no row and no pixel is found again as it was.
                        const auto next =
                            static_cast<Sample>(static_cast<std::size_t>(sample) + 5 * j);
                        samples[3 * side * j + i] = next;
                        left[3 * (side * (i % side) + j) + i / side] = next;
                    }
                }
            },
            like_above.samples);
        // Without a filter, or with the other one, they take several times as much.
        for (const Image* image : {&like_above, &like_left}) {
            const auto format =
                type == SampleType::integer8 ? ImageFileFormat::png8 : ImageFileFormat::png16;
            write_image(*image, folder / "a.png", format);
            EXPECT_LT(
                fs::file_size(folder / "a.png"), image->width * image->height * size_of(type));
            EXPECT_EQ(read_image(folder / "a.png").samples, image->samples);
        }
    }
}

TEST_F(ImageFile, CarriesItsMetadata) {
    const PictureMetadata metadata = {
        {"Software", "vera 0.1.0"}, {"Settings", "--depth 5"}, {"Author", "J\xc3\xb6rg"}};
    for (const ImageFileFormat format : all_formats) {
        if (format == ImageFileFormat::pfm)
            continue;
        write_image(sample_image(sample_type(format), 9, 9), folder / "a", format, metadata);
        const std::string bytes = content(folder / "a");
        for (const auto& [name, value] : metadata) {
            EXPECT_THAT(bytes, HasSubstr(name)) << static_cast<int>(format);
            EXPECT_THAT(bytes, HasSubstr(value)) << static_cast<int>(format);
        }
    }
}

TEST_F(ImageFile, TakesMetadataThatAFormatHasNoNameFor) {
    const PictureMetadata metadata = {
        {"", "nameless"},
        {std::string(300, 'n'), "long"},
        {"channels", "what EXR uses for itself"},
        {"channels", "again"},
        {"line\nbreak", std::string(200'000, 'v')}};
    for (const ImageFileFormat format : all_formats) {
        const Image image = sample_image(sample_type(format), 9, 9);
        write_image(image, folder / "a", format, metadata);
        EXPECT_EQ(read_image(folder / "a").width, 9U) << static_cast<int>(format);
    }
}

TEST_F(ImageFile, DeclaresSrgbInPngAndItsPrimariesInExr) {
    write_image(sample_image(SampleType::integer8, 2, 2), folder / "a", ImageFileFormat::png8);
    EXPECT_THAT(content(folder / "a"), HasSubstr("sRGB"));
    EXPECT_THAT(content(folder / "a"), HasSubstr("gAMA"));
    EXPECT_THAT(content(folder / "a"), testing::Not(HasSubstr("tIME")));
    write_image(sample_image(SampleType::float32, 2, 2), folder / "b", ImageFileFormat::exr_half);
    EXPECT_THAT(content(folder / "b"), HasSubstr("chromaticities"));
}

TEST_F(ImageFile, LimitsHalvesToTheLargest) {
    const Image image = {2, 1, std::vector<float>{1e9F, -1e9F, 65504, 65519, 0.1F, 0}};
    write_image(image, folder / "a.exr", ImageFileFormat::exr_half);
    const Image read = read_image(folder / "a.exr");
    EXPECT_THAT(
        std::get<std::vector<float>>(read.samples),
        testing::ElementsAre(65504, -65504, 65504, 65504, 0.0999755859375F, 0));
}

TEST_F(ImageFile, GoesToAPipeAsToAFile) {
    for (const ImageFileFormat format : all_formats) {
        const Image image = sample_image(sample_type(format), 31, 40);
        write_image(image, folder / "file", format);
        ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
        const std::string command =
            "cat " + (folder / "pipe").native() + " > " + (folder / "copy").native() + " & echo $!";
        std::FILE* shell = popen(command.c_str(), "r");
        write_image(image, folder / "pipe", format);
        pclose(shell);
        // The reader may still be writing what it has read.
        for (int i = 0; i < 500 && content(folder / "copy") != content(folder / "file"); ++i)
            usleep(10'000);
        EXPECT_EQ(content(folder / "copy"), content(folder / "file")) << static_cast<int>(format);
        fs::remove(folder / "pipe");
    }
}

TEST_F(ImageFile, SaysThatADeviceIsFull) {
    for (const ImageFileFormat format : all_formats)
        try {
            write_image(sample_image(sample_type(format), 31, 40), "/dev/full", format);
            FAIL() << static_cast<int>(format);
        } catch (const std::system_error& error) {
            EXPECT_EQ(error.code(), std::errc::no_space_on_device);
            EXPECT_THAT(error.what(), HasSubstr("cannot write '/dev/full'; free some space"));
        }
}

TEST_F(ImageFile, LeavesNothingWhenItGrowsBeyondALimit) {
    for (const ImageFileFormat format : all_formats) {
        const Image image = sample_image(sample_type(format), 300, 300);
        const pid_t child = fork();
        if (child == 0) {
            std::signal(SIGXFSZ, SIG_IGN);
            const rlimit limit = {10'000, 10'000};
            setrlimit(RLIMIT_FSIZE, &limit);
            try {
                write_image(image, folder / "a", format);
            } catch (const std::system_error& error) {
                const std::string start = "cannot write '" + (folder / "a").native() + "'; raise";
                _exit(std::string(error.what()).starts_with(start) ? error.code().value() : 98);
            } catch (...) {
                _exit(97);
            }
            _exit(0);
        }
        int status = 0;
        waitpid(child, &status, 0);
        EXPECT_EQ(WEXITSTATUS(status), EFBIG) << static_cast<int>(format);
        EXPECT_TRUE(fs::is_empty(folder));
    }
}

TEST_F(ImageFile, TooWideForJpegIsRefusedWithAnAlternative) {
    const Image image = blank_image(65501, 1, SampleType::integer8);
    try {
        write_image(image, folder / "a.jpg", ImageFileFormat::jpeg);
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("at most 65500 pixels a side; choose PNG or EXR"));
    }
    EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(ImageFile, CutShortIsAnErrorWhereverItIsCut) {
    for (const ImageFileFormat format : all_formats) {
        const std::string name = "cut " + std::to_string(static_cast<int>(format));
        write_image(sample_image(sample_type(format), 20, 20), folder / "a", format);
        const std::string whole = content(folder / "a");
        // A JPEG may do without its last marker, and all EXR pixels come before its end.
        for (std::size_t size = 0; size + 2 < whole.size(); size += 1 + whole.size() / 200)
            try {
                decoded_image(as_bytes(whole.substr(0, size)), name);
                FAIL() << name << ' ' << size << " of " << whole.size();
            } catch (const InputError& error) {
                ASSERT_EQ(error.diagnostics().size(), 1U);
                ASSERT_EQ(error.diagnostics()[0].place.file, name);
                ASSERT_THAT(
                    error.diagnostics()[0].problem,
                    StartsWith("this is no picture that can be read: "));
            }
    }
}

TEST_F(ImageFile, DamagedAnywhereGivesAPictureOrAnErrorAndNothingElse) {
    std::mt19937 random(3);
    for (const ImageFileFormat format : all_formats) {
        write_image(sample_image(sample_type(format), 20, 20), folder / "a", format);
        const std::string whole = content(folder / "a");
        for (int round = 0; round < 100; ++round) {
            std::string damaged = whole;
            for (int i = 0; i <= round % 3; ++i)
                damaged
                    [random() % std::min<std::size_t>(damaged.size(), round % 2 ? 400 : 1 << 30)] =
                        static_cast<char>("\x00\x01\x7f\x80\xff"[random() % 5]);
            try {
                const Image image = decoded_image(as_bytes(damaged), "damaged");
                EXPECT_GT(image.width * image.height, 0U);
            } catch (const std::runtime_error&) {
            }
        }
    }
}

TEST(DecodedImage, NamesWhatItCannotRead) {
    const auto problem = [](const std::string& bytes) {
        try {
            decoded_image(as_bytes(bytes), "a.ppm");
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_THAT(
        problem(""),
        HasSubstr("a.ppm: this is no picture that can be read: it is "
                  "empty"));
    EXPECT_THAT(problem("GIF89a"), HasSubstr("its first bytes are those of no format"));
    EXPECT_THAT(
        problem("P6 2 x 255\n"), HasSubstr("expected its height, from 1 to 2147483647, found 'x'"));
    EXPECT_THAT(
        problem("P6 2 2 255\nabc"),
        HasSubstr("it ends early: 2 x 2 pixels of 3 bytes do not fit into the 3 bytes"));
    EXPECT_THAT(problem("P6 1 1 7\n\x08\x01\x01"), HasSubstr("a sample is 8, more than its white"));
    EXPECT_THAT(problem("PF 1 1 x\n"), HasSubstr("expected its scale"));
    EXPECT_THAT(problem("P6 2147483647 2147483647 255\nabc"), HasSubstr("it ends early"));
}

TEST(ImageBytes, OfADeviceWithoutAnEndAreRefused) {
    try {
        file_bytes("/dev/zero", 100'000);
        FAIL() << "it was read";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("/dev/zero: more than 100000 bytes came"));
    }
}

TEST_F(ImageFile, MayBeLargeAndOfOneColor) {
    for (const ImageFileFormat format : all_formats) {
        write_image(blank_image(1000, 800, sample_type(format)), folder / "a", format);
        EXPECT_EQ(read_image(folder / "a").height, 800U) << static_cast<int>(format);
    }
}

TEST_F(ImageFile, ThatPromisesMorePixelsThanItCanHoldIsRefusedBeforeTheyTakeMemory) {
    write_image(blank_image(5, 5, SampleType::integer8), folder / "a", ImageFileFormat::jpeg);
    std::string bytes = content(folder / "a");
    const std::size_t frame = bytes.find("\xff\xc0\x00\x11\x08"s);
    ASSERT_NE(frame, std::string::npos);
    bytes.replace(frame + 5, 4, "\xff\x00\xff\x00"s);
    try {
        decoded_image(as_bytes(bytes), "a.jpg");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(
            error.what(), HasSubstr("cannot hold the 65280 x 65280 pixels that its header"));
    }

    write_image(blank_image(5, 5, SampleType::float32), folder / "a", ImageFileFormat::exr_half);
    bytes = content(folder / "a");
    const std::size_t window = bytes.find("dataWindow\0box2i\0\x10\0\0\0"s);
    ASSERT_NE(window, std::string::npos);
    bytes.replace(window + 21 + 8, 4, "\xff\xff\x03\x00"s); // the last column
    try {
        decoded_image(as_bytes(bytes), "a.exr");
        FAIL();
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("cannot hold the 262144 x 5 pixels that its header"));
    }
}

TEST_F(ImageFile, RefusesAnExrThatPromisesMoreThanItHolds) {
    write_image(blank_image(5, 5, SampleType::float32), folder / "a", ImageFileFormat::exr_half);
    const std::string whole = content(folder / "a");
    const std::string huge = "\xff\xff\xff\x7f"s;
    const auto refused = [&](const std::string& name_and_type, std::size_t offset) {
        std::string bytes = whole;
        const std::size_t attribute = bytes.find(name_and_type);
        EXPECT_NE(attribute, std::string::npos);
        bytes.replace(attribute + name_and_type.size() + offset, 4, huge);
        try {
            decoded_image(as_bytes(bytes), "a.exr");
        } catch (const InputError& error) {
            return std::string(error.what()).find("it ends before what its header promises")
                != std::string::npos;
        }
        return false;
    };
    EXPECT_TRUE(refused("channels\0chlist\0"s, 0)) << "its size";
    EXPECT_TRUE(refused("dataWindow\0box2i\0"s, 4 + 12)) << "the last row";
}

TEST(DecodedImage, StretchesAPpmToItsWhite) {
    const std::string bytes = "P6#c\n1 # 7\n1 15 \x00\x07\x0f"s;
    EXPECT_EQ(
        std::get<std::vector<std::uint8_t>>(decoded_image(as_bytes(bytes), "a").samples),
        (std::vector<std::uint8_t>{0, 119, 255}));
}

TEST(DecodedImage, ReadsPfmOfBothByteOrders) {
    const std::string bytes = "PF 1 1 1.0\n"
        + std::string("\x3f\x80\x00\x00\xbf\x80\x00\x00"
                      "\x40\x00\x00\x00",
                      12);
    EXPECT_EQ(
        std::get<std::vector<float>>(decoded_image(as_bytes(bytes), "a").samples),
        (std::vector<float>{1, -1, 2}));
}

TEST(FormatFromExtension, KnowsTheFormatsInAnyCase) {
    EXPECT_EQ(format_from_extension("a/b.png"), ImageFileFormat::png8);
    EXPECT_EQ(format_from_extension("b.EXR"), ImageFileFormat::exr_half);
    EXPECT_EQ(format_from_extension("b.JPeG"), ImageFileFormat::jpeg);
    EXPECT_EQ(format_from_extension("b.jpg"), ImageFileFormat::jpeg);
    EXPECT_EQ(format_from_extension("x.y.ppm"), ImageFileFormat::ppm8);
    EXPECT_EQ(format_from_extension("b.pfm"), ImageFileFormat::pfm);
    for (const char* other : {"png", "a.pn", "a.apng", "-", "", "a.png16", "a.", ".png"})
        EXPECT_EQ(format_from_extension(other), std::nullopt) << other;
}

TEST(FormatFromName, KnowsEveryNameItLists) {
    EXPECT_EQ(format_names(), "png, png16, exr, exr-float, jpeg, ppm, ppm16, pfm, vra, vra16");
    EXPECT_EQ(format_from_name("png16"), ImageFileFormat::png16);
    EXPECT_EQ(format_from_name("EXR-float"), ImageFileFormat::exr_float);
    EXPECT_EQ(format_from_name("jpg"), ImageFileFormat::jpeg);
    EXPECT_EQ(format_from_name("gif"), std::nullopt);
}

} // namespace
} // namespace vera
