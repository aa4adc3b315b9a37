// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/base/read_bytes.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace vera {

/// The bytes of an input file, and what a diagnostic needs to point into them. A regular file is
/// mapped, not copied; "-" is standard input. Keeps no table of lines: places are worked out when
/// they are asked for, which errors alone do.
class SourceText {
public:
    /// Throws std::system_error, naming the path, when the file cannot be read, and InputError when
    /// it is no regular file and more than so many bytes come from it.
    explicit SourceText(
        const std::filesystem::path& path, std::size_t most_streamed = most_streamed_bytes);
    /// A text from memory, under a name.
    SourceText(std::string name, std::string text);
    ~SourceText();
    SourceText(const SourceText&) = delete;
    SourceText& operator=(const SourceText&) = delete;

    const std::string& name() const { return name_; }

    std::string_view text() const { return {data_, size_}; }

    /// Gives the memory of what stands between two offsets back to the machine, where the text is a
    /// mapped file. It is read again when it is asked for.
    void forget(std::size_t begin, std::size_t end) const;

    /// The place of the byte at an offset, or just behind the end.
    SourcePlace place(std::size_t offset) const;

    /// The whole line that holds the byte at the offset, without its end, at most 4096 bytes of it
    /// and then none of what follows. Bytes that are not UTF-8 are shown as '?'.
    std::string line_at(std::size_t offset) const;

    /// A diagnostic that marks length bytes at the offset.
    Diagnostic diagnostic(
        Severity severity,
        std::size_t offset,
        std::size_t length,
        std::string problem,
        std::string remedy = {}) const;

private:
    std::string name_;
    std::string owned_;
    const char* data_ = nullptr;
    std::size_t size_ = 0;
    void* mapping_ = nullptr;
};

/// How long the mark of its encoding is that some editors begin a text with: 0 where there is none.
inline std::size_t encoding_mark_length(std::string_view text) {
    return text.starts_with("\xef\xbb\xbf") ? 3 : 0;
}

/// Throws InputError where the text is in UTF-16, as some editors save it: where it begins with
/// that encoding's mark, or every other byte at its beginning is zero.
void refuse_utf16(const SourceText& text);

/// What has been read of a text that is read from front to back: its memory is given back now and
/// then, so that a text and what is made of it are never in memory as a whole both.
class SpentText {
public:
    /// The text must outlive it.
    explicit SpentText(const SourceText& text)
        : text_(&text) {}

    /// What stands before the offset has been read.
    void up_to(std::size_t offset) {
        constexpr std::size_t step = 1U << 20U;
        if (offset < forgotten_ + step)
            return;
        text_->forget(forgotten_, offset);
        forgotten_ = offset;
    }

private:
    const SourceText* text_;
    std::size_t forgotten_ = 0;
};

} // namespace vera
