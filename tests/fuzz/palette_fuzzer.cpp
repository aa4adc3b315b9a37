// SPDX-License-Identifier: Apache-2.0
#include "vera/base/check.h"
#include "vera/base/diagnostic.h"
#include "vera/image/palette.h"

#include <cstdint>

/// Whatever the text, it is a palette, whose colours are read again as they are, or errors.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const vera::Palette palette =
            vera::palette_from_text({reinterpret_cast<const char*>(data), size}, "fuzz.txt");
        VERA_CHECK(!palette.empty() && palette.size() <= 256);
        std::string text;
        for (const vera::Rgb8 color : palette) {
            text += '#';
            for (const std::uint8_t sample : color)
                for (const int digit : {sample >> 4, sample & 15})
                    text += "0123456789ABCDEF"[digit];
            text += '\n';
        }
        VERA_CHECK(vera::palette_from_text(text, "fuzz.txt") == palette);
    } catch (const vera::InputError& error) {
        VERA_CHECK(!error.diagnostics().empty());
        for (const vera::Diagnostic& diagnostic : error.diagnostics())
            VERA_CHECK(!vera::to_text(diagnostic).empty());
    }
    return 0;
}
