// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"
#include "vera/base/read_bytes.h"

#include <cstdio>
#include <memory>
#include <system_error>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace vera {
namespace {

using testing::HasSubstr;

constexpr std::size_t no_size = 0;

/// A file that is gone when it is closed, with so many different bytes, and where it is read next.
class BytesInFile {
public:
    explicit BytesInFile(std::size_t count)
        : file_(std::tmpfile(), &std::fclose) {
        for (std::size_t i = 0; i < count; ++i)
            bytes.push_back(static_cast<char>(i % 251));
        std::fwrite(bytes.data(), 1, count, file_.get());
        std::rewind(file_.get());
    }

    int descriptor() const { return fileno(file_.get()); }

    std::string bytes;

private:
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

TEST(BytesToEnd, AreAllWhateverSizeIsExpected) {
    for (const std::size_t count : {0U, 1U, 2U, 65535U, 65536U, 65537U, 300000U})
        for (const std::size_t size : {0U, 1U, 65536U, 300000U}) {
            const BytesInFile file(count);
            const auto read =
                bytes_to_end<std::string>(file.descriptor(), "a", size, most_streamed_bytes);
            EXPECT_TRUE(read == file.bytes) << count << " bytes, expected " << size;
        }
    const BytesInFile file(5);
    const auto read =
        bytes_to_end<std::vector<std::byte>>(file.descriptor(), "a", 5, most_streamed_bytes);
    EXPECT_EQ(read.size(), 5U);
}

TEST(BytesToEnd, AreRefusedBeyondTheLimitOnlyWhereTheirSizeIsNotKnown) {
    constexpr std::size_t most = 100000;
    for (const std::size_t count : {most - 1, most}) {
        const BytesInFile file(count);
        EXPECT_TRUE(bytes_to_end<std::string>(file.descriptor(), "a", no_size, most) == file.bytes)
            << count;
    }
    const BytesInFile of_known_size(2 * most);
    EXPECT_TRUE(
        bytes_to_end<std::string>(of_known_size.descriptor(), "a", 2 * most, most)
        == of_known_size.bytes);
    for (const std::size_t count : {most + 1, 2 * most}) {
        const BytesInFile file(count);
        try {
            bytes_to_end<std::string>(file.descriptor(), "pipe", no_size, most);
            FAIL() << count << " were read";
        } catch (const InputError& error) {
            ASSERT_EQ(error.diagnostics().size(), 1U);
            EXPECT_EQ(error.diagnostics()[0].place, (SourcePlace{"pipe", 0, 0}));
            EXPECT_EQ(
                error.diagnostics()[0].problem,
                "more than 100000 bytes came from this pipe or device, which may have no end");
            EXPECT_THAT(error.diagnostics()[0].remedy, HasSubstr("to a file"));
        }
    }
}

TEST(BytesToEnd, OfALimitOfMebibytesAreToldInThem) {
    try {
        throw_without_end("pipe", most_streamed_bytes);
    } catch (const InputError& error) {
        EXPECT_THAT(error.diagnostics()[0].problem, HasSubstr("more than 1024 MiB came"));
    }
}

TEST(BytesToEnd, OfAFileThatCannotBeReadNameIt) {
    try {
        bytes_to_end<std::string>(-1, "lost", no_size, most_streamed_bytes);
        FAIL() << "it was read";
    } catch (const std::system_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("cannot read 'lost'"));
    }
}

TEST(BytesToEnd, OfMoreThanTheMachineHoldsAreRefusedBeforeTheyAreRead) {
    const BytesInFile file(10);
    const MemoryLimit limit(1000);
    try {
        bytes_to_end<std::string>(
            file.descriptor(), "large", std::size_t{1} << 40U, most_streamed_bytes);
        FAIL() << "it was read";
    } catch (const std::runtime_error& error) {
        EXPECT_THAT(error.what(), HasSubstr("reading 'large' takes about 1048577 MiB of memory"));
    }
}

} // namespace
} // namespace vera
