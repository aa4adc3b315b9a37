// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace vera {

namespace detail {
struct OutputTarget;
} // namespace detail

/// A file that appears whole or not at all. What is written goes to a file NAME.partial-XXXXXXXX
/// beside the target, which takes the target's place when it is committed and is removed when it is
/// not. An existing target keeps its permissions, a new one gets those that the umask leaves; a
/// symbolic link stays, and what it points to is replaced. "-" is standard output; that, a device
/// or a pipe is written directly, as far as the work comes.
///
/// Everything throws std::system_error that names the file and says what to do.
class OutputFile {
public:
    /// Fails when a file could not be made there, so that this is known before long work.
    explicit OutputFile(const std::filesystem::path& path);
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    /// The file as a message names it: its path in quotes, or "standard output".
    const std::string& name() const { return name_; }

    void write(std::span<const std::byte> bytes);

    void write(std::string_view text) { write(std::as_bytes(std::span(text))); }

    /// Whether write_at can be used: false for what is written directly.
    bool seekable() const;

    /// Writes over what stands at a position, counted from the file's beginning, or behind its end.
    /// The position of write() stays as it is.
    void write_at(std::uint64_t position, std::span<const std::byte> bytes);

    /// Moves all that was written behind a gap of that size, for what stands before it and is known
    /// but after it. What the gap holds means nothing until write_at() fills it. Only where
    /// seekable().
    void open_gap_before_all(std::uint64_t size);

    /// Nothing more will be written: all that was is on the disk when this returns, and the file is
    /// closed but has not appeared. Many may wait so for their commit, in a folder that is open
    /// once for all.
    void finish();

    /// Makes the file appear: all that was written is on the disk when this returns. Once, at the
    /// end.
    void commit();

private:
    void flush();

    std::string name_;
    std::unique_ptr<detail::OutputTarget> target_;
};

/// Removes the partial files of this process. Made for signal handlers: safe in them at any time.
void remove_partial_files() noexcept;

/// From now on SIGINT, SIGTERM and SIGHUP, where they are not ignored, first remove the partial
/// files and then end the process as they always do.
void remove_partial_files_on_signals();

} // namespace vera
