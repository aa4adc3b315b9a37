// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/check.h"
#include "vera/drawing/snapped_path.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace vera::detail {

/// Path data of an SVG that is as short as its grammar allows. All but its first point is relative,
/// in differences of rounded numbers: rounding does not add up.
class SvgPathWriter {
public:
    static constexpr int most_digits = 12;

    /// Adds to the text, which must outlive it, numbers of units of 10^-digits, most_digits at
    /// most.
    SvgPathWriter(std::string& text, int digits)
        : digits_(digits)
        , text_(text) {
        VERA_CHECK(digits <= most_digits);
    }

    void write(const SnappedPath& path);

    /// The same of a closed path without arcs.
    void write_ring(std::span<const SnappedPoint> points);

private:
    void begin_path(SnappedPoint point);
    void end_path();
    void write_line_to(SnappedPoint point);
    void write_arc_to(const DrawingArc& arc, SnappedPoint point);
    void write_curves_to(const DrawingArc& arc, SnappedPoint point);
    void begin(char command);
    void write_point(SnappedPoint point);
    void write(std::int64_t units, int digits);

    void write(std::int64_t units) { write(units, digits_); }

    enum class Last { command, integer, fraction };

    int digits_;
    std::string& text_;
    SnappedPoint at_;
    SnappedPoint start_;  ///< of the path
    char implied_ = '\0'; ///< the command that further numbers would repeat
    Last last_ = Last::command;
};

/// The paths as the attribute d of an SVG path.
std::string svg_path_data(std::span<const SnappedPath> paths, int digits);

} // namespace vera::detail
