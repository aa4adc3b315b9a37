// SPDX-License-Identifier: Apache-2.0
// What the terms of a bound have of what is counted, in each family of inputs and in all together.
#pragma once

#include "vera/theory/curve.h"
#include "vera/theory/structural_fit.h"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vera {

/// Of the curves of one name.
struct CurveStructure {
    const Experiment* experiment = nullptr; ///< the first one, for the terms
    std::vector<std::string> families;      ///< those with points enough
    std::vector<StructuralFit> fits;        ///< of each
    std::optional<StructuralFit> together;  ///< of all points
    std::vector<std::optional<bool>> same;  ///< of each term: as has_one_coefficient()
};

/// Of each name whose bound has terms, by all points: small ones tell the terms of lower order.
std::vector<CurveStructure> structures(std::span<const Curve> curves);

/// "c1 n log n + c2 k log n"
std::string structure_text(const Experiment& experiment);

/// "1.23 (1.2 to 1.26)", "0 (else negative)" where the whole interval was below 0 before it was cut
/// off, or "not told".
std::string coefficient_text(const std::optional<TermCoefficient>& coefficient);

} // namespace vera
