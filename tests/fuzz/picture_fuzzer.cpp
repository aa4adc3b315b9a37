// SPDX-License-Identifier: Apache-2.0
#include "vera/image/image_file.h"

#include <cstdint>
#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // The larger the file, the larger and slower a picture that it may promise.
    constexpr std::size_t longest = 1024;
    if (size > longest)
        return 0;
    try {
        vera::decoded_image(std::as_bytes(std::span(data, size)), "fuzz");
    } catch (const std::runtime_error&) {
        // A picture or an error that names the file: nothing else may come of it.
    }
    return 0;
}
