// SPDX-License-Identifier: Apache-2.0
// Inputs that no reader may be led astray by: what is read is right, or an error says where it is
// wrong, in time and in little memory.
#include "vera/formats/control_file.h"
#include "vera/formats/read_scene.h"
#include "vera/formats/source_text.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "base/memory_is_watched.h"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vera {

namespace {

using testing::HasSubstr;
using testing::Not;

/// A file that is gone at the end of its scope.
class ScratchFile {
public:
    explicit ScratchFile(const std::string& extension)
        : path_(
            std::filesystem::path(testing::TempDir())
            / fmt::format("strange-{}{}", getpid(), extension)) {}

    ~ScratchFile() {
        std::error_code ignored;
        std::filesystem::remove(path_, ignored);
    }

    ScratchFile(const ScratchFile&) = delete;
    ScratchFile& operator=(const ScratchFile&) = delete;

    const std::filesystem::path& path() const { return path_; }

    const ScratchFile& hold(const std::string& bytes) const {
        std::ofstream(path_, std::ios::binary) << bytes;
        return *this;
    }

private:
    std::filesystem::path path_;
};

/// A file that one of the readers reads, and how its format begins.
struct Format {
    const char* extension;
    std::string beginning;
    std::function<void(const std::filesystem::path&)> read;
};

void read_any_scene(const std::filesystem::path& path) {
    read_scene(path);
}

std::vector<Format> formats() {
    const auto read_control = [](const std::filesystem::path& path) {
        std::vector<Diagnostic> warnings;
        read_control_file(path, {}, warnings);
    };
    const std::string ply_counts = "element vertex 9\nproperty float x\nproperty float y\n"
                                   "property float z\nelement face 9\n"
                                   "property list uchar int vertex_indices\nend_header\n";
    return {
        {".vera", "CM m MA m\nSP 0 0 0 1\nP3 ", read_any_scene},
        {".ctl", "RASTER 5 5\nSKY ", read_control},
        {".nff", "b 0 0 0\nl 1 2 3\ns 0 0 0 1\np 3\n", read_any_scene},
        {".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv ", read_any_scene},
        {".ply", "ply\nformat ascii 1.0\n" + ply_counts, read_any_scene},
        {".ply", "ply\nformat binary_little_endian 1.0\n" + ply_counts, read_any_scene},
        {".stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex ", read_any_scene},
        {".stl", std::string(80, ' ') + std::string("\0\0\1\0", 4), read_any_scene}};
}

std::string random_bytes(std::size_t count) {
    std::mt19937 random(1988);
    std::string bytes(count, '\0');
    for (char& byte : bytes)
        byte = static_cast<char>(random());
    return bytes;
}

/// What is said of a wrong file; nothing when it is not wrong.
std::vector<Diagnostic> errors(const Format& format, const std::string& bytes) {
    const ScratchFile file(format.extension);
    try {
        format.read(file.hold(bytes).path());
    } catch (const InputError& error) {
        return error.diagnostics();
    }
    return {};
}

TEST(StrangeFiles, InUtf16AreToldAsSuch) {
    const struct {
        std::string mark;
        std::size_t place_of_zero;
        const char* name;
    } encodings[] = {
        {"\xff\xfe", 1, "UTF-16"},
        {"\xfe\xff", 0, "UTF-16"},
        {"", 1, "UTF-16LE"},
        {"", 0, "UTF-16BE"}};

    for (const Format& format : formats()) {
        if (std::string(format.extension) == ".stl") // a zero tells of a binary file
            continue;
        for (const auto& [mark, place_of_zero, name] : encodings) {
            std::string wide = mark;
            for (const char letter : format.beginning)
                wide += place_of_zero == 1 ? std::string{letter, '\0'} : std::string{'\0', letter};
            const auto said = errors(format, wide);
            ASSERT_EQ(said.size(), 1U) << format.extension;
            EXPECT_EQ(said[0].problem, "the file is in UTF-16");
            EXPECT_THAT(said[0].remedy, HasSubstr(fmt::format("iconv -f {} -t UTF-8", name)));
        }
    }
    // Zeros alone are none.
    EXPECT_THAT(errors(formats()[0], std::string(64, '\0'))[0].problem, Not(HasSubstr("UTF-16")));
}

TEST(StrangeFiles, OfBinaryJunkAreToldByEveryReader) {
    const std::string junk = random_bytes(100'000);
    for (const Format& format : formats())
        for (const std::string& beginning : {std::string(), format.beginning}) {
            const auto said = errors(format, beginning + junk);
            ASSERT_FALSE(said.empty()) << format.extension;
            EXPECT_LE(said.size(), 60U) << format.extension;
            EXPECT_THAT(said.front().place.file, HasSubstr(format.extension));
            // By line and column, or in a binary file by the byte.
            EXPECT_TRUE(
                said.front().place.line > 0
                || said.front().problem.find("byte ") != std::string::npos)
                << format.extension << ": " << said.front().problem;
        }
}

TEST(StrangeFiles, OfZerosAreToldByEveryReader) {
    for (const Format& format : formats())
        EXPECT_FALSE(errors(format, format.beginning + std::string(1'000'000, '\0')).empty())
            << format.extension;
}

TEST(StrangeFiles, WithoutAnEndAreRefused) {
    try {
        const SourceText text("/dev/zero", 100'000);
        FAIL() << "it was read";
    } catch (const InputError& error) {
        EXPECT_THAT(error.what(), HasSubstr("/dev/zero: more than 100000 bytes came"));
    }
}

TEST(StrangeFiles, WithANumberOfTenThousandDigitsAreRead) {
    const std::string half = "0.5" + std::string(10'000, '0');
    const std::string huge = "5" + std::string(10'000, '0');

    const struct {
        Format format;
        std::string before;
        std::string behind;
    } texts[] = {
        {formats()[0], "CM m MA m SP 0 0 0 ", ""},
        {formats()[1], "AMBIENT ", " 0 0"},
        {formats()[2], "s 0 0 0 ", "\n"},
        {formats()[3], "v ", " 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
        {formats()[4],
         "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n",
         " 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
        {formats()[6],
         "solid a\nfacet normal 0 0 1\nouter loop\nvertex ",
         " 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"}};

    for (const auto& [format, before, behind] : texts) {
        EXPECT_TRUE(errors(format, fmt::format("{}{}{}", before, half, behind)).empty())
            << format.extension;
        const auto said = errors(format, fmt::format("{}{}{}", before, huge, behind));
        ASSERT_EQ(said.size(), 1U) << format.extension;
        EXPECT_THAT(said[0].problem, HasSubstr("too large")) << format.extension;
        EXPECT_GT(said[0].place.line, 0U);
    }
}

/// A number of kilobytes that /proc knows of this process.
std::size_t status_kilobytes(std::string_view key) {
    std::ifstream status("/proc/self/status");
    std::string line;
    while (std::getline(status, line))
        if (line.compare(0, key.size(), key) == 0)
            return std::strtoull(line.c_str() + key.size() + 1, nullptr, 10);
    return 0;
}

/// What the peak of a process grows by, in bytes, that does nothing but read the file.
std::size_t peak_growth(const std::filesystem::path& path) {
    const ScratchFile answer(".growth");
    const pid_t child = fork();
    if (child == 0) {
        std::ofstream("/proc/self/clear_refs") << "5\n"; // forgets the peak so far
        const std::size_t before = status_kilobytes("VmRSS");
        read_scene(path);
        std::ofstream(answer.path()) << 1024 * (status_kilobytes("VmHWM") - before);
        _exit(0);
    }
    waitpid(child, nullptr, 0);
    std::size_t growth = 0;
    std::ifstream(answer.path()) >> growth;
    return growth;
}

std::string repeated(std::string_view line, std::size_t bytes) {
    std::string text;
    text.reserve(bytes + line.size());
    while (text.size() < bytes)
        text += line;
    return text;
}

TEST(ReadingMemory, IsAtMostThreeTimesTheFileAndOfShortWordsWhatTheSceneTakes) {
    if (memory_is_watched() || !std::filesystem::exists("/proc/self/clear_refs"))
        GTEST_SKIP() << "a sanitizer takes more memory than the readers";

    const struct {
        const char* extension;
        std::string head;
        const char* line;
        std::string foot;
        double most; ///< times the file; docs/platforms.md derives what is above 3
    } files[] = {
        {".vera", "CM m MA m\n", "P3 0.1234 0.2345 0.3456 1.234 2.345 3.456 0 1.345 0\n", "", 3},
        {".vera", "CM m MA m\n", "P4 10 20 -15 11 20 -15 11 21 -15 10 21 -15\n", "", 3.6},
        {".vera", "CM m MA m\n", "SP 1.5 2.5 3.5 0.25\n", "", 3},
        {".vera", "CM m MA m\n", "SP 0 0 0 1\n", "", 4.4},
        {".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "v 0 0 0\n", "f 1 2 3\n", 3},
        {".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n", "vn 0 0 1\n", "f 1//1 2//1 3//1\n", 3},
        {".obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n", "f 1 2 4 3\n", "", 3},
        {".nff", "f 1 1 1 1 0 0 0 0\n", "s 1.5 2.5 3.5 0.25\n", "", 3}};

    for (const auto& [extension, head, line, foot, most] : files) {
        const ScratchFile file(extension);
        const std::string text = fmt::format("{}{}{}", head, repeated(line, 10'000'000), foot);
        const auto growth = static_cast<double>(peak_growth(file.hold(text).path()));
        EXPECT_GT(growth, 0) << line;
        // The part of the file in which the reader is, and large pages that are not full.
        constexpr double besides = 4e6;
        EXPECT_LT(growth, most * static_cast<double>(text.size()) + besides) << line;
    }
}

/// Files of gigabytes take a minute and the room, and are made only when they are asked for.
class LargeFiles : public testing::Test {
protected:
    static constexpr std::size_t size = 4'400'000'000;

    void SetUp() override {
        const char* const wanted = std::getenv("VERA_LARGE_TESTS");
        if (wanted == nullptr || std::string_view(wanted) != "1")
            GTEST_SKIP() << "VERA_LARGE_TESTS=1 makes files of 4.4 GB";
        if (std::filesystem::space(testing::TempDir()).available < 2 * size)
            GTEST_SKIP() << "there is no room for files of 4.4 GB in " << testing::TempDir();
    }

    /// The line again and again, over more than 4 GB; how often.
    static std::size_t fill(const ScratchFile& file, const std::string& line) {
        const std::string block = repeated(line, 16'000'000);
        std::ofstream stream(file.path(), std::ios::binary);
        std::size_t written = 0;
        for (; written < size; written += block.size())
            stream << block;
        EXPECT_TRUE(stream.flush()) << "writing to " << file.path();
        return written / line.size();
    }

    static void append(const ScratchFile& file, const std::string& text) {
        std::ofstream(file.path(), std::ios::binary | std::ios::app) << text;
    }
};

TEST_F(LargeFiles, OfTheSceneLanguageAreReadAndMistakesBehindFourGigabytesLocated) {
    const ScratchFile file(".vera");
    const std::size_t lines = fill(
        file, "(* one line of many that say nothing, so that the file is long and no more *)\n");
    append(file, "CM m MA m SP 1 2 3 4\n");
    const std::size_t growth = peak_growth(file.path());
    EXPECT_GT(growth, 0U);
    // The file itself, whose pages the machine takes back when it needs them, and little besides.
    EXPECT_LT(growth, size + 64'000'000);
    const Geometry geometry = read_scene(file.path()).scene.geometry;
    ASSERT_EQ(geometry.spheres.size(), 1U);
    EXPECT_EQ(geometry.items[0].line, lines + 1);
    append(file, "  SP 1 2 blue 4\n");
    try {
        read_scene(file.path());
        FAIL();
    } catch (const InputError& error) {
        ASSERT_EQ(error.diagnostics().size(), 1U);
        EXPECT_EQ(error.diagnostics()[0].place, (SourcePlace{file.path().string(), lines + 2, 10}));
        EXPECT_EQ(error.diagnostics()[0].line, "  SP 1 2 blue 4");
    }
}

TEST_F(LargeFiles, InObjAreReadAndMistakesBehindFourGigabytesLocated) {
    const ScratchFile file(".obj");
    const std::size_t lines = fill(file, "vt 0.123456 0.654321\n");
    append(file, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(read_scene(file.path()).scene.geometry.primitive_count, 1U);
    append(file, "f 1 2 4\n");
    try {
        read_scene(file.path());
        FAIL();
    } catch (const InputError& error) {
        ASSERT_EQ(error.diagnostics().size(), 1U);
        EXPECT_EQ(error.diagnostics()[0].place, (SourcePlace{file.path().string(), lines + 5, 7}));
    }
}

TEST_F(LargeFiles, OfZerosAreToldByEveryReader) {
    for (const Format& format : formats()) {
        const ScratchFile file(format.extension);
        std::filesystem::resize_file(file.hold(format.beginning).path(), size); // with a hole
        EXPECT_THROW(format.read(file.path()), InputError) << format.extension;
    }
}

TEST_F(LargeFiles, WithoutAnEndAreRefusedByEveryReader) {
    for (const Format& format : formats()) {
        const ScratchFile file(format.extension);
        std::filesystem::create_symlink("/dev/zero", file.path());
        try {
            format.read(file.path());
            FAIL() << format.extension << " was read";
        } catch (const InputError& error) {
            EXPECT_THAT(error.what(), HasSubstr("more than 1024 MiB came")) << format.extension;
        }
    }
}

} // namespace
} // namespace vera
