// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/growth_models.h"

#include "vera/math/elementary.h"
#include "vera/theory/experiment.h"
#include "vera/theory/growth.h"
#include "vera/theory/line_fit.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

namespace vera {

namespace {

constexpr std::size_t foretold = 2;

/// Logarithms of points, to base 2.
struct ModelPoints {
    explicit ModelPoints(std::span<const CountedSize> points) {
        std::vector<double> of_points;
        std::vector<double> counted;
        std::vector<double> bound;
        for (const CountedSize& point : points) {
            of_points.push_back(point.size);
            counted.push_back(point.count);
            bound.push_back(point.bound);
        }
        Logarithms logs = logarithms(of_points, counted);
        sizes = std::move(logs.of_sizes);
        counts = std::move(logs.of_counts);
        bounds = logarithms(of_points, bound).of_counts;
    }

    std::vector<double> sizes;
    std::vector<double> counts;
    std::vector<double> bounds;
};

/// The logarithm of the formula without c; of a power, of n.
double shape(ModelKind kind, const ModelPoints& points, std::size_t i) {
    switch (kind) {
    case ModelKind::linear_by_logarithm:
        return points.sizes[i] + log2_of(points.sizes[i]);
    case ModelKind::bound:
        return points.bounds[i];
    case ModelKind::linear:
    case ModelKind::power:
        break;
    }
    return points.sizes[i];
}

std::vector<double> shapes(ModelKind kind, const ModelPoints& points) {
    std::vector<double> found;
    for (std::size_t i = 0; i < points.sizes.size(); ++i)
        found.push_back(shape(kind, points, i));
    return found;
}

/// A power's own slope; that of all others is 1, of their shape.
struct FittedShape {
    FittedShape(ModelKind kind, const ModelPoints& points) {
        const std::vector<double> xs = shapes(kind, points);
        if (kind == ModelKind::power)
            slope = line_fit(xs, points.counts).slope;
        for (std::size_t i = 0; i < xs.size(); ++i)
            height += (points.counts[i] - slope * xs[i]) / static_cast<double>(xs.size());
        for (std::size_t i = 0; i < xs.size(); ++i) {
            const double rest = points.counts[i] - at(xs[i]);
            left += rest * rest;
        }
    }

    double at(double x) const { return height + slope * x; }

    double slope = 1;
    double height = 0;
    double left = 0; ///< the sum of the squares
};

double information_of(const FittedShape& fit, ModelKind kind, std::size_t points) {
    // Less is the rounding of logarithms, where all models that fit are as good.
    constexpr double least_variance = 1e-24;
    constexpr double natural = 0.69314718055994531; // ln 2
    const auto count = static_cast<double>(points);
    const double parameters = kind == ModelKind::power ? 3 : 2;
    return count * natural * log2_of(std::max(fit.left / count, least_variance)) + 2 * parameters;
}

/// Fitted to the points before the last two, of the last two.
double prediction_error_of(ModelKind kind, std::span<const CountedSize> points) {
    const auto before = points.first(points.size() - foretold);
    const FittedShape fit(kind, ModelPoints(before.subspan(first_to_fit(before.size()))));
    const ModelPoints last(points.last(foretold));
    double squares = 0;
    for (std::size_t i = 0; i < foretold; ++i) {
        const double rest = last.counts[i] - fit.at(shape(kind, last, i));
        squares += rest * rest;
    }
    return exp2_of(std::sqrt(squares / foretold)) - 1;
}

bool differ_by_a_factor(std::span<const double> a, std::span<const double> b) {
    constexpr double rounding = 1e-9;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (std::abs((a[i] - b[i]) - (a[0] - b[0])) > rounding)
            return false;
    return true;
}

std::vector<ModelKind> kinds_of(const ModelPoints& points) {
    std::vector<ModelKind> kinds = {ModelKind::linear};
    if (*std::min_element(points.sizes.begin(), points.sizes.end()) > 0)
        kinds.push_back(ModelKind::linear_by_logarithm);
    const bool is_another = std::none_of(kinds.begin(), kinds.end(), [&](ModelKind kind) {
        return differ_by_a_factor(shapes(kind, points), points.bounds);
    });
    kinds.push_back(ModelKind::power);
    if (is_another)
        kinds.push_back(ModelKind::bound);
    return kinds;
}

} // namespace

std::vector<ModelFit> model_fits(std::span<const CountedSize> points) {
    if (points.size() < least_points_of_models)
        throw std::invalid_argument("models are compared at 4 sizes or more");
    const std::span<const CountedSize> fitted = points.subspan(first_to_fit(points.size()));
    const ModelPoints logs(fitted);
    std::vector<ModelFit> models;
    for (const ModelKind kind : kinds_of(ModelPoints(points))) {
        const FittedShape fit(kind, logs);
        models.push_back(
            {kind,
             exp2_of(fit.height),
             fit.slope,
             information_of(fit, kind, fitted.size()),
             prediction_error_of(kind, points)});
    }
    const double least = best_model(models).information;
    for (ModelFit& model : models)
        model.information -= least;
    return models;
}

const ModelFit& best_model(std::span<const ModelFit> models) {
    return *std::min_element(
        models.begin(), models.end(), [](const ModelFit& a, const ModelFit& b) {
            return a.information < b.information;
        });
}

std::string model_text(const ModelFit& model, const std::string& bound) {
    switch (model.kind) {
    case ModelKind::linear:
        return "c n";
    case ModelKind::linear_by_logarithm:
        return "c n log n";
    case ModelKind::power:
        return fmt::format("c n^{:.2f}", model.exponent);
    case ModelKind::bound:
        break;
    }
    return "c (" + bound + ")";
}

} // namespace vera
