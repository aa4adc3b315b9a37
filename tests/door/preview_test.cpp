// SPDX-License-Identifier: Apache-2.0
#include <array>

#include "door/program.h"
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/ioctl.h>

namespace vera {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* render = "render a.vera --raster 20x16 -o a.png ";
constexpr const char* half_block = "\u2580";

/// A terminal of 80 columns and 24 rows that somebody else holds the other end of.
class PseudoTerminal {
public:
    PseudoTerminal()
        : ours_(posix_openpt(O_RDWR | O_NOCTTY)) {
        EXPECT_EQ(grantpt(ours_), 0);
        EXPECT_EQ(unlockpt(ours_), 0);
        const winsize size = {.ws_row = 24, .ws_col = 80, .ws_xpixel = 0, .ws_ypixel = 0};
        ioctl(ours_, TIOCSWINSZ, &size);
        // Kept open, so that what is written is there after the program's end.
        theirs_ = open(name().c_str(), O_RDWR | O_NOCTTY);
    }

    ~PseudoTerminal() {
        close(theirs_);
        close(ours_);
    }

    PseudoTerminal(const PseudoTerminal&) = delete;
    PseudoTerminal& operator=(const PseudoTerminal&) = delete;

    std::string name() const { return ptsname(ours_); }

    /// Starts taking what the terminal shows, so that who writes need not wait.
    std::string text_of(const std::string& command) const {
        const pid_t child = fork();
        if (child == 0) {
            execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
            _exit(127);
        }
        fcntl(ours_, F_SETFL, O_NONBLOCK);
        std::string text;
        std::array<char, 4096> piece = {};
        for (bool ended = false;;) {
            const ssize_t count = read(ours_, piece.data(), piece.size());
            if (count > 0) {
                text.append(piece.data(), static_cast<std::size_t>(count));
                continue;
            }
            if (ended)
                return text;
            int status = 0;
            if (waitpid(child, &status, WNOHANG) == child)
                ended = true;
            else
                usleep(2000);
        }
    }

private:
    int ours_;
    int theirs_ = -1;
};

class Preview : public testing::Test {
protected:
    Preview() { folder.write("a.vera", small_scene); }

    /// What a terminal shows of the program's messages.
    std::string shown(const std::string& environment, const std::string& options) const {
        const PseudoTerminal terminal;
        return terminal.text_of(
            "cd '" + folder.path().string()
            + "' && env -u TMUX -u NO_COLOR -u COLORTERM -u KITTY_WINDOW_ID " + environment + " '"
            + VERA_PROGRAM + "' " + render + options + " 2>" + terminal.name());
    }

    ScratchFolder folder;
};

TEST_F(Preview, ShowsHalfBlocksInTheColoursOfTheTerminal) {
    const std::string plain = shown("TERM=xterm-256color", "");
    EXPECT_THAT(plain, HasSubstr(half_block));
    EXPECT_THAT(plain, HasSubstr("\x1b[38;5;"));
    EXPECT_THAT(plain, Not(HasSubstr("\x1b[38;2;")));
    const std::string all = shown("TERM=xterm-256color COLORTERM=truecolor", "");
    EXPECT_THAT(all, HasSubstr("\x1b[38;2;"));
    std::size_t lines = 0;
    for (std::size_t at = all.find("\x1b[0m"); at != std::string::npos;
         at = all.find("\x1b[0m", at + 1))
        ++lines;
    EXPECT_GE(lines, 8U); // of two rows each; messages may add some
}

TEST_F(Preview, SendsGraphicsWhereTheTerminalKnowsThem) {
    EXPECT_THAT(shown("TERM=xterm-kitty", ""), HasSubstr("\x1b_Ga=T,f=24,q=2,s=20,v=16,"));
    EXPECT_THAT(shown("TERM=xterm KITTY_WINDOW_ID=1", ""), HasSubstr("\x1b_Ga=T"));
    EXPECT_THAT(shown("TERM=screen KITTY_WINDOW_ID=1", ""), HasSubstr(half_block));
}

TEST_F(Preview, IsOffWhereItWouldDisturb) {
    for (const char* environment : {"TERM=xterm NO_COLOR=1", "TERM=dumb"})
        EXPECT_THAT(shown(environment, ""), Not(HasSubstr(half_block))) << environment;
    for (const char* options : {"-q", "--preview never"})
        EXPECT_THAT(shown("TERM=xterm", options), Not(HasSubstr(half_block))) << options;
    const ProgramRun run = run_vera(folder, render);
    EXPECT_THAT(run.err, Not(HasSubstr(half_block)));
    EXPECT_EQ(run.out, "");
}

TEST_F(Preview, IsShownAnywhereWhenItIsAskedFor) {
    const ProgramRun run =
        run_vera(folder, std::string(render) + "--preview always", "TERM=xterm COLORTERM=24bit");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_THAT(run.err, HasSubstr(half_block));
    EXPECT_EQ(run.out, "");
    const ProgramRun wrong = run_vera(folder, std::string(render) + "--preview often");
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(wrong.err, HasSubstr("--preview"));
}

} // namespace
} // namespace vera
