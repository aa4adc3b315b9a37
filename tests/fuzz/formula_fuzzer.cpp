// SPDX-License-Identifier: Apache-2.0
#include "vera/base/check.h"
#include "vera/generate/formula.h"

#include <cmath>
#include <cstdint>
#include <string>

/// Whatever the text, it is a formula or an error within it; and what it is at a place lies in what
/// intervals say of it.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        const vera::Formula formula(text, {{"n", 5}});
        const double value = formula.at(0.5, -0.25).value;
        const vera::Interval all =
            formula.at(vera::Interval(0.25, 0.5), vera::Interval(-0.25, 1)).value;
        VERA_CHECK(!std::isfinite(value) || all.contains(value));
    } catch (const vera::FormulaError& error) {
        VERA_CHECK(error.offset <= text.size());
        VERA_CHECK(error.length >= 1);
    }
    return 0;
}
