// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vera {

/// Rows of whole numbers. Each column takes as many bits of a row as its numbers above the least of
/// them need: of numbers that are near each other, few.
template <std::size_t Columns>
class PackedRows {
public:
    using Row = std::array<std::uint64_t, Columns>;

    PackedRows() = default;

    /// row_at(i) is row i, which is asked for twice.
    template <typename RowAt>
    PackedRows(std::size_t count, const RowAt& row_at)
        : count_(count) {
        if (count == 0)
            return;
        Row most = row_at(0);
        least_ = most;
        for (std::size_t i = 1; i < count; ++i) {
            const Row row = row_at(i);
            for (std::size_t column = 0; column < Columns; ++column) {
                least_[column] = std::min(least_[column], row[column]);
                most[column] = std::max(most[column], row[column]);
            }
        }
        for (std::size_t column = 0; column < Columns; ++column) {
            widths_[column] =
                static_cast<std::size_t>(std::bit_width(most[column] - least_[column]));
            masks_[column] =
                widths_[column] == 0 ? 0 : ~std::uint64_t{0} >> (word_bits - widths_[column]);
            bits_of_a_row_ += widths_[column];
        }
        // One word more, as a number is read from the word in which it begins and the next one.
        words_.resize(count * bits_of_a_row_ / word_bits + 2);
        std::size_t bit = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const Row row = row_at(i);
            for (std::size_t column = 0; column < Columns; ++column) {
                put(bit, row[column] - least_[column]);
                bit += widths_[column];
            }
        }
    }

    std::size_t size() const { return count_; }

    Row operator[](std::size_t i) const {
        Row row;
        std::size_t bit = i * bits_of_a_row_;
        for (std::size_t column = 0; column < Columns; ++column) {
            row[column] = least_[column] + (bits_from(bit) & masks_[column]);
            bit += widths_[column];
        }
        return row;
    }

    /// Calls visit(row) for all rows, one after the other.
    template <typename Visit>
    void for_each(const Visit& visit) const {
        for (std::size_t i = 0; i < count_; ++i)
            visit((*this)[i]);
    }

    /// Bytes that it takes.
    std::size_t room() const { return words_.capacity() * sizeof(std::uint64_t); }

private:
    static constexpr std::size_t word_bits = 64;

    void put(std::size_t bit, std::uint64_t number) {
        const std::size_t shift = bit % word_bits;
        words_[bit / word_bits] |= number << shift;
        words_[bit / word_bits + 1] |= number >> 1U >> (word_bits - 1 - shift);
    }

    std::uint64_t bits_from(std::size_t bit) const {
        const std::size_t shift = bit % word_bits;
        const std::uint64_t* words = words_.data() + bit / word_bits;
        // The next word is shifted in two steps, as by all of its bits it cannot be.
        return words[0] >> shift | words[1] << 1U << (word_bits - 1 - shift);
    }

    std::size_t count_ = 0;
    std::size_t bits_of_a_row_ = 0;
    Row least_ = {};
    Row masks_ = {};
    std::array<std::size_t, Columns> widths_ = {}; ///< bits
    std::vector<std::uint64_t> words_;
};

} // namespace vera
