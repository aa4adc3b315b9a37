// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/generator.h"

#include "vera/base/check.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace vera {

ParameterValues::ParameterValues(const Generator& generator)
    : generator_(&generator) {
    for (const Parameter& parameter : generator.parameters)
        values_.push_back(parameter.standard);
}

std::size_t ParameterValues::number_of(std::string_view name) const {
    const auto found = std::find_if(
        generator_->parameters.begin(),
        generator_->parameters.end(),
        [&](const Parameter& parameter) { return parameter.name == name; });
    VERA_CHECK(found != generator_->parameters.end());
    return static_cast<std::size_t>(found - generator_->parameters.begin());
}

double ParameterValues::operator[](std::string_view name) const {
    return values_[number_of(name)];
}

std::size_t ParameterValues::whole(std::string_view name) const {
    return static_cast<std::size_t>((*this)[name]);
}

std::optional<std::string> ParameterValues::set(const Parameter& parameter, double value) {
    if (!(value >= parameter.least && value <= parameter.most)
        || (parameter.whole && value != std::floor(value)))
        return fmt::format(
            "{} of {} is {}, but must be a {} from {} to {}",
            parameter.name,
            generator_->name,
            value,
            parameter.whole ? "whole number" : "number",
            parameter.least,
            parameter.most);
    values_[number_of(parameter.name)] = value;
    return std::nullopt;
}

const Generator* generator_named(std::string_view name) {
    for (const Generator& generator : generators())
        if (generator.name == name)
            return &generator;
    return nullptr;
}

} // namespace vera
