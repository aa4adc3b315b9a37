// SPDX-License-Identifier: Apache-2.0
#include "vera/base/read_bytes.h"

#include "vera/base/diagnostic.h"

#include <cerrno>
#include <system_error>

#include <fmt/format.h>
#include <unistd.h>

namespace vera {

std::size_t read_some(int file, std::span<std::byte> buffer, const std::string& name) {
    while (true) {
        const ssize_t count = read(file, buffer.data(), buffer.size());
        if (count >= 0)
            return static_cast<std::size_t>(count);
        if (errno != EINTR)
            throw std::system_error(
                errno, std::generic_category(), fmt::format("cannot read '{}'", name));
    }
}

void throw_without_end(const std::string& name, std::size_t most) {
    constexpr std::size_t mebibyte = std::size_t{1} << 20U;
    const std::string limit = most % mebibyte == 0 ? fmt::format("{} MiB", most / mebibyte)
                                                   : fmt::format("{} bytes", most);
    throw InputError({Diagnostic{
        .place = {.file = name},
        .problem =
            fmt::format("more than {} came from this pipe or device, which may have no end", limit),
        .remedy = "write what it gives to a file, which may be larger, and name that"}});
}

} // namespace vera
