// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/image.h"

#include <cstddef>

namespace vera {

/// How two pictures differ.
struct ImageDifference {
    Image image;                    ///< the samples' differences times the factor, at most 255
    int factor = 1;                 ///< a power of two from 1 to 16
    std::size_t changed_pixels = 0; ///< that differ in any colour
    double mean = 0;                ///< of all samples' differences, in steps of 255
    int largest = 0;
};

/// The absolute differences, amplified as far as 9 of 10 samples that differ stay below white.
/// Both pictures must have 8 bit samples and the same size.
ImageDifference difference(const Image& first, const Image& second);

} // namespace vera
