// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/box_faces.h"

#include "vera/exact/wide_integer.h"

#include <stdexcept>
#include <string>
#include <tuple>

namespace vera {

namespace {

/// The axis that plays x, y or z, where this one plays z.
std::size_t turned(std::size_t axis, std::size_t role) {
    return (axis + 1 + role) % 3;
}

WholeRay turned(std::size_t axis, const WholeRay& ray) {
    WholeRay found;
    for (std::size_t role = 0; role < 3; ++role) {
        found.origin[role] = ray.origin[turned(axis, role)];
        found.direction[role] = ray.direction[turned(axis, role)];
    }
    return found;
}

std::vector<IsoRectangle> faces_across(std::size_t axis, std::span<const WholeBox> boxes) {
    const std::size_t x = turned(axis, 0);
    const std::size_t y = turned(axis, 1);
    std::vector<IsoRectangle> faces;
    faces.reserve(2 * boxes.size());
    for (const WholeBox& box : boxes)
        for (const std::int32_t z : {box.lower[axis], box.upper[axis]})
            faces.push_back({z, box.lower[x], box.upper[x], box.lower[y], box.upper[y]});
    return faces;
}

/// How far along the ray a face lies, in units of its direction: distance / speed.
struct Way {
    std::int64_t distance = 0;
    std::int64_t speed = 1; ///< positive

    friend bool operator<(Way a, Way b) {
        return Int128{a.distance} * b.speed < Int128{b.distance} * a.speed;
    }
};

Way way_to(const WholeRay& ray, std::size_t axis, std::int32_t place) {
    const std::int64_t distance = std::int64_t{place} - ray.origin[axis];
    return ray.direction[axis] < 0 ? Way{-distance, -std::int64_t{ray.direction[axis]}}
                                   : Way{distance, ray.direction[axis]};
}

struct FoundFace {
    FaceOfBox face;
    Way way;

    bool comes_before(const FoundFace& other) const {
        if (way < other.way || other.way < way)
            return way < other.way;
        const auto order = [](const FaceOfBox& of) {
            return std::tuple(of.box, of.axis, of.is_upper);
        };
        return order(face) < order(other.face);
    }
};

void keep_first(std::optional<FoundFace>& first, const FoundFace& found) {
    if (!first || found.comes_before(*first))
        first = found;
}

void require_direction(const WholeRay& ray) {
    if (ray.direction == std::array<std::int32_t, 3>{})
        throw std::invalid_argument("the ray's direction is 0 0 0: give it one");
}

/// Whether the ray's line is between the box's other sides where it has gone that way.
bool is_within(const WholeBox& box, const WholeRay& ray, std::size_t axis, Way way) {
    for (std::size_t role = 0; role < 2; ++role) {
        const std::size_t other = turned(axis, role);
        const Int128 at =
            Int128{ray.origin[other]} * way.speed + Int128{way.distance} * ray.direction[other];
        if (at < Int128{box.lower[other]} * way.speed || at > Int128{box.upper[other]} * way.speed)
            return false;
    }
    return true;
}

std::optional<FaceOfBox> face_of(const std::optional<FoundFace>& found) {
    return found ? std::optional(found->face) : std::nullopt;
}

} // namespace

BoxFaces::BoxFaces(
    std::span<const WholeBox> boxes, std::optional<std::size_t> few, const CancelFlag* cancel) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        trees_.emplace_back(faces_across(axis, boxes), few, Progress(), cancel);
}

std::optional<FaceOfBox> BoxFaces::first_face(const WholeRay& ray, StepCounts* counts) const {
    require_direction(ray);
    std::optional<FoundFace> first;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (ray.direction[axis] == 0)
            continue;
        const auto number = trees_[axis].first_rectangle(turned(axis, ray), counts);
        if (!number)
            continue;
        const std::int32_t place = trees_[axis].rectangles()[*number].z;
        keep_first(
            first,
            {{*number / 2, static_cast<std::uint8_t>(axis), *number % 2 == 1},
             way_to(ray, axis, place)});
    }
    return face_of(first);
}

std::optional<FaceOfBox>
brute_force_first_face(std::span<const WholeBox> boxes, const WholeRay& ray) {
    require_direction(ray);
    std::optional<FoundFace> first;
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const bool is_upper : {false, true}) {
                if (ray.direction[axis] == 0)
                    continue;
                const Way way =
                    way_to(ray, axis, is_upper ? boxes[i].upper[axis] : boxes[i].lower[axis]);
                if (way.distance >= 0 && is_within(boxes[i], ray, axis, way))
                    keep_first(first, {{i, static_cast<std::uint8_t>(axis), is_upper}, way});
            }
    return face_of(first);
}

} // namespace vera
