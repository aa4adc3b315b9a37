// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/generate/stage.h"
#include "vera/scene/scene.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vera {

/// A number that a generator takes.
struct Parameter {
    std::string_view name;
    double standard = 0; ///< its value where none is given
    double least = 0;
    double most = 0;
    bool whole = false;
    std::string_view meaning;
};

struct Generator;

/// A value for each parameter of a generator.
class ParameterValues {
public:
    /// The standard values.
    explicit ParameterValues(const Generator& generator);

    /// The generator must have the parameter.
    double operator[](std::string_view name) const;
    std::size_t whole(std::string_view name) const;

    /// Why the parameter cannot have the value, in words for people; nothing where it now has it.
    std::optional<std::string> set(const Parameter& parameter, double value);

    friend bool operator==(const ParameterValues& a, const ParameterValues& b) {
        return a.generator_ == b.generator_ && a.values_ == b.values_;
    }

private:
    std::size_t number_of(std::string_view name) const;

    const Generator* generator_;
    std::vector<double> values_; ///< in the order of the generator's parameters
};

/// Makes a scene of parameters: the same for the same values, on every machine. Its geometry stands
/// on y = 0 or about the origin, y is up; it has no camera and no lights. What has no material is
/// to get the material of the place where the scene is put.
struct Generator {
    std::string_view name;
    std::string_view summary; ///< one line
    std::span<const Parameter> parameters;
    Scene (*make)(const ParameterValues& values);
    Stage stage; ///< on which it looks well
};

/// All generators of numbers alone, in the order of their names.
std::span<const Generator> generators();

/// Null when there is none of the name.
const Generator* generator_named(std::string_view name);

} // namespace vera
