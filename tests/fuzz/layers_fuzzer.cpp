// SPDX-License-Identifier: Apache-2.0
#include "vera/image/layers_file.h"

#include <cstdint>
#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    // The larger the file, the larger and slower a picture that it may promise.
    constexpr std::size_t longest = 2048;
    constexpr std::size_t most_samples = std::size_t{1} << 22;
    if (size > longest)
        return 0;
    try {
        const vera::LayersReader reader(std::as_bytes(std::span(data, size)), "fuzz");
        std::vector<std::string> names;
        for (const vera::LayerChannel& channel : reader.channels())
            names.push_back(channel.name);
        if (reader.width() * names.size() > most_samples)
            return 0;
        std::vector<float> samples(reader.width() * names.size());
        (void)reader.text("Settings");
        for (const std::size_t y : {std::size_t{0}, reader.height() / 2, reader.height() - 1})
            reader.read_row(y, names, samples);
    } catch (const std::runtime_error&) {
        // Rows or an error that names the file: nothing else may come of it.
    }
    return 0;
}
