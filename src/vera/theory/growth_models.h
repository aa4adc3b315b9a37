// SPDX-License-Identifier: Apache-2.0
// Which formula counts follow: c n, c n log n, c n^p with a power of its own, or c times the bound.
// Over few doublings a logarithm looks like a small power, and a fitted power says nothing about
// that. All are fitted by least squares of the logarithms, and compared in two ways: by Akaike's
// information criterion (Akaike 1974), N ln(left / N) + 2 k for k parameters, the variance of what
// is left one of them; and by what they foretell of the two largest sizes when fitted without
// these.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace vera {

struct CountedSize;

enum class ModelKind { linear, linear_by_logarithm, power, bound };

struct ModelFit {
    ModelKind kind = ModelKind::linear;
    double factor = 0;           ///< c
    double exponent = 0;         ///< of a power: p
    double information = 0;      ///< Akaike's criterion, above that of the best model: 0 or more
    double prediction_error = 0; ///< at the two largest sizes, as a part: 0.1 is off by a tenth
};

/// Models whose criteria differ by no more are not told apart (Burnham and Anderson 2002).
constexpr double told_apart_from = 2;

/// The formula: "c n", "c n log n", "c n^0.98" or "c (bound)", with the bound's own formula.
std::string model_text(const ModelFit& model, const std::string& bound);

constexpr std::size_t least_points_of_models = 4;

/// Of 4 points or more, by size: those that are fitted of them, in the order of the kinds. What is
/// foretold of the last two is by the points that would be fitted if these were not there. The
/// bound is left out where it is one of the first two, and n log n where a size is not above 1.
/// Throws std::invalid_argument as growth() does.
std::vector<ModelFit> model_fits(std::span<const CountedSize> points);

/// The one of the least criterion; of several, the first.
const ModelFit& best_model(std::span<const ModelFit> models);

} // namespace vera
