// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/output_file.h"
#include "vera/image/image.h"

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include <ImfHeader.h>
#include <ImfIO.h>

namespace vera::detail {

// What the codecs of EXR files have in common: how OpenEXR reads and writes our files. For them
// alone: it includes OpenEXR's headers, which others need not have.

class ExrStream;

/// An output file as OpenEXR writes it: going back at the end to fill in where each block of rows
/// lies. For a pipe, which cannot go back, everything waits in a file without a name.
class ExrTarget {
public:
    /// The file must outlive it.
    explicit ExrTarget(OutputFile& file);
    ~ExrTarget();
    ExrTarget(const ExrTarget&) = delete;
    ExrTarget& operator=(const ExrTarget&) = delete;

    Imf::OStream& stream();

    /// Calls what lets OpenEXR write. OpenEXR swallows some errors and gives others its own words:
    /// throws those of the file as they were, and others as std::runtime_error that names it.
    void encode(const std::function<void()>& write);

    /// After all is written.
    void finish();

private:
    OutputFile& file_;
    std::unique_ptr<ExrStream> stream_;
};

/// The bytes of a file as OpenEXR reads them.
class ExrSource : public Imf::IStream {
public:
    ExrSource(std::span<const std::byte> bytes, const std::string& name);

    bool read(char* data, int count) override;

    std::uint64_t tellg() override { return position_; }

    void seekg(std::uint64_t position) override { position_ = position; }

private:
    std::span<const std::byte> bytes_;
    std::uint64_t position_ = 0;
};

/// Whether OpenEXR may be let read the headers, which makes room for what they promise before it
/// sees how long the file is: every attribute ends within the file, and the tables of where its
/// rows or tiles lie could.
bool exr_headers_fit(std::span<const std::byte> bytes);

/// Text attributes, under names that OpenEXR does not use itself.
void add_metadata(Imf::Header& header, const PictureMetadata& metadata);

/// Throws std::runtime_error, which names the file, when no EXR picture is as large.
void check_exr_size(std::size_t width, std::size_t height, const OutputFile& file);

} // namespace vera::detail
