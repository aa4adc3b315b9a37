// SPDX-License-Identifier: Apache-2.0
// The plain walk of one ray through a hierarchy of boxes, in the arithmetic of the streams that
// tree_search.cpp makes of rays that are alone.
#include "vera/accel/element_meeting.h"
#include "vera/accel/tree_structures.h"
#include "vera/accel/walk_recorder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <vector>

namespace vera::detail {

namespace {

using Outcome = WalkedObject::Outcome;

/// A subscene's tree, or the main scene's, that the ray comes to.
struct TreeVisit {
    Frame& frame;
    std::size_t place = 0;   ///< number in RayWalk::places
    std::uint32_t level = 1; ///< of its root

    const GeometryTree& tree() const { return static_cast<const GeometryTree&>(*frame.local); }
};

/// A child of a node, which waits for the ray.
struct Waiting {
    TreeChild child;
    std::uint32_t node = 0; ///< that it is a child of
    std::uint32_t level = 1;
    Box3 box; ///< local
};

Box3 child_box(const WideNode& node, std::size_t child) {
    Box3 box;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.lower[axis] = static_cast<double>(node.planes[axis][child]);
        box.upper[axis] = static_cast<double>(node.planes[3 + axis][child]);
    }
    return box;
}

/// Whether the ray meets the box of a node's child, moved outward by the slack, before its limit.
bool meets_child(const Frame& frame, const WideNode& node, std::size_t child) {
    float near = 0;
    float far = frame.limit[0];
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const float inverse = frame.inverse[axis][0];
        const float origin = frame.origin[axis][0];
        const float outward = std::copysign(frame.box_slack, inverse);
        const bool backward = inverse < 0;
        const float first = node.planes[backward ? axis + 3 : axis][child];
        const float last = node.planes[backward ? axis : axis + 3][child];
        near = std::max(near, multiply_add(first, inverse, -((origin + outward) * inverse)));
        far = std::min(far, multiply_add(last, inverse, -((origin - outward) * inverse)));
    }
    return near <= far;
}

/// In which order the ray comes to a node's children: see TreeChild.
std::size_t order_of(const PacketQuery& query, const Frame& frame) {
    if (query.purpose == Purpose::any)
        return any_order;
    std::size_t octant = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
        octant |= std::size_t{frame.inverse[axis][0] < 0} << axis;
    return octant;
}

ElementRecord record_of(const BlockRow* rows, ElementRecord::Kind kind, std::size_t i) {
    ElementRecord record;
    record.kind = kind;
    for (std::size_t j = 0; j < value_count(kind); ++j)
        record.values[j] = rows[1 + j][i];
    return record;
}

class TreeWalk {
public:
    explicit TreeWalk(PacketQuery& query)
        : query_(query) {}

    void visit(const TreeVisit& at) {
        at.frame.candidates.count = 0;
        std::vector<Waiting> stack;
        stack.push_back({TreeChild::node(0), 0, at.level, at.frame.local->local_bounds});
        while (!stack.empty() && is_active(query_)) {
            const Waiting next = stack.back();
            stack.pop_back();
            if (next.child.is_block() != 0)
                visit_block(at, next);
            else
                visit_node(at, next, stack);
        }
        if (at.frame.depth > 0)
            decide(query_, at.frame, walking_lane & query_.active);
    }

private:
    WalkStep step_at(const TreeVisit& at, const Waiting& waiting) const {
        const LocalGeometry& local = *at.frame.local;
        WalkStep step;
        step.place = at.place;
        step.level = waiting.level;
        step.box = {own_point(local, waiting.box.lower), own_point(local, waiting.box.upper)};
        return step;
    }

    void visit_node(const TreeVisit& at, const Waiting& waiting, std::vector<Waiting>& stack) {
        const auto number = static_cast<std::uint32_t>(waiting.child.first());
        const WideNode& node = at.tree().nodes[number];
        ++query_.counts.cells;
        WalkStep step = step_at(at, waiting);
        step.kind = WalkStep::Kind::node;
        step.number = number;
        query_.recorder->add(std::move(step));
        const std::size_t order = order_of(query_, at.frame);
        for (std::size_t place = 0; place < tree_width; ++place) {
            const std::size_t child = waiting_at(node, place, order);
            if (meets_child(at.frame, node, child))
                stack.push_back(
                    {node.children[child], number, waiting.level + 1, child_box(node, child)});
        }
    }

    void visit_block(const TreeVisit& at, const Waiting& waiting) {
        Frame& frame = at.frame;
        const BlockRow* const rows = at.tree().rows.data() + waiting.child.first();
        const auto kind = static_cast<ElementRecord::Kind>(waiting.child.kind());
        const std::size_t count = waiting.child.count();
        WalkStep step = step_at(at, waiting);
        step.kind = WalkStep::Kind::leaf;
        step.number = waiting.node;
        step.listed = static_cast<std::uint32_t>(count);
        const std::size_t added = query_.recorder->add(std::move(step));
        // All are tested before it is looked at what follows from that.
        std::array<ElementMeeting, block_width> met;
        std::array<std::uint32_t, block_width> elements = {};
        for (std::size_t i = 0; i < count; ++i) {
            elements[i] = std::bit_cast<std::uint32_t>(rows[0][i]);
            met[i] = element_meeting(frame, record_of(rows, kind, i));
            if (kind == ElementRecord::Kind::call)
                continue;
            ++query_.counts.tests;
            query_.recorder->add_test(added, query_, frame, elements[i]);
        }
        for (std::size_t i = 0; i < count && is_active(query_); ++i)
            if (kind == ElementRecord::Kind::call)
                visit_call(at, waiting.level, added, elements[i], met[i].may);
            else if (met[i].may)
                take_met(frame, kind, elements[i], met[i]);
    }

    void take_met(
        Frame& frame, ElementRecord::Kind kind, std::uint32_t element, const ElementMeeting& met) {
        if (element == frame.start_element[0]) {
            if (met.leaves)
                return;
        } else if (met.sure) {
            if (query_.purpose == Purpose::nearest)
                frame.limit[0] = std::min(frame.limit[0], met.far + margin_behind(frame));
            else if (ends_search(query_, frame, element))
                return block(query_, frame, walking_lane);
        }
        if (!may_wait(kind))
            return test_exactly(query_, frame, element, walking_lane);
        make_room_for_candidate(query_, frame);
        frame.candidates.near[frame.candidates.count][0] = met.near;
        add_candidate(frame, kind, element, walking_lane);
    }

    void visit_call(
        const TreeVisit& at,
        std::uint32_t level,
        std::size_t step,
        std::uint32_t element,
        bool may) {
        WalkRecorder& recorder = *query_.recorder;
        if (!may) {
            recorder.add_object(step, at.frame, element);
            return;
        }
        decide(query_, at.frame, walking_lane);
        refresh_limits(query_, at.frame, walking_lane);
        if (!is_active(query_))
            return;
        if (too_deep(at.frame))
            return recorder.add_plain_search(step, query_, at.frame, element);
        if (enter_call(query_, at.frame, element, walking_lane) == 0) {
            recorder.add_object(step, at.frame, element);
            return;
        }
        const std::size_t place = recorder.enter_call(at.place, at.frame, element);
        recorder.add_object(step, at.frame, element, Outcome::entered).place = place;
        visit({query_.frames[at.frame.depth + std::size_t{1}], place, level + 1});
        refresh_limits(query_, at.frame, walking_lane);
    }

    PacketQuery& query_;
};

} // namespace

void walk_trees(PacketQuery& query) {
    query.local_start = LocalStart::near_bounds;
    const std::size_t place = query.recorder->enter_scene();
    if (enter_scene(query) != 0)
        TreeWalk(query).visit({query.frames.front(), place, 1});
}

} // namespace vera::detail
