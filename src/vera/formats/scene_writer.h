// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/scene/scene.h"

#include <functional>
#include <string>
#include <string_view>

namespace vera {

/// Writes the scene as a text in the VERA scene language, piece by piece. Each number is the
/// shortest that is read as the same double, so that the text tells the scene to the bit, but for
/// this: the triangles of meshes become statements of their own, and names that are no names or are
/// given twice get a number behind them.
///
/// The scene must be one that has no need of IP, as those of generators are: the outside of faces
/// is where their normals say, and in each geometry what has no material stands first.
///
/// Tells after each piece how much has been written. Throws Cancelled.
void write_vera_scene(
    const Scene& scene,
    const std::function<void(std::string_view)>& write,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// The same as one text.
std::string vera_scene_text(const Scene& scene);

} // namespace vera
