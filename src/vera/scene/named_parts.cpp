// SPDX-License-Identifier: Apache-2.0
// The last part that begins no later than an element is in all parts that the element is in: such a
// part begins no later than that one and goes on beyond its beginning. So the way up from it tells
// them all, and what has ended on the way ended last before the element.
#include "vera/scene/named_parts.h"

#include <algorithm>
#include <cstddef>

namespace vera {

PartStretch stretch_of(const Geometry& geometry, Element element) {
    const std::vector<NamedPart>& parts = geometry.named_parts;
    const auto after = std::upper_bound(
        parts.begin(), parts.end(), element, [](Element sought, const NamedPart& part) {
            return sought < part.first;
        });
    PartStretch stretch;
    // Not beyond the item.
    stretch.first = {element.item, 0};
    stretch.end = {element.item + 1, 0};
    if (after != parts.end())
        stretch.end = std::min(stretch.end, after->first);
    std::uint32_t part = after == parts.begin()
        ? NamedPart::none
        : static_cast<std::uint32_t>(after - parts.begin() - 1);
    for (; part != NamedPart::none && parts[part].end <= element; part = parts[part].parent)
        stretch.first = std::max(stretch.first, parts[part].end);
    if (part != NamedPart::none) {
        stretch.first = std::max(stretch.first, parts[part].first);
        stretch.end = std::min(stretch.end, parts[part].end);
    }
    stretch.part = part;
    return stretch;
}

std::vector<std::uint32_t> stretch_ends(const Geometry& geometry, std::uint32_t item) {
    std::vector<std::uint32_t> ends;
    if (geometry.named_parts.empty())
        return ends;
    const auto count =
        static_cast<std::uint32_t>(geometry.meshes[geometry.items[item].index].triangle_count());
    for (Element at = {item, 0}; at.triangle < count;) {
        at = stretch_of(geometry, at).end;
        if (at.item != item || at.triangle >= count)
            break;
        ends.push_back(at.triangle);
    }
    return ends;
}

std::vector<std::uint32_t> parts_around(const Geometry& geometry, std::uint32_t part) {
    std::vector<std::uint32_t> parts;
    for (; part != NamedPart::none; part = geometry.named_parts[part].parent)
        parts.push_back(part);
    std::reverse(parts.begin(), parts.end());
    return parts;
}

bool has_parts_within(const Geometry& geometry, std::uint32_t part) {
    const std::size_t next = std::size_t{part} + 1;
    return next < geometry.named_parts.size() && geometry.named_parts[next].parent == part;
}

} // namespace vera
