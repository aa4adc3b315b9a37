// SPDX-License-Identifier: Apache-2.0
#include "curve_report.h"

#include "vera/base/version.h"
#include "vera/theory/curve_plot.h"
#include "vera/theory/curve_structure.h"

#include <algorithm>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vera {

namespace {

using Json = nlohmann::ordered_json;

std::vector<double> of_points(const Curve& curve, double CountedSize::*member) {
    std::vector<double> values;
    for (const CountedSize& point : curve.points)
        values.push_back(point.*member);
    return values;
}

const char* verdict_word(Verdict verdict) {
    return verdict == Verdict::below ? "below" : verdict == Verdict::along ? "along" : "above";
}

std::string growth_table(std::span<const Curve> curves) {
    std::string text = fmt::format(
        "{:<32} {:>20} {:>14}  {:<14} {:>6}  {:<19} {:>5}  {}\n",
        "curve",
        "sizes fitted",
        "grows as n^",
        "by a bootstrap",
        "R^2",
        "bound",
        "as n^",
        "verdict");
    for (const Curve& curve : curves)
        text += fmt::format(
            "{:<32} {:>20} {:>14}  {:<14} {:>6.4f}  {:<19} {:>5.2f}  {}{}\n",
            full_name(*curve.experiment),
            fmt::format(
                "{} to {} ({})",
                curve.fitted().front().size,
                curve.fitted().back().size,
                curve.fitted().size()),
            exponent_text(curve.growth),
            interval_text(curve.resampled.both_ways),
            curve.growth.r_squared,
            curve.experiment->bound,
            curve.bound_growth.exponent,
            verdict_text(curve.verdict),
            curve.is_contradicted()
                ? fmt::format("; the bootstrap says {}", verdict_word(curve.resampled_verdict))
                : "");
    return text;
}

/// "12.3  4 %"
std::string model_cell(const Curve& curve, ModelKind kind) {
    for (const ModelFit& model : curve.models)
        if (model.kind == kind)
            return fmt::format(
                "{:.1f} {:>4.0f} %", model.information, 100 * model.prediction_error);
    return {};
}

std::string model_table(std::span<const Curve> curves) {
    std::string text = fmt::format(
        "Formulas: Akaike's criterion above the best one's, and how far off they foretell the two "
        "largest sizes\n{:<32} {:>12} {:>12} {:>12} {:>12}  {}\n",
        "curve",
        "c n",
        "c n log n",
        "c n^p",
        "c (bound)",
        "follows");
    for (const Curve& curve : curves)
        text += fmt::format(
            "{:<32} {:>12} {:>12} {:>12} {:>12}  {}\n",
            full_name(*curve.experiment),
            model_cell(curve, ModelKind::linear),
            model_cell(curve, ModelKind::linear_by_logarithm),
            model_cell(curve, ModelKind::power),
            model_cell(curve, ModelKind::bound),
            followed_text(curve));
    return text;
}

const char* same_word(std::optional<bool> same) {
    return !same ? "not told" : *same ? "may be one" : "differs";
}

std::string structure_table(const CurveStructure& structure) {
    const Experiment& experiment = *structure.experiment;
    std::string text =
        fmt::format("Terms: {} as {}\n", experiment.name, structure_text(experiment));
    const auto add_line = [&](const std::string& label, const StructuralFit& fit) {
        text += fmt::format("  {:<14}", label);
        for (const auto& coefficient : fit.coefficients)
            text += fmt::format(" {:>24}", coefficient_text(coefficient));
        text += fmt::format("  off by {:.1f} %\n", 100 * fit.error);
    };
    for (std::size_t i = 0; i < structure.families.size(); ++i)
        add_line(structure.families[i], structure.fits[i]);
    if (structure.together && structure.families.size() > 1)
        add_line("all together", *structure.together);
    if (structure.families.size() > 1) {
        text += fmt::format("  {:<14}", "one for all");
        for (const auto& same : structure.same)
            text += fmt::format(" {:>24}", same_word(same));
        text += '\n';
    }
    return text;
}

Json as_json(const Interval& interval) {
    return {interval.lower, interval.upper};
}

Json as_json(const ModelFit& model, const std::string& bound) {
    return {
        {"formula", model_text(model, bound)},
        {"factor", model.factor},
        {"aic_above_best", model.information},
        {"prediction_error", model.prediction_error}};
}

Json variables_of(const Curve& curve) {
    Json json = Json::object();
    const std::vector<std::string>& names = curve.experiment->variables;
    for (std::size_t i = 0; i < names.size(); ++i) {
        Json values = Json::array();
        for (const CountedSize& point : curve.points)
            values.push_back(point.variables[i]);
        json[names[i]] = values;
    }
    return json;
}

Json as_json(const Curve& curve) {
    const Experiment& experiment = *curve.experiment;
    Json models = Json::array();
    for (const ModelFit& model : curve.models)
        models.push_back(as_json(model, experiment.bound));
    return {
        {"name", experiment.name},
        {"family", experiment.family},
        {"input", experiment.input},
        {"counted", experiment.counted},
        {"unit", experiment.unit},
        {"bound", experiment.bound},
        {"source", experiment.source},
        {"keeps_bound", experiment.keeps_bound},
        {"sizes", of_points(curve, &CountedSize::size)},
        {"counts", of_points(curve, &CountedSize::count)},
        {"bounds", of_points(curve, &CountedSize::bound)},
        {"variables", variables_of(curve)},
        {"local_exponents", curve.local_exponents()},
        {"first_fitted", curve.fitted().front().size},
        {"exponent", curve.growth.exponent},
        {"half_interval", curve.growth.half_interval},
        {"bootstrap_interval", as_json(curve.resampled.both_ways)},
        {"r_squared", curve.growth.r_squared},
        {"bound_exponent", curve.bound_growth.exponent},
        {"excess", curve.excess.exponent},
        {"excess_uncertainty", curve.excess.uncertainty},
        {"excess_bootstrap_interval", as_json(curve.resampled_excess.one_way)},
        {"verdict", verdict_word(curve.verdict)},
        {"bootstrap_verdict", verdict_word(curve.resampled_verdict)},
        {"models", models},
        {"follows", model_text(best_model(curve.models), experiment.bound)}};
}

Json as_json(const StructuralFit& fit) {
    Json coefficients = Json::array();
    for (const auto& found : fit.coefficients)
        coefficients.push_back(
            found
                ? Json{{"value", found->value}, {"interval", as_json(Interval{found->lower, found->upper})}}
                : Json(nullptr));
    return {{"coefficients", coefficients}, {"error", fit.error}};
}

Json as_json(const CurveStructure& structure) {
    Json json = {
        {"name", structure.experiment->name},
        {"terms", Json::array()},
        {"families", Json::array()},
        {"together", structure.together ? as_json(*structure.together) : Json(nullptr)},
        {"one_for_all", Json::array()}};
    for (const BoundTerm& term : structure.experiment->terms)
        json["terms"].push_back(term.formula);
    for (std::size_t i = 0; i < structure.families.size(); ++i) {
        Json family = {{"family", structure.families[i]}};
        family.update(as_json(structure.fits[i]));
        json["families"].push_back(family);
    }
    for (const auto& same : structure.same)
        json["one_for_all"].push_back(same ? Json(*same) : Json(nullptr));
    return json;
}

/// Of all bounds, each once.
std::vector<std::string> variable_names(std::span<const Curve> curves) {
    std::vector<std::string> names;
    for (const Curve& curve : curves)
        for (const std::string& name : curve.experiment->variables)
            if (std::find(names.begin(), names.end(), name) == names.end())
                names.push_back(name);
    return names;
}

/// "," and the value for each name; nothing where the curve has no such variable.
std::string variable_cells(
    const Experiment& experiment, const CountedSize& point, std::span<const std::string> names) {
    std::string text;
    for (const std::string& name : names) {
        text += ',';
        for (std::size_t i = 0; i < experiment.variables.size(); ++i)
            if (experiment.variables[i] == name)
                text += fmt::format("{}", point.variables[i]);
    }
    return text;
}

} // namespace

std::string curve_tables(std::span<const Curve> curves) {
    std::string text = growth_table(curves) + "\n" + model_table(curves);
    for (const CurveStructure& structure : structures(curves))
        text += "\n" + structure_table(structure);
    return text;
}

std::string curve_csv(std::span<const Curve> curves) {
    const std::vector<std::string> names = variable_names(curves);
    std::string text = "curve,size,count,bound,local_exponent,fitted";
    for (const std::string& name : names)
        text += "," + name;
    text += "\n";
    for (const Curve& curve : curves) {
        const std::vector<double> locals = curve.local_exponents();
        for (std::size_t i = 0; i < curve.points.size(); ++i)
            text += fmt::format(
                "{},{},{},{:.6g},{},{}{}\n",
                full_name(*curve.experiment),
                curve.points[i].size,
                curve.points[i].count,
                curve.points[i].bound,
                i == 0 ? "" : fmt::format("{:.4f}", locals[i - 1]),
                i >= curve.first_fitted ? 1 : 0,
                variable_cells(*curve.experiment, curve.points[i], names));
    }
    return text;
}

std::string curve_json(std::span<const Curve> curves, std::uint64_t seed) {
    Json json = {
        {"version", 1},
        {"program", fmt::format("vera {}", version)},
        {"seed", seed},
        {"curves", Json::array()},
        {"structures", Json::array()}};
    for (const Curve& curve : curves)
        json["curves"].push_back(as_json(curve));
    for (const CurveStructure& structure : structures(curves))
        json["structures"].push_back(as_json(structure));
    return json.dump(2);
}

} // namespace vera
