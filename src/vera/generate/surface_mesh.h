// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/generate/surface.h"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace vera::detail {

/// A rectangle of u and v, in steps of a ParameterGrid.
struct ParameterCell {
    std::uint32_t u_begin = 0;
    std::uint32_t u_end = 0;
    std::uint32_t v_begin = 0;
    std::uint32_t v_end = 0;
};

/// The cell cut in the middle, across u or across v; that side must be longer than one step.
std::pair<ParameterCell, ParameterCell> halves(const ParameterCell& cell, bool across_u);

/// The ranges of u and v of a surface in 2^28 steps each, so that places are compared exactly.
class ParameterGrid {
public:
    static constexpr std::uint32_t steps = 1U << 28U;

    explicit ParameterGrid(const Surface& surface)
        : surface_(surface) {}

    double u(std::uint32_t step) const { return at(surface_.u_begin, surface_.u_end, step); }

    double v(std::uint32_t step) const { return at(surface_.v_begin, surface_.v_end, step); }

    /// Of x, y and z.
    template <typename Number>
    std::array<Jet<Number>, 3> jets(const Number& u, const Number& v) const {
        return {surface_.x.at(u, v), surface_.y.at(u, v), surface_.z.at(u, v)};
    }

    std::vector<ParameterCell> first_cells() const;

    /// The lengths of the ranges.
    double u_range() const { return surface_.u_end - surface_.u_begin; }

    double v_range() const { return surface_.v_end - surface_.v_begin; }

private:
    /// Not farther than the end, and the end itself at the last step.
    static double at(double begin, double end, std::uint32_t step) {
        return step == steps ? end : begin + (end - begin) * (static_cast<double>(step) / steps);
    }

    const Surface& surface_;
};

/// Triangles of cells that cover the ranges without overlap. Every corner of a cell that lies on
/// another one's side is a corner of its triangles too. Throws SurfaceError where the rounding of a
/// corner is not small beside what is allowed there.
Mesh mesh_of_cells(
    const ParameterGrid& grid,
    const std::vector<ParameterCell>& cells,
    const AllowedDeviation& allowed);

} // namespace vera::detail
