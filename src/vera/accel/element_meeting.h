// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/accel/packet_query.h"

namespace vera::detail {

/// What the cheap tests in single precision say about one ray and an element: see
/// element_tests-inl.h.
struct ElementMeeting {
    bool may = false;    ///< it may meet the element
    bool sure = false;   ///< it surely does, if it does not start there
    bool leaves = false; ///< it surely does not again, if it starts there
    float near = 0;      ///< the local distance before which it surely does not
    float far = 0;       ///< where it surely does: by which it has
};

/// Of the frame's first ray, with the bits that the searches find for it.
ElementMeeting element_meeting(const Frame& frame, const ElementRecord& record);

/// a b + c as the searches have it: rounded once where the processor does that, else twice.
float multiply_add(float a, float b, float c);

} // namespace vera::detail
