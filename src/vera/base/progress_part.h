// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"

#include <cstddef>
#include <utility>

namespace vera {

/// What the part number `part` of `parts` equal ones of some work tells of its own progress, as the
/// progress of the whole.
inline Progress progress_part(Progress whole, std::size_t part, std::size_t parts) {
    if (!whole)
        return {};
    return [whole = std::move(whole), part, parts](double done) {
        whole((static_cast<double>(part) + done) / static_cast<double>(parts));
    };
}

} // namespace vera
