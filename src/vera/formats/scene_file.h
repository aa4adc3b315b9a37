// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/scene/scene.h"

#include <vector>

namespace vera {

/// A scene as it was read, and what its author should know of it.
struct SceneFile {
    Scene scene;
    std::vector<Diagnostic> warnings;
};

} // namespace vera
