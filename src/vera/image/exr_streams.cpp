// SPDX-License-Identifier: Apache-2.0
#include "vera/image/codecs.h"
#include "vera/image/exr_streams-inl.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>

namespace vera::detail {

/// Takes what OpenEXR writes, which goes back at the end to fill in where each block of rows lies.
/// OpenEXR swallows an error of that last step: it is kept here.
class ExrStream : public Imf::OStream {
public:
    explicit ExrStream(const std::string& name)
        : Imf::OStream(name.c_str()) {}

    void write(const char* data, int count) override {
        const auto bytes = std::as_bytes(std::span(data, static_cast<std::size_t>(count)));
        try {
            if (position_ == size_) {
                append(bytes);
                size_ += bytes.size();
            } else {
                overwrite(position_, bytes);
                size_ = std::max(size_, position_ + bytes.size());
            }
        } catch (...) {
            if (!failure_)
                failure_ = std::current_exception();
            throw;
        }
        position_ += bytes.size();
    }

    std::uint64_t tellp() override { return position_; }

    void seekp(std::uint64_t position) override { position_ = position; }

    void throw_if_failed() const {
        if (failure_)
            std::rethrow_exception(failure_);
    }

    /// After all is written.
    virtual void finish(OutputFile& file) = 0;

protected:
    virtual void append(std::span<const std::byte> bytes) = 0;
    virtual void overwrite(std::uint64_t position, std::span<const std::byte> bytes) = 0;

private:
    std::uint64_t position_ = 0;
    std::uint64_t size_ = 0;
    std::exception_ptr failure_;
};

namespace {

class SeekableTarget : public ExrStream {
public:
    explicit SeekableTarget(OutputFile& file)
        : ExrStream(file.name())
        , file_(file) {}

    void finish(OutputFile& /*file*/) override {}

private:
    void append(std::span<const std::byte> bytes) override { file_.write(bytes); }

    void overwrite(std::uint64_t position, std::span<const std::byte> bytes) override {
        file_.write_at(position, bytes);
    }

    OutputFile& file_;
};

/// For a pipe, which cannot go back: everything waits in a file without a name.
class SpooledTarget : public ExrStream {
public:
    explicit SpooledTarget(const std::string& name)
        : ExrStream(name)
        , spool_(std::tmpfile()) {
        if (spool_ == nullptr)
            fail();
    }

    ~SpooledTarget() override {
        if (spool_ != nullptr)
            std::fclose(spool_);
    }

    SpooledTarget(const SpooledTarget&) = delete;
    SpooledTarget& operator=(const SpooledTarget&) = delete;

    void finish(OutputFile& file) override {
        std::rewind(spool_);
        std::vector<std::byte> buffer(std::size_t{1} << 16);
        while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), spool_))
            file.write(std::span(buffer).first(count));
        if (std::ferror(spool_) != 0)
            fail();
    }

private:
    void append(std::span<const std::byte> bytes) override {
        if (std::fseek(spool_, 0, SEEK_END) != 0)
            fail();
        put(bytes);
    }

    void overwrite(std::uint64_t position, std::span<const std::byte> bytes) override {
        if (std::fseek(spool_, static_cast<long>(position), SEEK_SET) != 0)
            fail();
        put(bytes);
    }

    void put(std::span<const std::byte> bytes) {
        if (std::fwrite(bytes.data(), 1, bytes.size(), spool_) != bytes.size())
            fail();
    }

    [[noreturn]] void fail() const {
        throw std::system_error(
            errno,
            std::generic_category(),
            std::string("cannot write ") + fileName()
                + "; an EXR picture waits in the folder for temporary files when it goes to a "
                  "pipe");
    }

    std::FILE* spool_;
};

/// Walks over the headers of an EXR file, as far as to tell whether OpenEXR may be let read them:
/// it makes room for what they promise before it sees how long the file is.
class ExrHeaders {
public:
    explicit ExrHeaders(std::span<const std::byte> bytes)
        : rest_(bytes) {}

    /// Whether every attribute ends within the file, and the tables of where its rows or tiles lie
    /// could.
    bool fit() {
        constexpr std::size_t magic_and_version = 8;
        return skip(magic_and_version) && attributes_fit() && tables_fit();
    }

private:
    using Sides = std::array<std::int64_t, 2>;

    bool attributes_fit() {
        // Headers of several parts follow one another, and an empty one ends them.
        while (true) {
            const std::optional<std::string> name = text();
            if (!name)
                return false;
            if (name->empty())
                return true;
            const std::optional<std::string> type = text();
            if (!type || rest_.size() < 4)
                return false;
            const std::int32_t size = number_at(0);
            skip(4);
            if (size < 0 || static_cast<std::size_t>(size) > rest_.size())
                return false;
            if (*name == "dataWindow" && size >= 16)
                window_ = {
                    std::int64_t{number_at(8)} - number_at(0) + 1,
                    std::int64_t{number_at(12)} - number_at(4) + 1};
            if (*name == "tiles" && size >= 8)
                tile_ = {number_at(0), number_at(4)};
            skip(static_cast<std::size_t>(size));
        }
    }

    bool tables_fit() const {
        constexpr std::int64_t most_rows_of_a_block = 256;
        constexpr std::size_t entry = 8;
        const Sides block = tile_.value_or(Sides{window_[0], most_rows_of_a_block});
        const auto most = static_cast<std::int64_t>(rest_.size() / entry) + 1;
        std::int64_t blocks = 1;
        for (std::size_t i = 0; i < 2; ++i) {
            if (window_[i] <= 0 || block[i] <= 0)
                return true; // OpenEXR complains
            const std::int64_t along = (window_[i] - 1) / block[i] + 1;
            if (along > most)
                return false;
            blocks *= along;
        }
        return blocks <= most;
    }

    bool skip(std::size_t count) {
        if (count > rest_.size())
            return false;
        rest_ = rest_.subspan(count);
        return true;
    }

    /// Up to a byte 0, which is skipped.
    std::optional<std::string> text() {
        const auto end = std::find(rest_.begin(), rest_.end(), std::byte{0});
        if (end == rest_.end())
            return std::nullopt;
        const auto length = static_cast<std::size_t>(end - rest_.begin());
        std::string result(length, '\0');
        std::memcpy(result.data(), rest_.data(), length);
        skip(length + 1);
        return result;
    }

    std::int32_t number_at(std::size_t offset) const {
        std::uint32_t bits = 0;
        for (std::size_t i = 0; i < 4; ++i)
            bits |= std::to_integer<std::uint32_t>(rest_[offset + i]) << (8 * i);
        return static_cast<std::int32_t>(bits);
    }

    std::span<const std::byte> rest_;
    Sides window_ = {1, 1};
    std::optional<Sides> tile_;
};

} // namespace

ExrTarget::ExrTarget(OutputFile& file)
    : file_(file) {
    if (file.seekable())
        stream_ = std::make_unique<SeekableTarget>(file);
    else
        stream_ = std::make_unique<SpooledTarget>(file.name());
}

ExrTarget::~ExrTarget() = default;

Imf::OStream& ExrTarget::stream() {
    return *stream_;
}

void ExrTarget::encode(const std::function<void()>& write) {
    try {
        write();
    } catch (const std::exception& error) {
        // OpenEXR has given errors of ours other words.
        stream_->throw_if_failed();
        throw std::runtime_error(
            std::string("cannot write ") + stream_->fileName() + ": " + error.what());
    }
    stream_->throw_if_failed();
}

void ExrTarget::finish() {
    stream_->finish(file_);
}

ExrSource::ExrSource(std::span<const std::byte> bytes, const std::string& name)
    : Imf::IStream(name.c_str())
    , bytes_(bytes) {}

bool ExrSource::read(char* data, int count) {
    const auto size = static_cast<std::size_t>(count);
    if (count < 0 || position_ > bytes_.size() || bytes_.size() - position_ < size)
        throw std::runtime_error("it ends early");
    std::memcpy(data, bytes_.data() + position_, size);
    position_ += size;
    return position_ < bytes_.size();
}

bool exr_headers_fit(std::span<const std::byte> bytes) {
    return ExrHeaders(bytes).fit();
}

void add_metadata(Imf::Header& header, const PictureMetadata& metadata) {
    constexpr std::size_t longest_name = 255;
    for (const auto& [name, value] : metadata) {
        std::string attribute = plain_name(name, longest_name);
        // A name that OpenEXR uses for something else would change the picture.
        while (header.find(attribute.c_str()) != header.end())
            attribute.insert(0, "vera_");
        header.insert(attribute.c_str(), Imf::StringAttribute(value));
    }
}

void check_exr_size(std::size_t width, std::size_t height, const OutputFile& file) {
    constexpr auto largest_side = static_cast<std::size_t>(std::numeric_limits<int>::max() / 16);
    if (width > largest_side || height > largest_side)
        throw std::runtime_error(
            "cannot write " + file.name() + ": an EXR picture has at most 134217727 pixels a side");
}

} // namespace vera::detail
