// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/scene_file.h"
#include "vera/formats/source_text.h"

namespace vera {

/// A scene in Haines' Neutral File Format, with the settings that pictures of it are made with
/// (resolution, background, RTDEPTH 5) as its defaults. docs/nff.md says what becomes of what.
/// Throws InputError with the first twenty things that are wrong.
SceneFile read_nff(const SourceText& source);

} // namespace vera
