// SPDX-License-Identifier: Apache-2.0
// The bytes of an open file whose end is not known before: a pipe, a device, standard input.
#pragma once

#include "vera/base/available_memory.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <string>

namespace vera {

/// Not more is read of what is no regular file: it may have no end.
constexpr std::size_t most_streamed_bytes = std::size_t{1} << 30U;

/// Fills the front of the buffer with what comes next from an open file; 0 is its end. Throws
/// std::system_error: "cannot read 'NAME'".
std::size_t read_some(int file, std::span<std::byte> buffer, const std::string& name);

/// Throws the InputError about a file of which more than so many bytes came.
[[noreturn]] void throw_without_end(const std::string& name, std::size_t most);

/// All bytes that come from an open file, in a string or vector. The name is for messages; size is
/// how many bytes are expected, 0 where that is not known: then no more than most_streamed are
/// read. Throws std::system_error, InputError where more come, and std::runtime_error before more
/// memory is taken than is available.
template <typename Bytes>
Bytes bytes_to_end(int file, const std::string& name, std::size_t size, std::size_t most_streamed) {
    constexpr std::size_t least_room = std::size_t{1} << 16U;
    Bytes bytes;
    static_assert(sizeof(bytes[0]) == 1);
    // One byte more shows that there is no more, or too much.
    std::size_t room = size == 0 ? std::min(least_room, most_streamed + 1) : size + 1;
    std::size_t count = 0;
    while (true) {
        if (count == bytes.size()) {
            require_memory(
                static_cast<double>(room),
                "reading '" + name + "'",
                "free some, or read what is smaller");
            bytes.resize(room);
            room = size == 0 ? std::min(2 * room, most_streamed + 1) : 2 * room;
        }
        const std::size_t more =
            read_some(file, std::as_writable_bytes(std::span(bytes)).subspan(count), name);
        if (more == 0)
            break;
        count += more;
        if (size == 0 && count > most_streamed)
            throw_without_end(name, most_streamed);
    }
    bytes.resize(count);
    return bytes;
}

} // namespace vera
