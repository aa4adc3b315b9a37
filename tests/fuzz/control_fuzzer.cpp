// SPDX-License-Identifier: Apache-2.0
#include "vera/base/check.h"
#include "vera/formats/control_file.h"

#include <cstdint>
#include <string>

/// Whatever the text, it is a list of settings within their bounds or one of errors.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const vera::SourceText text("fuzz.ctl", std::string(reinterpret_cast<const char*>(data), size));
    std::vector<vera::Diagnostic> warnings;
    try {
        const vera::PictureSettings settings = vera::read_control_text(text, {}, warnings);
        VERA_CHECK(settings.width >= 1 && settings.height >= 1 && settings.depth >= 1);
        VERA_CHECK(settings.antialiasing.samples >= 2 && settings.antialiasing.samples <= 256);
        VERA_CHECK(!settings.frame_margin || *settings.frame_margin < 0.5);
    } catch (const vera::InputError& error) {
        VERA_CHECK(!error.diagnostics().empty());
        for (const vera::Diagnostic& diagnostic : error.diagnostics())
            VERA_CHECK(!vera::to_text(diagnostic).empty());
    }
    return 0;
}
