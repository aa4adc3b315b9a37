// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/image_file.h"

#include "prepared_scene.h"

namespace vera {

/// What a picture of the scene says of itself: the program, a hash of the files that the scene was
/// read from, the settings as a control text ("Settings"), and the camera.
PictureMetadata picture_metadata(const PreparedScene& prepared);

} // namespace vera
