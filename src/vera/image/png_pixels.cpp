// SPDX-License-Identifier: Apache-2.0
#include "vera/image/png_pixels.h"

#include "vera/base/check.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <new>

namespace vera::detail {

namespace {

constexpr unsigned char left_filter = 1;
constexpr unsigned char above_filter = 2;

/// The sum of the sizes of differences, taken as signed.
std::uint64_t size_of_differences(const std::vector<unsigned char>& filtered) {
    std::uint64_t sum = 0;
    constexpr std::size_t part = 1 << 16; // whose sum fits into 32 bits
    for (std::size_t first = 1; first < filtered.size(); first += part) {
        const std::size_t last = std::min(first + part, filtered.size());
        std::uint32_t part_sum = 0;
        for (std::size_t i = first; i < last; ++i)
            part_sum += std::min<unsigned char>(
                filtered[i], static_cast<unsigned char>(256U - filtered[i]));
        sum += part_sum;
    }
    return sum;
}

} // namespace

PngPixels::PngPixels(const PngLayout& layout)
    : layout_(layout)
    , above_(layout.width * layout.pixel_bytes)
    , row_(above_.size())
    , by_left_(above_.size() + 1, left_filter)
    , by_above_(above_.size() + 1, above_filter)
    , chunk_(std::size_t{1} << 16) {
    constexpr int largest_window = 15;
    constexpr int usual_memory = 8;
    if (deflateInit2(
            &stream_,
            layout.compression,
            Z_DEFLATED,
            largest_window,
            usual_memory,
            Z_DEFAULT_STRATEGY)
        != Z_OK)
        throw std::bad_alloc();
    stream_.next_out = chunk_.data();
    stream_.avail_out = static_cast<uInt>(chunk_.size());
}

PngPixels::~PngPixels() {
    deflateEnd(&stream_);
}

void PngPixels::add_row(const unsigned char* row) {
    VERA_CHECK(waiting_ == 0);
    const std::size_t size = row_.size();
    if (layout_.swapped)
        for (std::size_t i = 0; i < size; i += 2) {
            row_[i] = row[i + 1];
            row_[i + 1] = row[i];
        }
    else
        std::memcpy(row_.data(), row, size);
    // PNG takes what lies beside the picture for 0.
    const std::size_t first = std::min(layout_.pixel_bytes, size);
    unsigned char* by_left = by_left_.data() + 1;
    unsigned char* by_above = by_above_.data() + 1;
    std::copy_n(row_.begin(), first, by_left);
    for (std::size_t i = first; i < size; ++i)
        by_left[i] = static_cast<unsigned char>(row_[i] - row_[i - first]);
    for (std::size_t i = 0; i < size; ++i)
        by_above[i] = static_cast<unsigned char>(row_[i] - above_[i]);
    std::swap(row_, above_);
    std::vector<unsigned char>& chosen =
        size_of_differences(by_left_) < size_of_differences(by_above_) ? by_left_ : by_above_;
    stream_.next_in = chosen.data();
    waiting_ = chosen.size();
}

bool PngPixels::compress(Rest rest) {
    if (rest == Rest::none) {
        VERA_CHECK(waiting_ == 0);
        return deflate(&stream_, Z_FINISH) == Z_STREAM_END;
    }
    while (waiting_ > 0 && stream_.avail_out > 0) {
        // zlib counts in 32 bits, and a row may be longer.
        const std::size_t part = std::min(waiting_, std::size_t{1} << 30U);
        stream_.avail_in = static_cast<uInt>(part);
        VERA_CHECK(deflate(&stream_, Z_NO_FLUSH) == Z_OK);
        waiting_ -= part - stream_.avail_in;
    }
    return waiting_ == 0;
}

std::span<const unsigned char> PngPixels::fetch() {
    const std::size_t size = chunk_.size() - stream_.avail_out;
    stream_.next_out = chunk_.data();
    stream_.avail_out = static_cast<uInt>(chunk_.size());
    return {chunk_.data(), size};
}

} // namespace vera::detail
