// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/drawing/line_class.h"
#include "vera/visible/line_step.h"
#include "vera/visible/outline_curves.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace vera {

/// A part of a line of the drawing, straight or on a curve.
struct LinePart {
    std::array<std::uint32_t, 2> ends = {};  ///< numbers of points; of a whole ellipse the same one
    LineStep step;                           ///< along it
    std::array<std::uint32_t, 2> faces = {}; ///< beside it, or no_source
    std::uint32_t curve = no_curve;          ///< see OutlineCurves
    LineClass line_class = LineClass::silhouette;
    bool is_between_neighbours = false; ///< see LineRules::is_between_neighbours()
};

/// Parts that go on in each other: parts[i] leads from vertices[i] to the next, of a closed chain
/// the last to the first.
struct LineChain {
    std::vector<std::uint32_t> vertices;
    std::vector<std::uint32_t> parts;
    bool closed = false;
};

/// Calls visit(chain) for the parts of one class as chains, each part in one: open ones first.
/// Where more than two end at a point, those go on in each other that lie on one curve, or in one
/// straight line. Only points below point_count are used. Calls expect(count) before, if it is
/// given: so many chains there will be.
void for_each_line_chain(
    std::span<const LinePart> parts,
    LineClass line_class,
    std::size_t point_count,
    const std::function<void(LineChain chain)>& visit,
    const std::function<void(std::size_t count)>& expect = {});

} // namespace vera
