// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/diagnostic.h"
#include "vera/scene/hit.h"
#include "vera/scene/scene.h"

#include <cstdint>
#include <string>
#include <vector>

#include "item_places.h"

namespace vera {

/// What a face of the scene is, for those who wrote the scene.
struct SceneObject {
    /// A subscene that it stands in, and where that was called.
    struct Call {
        std::string subscene;
        SourcePlace place;
    };

    std::string kind;               ///< "sphere", "triangle of a mesh"
    std::uint64_t number = 0;       ///< of the primitive, from 1 in text order, subscenes expanded
    std::uint64_t triangle = 0;     ///< of a mesh, from 1; else 0
    SourcePlace place;              ///< of its statement, or of its face in an OBJ file
    std::vector<std::string> parts; ///< that its file names, from the outermost on
    std::vector<Call> calls;        ///< from the main scene inwards
};

/// Names the scene's objects. Keeps the texts of the scene's files, once they were asked about.
class SceneObjects {
public:
    explicit SceneObjects(const Scene& scene)
        : scene_(scene)
        , places_(scene) {}

    SceneObject object(FaceId face);

private:
    const Scene& scene_;
    ItemPlaces places_;
};

/// "still_life.vera:12:1"
std::string to_text(const SourcePlace& place);

/// "sphere 12 (still_life.vera:12:1)"
std::string short_name(const SceneObject& object);

/// The material's name; of a missing one "none".
std::string material_name(const Scene& scene, MaterialId material);

} // namespace vera
