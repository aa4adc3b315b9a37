// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/generate/jet.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace vera {

/// A formula is wrong; what() says how.
class FormulaError : public std::runtime_error {
public:
    FormulaError(std::size_t at, std::size_t size, const std::string& problem, std::string advice)
        : std::runtime_error(problem)
        , offset(at)
        , length(size)
        , remedy(std::move(advice)) {}

    std::size_t offset; ///< of the wrong place in the formula's text
    std::size_t length;
    std::string remedy; ///< what to do; may be empty
};

/// Names for numbers, as formulas may use them.
using FormulaNames = std::map<std::string, double, std::less<>>;

/// A formula in the variables u and v: numbers, names, + - * / ^ with their usual ranks (^ binds to
/// the right and before a sign), brackets, and functions (formula_function_names()).
class Formula {
public:
    /// Throws FormulaError.
    explicit Formula(std::string_view text, const FormulaNames& names = {});

    /// The value, with derivatives; of intervals, for all u and v of these.
    Jet<double> at(double u, double v) const { return evaluated<double>(u, v); }

    Jet<Interval> at(const Interval& u, const Interval& v) const {
        return evaluated<Interval>(u, v);
    }

    /// Whether it names neither u nor v.
    bool is_constant() const;

private:
    friend class FormulaParser;

    enum class Operation : std::uint8_t {
        number,
        u,
        v,
        add,
        subtract,
        multiply,
        divide,
        power,
        whole_power,
        constant_power,
        negate,
        sine,
        cosine,
        tangent,
        exponential,
        logarithm,
        square_root,
        absolute,
        arc_tangent,
        hyperbolic_sine,
        hyperbolic_cosine,
        hyperbolic_tangent,
        angle,
        smaller,
        larger
    };

    /// Of a program for a stack of values: takes its arguments from the top and leaves its result.
    struct Step {
        Operation operation;
        double number = 0; ///< of number, whole_power and constant_power
    };

    template <typename Number>
    Jet<Number> evaluated(const Number& u, const Number& v) const;

    std::vector<Step> steps_;
};

/// The value of a formula without variables. Throws FormulaError where there is one, or where the
/// value is not finite.
double constant_value(std::string_view text, const FormulaNames& names = {});

/// Adds "NAME=FORMULA" to the names. Throws FormulaError; nothing may have two meanings.
void define_name(std::string_view definition, FormulaNames& names);

/// "abs, atan, ...": for messages and help.
std::string formula_function_names();

} // namespace vera
