// SPDX-License-Identifier: Apache-2.0
#pragma once

/// The attributes of a file of layers beside those of pictures (docs/explaining.md).
namespace vera::layer_attributes {

inline constexpr const char* settings = "Settings";
inline constexpr const char* encoding = "Encoding";
inline constexpr const char* sum = "Sum";
inline constexpr const char* light_factors = "Light factors";
inline constexpr const char* ambient = "Ambient";
inline constexpr const char* materials = "Materials";

} // namespace vera::layer_attributes
