// SPDX-License-Identifier: Apache-2.0
// A bound of several terms, as (n + k) log n, claims more than how fast counts grow: that a count
// is c1 n log n + c2 k log n, with c1 and c2 that are the same for all inputs. They are found by
// least squares of the relative errors (each row divided by its count), with no coefficient below 0
// (Lawson and Hanson 1974). Where inputs of different families have different c, the bound holds
// and yet is not what the count is made of.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace vera {

/// What counts have of a term, and between what it is at 95 % by Student's t, cut off at 0. The
/// interval takes what is left for normal noise.
struct TermCoefficient {
    double value = 0;
    double lower = 0;
    double upper = 0;
};

/// One input: what was counted, and the terms of its bound.
struct TermRow {
    double count = 0;
    std::vector<double> terms;
};

struct StructuralFit {
    /// Of each term; nothing where the inputs do not tell it: it was 0 in all of them, or is made
    /// up of other terms.
    std::vector<std::optional<TermCoefficient>> coefficients;
    double error = 0; ///< of the fit, as a part of the counts: root of the mean square
};

/// Nothing where there are no more rows than terms that are independent of each other. Throws
/// std::invalid_argument where a count is not positive, a term is negative, or rows have different
/// numbers of terms.
std::optional<StructuralFit> structural_fit(std::span<const TermRow> rows);

/// Whether a term has the same coefficient in all fits, as far as intervals tell: each overlaps
/// each other one. Nothing where fewer than two fits tell it.
std::optional<bool> has_one_coefficient(std::span<const StructuralFit> fits, std::size_t term);

} // namespace vera
