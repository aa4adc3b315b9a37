// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/scene_file.h"
#include "vera/formats/scene_limits.h"
#include "vera/formats/source_text.h"

namespace vera {

/// The scene that a text in the VERA scene language describes (docs/language.md). The files that it
/// names are looked for beside the one that the text is named after. Throws InputError with all
/// that is wrong.
SceneFile read_vera_scene(const SourceText& text, const SceneLimits& limits = {});

} // namespace vera
