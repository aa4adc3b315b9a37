// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/source_text.h"

#include "vera/base/read_bytes.h"
#include "vera/base/utf8.h"
#include "vera/formats/similar_file.h"

#include <algorithm>
#include <cerrno>
#include <string>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vera {

namespace {

[[noreturn]] void throw_for(const std::string& path, int error) {
    throw std::system_error(error, std::generic_category(), "cannot read '" + path + "'");
}

/// A file descriptor that is closed at the end of its scope.
struct OpenFile {
    int descriptor;
    bool owned;

    ~OpenFile() {
        if (owned)
            close(descriptor);
    }
};

} // namespace

SourceText::SourceText(const std::filesystem::path& path, std::size_t most_streamed)
    : name_(path.string()) {
    const bool standard_input = name_ == "-";
    if (standard_input)
        name_ = "<standard input>";
    const OpenFile file = {
        standard_input ? STDIN_FILENO : open(path.c_str(), O_RDONLY | O_CLOEXEC), !standard_input};
    if (file.descriptor < 0) {
        const int error = errno;
        // In brackets: what the machine says comes behind it.
        const std::string similar = error == ENOENT ? similar_file(path, " (") : "";
        throw std::system_error(
            error,
            std::generic_category(),
            "cannot read '" + name_ + "'" + similar + (similar.empty() ? "" : ")"));
    }
    struct stat status = {};
    if (fstat(file.descriptor, &status) != 0)
        throw_for(name_, errno);
    if (S_ISDIR(status.st_mode))
        throw_for(name_, EISDIR);

    const auto size = static_cast<std::size_t>(status.st_size);
    if (S_ISREG(status.st_mode) && size > 0 && !standard_input) {
        void* const mapping = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file.descriptor, 0);
        if (mapping != MAP_FAILED) {
            madvise(mapping, size, MADV_SEQUENTIAL);
            mapping_ = mapping;
            data_ = static_cast<const char*>(mapping);
            size_ = size;
            return;
        }
    }
    owned_ = bytes_to_end<std::string>(
        file.descriptor, name_, S_ISREG(status.st_mode) ? size : 0, most_streamed);
    data_ = owned_.data();
    size_ = owned_.size();
}

SourceText::SourceText(std::string name, std::string text)
    : name_(std::move(name))
    , owned_(std::move(text))
    , data_(owned_.data())
    , size_(owned_.size()) {}

SourceText::~SourceText() {
    if (mapping_ != nullptr)
        munmap(mapping_, size_);
}

void SourceText::forget(std::size_t begin, std::size_t end) const {
    if (mapping_ == nullptr)
        return;
    const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
    const std::size_t first = begin / page * page;
    const std::size_t last = std::min(end, size_) / page * page;
    if (first < last)
        madvise(static_cast<char*>(mapping_) + first, last - first, MADV_DONTNEED);
}

SourcePlace SourceText::place(std::size_t offset) const {
    const std::string_view before = text().substr(0, offset);
    const auto lines = std::count(before.begin(), before.end(), '\n');
    const std::size_t last = before.rfind('\n');
    const std::size_t column =
        last == std::string_view::npos ? before.size() : before.size() - last - 1;
    return {name_, static_cast<std::uint64_t>(lines) + 1, column + 1};
}

std::string SourceText::line_at(std::size_t offset) const {
    constexpr std::size_t longest = 4096;
    const std::string_view before = text().substr(0, offset);
    const std::size_t last = before.rfind('\n');
    const std::size_t first = last == std::string_view::npos ? 0 : last + 1;
    const std::size_t shown_from = first;
    std::string_view line = text().substr(shown_from, longest);
    line = line.substr(0, line.find('\n'));
    if (!line.empty() && line.back() == '\r')
        line.remove_suffix(1);
    // One byte for one, so that columns stay what they are.
    std::string shown(line);
    for (std::size_t i = 0; i < line.size();) {
        const std::size_t length = character_length(line.substr(i));
        if (length == 0)
            shown[i] = '?';
        i += std::max<std::size_t>(length, 1);
    }
    return shown;
}

Diagnostic SourceText::diagnostic(
    Severity severity,
    std::size_t offset,
    std::size_t length,
    std::string problem,
    std::string remedy) const {
    return {
        .severity = severity,
        .place = place(offset),
        .problem = std::move(problem),
        .remedy = std::move(remedy),
        .line = line_at(offset),
        .length = length};
}

namespace {

/// The name by which iconv knows the encoding, or null where it is not UTF-16.
const char* name_of_utf16(std::string_view text) {
    using namespace std::string_view_literals;
    if (text.starts_with("\xff\xfe"sv) || text.starts_with("\xfe\xff"sv))
        return "UTF-16";
    constexpr std::size_t least = 4;
    constexpr std::size_t looked_at = 64;
    const std::string_view beginning = text.substr(0, std::min(text.size() / 2 * 2, looked_at));
    if (beginning.size() < least)
        return nullptr;
    const auto is_of_order = [&](std::size_t place_of_zero) {
        for (std::size_t i = 0; i < beginning.size(); ++i)
            if ((beginning[i] == '\0') != (i % 2 == place_of_zero))
                return false;
        return true;
    };
    return is_of_order(1) ? "UTF-16LE" : is_of_order(0) ? "UTF-16BE" : nullptr;
}

} // namespace

void refuse_utf16(const SourceText& text) {
    const char* const name = name_of_utf16(text.text());
    if (name == nullptr)
        return;
    throw InputError(
        {{.place = {text.name(), 1, 1},
          .problem = "the file is in UTF-16",
          .remedy =
              std::string("save it as UTF-8, or convert it: iconv -f ") + name + " -t UTF-8"}});
}

} // namespace vera
