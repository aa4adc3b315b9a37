// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/formats/scene_file.h"
#include "vera/formats/source_text.h"
#include "vera/formats/vera_scene.h"

#include <string>
#include <vector>

namespace vera {

/// The scene of a text named "test.vera".
inline SceneFile read_text(const std::string& text, const SceneLimits& limits = {}) {
    return read_vera_scene(SourceText("test.vera", text), limits);
}

/// What is said of a text, as it is printed: warnings, or when it is wrong, all diagnostics.
inline std::string said_of(const std::string& text, const SceneLimits& limits = {}) {
    std::vector<Diagnostic> diagnostics;
    try {
        diagnostics = read_text(text, limits).warnings;
    } catch (const InputError& error) {
        diagnostics = error.diagnostics();
    }
    std::string said;
    for (const Diagnostic& diagnostic : diagnostics)
        said += to_text(diagnostic);
    return said;
}

/// The text after a view and a material that have nothing wrong, all in line 1, and with a sphere
/// behind it, so that only what is wrong with the text itself is said.
inline std::string within_scene(const std::string& text) {
    return "PROJECTION 0 0 9 -1 -1 0 1 -1 0 -1 1 0 CM m MA m\n" + text + "\nSP 0 0 0 1\n";
}

} // namespace vera
