// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/formats/text_edits.h"
#include "vera/solids/solid_findings.h"

#include <span>
#include <string_view>
#include <vector>

#include "prepared_scene.h"

namespace vera {

/// How the text of a scene is to be changed, and nothing else of it.
struct SceneFixes {
    std::vector<TextEdit> edits;
    std::size_t fixed = 0; ///< findings
    std::size_t left = 0;  ///< findings for which nothing can be proposed
};

/// What corrects the findings in the scene's first file, a VERA text: what stands twice is left
/// out, inner points move inside, the corners of turned faces change their order, and a scene
/// without light gets one from where what is seen is lit. Findings of other kinds are not counted.
/// Throws Cancelled.
SceneFixes scene_fixes(
    const PreparedScene& prepared,
    std::span<const SolidFinding> findings,
    std::string_view text,
    const CancelFlag& cancel);

} // namespace vera
