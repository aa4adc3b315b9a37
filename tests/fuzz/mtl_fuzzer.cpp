// SPDX-License-Identifier: Apache-2.0
#include "vera/base/check.h"
#include "vera/formats/mtl_file.h"

#include <cstdint>
#include <string>
#include <vector>

namespace {

bool is_part(vera::Color color) {
    for (const double part : {color.r, color.g, color.b})
        if (!(part >= 0 && part <= 1))
            return false;
    return true;
}

} // namespace

/// Whatever the bytes: materials that the language could say too, or an InputError.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace vera;
    std::vector<Diagnostic> warnings;
    const SourceText source("fuzz", std::string(reinterpret_cast<const char*>(data), size));
    try {
        for (const Material& material : read_mtl(source, warnings)) {
            VERA_CHECK(!material.name.empty());
            VERA_CHECK(is_part(material.drf) && is_part(material.rab) && is_part(material.tab));
            VERA_CHECK(material.sdi.r >= 0 && material.sdi.r <= 2);
            VERA_CHECK(material.spc >= 0 && material.spc <= 1 && material.ref > 0);
        }
        VERA_CHECK(warnings.size() < 10);
    } catch (const InputError& error) {
        VERA_CHECK(!error.diagnostics().empty() && error.diagnostics().size() < 40);
        for (const Diagnostic& diagnostic : error.diagnostics())
            VERA_CHECK(!to_text(diagnostic).empty());
    }
    return 0;
}
