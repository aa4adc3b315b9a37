// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <deque>
#include <fstream>
#include <functional>
#include <iterator>
#include <system_error>
#include <thread>
#include <vector>

#include "base/scratch_folder.h"
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace vera {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void put(const fs::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

mode_t permissions(const fs::path& path) {
    struct stat status = {};
    stat(path.c_str(), &status);
    return status.st_mode & 07777;
}

/// What a process of its own does: the number that work returns, or minus the signal that ends it.
int outcome(const std::function<int()>& work) {
    const pid_t child = fork();
    if (child == 0) {
        int result = 99;
        try {
            result = work();
        } catch (const std::exception&) {
        }
        _exit(result);
    }
    int status = 0;
    waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
}

/// The error that work throws: its code in the process's result, whose message holds the text.
int error_code(const std::function<void()>& work, const std::string& text) {
    try {
        work();
    } catch (const std::system_error& error) {
        return std::string(error.what()).find(text) != std::string::npos ? error.code().value()
                                                                         : 98;
    }
    return 97;
}

/// An empty folder for a test, removed at its end.
class OutputFileTest : public testing::Test {
protected:
    OutputFileTest() { target = folder / "picture.png"; }

    /// The message with which opening a file at the path fails.
    static std::string message(const fs::path& path) {
        try {
            const OutputFile file(path);
        } catch (const std::system_error& error) {
            return error.what();
        }
        return "";
    }

    ScratchFolder scratch;
    fs::path folder = scratch.path();
    fs::path target;
};

TEST_F(OutputFileTest, AppearsWhenItIsCommittedAndNotBefore) {
    OutputFile file(target);
    EXPECT_EQ(file.name(), "'" + target.native() + "'");
    file.write("one, ");
    EXPECT_FALSE(fs::exists(target));
    EXPECT_THAT(names_in(folder), ElementsAre(StartsWith("picture.png.partial-")));
    file.write("two");
    file.commit();
    EXPECT_EQ(content(target), "one, two");
    EXPECT_THAT(names_in(folder), ElementsAre("picture.png"));
}

TEST_F(OutputFileTest, LeavesAllAsItWasWhenItIsNotCommitted) {
    put(target, "old");
    {
        OutputFile file(target);
        file.write(std::string(1'000'000, 'x'));
        EXPECT_EQ(content(target), "old");
    }
    EXPECT_EQ(content(target), "old");
    EXPECT_THAT(names_in(folder), ElementsAre("picture.png"));
}

std::size_t open_files() {
    return names_in("/proc/self/fd").size();
}

TEST_F(OutputFileTest, WaitsForItsCommitClosedAndInAFolderThatIsOpenOnce) {
    put(folder / "a0", "old");
    const std::size_t before = open_files();
    {
        std::deque<OutputFile> files;
        for (int i = 0; i < 20; ++i) {
            OutputFile& file = files.emplace_back(folder / fmt::format("a{}", i));
            file.write(std::to_string(i));
            file.finish();
        }
        EXPECT_EQ(open_files(), before + 1);
        EXPECT_EQ(content(folder / "a0"), "old");
        for (int i = 0; i < 10; ++i)
            files[static_cast<std::size_t>(i)].commit();
    }
    EXPECT_EQ(open_files(), before);
    EXPECT_EQ(names_in(folder).size(), 10U);
    for (int i = 0; i < 10; ++i)
        EXPECT_EQ(content(folder / fmt::format("a{}", i)), std::to_string(i));
}

TEST_F(OutputFileTest, WaitsInItsOwnFolder) {
    fs::create_directory(folder / "x");
    fs::create_directory(folder / "y");
    OutputFile in_x(folder / "x/a");
    OutputFile in_y(folder / "y/a");
    OutputFile in_x_again(folder / "y/../x/b");
    for (OutputFile* file : {&in_x, &in_y, &in_x_again})
        file->finish();
    for (OutputFile* file : {&in_x_again, &in_y, &in_x})
        file->commit();
    EXPECT_THAT(names_in(folder / "x"), ElementsAre("a", "b"));
    EXPECT_THAT(names_in(folder / "y"), ElementsAre("a"));
}

TEST_F(OutputFileTest, HoldsEveryByteOfPiecesOfAllSizes) {
    std::string expected;
    OutputFile file(target);
    for (const std::size_t size : {1U, 0U, 262143U, 262144U, 262145U, 7U, 1000000U, 100000U}) {
        const std::string piece(size, static_cast<char>('a' + expected.size() % 26));
        file.write(piece);
        expected += piece;
    }
    file.commit();
    EXPECT_EQ(content(target), expected);
}

TEST_F(OutputFileTest, CanBeWrittenOverInTheMiddle) {
    OutputFile file(target);
    ASSERT_TRUE(file.seekable());
    file.write("0123456789");
    file.write_at(3, std::as_bytes(std::span("ab", 2)));
    file.write("end");
    file.commit();
    EXPECT_EQ(content(target), "012ab56789end");
}

TEST_F(OutputFileTest, OpensAGapBeforeAllThatWasWritten) {
    for (const std::size_t written : {0U, 1U, 262143U, 262144U, 262145U, 1000000U})
        for (const std::size_t size : {0U, 1U, 5U, 262144U, 700000U}) {
            std::string behind(written, '.');
            for (std::size_t i = 0; i < written; ++i)
                behind[i] = static_cast<char>('a' + i * i % 23);
            const std::string before(size, '-');
            OutputFile file(target);
            file.write(behind);
            file.open_gap_before_all(size);
            file.write_at(0, std::as_bytes(std::span(before)));
            file.write("end");
            file.commit();
            EXPECT_TRUE(content(target) == before + behind + "end")
                << size << " bytes before " << written;
        }
}

TEST_F(OutputFileTest, HasThePermissionsThatTheUmaskLeaves) {
    const mode_t before = umask(027);
    OutputFile file(target);
    file.commit();
    umask(before);
    EXPECT_EQ(permissions(target), 0640U);
}

TEST_F(OutputFileTest, KeepsThePermissionsOfTheFileThatItReplaces) {
    put(target, "old");
    chmod(target.c_str(), 0600);
    OutputFile file(target);
    file.commit();
    EXPECT_EQ(permissions(target), 0600U);
}

TEST_F(OutputFileTest, ReplacesWhatASymbolicLinkPointsTo) {
    fs::create_directory(folder / "other");
    put(folder / "other" / "real.png", "old");
    fs::create_symlink("other/real.png", folder / "middle");
    fs::create_symlink(folder / "middle", target);
    fs::create_symlink("other/new.png", folder / "dangling");
    for (const char* link : {"picture.png", "dangling"}) {
        OutputFile file(folder / link);
        file.write("new");
        file.commit();
        EXPECT_TRUE(fs::is_symlink(folder / link));
    }
    EXPECT_THAT(names_in(folder / "other"), ElementsAre("new.png", "real.png"));
    EXPECT_EQ(content(folder / "other" / "real.png"), "new");
}

TEST_F(OutputFileTest, FindsItsPlaceThoughTheWorkingFolderChanges) {
    EXPECT_EQ(
        outcome([&] {
            fs::current_path(folder);
            OutputFile file("picture.png");
            fs::current_path("/");
            file.write("x");
            file.commit();
            return 0;
        }),
        0);
    EXPECT_EQ(content(target), "x");
}

TEST_F(OutputFileTest, SaysAtOnceWhatMakesItImpossible) {
    put(folder / "file", "");
    fs::create_symlink("loop", folder / "loop");
    const std::string quoted = "cannot write '" + folder.native();
    EXPECT_THAT(message(folder), StartsWith(quoted + "'; give the name of a file in it: "));
    EXPECT_THAT(
        message(folder / "none" / "a.png"),
        StartsWith(quoted + "/none/a.png'; make its folder first: "));
    EXPECT_THAT(message(folder / "none" / ""), HasSubstr("give the name of a file in it"));
    EXPECT_THAT(
        message(folder / "file" / "a.png"), HasSubstr("what should be its folder is a file"));
    EXPECT_THAT(message(folder / std::string(300, 'x')), HasSubstr("choose a shorter name"));
    EXPECT_THAT(message(folder / "loop"), HasSubstr("cannot write"));
    EXPECT_THAT(message(""), HasSubstr("cannot write"));
    EXPECT_THAT(names_in(folder), ElementsAre("file", "loop"));
}

TEST_F(OutputFileTest, MayHaveTheLongestName) {
    const std::string name(255, 'x');
    OutputFile file(folder / name);
    file.commit();
    EXPECT_THAT(names_in(folder), ElementsAre(name));
}

TEST_F(OutputFileTest, RespectsWhatItMayNotWriteTo) {
    fs::create_directory(folder / "locked");
    put(target, "protected");
    chmod(target.c_str(), 0444);
    chmod((folder / "locked").c_str(), 0555);
    chmod(folder.c_str(), 0777);
    const std::string remedy = "'; choose a folder and a file that you may write to: ";
    const auto code_as_user = [&](const fs::path& path) {
        return outcome([&] {
            // The superuser may do anything.
            if (geteuid() == 0 && seteuid(65534) != 0)
                return 96;
            return error_code([&] { const OutputFile file(path); }, path.native() + remedy);
        });
    };
    EXPECT_EQ(code_as_user(target), EACCES);
    EXPECT_EQ(code_as_user(folder / "locked" / "a.png"), EACCES);
    EXPECT_EQ(content(target), "protected");
    EXPECT_THAT(names_in(folder / "locked"), IsEmpty());
}

TEST_F(OutputFileTest, WritesToDevicesDirectly) {
    OutputFile file("/dev/null");
    EXPECT_FALSE(file.seekable());
    file.write("x");
    file.commit();
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(OutputFileTest, SaysThatADeviceIsFullAtTheLatestWhenCommitted) {
    OutputFile file("/dev/full");
    file.write("x");
    EXPECT_EQ(
        error_code([&] { file.commit(); }, "cannot write '/dev/full'; free some space or choose"),
        ENOSPC);
}

TEST_F(OutputFileTest, WritesToStandardOutput) {
    for (const char* name : {"-", "/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"}) {
        put(target, "before ");
        EXPECT_EQ(
            outcome([&] {
                if (std::freopen(target.c_str(), "a", stdout) == nullptr)
                    return 1;
                OutputFile file(name);
                if (file.seekable())
                    return 2;
                file.write("x");
                file.commit();
                // Standard output stays open.
                return ::write(STDOUT_FILENO, "y", 1) == 1 ? 0 : 3;
            }),
            0);
        EXPECT_EQ(content(target), "before xy") << name;
    }
    EXPECT_THAT(names_in(folder), ElementsAre("picture.png"));
}

TEST_F(OutputFileTest, SaysThatStandardOutputIsClosed) {
    EXPECT_EQ(
        outcome([] {
            close(STDOUT_FILENO);
            return error_code([] { const OutputFile file("-"); }, "cannot write standard output");
        }),
        EBADF);
}

TEST_F(OutputFileTest, LeavesNothingWhenItGrowsBeyondALimit) {
    put(target, "old");
    EXPECT_EQ(
        outcome([&] {
            std::signal(SIGXFSZ, SIG_IGN);
            const rlimit limit = {100'000, 100'000};
            setrlimit(RLIMIT_FSIZE, &limit);
            return error_code(
                [&] {
                    OutputFile file(target);
                    file.write(std::string(200'000, 'x'));
                    file.commit();
                },
                target.native() + "'; raise the limit on the size of files");
        }),
        EFBIG);
    EXPECT_EQ(content(target), "old");
    EXPECT_THAT(names_in(folder), ElementsAre("picture.png"));
}

TEST_F(OutputFileTest, LeavesNothingOnAFullDisk) {
    if (mount("tmpfs", folder.c_str(), "tmpfs", 0, "size=64k") != 0)
        GTEST_SKIP() << "this process may not mount file systems";
    put(target, "old");
    EXPECT_EQ(
        error_code(
            [&] {
                OutputFile file(target);
                file.write(std::string(100'000, 'x'));
                file.commit();
            },
            "cannot write '" + target.native() + "'; free some space or choose another folder: "),
        ENOSPC);
    EXPECT_EQ(content(target), "old");
    EXPECT_THAT(names_in(folder), ElementsAre("picture.png"));
    umount(folder.c_str());
}

TEST_F(OutputFileTest, LeavesNothingWhenASignalEndsTheProcess) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        EXPECT_EQ(
            outcome([&] {
                remove_partial_files_on_signals();
                OutputFile first(target);
                OutputFile second(folder / "second");
                OutputFile committed(folder / "committed");
                first.write(std::string(1'000'000, 'x'));
                committed.commit();
                raise(signal);
                return 1;
            }),
            -signal);
        EXPECT_THAT(names_in(folder), ElementsAre("committed"));
    }
}

TEST_F(OutputFileTest, GoesOnWhenASignalIsIgnored) {
    EXPECT_EQ(
        outcome([&] {
            std::signal(SIGHUP, SIG_IGN);
            remove_partial_files_on_signals();
            OutputFile file(target);
            raise(SIGHUP);
            file.write("x");
            file.commit();
            return 0;
        }),
        0);
    EXPECT_EQ(content(target), "x");
}

TEST_F(OutputFileTest, IsNotRemovedByAChildProcess) {
    OutputFile file(target);
    EXPECT_EQ(
        outcome([] {
            remove_partial_files();
            return 0;
        }),
        0);
    file.commit();
    EXPECT_TRUE(fs::exists(target));
}

TEST_F(OutputFileTest, MayBeOneOfManyAtOnceFromManyThreads) {
    std::vector<std::thread> threads;
    threads.reserve(8);
    for (int i = 0; i < 8; ++i)
        threads.emplace_back([this, i] {
            for (int round = 0; round < 20; ++round) {
                OutputFile same(target);
                OutputFile own(folder / std::to_string(i));
                same.write(std::string(1000, static_cast<char>('a' + i)));
                own.write("x");
                own.commit();
                if (round % 2 == 0)
                    same.commit();
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(names_in(folder).size(), 9U);
    const std::string text = content(target);
    EXPECT_EQ(text, std::string(1000, text.empty() ? '?' : text[0]));
}

} // namespace
} // namespace vera
