// SPDX-License-Identifier: Apache-2.0
// Files of materials that OBJ files name (mtllib).
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/formats/source_text.h"
#include "vera/scene/material.h"

#include <vector>

namespace vera {

/// The materials of a file in Wavefront's MTL, as the lighting formula has them (docs/meshes.md
/// says how), in the order of the file; of two with one name both. Throws InputError with the first
/// twenty things that are wrong; what else the author should know is added to warnings.
std::vector<Material> read_mtl(const SourceText& source, std::vector<Diagnostic>& warnings);

/// The SPC of a highlight that is half as bright where cos^exponent of the angle from the mirror
/// direction is: the formula's own highlight ends where that one only fades. An exponent below 1
/// counts as 1.
double highlight_end(double exponent);

} // namespace vera
