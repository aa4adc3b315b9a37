// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/made_parts.h"

#include "vera/formats/vera_keywords.h"
#include "vera/generate/formula_shapes.h"
#include "vera/generate/surface.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>

#include <fmt/format.h>

namespace vera {

namespace {

constexpr std::string_view surface_name = "surface";
constexpr std::array<std::string_view, 4> surface_parameters = {"u", "v", "let", "deviation"};

bool is_parameter_like(std::string_view word) {
    return !word.empty() && word[0] >= 'a' && word[0] <= 'z';
}

std::string listed(const std::vector<std::string_view>& words) {
    std::string list;
    for (const std::string_view word : words)
        list += fmt::format("{}{}", list.empty() ? "" : ", ", word);
    return list;
}

void complain_of_parameter(WordReader& words, std::string_view name) {
    const std::vector<std::string_view> known = parameter_words(name);
    const std::string_view word = words.peek();
    words.complaints().error(
        words.place(),
        fmt::format("{} has no parameter {}{}", name, shown(word), did_you_mean(word, known)),
        known.empty() ? fmt::format("{} has none", name)
                      : fmt::format("its parameters are {}", listed(known)));
}

void complain_of_generator(WordReader& words, std::string_view name) {
    std::vector<std::string_view> known = {surface_name};
    for (const Generator& generator : generators())
        known.push_back(generator.name);
    std::sort(known.begin(), known.end());
    words.complaints().error(
        words.last_place(),
        fmt::format("there is no generator {}{}", shown(name), did_you_mean(name, known)),
        fmt::format("there are {}", listed(known)));
}

/// Where the parameters of a statement stand.
using GivenParameters = std::map<std::string_view, WordPlace>;

/// Whether the word that was taken last is there for the first time; complains where it is not.
bool is_first(WordReader& words, std::string_view word, GivenParameters& given) {
    const auto [entry, first] = given.try_emplace(word, words.last_place());
    if (!first) {
        const SourcePlace place = source_place(entry->second);
        words.complaints().error(
            words.last_place(),
            fmt::format("{} is given twice", word),
            fmt::format(
                "the first is at {}:{}:{}; keep one of them",
                place.file,
                place.line,
                place.column));
    }
    return first;
}

std::optional<MadePart> read_numbers(WordReader& words, const Generator& generator) {
    MadePart part = {
        std::string(generator.name), std::string(generator.name), words.last_place(), {}};
    ParameterValues values(generator);
    GivenParameters given;
    while (is_parameter_like(words.peek())) {
        const std::string_view word = words.peek();
        const auto parameter = std::find_if(
            generator.parameters.begin(), generator.parameters.end(), [&](const Parameter& known) {
                return known.name == word;
            });
        if (parameter == generator.parameters.end()) {
            complain_of_parameter(words, generator.name);
            return std::nullopt;
        }
        words.take();
        if (!is_first(words, parameter->name, given))
            return std::nullopt;
        const WordPlace place = words.place();
        const auto value = words.take_number(fmt::format("the {}", parameter->name).c_str());
        if (!value)
            return std::nullopt;
        if (const auto problem = values.set(*parameter, *value)) {
            words.complaints().error(place, *problem, std::string(parameter->meaning));
            return std::nullopt;
        }
    }
    for (const Parameter& parameter : generator.parameters)
        part.key += fmt::format(" {}", values[parameter.name]);
    part.make = [&generator, values] { return generator.make(values); };
    return part;
}

/// Reads MK surface "x" "y" "z" {u FROM TO | v FROM TO | let "name=value" | deviation LENGTH}.
class SurfaceReader {
public:
    explicit SurfaceReader(WordReader& words)
        : words_(words) {
        part_.name = part_.key = surface_name;
        part_.place = words.last_place();
    }

    std::optional<MadePart> read() {
        std::array<Text, 3> formulas;
        for (Text& formula : formulas)
            if (!take_text(formula))
                return std::nullopt;
        while (is_parameter_like(words_.peek()))
            if (!take_parameter())
                return std::nullopt;
        std::array<std::optional<Formula>, 3> parsed;
        for (std::size_t i = 0; i < 3; ++i)
            if (!(parsed[i] = understood(
                      formulas[i], [&](std::string_view text) { return Formula(text, names_); })))
                return std::nullopt;
        finish({.x = *parsed[0], .y = *parsed[1], .z = *parsed[2]});
        return part_;
    }

private:
    struct Text {
        std::string_view text;
        WordPlace place; ///< of the first quote
    };

    using Range = std::array<double, 2>;

    bool take_text(Text& text) {
        text.place = words_.place();
        const auto taken = words_.take_quoted("formula", "as in \"cos(u)*v\"");
        if (!taken)
            return false;
        text.text = *taken;
        part_.key += fmt::format(" \"{}\"", *taken);
        return true;
    }

    /// What the reader makes of a text; where that is wrong, complains at the place within it.
    template <typename Reader>
    auto understood(const Text& text, const Reader& reader)
        -> std::optional<decltype(reader(text.text))> {
        try {
            return reader(text.text);
        } catch (const FormulaError& error) {
            WordPlace place = text.place;
            place.offset += 1 + error.offset;
            place.length = error.length;
            words_.complaints().error(place, error.what(), error.remedy);
            return std::nullopt;
        }
    }

    bool take_parameter() {
        const std::string_view word = words_.peek();
        if (std::find(surface_parameters.begin(), surface_parameters.end(), word)
            == surface_parameters.end()) {
            complain_of_parameter(words_, surface_name);
            return false;
        }
        words_.take();
        if (word != "let" && !is_first(words_, word, given_))
            return false;
        part_.key += fmt::format(" {}", word);
        if (word == "u")
            return take_range(u_);
        if (word == "v")
            return take_range(v_);
        if (word == "let") {
            Text text;
            return take_text(text) && understood(text, [&](std::string_view definition) {
                       define_name(definition, names_);
                       return true;
                   });
        }
        return take_deviation();
    }

    /// A number, or a formula between quotes.
    bool take_value(double& value) {
        if (words_.peek().starts_with('"')) {
            Text text;
            if (!take_text(text))
                return false;
            const auto known = understood(
                text, [&](std::string_view formula) { return constant_value(formula, names_); });
            value = known.value_or(0);
            return known.has_value();
        }
        const auto number = words_.take_number("an end of the range, or a formula in quotes");
        value = number.value_or(0);
        part_.key += fmt::format(" {}", value);
        return number.has_value();
    }

    bool take_range(Range& range) {
        const WordPlace place = words_.last_place();
        if (!take_value(range[0]) || !take_value(range[1]))
            return false;
        if (range[0] < range[1])
            return true;
        words_.complaints().error(
            place,
            fmt::format(
                "the range goes from {} to {}, but must go from a smaller to a larger number",
                range[0],
                range[1]));
        return false;
    }

    bool take_deviation() {
        const WordPlace place = words_.place();
        deviation_ = words_.take_number("the deviation");
        if (!deviation_)
            return false;
        part_.key += fmt::format(" {}", *deviation_);
        if (*deviation_ > 0)
            return true;
        words_.complaints().error(
            place,
            "the deviation must be positive",
            "it is the length by which triangles may lie off the surface");
        return false;
    }

    void finish(Surface surface) {
        surface.u_begin = u_[0];
        surface.u_end = u_[1];
        surface.v_begin = v_[0];
        surface.v_end = v_[1];
        part_.make = [surface = std::move(surface), deviation = deviation_] {
            constexpr double standard = 1.0 / 2000; // of the size
            const Box3 box = sampled_bounds(surface);
            const double size = box.empty() ? 1 : length(box.upper - box.lower);
            return mesh_scene(tessellated(
                surface, {.allowed = deviation_of(deviation.value_or(standard * size))}));
        };
    }

    WordReader& words_;
    MadePart part_;
    FormulaNames names_;
    GivenParameters given_;
    Range u_ = {0, 1};
    Range v_ = {0, 1};
    std::optional<double> deviation_;
};

} // namespace

std::vector<std::string_view> parameter_words(std::string_view generator) {
    if (generator == surface_name)
        return {surface_parameters.begin(), surface_parameters.end()};
    std::vector<std::string_view> words;
    if (const Generator* const known = generator_named(generator))
        for (const Parameter& parameter : known->parameters)
            words.push_back(parameter.name);
    return words;
}

std::optional<MadePart> read_made_part(WordReader& words) {
    const auto name = words.take_name("the name of a generator", scene_words);
    if (!name)
        return std::nullopt;
    if (*name == surface_name)
        return SurfaceReader(words).read();
    if (const Generator* const generator = generator_named(*name))
        return read_numbers(words, *generator);
    complain_of_generator(words, *name);
    return std::nullopt;
}

} // namespace vera
