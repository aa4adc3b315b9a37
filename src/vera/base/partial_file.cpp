// SPDX-License-Identifier: Apache-2.0
#include "vera/base/partial_file.h"

#include "vera/base/check.h"
#include "vera/base/output_file.h"

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vera {

namespace detail {

/// What a signal handler must know of a partial file. Notes stand in a list that only grows; one
/// that is no longer needed is used again.
struct PartialFileNote {
    enum class State { free, claimed, armed };

    std::atomic<State> state = State::free;
    pid_t process = 0; ///< a child made by fork must not remove its parent's files
    int folder = -1;
    std::array<char, 256> name = {};
    PartialFileNote* next = nullptr;
};

} // namespace detail

namespace {

using detail::PartialFileNote;
using State = PartialFileNote::State;

static_assert(std::atomic<State>::is_always_lock_free, "signal handlers read it");
static_assert(std::atomic<PartialFileNote*>::is_always_lock_free, "signal handlers read it");

std::atomic<PartialFileNote*> notes = nullptr;

PartialFileNote& claimed_note() {
    for (PartialFileNote* note = notes.load(); note != nullptr; note = note->next) {
        State expected = State::free;
        if (note->state.compare_exchange_strong(expected, State::claimed))
            return *note;
    }
    // Kept until the process ends: a signal handler may be walking the list.
    auto* note = new PartialFileNote;
    note->state = State::claimed;
    note->next = notes.load();
    while (!notes.compare_exchange_weak(note->next, note)) {
    }
    return *note;
}

/// NAME.partial-XXXXXXXX, as much of NAME as leaves room for the rest.
std::string partial_name(std::string_view target) {
    constexpr std::string_view letters = "abcdefghijklmnopqrstuvwxyz012345";
    constexpr std::size_t longest_beginning = 200;
    std::uint64_t random = 0;
    if (getrandom(&random, sizeof random, 0) != sizeof random)
        random = static_cast<std::uint64_t>(getpid());
    std::string name = std::string(target.substr(0, longest_beginning)) + ".partial-";
    for (int i = 0; i < 8; ++i, random /= letters.size())
        name += letters[random % letters.size()];
    return name;
}

std::string_view remedy_for(int error) {
    switch (error) {
    case ENOSPC:
    case EDQUOT:
        return "; free some space or choose another folder";
    case EFBIG:
        return "; raise the limit on the size of files (ulimit -f) or choose a smaller picture";
    case EACCES:
    case EPERM:
    case EROFS:
        return "; choose a folder and a file that you may write to";
    case ENOENT:
        return "; make its folder first";
    case ENOTDIR:
        return "; what should be its folder is a file";
    case EISDIR:
        return "; give the name of a file in it";
    case ENAMETOOLONG:
        return "; choose a shorter name";
    default:
        return "";
    }
}

void end_after_removal(int signal) {
    remove_partial_files();
    // The handler is gone (SA_RESETHAND): the signal, blocked until this returns, now ends the
    // process as if nobody had listened.
    raise(signal);
}

} // namespace

namespace detail {

void throw_unwritable(const std::string& name, int error) {
    throw std::system_error(
        error, std::generic_category(), "cannot write " + name + std::string(remedy_for(error)));
}

PartialFile::PartialFile(int folder, std::string target, std::string shown_name)
    : folder_(folder)
    , target_(std::move(target))
    , shown_name_(std::move(shown_name))
    , note_(&claimed_note()) {
    note_->folder = folder;
    note_->process = getpid();
    constexpr int attempts = 100;
    for (int i = 0; i < attempts && descriptor_ < 0; ++i) {
        const std::string name = partial_name(target_);
        name.copy(note_->name.data(), name.size());
        note_->name[name.size()] = 0;
        // Armed first: a signal may come as soon as the file is there.
        note_->state = State::armed;
        descriptor_ =
            openat(folder, note_->name.data(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (descriptor_ >= 0)
            return;
        const int error = errno;
        note_->state = State::claimed;
        if (error != EEXIST && error != EINTR) {
            note_->state = State::free;
            throw_unwritable(shown_name_, error);
        }
    }
    note_->state = State::free;
    throw_unwritable(shown_name_, EEXIST);
}

PartialFile::~PartialFile() {
    if (descriptor_ >= 0)
        close(descriptor_);
    if (note_ == nullptr)
        return;
    unlinkat(folder_, note_->name.data(), 0);
    note_->state = State::free;
}

void PartialFile::finish() {
    // Some file systems report only here that the disk is full.
    if (close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR)
        throw_unwritable(shown_name_, errno);
}

void PartialFile::take_place() {
    VERA_CHECK(descriptor_ < 0 && note_ != nullptr);
    if (renameat(folder_, note_->name.data(), folder_, target_.c_str()) != 0)
        throw_unwritable(shown_name_, errno);
    std::exchange(note_, nullptr)->state = State::free;
}

} // namespace detail

void remove_partial_files() noexcept {
    const int error = errno;
    for (PartialFileNote* note = notes.load(); note != nullptr; note = note->next)
        if (note->state.load() == State::armed && note->process == getpid())
            unlinkat(note->folder, note->name.data(), 0);
    errno = error;
}

void remove_partial_files_on_signals() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action = {};
        if (sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN)
            continue;
        action = {};
        action.sa_handler = end_after_removal;
        // Two of these signals must not run two handlers.
        sigemptyset(&action.sa_mask);
        for (const int other : {SIGINT, SIGTERM, SIGHUP})
            sigaddset(&action.sa_mask, other);
        action.sa_flags = static_cast<int>(SA_RESETHAND);
        sigaction(signal, &action, nullptr);
    }
}

} // namespace vera
