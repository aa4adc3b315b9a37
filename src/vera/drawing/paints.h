// SPDX-License-Identifier: Apache-2.0
// The gradients of a drawing as documents define and name them.
#pragma once

#include "vera/drawing/drawing.h"
#include "vera/drawing/layers.h"

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

namespace vera::detail {

/// The different gradients of the drawing, in the order of their first use: equal ones are one.
class Gradients {
public:
    explicit Gradients(std::span<const FilledPath> fills);

    std::size_t count() const { return gradients_.size(); }

    const Gradient& operator[](std::size_t number) const { return *gradients_[number]; }

    /// Of a gradient of the fills.
    std::size_t number_of(const Gradient& gradient) const;

private:
    struct Hash {
        std::size_t operator()(const Gradient* gradient) const;
    };

    struct Equal {
        bool operator()(const Gradient* a, const Gradient* b) const { return *a == *b; }
    };

    std::vector<const Gradient*> gradients_;
    std::unordered_map<const Gradient*, std::size_t, Hash, Equal> numbers_;
};

/// Red, green and blue from 0 to 1, as PDF and PostScript have them.
std::string components(DrawingColor color);

/// The gradient as a pattern dictionary in a notation that PDF and PostScript of level 3 share:
/// "/PatternType 2/Shading<<...>>", without the matrix.
std::string shading_pattern(const Gradient& gradient);

/// The matrix of that pattern, "[a b c d e f]": to points on a page of that size, counted from the
/// bottom.
std::string pattern_matrix(const Gradient& gradient, PageSize page, double pixels_wide);

} // namespace vera::detail
