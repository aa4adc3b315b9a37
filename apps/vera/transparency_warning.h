// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/formats/read_scene.h"
#include "vera/scene/scene.h"

#include <optional>

namespace vera {

/// Tells once where a drawing shows something else than the lighting formula gives for what the
/// viewer meets first: of materials that let light through. Where the first of them is used.
/// The remedy is in the words of the scene's format.
std::optional<Diagnostic> transparency_warning(const Scene& scene, SceneFormat format);

} // namespace vera
