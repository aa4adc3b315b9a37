// SPDX-License-Identifier: Apache-2.0
#include "vera/base/check.h"
#include "vera/generate/formula.h"

#include <cmath>
#include <cstdint>
#include <string>

/// Whatever the text, it is a formula or an error within it; and what it is at a place is what
/// intervals say of that place alone. An interval holds exact results, so that what it says of a
/// range holds a part of that; not always the number, whose roundings may be those of another way
/// to the same result.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string text(reinterpret_cast<const char*>(data), size);
    try {
        const vera::Formula formula(text, {{"n", 5}});
        const double value = formula.at(0.5, -0.25).value;
        const vera::Interval here = formula.at(vera::Interval(0.5), vera::Interval(-0.25)).value;
        const vera::Interval all =
            formula.at(vera::Interval(0.25, 0.5), vera::Interval(-0.25, 1)).value;
        VERA_CHECK(!std::isfinite(value) || here.contains(value));
        VERA_CHECK(here.lower <= all.upper && all.lower <= here.upper);
    } catch (const vera::FormulaError& error) {
        VERA_CHECK(error.offset <= text.size());
        VERA_CHECK(error.length >= 1);
    }
    return 0;
}
