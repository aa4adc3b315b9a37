// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/formula.h"

#include "vera/base/similar_words.h"
#include "vera/base/utf8.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <numbers>

#include <fmt/format.h>

namespace vera {

namespace {

bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r';
}

std::size_t name_length(std::string_view text) {
    std::size_t length = 0;
    while (length < text.size()
           && (is_letter(text[length]) || (length > 0 && is_digit(text[length]))))
        ++length;
    return length;
}

} // namespace

/// Reads by recursive descent, a function for each rank of the operators, and writes the program
/// as it goes.
class FormulaParser {
public:
    FormulaParser(
        std::string_view text, const FormulaNames& names, std::vector<Formula::Step>& steps)
        : text_(text)
        , names_(names)
        , steps_(steps) {
        constexpr std::size_t most = 10'000;
        if (text.size() > most)
            fail(0, 1, fmt::format("the formula is longer than {} characters", most));
    }

    void parse() {
        sum();
        if (at_ < text_.size())
            fail_here("an operator", "a product is written with *, as in 2*u");
    }

    struct Function {
        std::string_view name;
        Formula::Operation operation;
        std::size_t arguments;
    };

    static constexpr std::array<Function, 15> functions = {{
        {"abs", Formula::Operation::absolute, 1},
        {"atan", Formula::Operation::arc_tangent, 1},
        {"atan2", Formula::Operation::angle, 2},
        {"cos", Formula::Operation::cosine, 1},
        {"cosh", Formula::Operation::hyperbolic_cosine, 1},
        {"exp", Formula::Operation::exponential, 1},
        {"log", Formula::Operation::logarithm, 1},
        {"max", Formula::Operation::larger, 2},
        {"min", Formula::Operation::smaller, 2},
        {"pow", Formula::Operation::power, 2},
        {"sin", Formula::Operation::sine, 1},
        {"sinh", Formula::Operation::hyperbolic_sine, 1},
        {"sqrt", Formula::Operation::square_root, 1},
        {"tan", Formula::Operation::tangent, 1},
        {"tanh", Formula::Operation::hyperbolic_tangent, 1},
    }};

    static bool is_taken(std::string_view name) {
        return name == "u" || name == "v" || name == "pi" || name == "e"
            || std::any_of(functions.begin(), functions.end(), [&](const Function& function) {
                   return function.name == name;
               });
    }

private:
    using Operation = Formula::Operation;

    [[noreturn]] static void fail(
        std::size_t offset,
        std::size_t length,
        const std::string& problem,
        std::string remedy = {}) {
        throw FormulaError(offset, length, problem, std::move(remedy));
    }

    [[noreturn]] void fail_here(std::string_view expected, std::string remedy = {}) {
        skip_space();
        if (at_ == text_.size())
            fail(at_, 1, fmt::format("expected {}, found the end", expected), std::move(remedy));
        const std::size_t name = name_length(text_.substr(at_));
        const std::size_t character = character_length(text_.substr(at_));
        const std::size_t length = std::max({name, character, std::size_t{1}});
        fail(
            at_,
            length,
            character == 0
                ? fmt::format("expected {}, found a byte that is not UTF-8", expected)
                : fmt::format("expected {}, found '{}'", expected, text_.substr(at_, length)),
            std::move(remedy));
    }

    void skip_space() {
        while (at_ < text_.size() && is_space(text_[at_]))
            ++at_;
    }

    bool take(char c) {
        skip_space();
        if (at_ == text_.size() || text_[at_] != c)
            return false;
        ++at_;
        return true;
    }

    void emit(Operation operation, double number = 0) { steps_.push_back({operation, number}); }

    void sum() {
        // Formulas may be nested only so deep that the program's own stack suffices.
        constexpr int deepest = 200;
        if (++depth_ > deepest)
            fail(at_, 1, fmt::format("brackets are nested deeper than {}", deepest));
        product();
        while (true) {
            if (take('+')) {
                product();
                emit(Operation::add);
            } else if (take('-')) {
                product();
                emit(Operation::subtract);
            } else {
                break;
            }
        }
        --depth_;
        skip_space();
    }

    void product() {
        signed_power();
        while (true) {
            if (take('*')) {
                signed_power();
                emit(Operation::multiply);
            } else if (take('/')) {
                signed_power();
                emit(Operation::divide);
            } else {
                return;
            }
        }
    }

    void signed_power() {
        bool negative = false;
        while (true) {
            if (take('-'))
                negative = !negative;
            else if (!take('+'))
                break;
        }
        power();
        if (negative)
            emit(Operation::negate);
    }

    void power() {
        constexpr int deepest = 200;
        if (++depth_ > deepest)
            fail(at_, 1, fmt::format("powers are nested deeper than {}", deepest));
        operand();
        if (take('^')) {
            const std::size_t first = steps_.size();
            signed_power();
            emit_power(first);
        }
        --depth_;
    }

    /// The steps from `first` on are those of the exponent.
    void emit_power(std::size_t first) {
        Formula exponent{std::string_view("0")};
        exponent.steps_.assign(steps_.begin() + static_cast<std::ptrdiff_t>(first), steps_.end());
        if (!exponent.is_constant())
            return emit(Operation::power);
        const double value = exponent.at(0, 0).value;
        steps_.resize(first);
        constexpr double most = 64;
        const bool whole = value == std::floor(value) && std::abs(value) <= most;
        if (whole && value < 0) {
            // 1 / a^n
            emit(Operation::whole_power, -value);
            emit(Operation::constant_power, -1);
        } else {
            emit(whole ? Operation::whole_power : Operation::constant_power, value);
        }
    }

    void operand() {
        skip_space();
        if (take('(')) {
            sum();
            if (!take(')'))
                fail_here("')' or an operator");
            return;
        }
        if (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.'))
            return number();
        if (at_ < text_.size() && is_letter(text_[at_]))
            return name();
        fail_here("a number, a name or '('");
    }

    void number() {
        double value = 0;
        const char* const begin = text_.data() + at_;
        const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), value);
        const auto length = static_cast<std::size_t>(end - begin);
        if (error == std::errc::result_out_of_range)
            fail(at_, length, "this number is too large or too small");
        if (error != std::errc())
            fail_here("a number");
        at_ += length;
        emit(Operation::number, value);
    }

    void name() {
        const std::size_t begin = at_;
        const std::string_view word = text_.substr(at_, name_length(text_.substr(at_)));
        at_ += word.size();
        if (word == "u")
            return emit(Operation::u);
        if (word == "v")
            return emit(Operation::v);
        if (word == "pi")
            return emit(Operation::number, std::numbers::pi);
        if (word == "e")
            return emit(Operation::number, std::numbers::e);
        if (const auto given = names_.find(word); given != names_.end())
            return emit(Operation::number, given->second);
        for (const Function& function : functions)
            if (function.name == word)
                return call(function);
        unknown(begin, word);
    }

    [[noreturn]] void unknown(std::size_t begin, std::string_view word) {
        std::vector<std::string> known = {"u", "v", "pi", "e"};
        for (const Function& function : functions)
            known.emplace_back(function.name);
        for (const auto& [name, value] : names_)
            known.push_back(name);
        const auto similar = most_similar(word, known);
        fail(
            begin,
            word.size(),
            fmt::format(
                "there is no '{}'{}",
                word,
                similar ? fmt::format("; did you mean '{}'?", *similar) : ""),
            fmt::format(
                "known are u, v, pi, e, names given by 'let', and {}", formula_function_names()));
    }

    void call(const Function& function) {
        if (!take('('))
            fail_here(
                fmt::format("'(' behind {}", function.name),
                fmt::format(
                    "it is a function, as in {}({})",
                    function.name,
                    function.arguments == 2 ? "u, v" : "u"));
        for (std::size_t i = 0; i < function.arguments; ++i) {
            if (i > 0 && !take(','))
                fail_here(fmt::format("',' and another argument of {}", function.name));
            const std::size_t first = steps_.size();
            sum();
            if (i == 1 && function.operation == Operation::power) {
                if (!take(')'))
                    fail_here("')' or an operator");
                return emit_power(first);
            }
        }
        if (!take(')'))
            fail_here("')' or an operator");
        emit(function.operation);
    }

    std::string_view text_;
    const FormulaNames& names_;
    std::vector<Formula::Step>& steps_;
    std::size_t at_ = 0;
    int depth_ = 0;
};

Formula::Formula(std::string_view text, const FormulaNames& names) {
    if (text == "0") {
        steps_ = {{Operation::number, 0}};
        return;
    }
    FormulaParser(text, names, steps_).parse();
}

bool Formula::is_constant() const {
    return std::none_of(steps_.begin(), steps_.end(), [](const Step& step) {
        return step.operation == Operation::u || step.operation == Operation::v;
    });
}

namespace {

template <typename Number>
Jet<Number> raised(const Jet<Number>& base, const Jet<Number>& exponent) {
    return exponential(exponent * logarithm(base));
}

template <typename Number>
Jet<Number> hyperbolic_sine(const Jet<Number>& a) {
    const Jet<Number> half = {Number(0.5)};
    return half * (exponential(a) - exponential(-a));
}

template <typename Number>
Jet<Number> hyperbolic_cosine(const Jet<Number>& a) {
    const Jet<Number> half = {Number(0.5)};
    return half * (exponential(a) + exponential(-a));
}

/// 1 - 2 / (e^2a + 1), which does not overflow.
template <typename Number>
Jet<Number> hyperbolic_tangent(const Jet<Number>& a) {
    const Jet<Number> one = {Number(1)};
    const Jet<Number> two = {Number(2)};
    return one - two / (exponential(two * a) + one);
}

} // namespace

template <typename Number>
Jet<Number> Formula::evaluated(const Number& u, const Number& v) const {
    using Value = Jet<Number>;
    std::vector<Value> stack;
    stack.reserve(16);
    const auto take = [&] {
        const Value value = stack.back();
        stack.pop_back();
        return value;
    };
    const auto one = [&](auto function) { stack.back() = function(stack.back()); };
    const auto two = [&](auto function) {
        const Value second = take();
        stack.back() = function(stack.back(), second);
    };
    for (const Step& step : steps_)
        switch (step.operation) {
        case Operation::number:
            stack.push_back({Number(step.number)});
            break;
        case Operation::u:
            stack.push_back({u, Number(1)});
            break;
        case Operation::v:
            stack.push_back({v, Number(0), Number(1)});
            break;
        case Operation::add:
            two([](const Value& a, const Value& b) { return a + b; });
            break;
        case Operation::subtract:
            two([](const Value& a, const Value& b) { return a - b; });
            break;
        case Operation::multiply:
            two([](const Value& a, const Value& b) { return a * b; });
            break;
        case Operation::divide:
            two([](const Value& a, const Value& b) { return a / b; });
            break;
        case Operation::power:
            two([](const Value& a, const Value& b) { return raised(a, b); });
            break;
        case Operation::whole_power:
            one([&](const Value& a) { return whole_power(a, static_cast<unsigned>(step.number)); });
            break;
        case Operation::constant_power:
            one([&](const Value& a) {
                return step.number == -1 ? reciprocal(a) : constant_power(a, step.number);
            });
            break;
        case Operation::negate:
            one([](const Value& a) { return -a; });
            break;
        case Operation::sine:
            one([](const Value& a) { return sine(a); });
            break;
        case Operation::cosine:
            one([](const Value& a) { return cosine(a); });
            break;
        case Operation::tangent:
            one([](const Value& a) { return sine(a) / cosine(a); });
            break;
        case Operation::exponential:
            one([](const Value& a) { return exponential(a); });
            break;
        case Operation::logarithm:
            one([](const Value& a) { return logarithm(a); });
            break;
        case Operation::square_root:
            one([](const Value& a) { return square_root(a); });
            break;
        case Operation::absolute:
            one([](const Value& a) { return absolute(a); });
            break;
        case Operation::arc_tangent:
            one([](const Value& a) { return arc_tangent(a); });
            break;
        case Operation::hyperbolic_sine:
            one([](const Value& a) { return hyperbolic_sine(a); });
            break;
        case Operation::hyperbolic_cosine:
            one([](const Value& a) { return hyperbolic_cosine(a); });
            break;
        case Operation::hyperbolic_tangent:
            one([](const Value& a) { return hyperbolic_tangent(a); });
            break;
        case Operation::angle:
            two([](const Value& y, const Value& x) { return angle_of(y, x); });
            break;
        case Operation::smaller:
            two([](const Value& a, const Value& b) { return -larger(-a, -b); });
            break;
        case Operation::larger:
            two([](const Value& a, const Value& b) { return larger(a, b); });
            break;
        }
    return stack.back();
}

template Jet<double> Formula::evaluated(const double& u, const double& v) const;
template Jet<Interval> Formula::evaluated(const Interval& u, const Interval& v) const;

double constant_value(std::string_view text, const FormulaNames& names) {
    const Formula formula(text, names);
    if (!formula.is_constant())
        throw FormulaError(0, text.size(), "u and v have no value here", "write a number");
    const double value = formula.at(0, 0).value;
    if (!std::isfinite(value))
        throw FormulaError(0, text.size(), "this has no finite value", "");
    return value;
}

void define_name(std::string_view definition, FormulaNames& names) {
    std::size_t begin = 0;
    while (begin < definition.size() && is_space(definition[begin]))
        ++begin;
    const std::string_view name = definition.substr(begin, name_length(definition.substr(begin)));
    std::size_t equals = begin + name.size();
    while (equals < definition.size() && is_space(definition[equals]))
        ++equals;
    if (name.empty() || equals == definition.size() || definition[equals] != '=')
        throw FormulaError(
            name.empty() ? begin : equals, 1, "expected a name and '='", "as in n=5");
    if (FormulaParser::is_taken(name) || names.contains(name))
        throw FormulaError(
            begin,
            name.size(),
            fmt::format("'{}' has a meaning already", name),
            "take another name");
    const std::size_t value = equals + 1;
    try {
        names.emplace(name, constant_value(definition.substr(value), names));
    } catch (const FormulaError& error) {
        throw FormulaError(error.offset + value, error.length, error.what(), error.remedy);
    }
}

std::string formula_function_names() {
    std::string list;
    for (const FormulaParser::Function& function : FormulaParser::functions)
        list += fmt::format("{}{}", list.empty() ? "" : ", ", function.name);
    return list;
}

} // namespace vera
