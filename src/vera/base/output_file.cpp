// SPDX-License-Identifier: Apache-2.0
#include "vera/base/output_file.h"

#include "vera/base/check.h"
#include "vera/base/free_room.h"
#include "vera/base/partial_file.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <memory>
#include <mutex>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vera {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t buffer_size = std::size_t{1} << 18;

/// An open file or folder.
class Descriptor {
public:
    explicit Descriptor(int number = -1)
        : number_(number) {}

    ~Descriptor() {
        if (number_ >= 0)
            close(number_);
    }

    Descriptor(Descriptor&& other) noexcept
        : number_(std::exchange(other.number_, -1)) {}

    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }

    int number() const { return number_; }

    int release() { return std::exchange(number_, -1); }

private:
    int number_;
};

/// The number of the open file of this process that a path stands for: opened by its path it would
/// be written from its beginning on, whatever stands there already.
std::optional<int> open_file_named(const fs::path& path) {
    const std::string& text = path.native();
    if (text == "-" || text == "/dev/stdout")
        return STDOUT_FILENO;
    if (text == "/dev/stderr")
        return STDERR_FILENO;
    for (const std::string_view beginning : {"/dev/fd/", "/proc/self/fd/"}) {
        int number = 0;
        const char* const end = text.data() + text.size();
        if (text.starts_with(beginning)
            && std::from_chars(text.data() + beginning.size(), end, number).ptr == end)
            return number;
    }
    return std::nullopt;
}

/// Where symbolic links lead in the end, even if nothing is there yet.
fs::path followed(fs::path path, const std::string& name) {
    constexpr int longest_chain = 40;
    for (int i = 0; i < longest_chain; ++i) {
        std::error_code error;
        const fs::path next = fs::read_symlink(path, error);
        if (error)
            return path; // not a link; if something is amiss, opening will tell
        path = next.is_absolute() ? next : path.parent_path() / next;
    }
    detail::throw_unwritable(name, ELOOP);
}

/// Reads all bytes from the position on, or throws.
void read_fully(
    int descriptor, std::span<std::byte> bytes, std::uint64_t position, const std::string& name) {
    while (!bytes.empty()) {
        const ssize_t count =
            pread(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(position));
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            detail::throw_unwritable(name, count < 0 ? errno : EIO);
        bytes = bytes.subspan(static_cast<std::size_t>(count));
        position += static_cast<std::uint64_t>(count);
    }
}

/// Writes everything or throws; at a position if one is given, else where the file stands.
void write_fully(
    int descriptor,
    std::span<const std::byte> bytes,
    std::optional<std::uint64_t> position,
    const std::string& name) {
    while (!bytes.empty()) {
        const ssize_t count = position
            ? pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(*position))
            : ::write(descriptor, bytes.data(), bytes.size());
        if (count < 0 && errno == EINTR)
            continue;
        if (count <= 0)
            detail::throw_unwritable(name, count < 0 ? errno : EIO);
        bytes = bytes.subspan(static_cast<std::size_t>(count));
        if (position)
            *position += static_cast<std::uint64_t>(count);
    }
}

} // namespace

namespace detail {

/// Either a partial file in a folder, or something that is written directly.
struct OutputTarget {
    Descriptor direct;
    std::shared_ptr<const Descriptor> folder;
    std::optional<PartialFile> partial; ///< behind the folder, which it needs to the end
    std::vector<std::byte> buffer;      ///< written, but not to the file yet

    int descriptor() const { return partial ? partial->descriptor() : direct.number(); }
};

} // namespace detail

namespace {

bool are_one_file(const Descriptor& a, const Descriptor& b) {
    struct stat of_a = {};
    struct stat of_b = {};
    return fstat(a.number(), &of_a) == 0 && fstat(b.number(), &of_b) == 0
        && of_a.st_dev == of_b.st_dev && of_a.st_ino == of_b.st_ino;
}

/// The folder, open: the same descriptor as the last one's that is still open, if it is the same
/// folder, since a process may have few and many files may wait in one folder.
std::shared_ptr<const Descriptor> opened_folder(const fs::path& folder, const std::string& name) {
    static std::mutex mutex;
    static std::weak_ptr<const Descriptor> last;
    auto opened =
        std::make_shared<const Descriptor>(open(folder.c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    if (opened->number() < 0)
        detail::throw_unwritable(name, errno);
    const std::lock_guard lock(mutex);
    if (auto open_already = last.lock(); open_already && are_one_file(*open_already, *opened))
        return open_already;
    last = opened;
    return opened;
}

/// A partial file beside path, which is no link. Existing is what stands there, if anything does.
void open_beside(
    detail::OutputTarget& target,
    const fs::path& path,
    const struct stat* existing,
    const std::string& name) {
    // Renaming would replace a file that its owner has protected from writing.
    if (existing != nullptr && faccessat(AT_FDCWD, path.c_str(), W_OK, AT_EACCESS) != 0)
        detail::throw_unwritable(name, errno);
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    if (!path.has_filename())
        detail::throw_unwritable(name, EISDIR);

    // Kept open: the file finds its place even if the working folder changes meanwhile.
    target.folder = opened_folder(folder, name);
    target.partial.emplace(target.folder->number(), path.filename().native(), name);
    constexpr mode_t permissions = 0777;
    if (existing != nullptr)
        fchmod(target.partial->descriptor(), existing->st_mode & permissions);
}

/// Waits until the folder's entry for the new file is on the disk.
void sync_folder(int folder, const std::string& name) {
    const Descriptor readable(openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    // A folder may be written to but not read, and some file systems know no fsync of folders: the
    // file is in its place all the same.
    if (readable.number() < 0 || fsync(readable.number()) == 0)
        return;
    if (errno == EIO || errno == ENOSPC || errno == EDQUOT)
        detail::throw_unwritable(name, errno);
}

} // namespace

OutputFile::OutputFile(const fs::path& path)
    : name_(path == "-" ? "standard output" : fmt::format("'{}'", path.native()))
    , target_(std::make_unique<detail::OutputTarget>()) {
    target_->buffer.reserve(buffer_size);
    if (const auto number = open_file_named(path)) {
        // A copy: what closing it says about the data is heard, and the original stays open.
        target_->direct = Descriptor(fcntl(*number, F_DUPFD_CLOEXEC, 3));
        if (target_->direct.number() < 0)
            detail::throw_unwritable(name_, errno);
        return;
    }
    struct stat status = {};
    const bool exists = stat(path.c_str(), &status) == 0;
    if (!exists && errno != ENOENT)
        detail::throw_unwritable(name_, errno);
    if (exists && S_ISDIR(status.st_mode))
        detail::throw_unwritable(name_, EISDIR);
    if (exists && !S_ISREG(status.st_mode)) {
        target_->direct = Descriptor(open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
        if (target_->direct.number() < 0)
            detail::throw_unwritable(name_, errno);
        return;
    }
    open_beside(*target_, followed(path, name_), exists ? &status : nullptr, name_);
}

OutputFile::~OutputFile() = default;

bool OutputFile::seekable() const {
    return target_->partial.has_value();
}

void OutputFile::flush() {
    write_fully(target_->descriptor(), target_->buffer, std::nullopt, name_);
    target_->buffer.clear();
}

void OutputFile::write(std::span<const std::byte> bytes) {
    if (target_->buffer.size() + bytes.size() > buffer_size)
        flush();
    if (bytes.size() >= buffer_size)
        write_fully(target_->descriptor(), bytes, std::nullopt, name_);
    else
        target_->buffer.insert(target_->buffer.end(), bytes.begin(), bytes.end());
}

void OutputFile::write_at(std::uint64_t position, std::span<const std::byte> bytes) {
    VERA_CHECK(seekable());
    flush();
    write_fully(target_->descriptor(), bytes, position, name_);
}

void OutputFile::open_gap_before_all(std::uint64_t size) {
    VERA_CHECK(seekable());
    flush();
    const int file = target_->descriptor();
    const off_t end = lseek(file, 0, SEEK_CUR); // where write() goes on
    if (end < 0)
        detail::throw_unwritable(name_, errno);
    std::vector<std::byte> moved(buffer_size);
    for (auto left = static_cast<std::uint64_t>(end); left > 0;) { // from behind
        const auto part = std::span(moved).first(std::min<std::uint64_t>(left, moved.size()));
        left -= part.size();
        read_fully(file, part, left, name_);
        write_fully(file, part, left + size, name_);
    }
    if (lseek(file, end + static_cast<off_t>(size), SEEK_SET) < 0)
        detail::throw_unwritable(name_, errno);
}

void OutputFile::finish() {
    VERA_CHECK(target_->descriptor() >= 0);
    flush();
    free_room(target_->buffer); // many files may wait for each other
    if (!target_->partial)
        return;
    if (fsync(target_->descriptor()) != 0)
        detail::throw_unwritable(name_, errno);
    target_->partial->finish();
}

void OutputFile::commit() {
    if (target_->descriptor() >= 0)
        finish();
    if (!target_->partial) {
        if (close(target_->direct.release()) != 0 && errno != EINTR)
            detail::throw_unwritable(name_, errno);
        return;
    }
    target_->partial->take_place();
    sync_folder(target_->folder->number(), name_);
}

} // namespace vera
