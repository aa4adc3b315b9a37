// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/element_meeting.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "vera/accel/element_meeting.cpp"
#include <hwy/foreach_target.h>
// Behind the line above, which includes this file once for each instruction set.
#include "vera/accel/element_tests-inl.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();

namespace vera::detail::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using One = hn::CappedTag<float, 1>;

ElementMeeting element_meeting_kernel(const Frame& frame, const ElementRecord& record) {
    const One d;
    const auto first = [&](const Frame::Row& row) HWY_ATTR { return hn::Set(d, row[0]); };
    const TestedRays<One> ray = {
        {first(frame.origin[0]), first(frame.origin[1]), first(frame.origin[2])},
        {first(frame.direction[0]), first(frame.direction[1]), first(frame.direction[2])},
        {first(frame.inverse[0]), first(frame.inverse[1]), first(frame.inverse[2])},
        first(frame.limit),
        frame.slack,
        frame.double_slack};
    hn::Vec<One> values[11];
    for (std::size_t i = 0; i < 11; ++i)
        values[i] = hn::Set(d, record.values[i]);
    const auto met = meeting(d, ray, record.kind, values);
    return {
        hn::AllTrue(d, met.may),
        hn::AllTrue(d, met.sure),
        hn::AllTrue(d, surely_leaves(d, ray, record.kind, values)),
        hn::GetLane(met.near),
        hn::GetLane(met.far)};
}

float multiply_add_kernel(float a, float b, float c) {
    const One d;
    return hn::GetLane(hn::MulAdd(hn::Set(d, a), hn::Set(d, b), hn::Set(d, c)));
}

} // namespace vera::detail::HWY_NAMESPACE

HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace vera::detail {

HWY_EXPORT(element_meeting_kernel);
HWY_EXPORT(multiply_add_kernel);

ElementMeeting element_meeting(const Frame& frame, const ElementRecord& record) {
    return HWY_DYNAMIC_DISPATCH(element_meeting_kernel)(frame, record);
}

float multiply_add(float a, float b, float c) {
    return HWY_DYNAMIC_DISPATCH(multiply_add_kernel)(a, b, c);
}

} // namespace vera::detail

#endif
