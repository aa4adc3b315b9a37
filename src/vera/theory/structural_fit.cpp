// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/structural_fit.h"

#include "vera/math/bounded_least_squares.h"
#include "vera/theory/line_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace vera {

namespace {

using Columns = std::vector<std::vector<double>>;

/// Of a column made up of others, rounding leaves some 1e-16 of its length.
constexpr double rounding = 1e-10;

void require_rows(std::span<const TermRow> rows) {
    for (const TermRow& row : rows) {
        if (!(row.count > 0))
            throw std::invalid_argument("terms are fitted to positive counts");
        if (row.terms.size() != rows.front().terms.size())
            throw std::invalid_argument("terms are fitted to rows of as many terms each");
        if (std::any_of(
                row.terms.begin(), row.terms.end(), [](double term) { return !(term >= 0); }))
            throw std::invalid_argument("the terms of a bound are not negative");
    }
}

/// A term in all rows, divided by their counts.
std::vector<double> scaled_column(std::span<const TermRow> rows, std::size_t term) {
    std::vector<double> column;
    for (const TermRow& row : rows)
        column.push_back(row.terms[term] / row.count);
    return column;
}

double dot(std::span<const double> a, std::span<const double> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
    return sum;
}

bool is_nothing_beside(std::span<const double> rest, std::span<const double> whole) {
    return dot(rest, rest) <= rounding * rounding * dot(whole, whole);
}

/// What is left of a column beside others: made perpendicular to them, one after the other.
std::vector<double> beside(std::vector<double> column, const Columns& columns) {
    Columns others = columns;
    for (std::size_t i = 0; i < others.size(); ++i) {
        const std::vector<double>& other = others[i];
        if (is_nothing_beside(other, columns[i]))
            continue; // made up of those before it
        const double square = dot(other, other);
        const auto take_away = [&](std::vector<double>& from) {
            const double part = dot(from, other) / square;
            for (std::size_t row = 0; row < from.size(); ++row)
                from[row] -= part * other[row];
        };
        for (std::size_t later = i + 1; later < others.size(); ++later)
            take_away(others[later]);
        take_away(column);
    }
    return column;
}

Columns without(const Columns& columns, std::size_t left_out) {
    Columns rest = columns;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left_out));
    return rest;
}

bool is_made_up_of(const std::vector<double>& column, const Columns& others) {
    return is_nothing_beside(beside(column, others), column);
}

/// The x >= 0 for which the columns by x are nearest to 1.
std::vector<double> nearest_not_below_0(const Columns& columns) {
    const std::size_t rows = columns.front().size();
    BoundedLeastSquares problem;
    problem.columns = columns.size();
    problem.right.assign(rows, 1);
    for (std::size_t row = 0; row < rows; ++row)
        for (const std::vector<double>& column : columns)
            problem.matrix.push_back(column[row]);
    problem.least.assign(columns.size(), 0);
    problem.most.assign(columns.size(), std::numeric_limits<double>::infinity());
    return solution(problem);
}

/// The sum of the squares of what columns by x leave of 1.
double square_left(const Columns& columns, std::span<const double> x) {
    double sum = 0;
    for (std::size_t row = 0; row < columns.front().size(); ++row) {
        double rest = 1;
        for (std::size_t i = 0; i < columns.size(); ++i)
            rest -= columns[i][row] * x[i];
        sum += rest * rest;
    }
    return sum;
}

/// Of independent columns, with coefficients of any sign: the coefficient of each is that of what
/// is left of its column beside the others (Frisch and Waugh 1933), and as sure as that is long.
std::vector<TermCoefficient> free_coefficients(const Columns& columns) {
    const std::size_t rows = columns.front().size();
    const std::vector<double> ones(rows, 1);
    std::vector<double> values;
    std::vector<double> squares;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const std::vector<double> rest = beside(columns[i], without(columns, i));
        squares.push_back(dot(rest, rest));
        values.push_back(dot(rest, ones) / squares.back());
    }
    const std::size_t freedom = rows - columns.size();
    const double variance = square_left(columns, values) / static_cast<double>(freedom);
    std::vector<TermCoefficient> found;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        const double half = student_both_ways(freedom) * std::sqrt(variance / squares[i]);
        found.push_back({values[i], values[i] - half, values[i] + half});
    }
    return found;
}

/// Of independent columns. Those above 0 have the interval of the fit of them alone; one at 0
/// reaches as far up as that of the fit which may go below.
std::vector<TermCoefficient> coefficients_not_below_0(const Columns& columns) {
    const std::vector<double> values = nearest_not_below_0(columns);
    Columns above;
    for (std::size_t i = 0; i < columns.size(); ++i)
        if (values[i] > 0)
            above.push_back(columns[i]);
    std::vector<TermCoefficient> found = free_coefficients(columns);
    const std::vector<TermCoefficient> alone = free_coefficients(above);
    auto next = alone.begin();
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if (values[i] > 0) {
            found[i] = {values[i], std::max(next->lower, 0.0), next->upper};
            ++next;
        } else {
            found[i] = {0, 0, std::max(found[i].upper, 0.0)};
        }
    }
    return found;
}

} // namespace

std::optional<StructuralFit> structural_fit(std::span<const TermRow> rows) {
    require_rows(rows);
    const std::size_t terms = rows.empty() ? 0 : rows.front().terms.size();
    Columns met;
    std::vector<std::size_t> term_of;
    for (std::size_t term = 0; term < terms; ++term) {
        std::vector<double> column = scaled_column(rows, term);
        if (dot(column, column) == 0)
            continue;
        met.push_back(std::move(column));
        term_of.push_back(term);
    }
    Columns independent;
    std::vector<std::size_t> kept;
    for (std::size_t i = 0; i < met.size(); ++i)
        if (!is_made_up_of(met[i], independent)) {
            independent.push_back(met[i]);
            kept.push_back(i);
        }
    if (independent.empty() || rows.size() <= independent.size())
        return std::nullopt;
    const std::vector<TermCoefficient> found = coefficients_not_below_0(independent);
    StructuralFit fit;
    fit.coefficients.resize(terms);
    std::vector<double> values;
    for (std::size_t i = 0; i < kept.size(); ++i) {
        values.push_back(found[i].value);
        if (!is_made_up_of(met[kept[i]], without(met, kept[i])))
            fit.coefficients[term_of[kept[i]]] = found[i];
    }
    fit.error = std::sqrt(square_left(independent, values) / static_cast<double>(rows.size()));
    return fit;
}

std::optional<bool> has_one_coefficient(std::span<const StructuralFit> fits, std::size_t term) {
    double highest_lower = 0;
    double lowest_upper = std::numeric_limits<double>::infinity();
    std::size_t told = 0;
    for (const StructuralFit& fit : fits)
        if (const auto& coefficient = fit.coefficients[term]) {
            highest_lower = std::max(highest_lower, coefficient->lower);
            lowest_upper = std::min(lowest_upper, coefficient->upper);
            ++told;
        }
    if (told < 2)
        return std::nullopt;
    return highest_lower <= lowest_upper;
}

} // namespace vera
