// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace vera {

/// Something about a scene that most likely is a mistake, though a picture can be made of it.
struct Finding {
    enum class Kind {
        no_light,            ///< no light and nothing luminous: the picture would be black
        viewpoint_in_object, ///< the view point lies inside something closed
        light_in_object,     ///< a light lies inside something opaque, and there are shadows
        all_behind_viewer    ///< no geometry before the view point
    };

    Kind kind = Kind::no_light;
    std::optional<Item> item; ///< the object in question, where there is one
    std::string problem;
    std::string remedy;
};

/// Of each material, whether an item of the scene has it.
std::vector<bool> used_materials(const Scene& scene);

/// What can be said without the text of the scene, in the order of the kinds. Cheap: no index is
/// built.
std::vector<Finding> inspect(const Scene& scene, const PictureSettings& settings);

} // namespace vera
