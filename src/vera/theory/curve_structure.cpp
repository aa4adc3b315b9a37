// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/curve_structure.h"

#include <fmt/format.h>

namespace vera {

namespace {

void add_rows(const Curve& curve, std::vector<TermRow>& rows) {
    for (const CountedSize& point : curve.points) {
        TermRow row = {point.count, {}};
        for (const BoundTerm& term : curve.experiment->terms)
            row.terms.push_back(term.value(point.variables));
        rows.push_back(std::move(row));
    }
}

CurveStructure structure(std::span<const Curve> curves) {
    CurveStructure found;
    found.experiment = curves.front().experiment;
    std::vector<TermRow> all;
    for (const Curve& curve : curves) {
        std::vector<TermRow> rows;
        add_rows(curve, rows);
        if (auto fit = structural_fit(rows)) {
            found.families.push_back(curve.experiment->family);
            found.fits.push_back(std::move(*fit));
        }
        add_rows(curve, all);
    }
    found.together = structural_fit(all);
    for (std::size_t term = 0; term < found.experiment->terms.size(); ++term)
        found.same.push_back(has_one_coefficient(found.fits, term));
    return found;
}

} // namespace

std::vector<CurveStructure> structures(std::span<const Curve> curves) {
    std::vector<CurveStructure> found;
    for (const std::span<const Curve> group : curves_by_name(curves))
        if (!group.front().experiment->terms.empty())
            found.push_back(structure(group));
    return found;
}

std::string structure_text(const Experiment& experiment) {
    std::string text;
    for (std::size_t i = 0; i < experiment.terms.size(); ++i)
        text += fmt::format("{}c{} {}", i == 0 ? "" : " + ", i + 1, experiment.terms[i].formula);
    return text;
}

std::string coefficient_text(const std::optional<TermCoefficient>& coefficient) {
    if (!coefficient)
        return "not told";
    if (coefficient->upper == 0)
        return "0 (else negative)";
    return fmt::format(
        "{:.3g} ({:.3g} to {:.3g})", coefficient->value, coefficient->lower, coefficient->upper);
}

} // namespace vera
