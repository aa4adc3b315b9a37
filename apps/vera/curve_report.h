// SPDX-License-Identifier: Apache-2.0
// What vera bench curve tells of curves: tables for people, points as CSV, and everything as JSON.
#pragma once

#include "vera/theory/curve.h"

#include <cstdint>
#include <span>
#include <string>

namespace vera {

/// How fast each grows beside its bound; which formula it follows; and, where a bound has terms,
/// what each family has of them.
std::string curve_tables(std::span<const Curve> curves);

/// A line for each size, with a column for each variable of the bounds.
std::string curve_csv(std::span<const Curve> curves);

/// Documented in docs/json.md.
std::string curve_json(std::span<const Curve> curves, std::uint64_t seed);

} // namespace vera
