// SPDX-License-Identifier: Apache-2.0
// Stretches of elements in the same named parts, compared with a look at all parts of each element.
#include "vera/scene/named_parts.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

/// Meshes of 1 to 3 triangles, and a sphere here and there.
Geometry random_geometry(std::mt19937& random) {
    Geometry geometry;
    const std::size_t count = 1 + random() % 6;
    for (std::uint32_t i = 0; i < count; ++i) {
        Item item = {.kind = ItemKind::sphere};
        if (random() % 4 != 0) {
            item = {.kind = ItemKind::mesh};
            item.index = static_cast<std::uint32_t>(geometry.meshes.size());
            geometry.meshes.emplace_back().position_indices.resize(3 * (1 + random() % 3));
        } else {
            geometry.spheres.emplace_back();
        }
        geometry.items.push_back(item);
    }
    return geometry;
}

std::vector<Element> elements_of(const Geometry& geometry) {
    std::vector<Element> elements;
    for (std::uint32_t i = 0; i < geometry.items.size(); ++i) {
        const Item& item = geometry.items[i];
        const std::size_t count = item.kind == ItemKind::mesh
            ? geometry.meshes[item.index].triangle_count()
            : std::size_t{1};
        for (std::uint32_t triangle = 0; triangle < count; ++triangle)
            elements.push_back({i, triangle});
    }
    return elements;
}

/// Parts of the elements from first up to end, in up to three levels, some of them alike.
void add_parts(
    std::mt19937& random,
    const std::vector<Element>& elements,
    std::size_t first,
    std::size_t end,
    std::uint32_t parent,
    int levels,
    Geometry& geometry) {
    const auto at = [&](std::size_t i) {
        return i < elements.size() ? elements[i]
                                   : Element{static_cast<std::uint32_t>(geometry.items.size()), 0};
    };
    while (levels > 0 && first < end) {
        const std::size_t last = first + 1 + random() % (end - first);
        if (random() % 3 != 0) {
            const auto number = static_cast<std::uint32_t>(geometry.named_parts.size());
            geometry.named_parts.push_back({"part", at(first), at(last), parent});
            add_parts(random, elements, first, last, number, levels - 1, geometry);
        }
        first = last;
    }
}

bool holds(const NamedPart& part, Element element) {
    return part.first <= element && element < part.end;
}

std::vector<bool> parts_with(const Geometry& geometry, Element element) {
    std::vector<bool> with;
    for (const NamedPart& part : geometry.named_parts)
        with.push_back(holds(part, element));
    return with;
}

/// The numbers of the parts with an element, in their order: those within others come later.
std::vector<std::uint32_t> numbers_of(const std::vector<bool>& with) {
    std::vector<std::uint32_t> numbers;
    for (std::uint32_t part = 0; part < with.size(); ++part)
        if (with[part])
            numbers.push_back(part);
    return numbers;
}

void expect_stretches(const Geometry& geometry, const std::vector<Element>& elements) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
        const std::vector<bool> with = parts_with(geometry, elements[i]);
        const std::vector<std::uint32_t> numbers = numbers_of(with);
        const auto is_alike = [&](std::size_t other) {
            return elements[other].item == elements[i].item
                && parts_with(geometry, elements[other]) == with;
        };
        std::size_t first = i;
        while (first > 0 && is_alike(first - 1))
            --first;
        std::size_t end = i + 1;
        while (end < elements.size() && is_alike(end))
            ++end;
        const PartStretch stretch = stretch_of(geometry, elements[i]);
        EXPECT_EQ(stretch.part, numbers.empty() ? NamedPart::none : numbers.back());
        EXPECT_EQ(parts_around(geometry, stretch.part), numbers);
        EXPECT_EQ(stretch.first, elements[first]);
        EXPECT_GT(stretch.end, elements[end - 1]);
        EXPECT_TRUE(end == elements.size() || stretch.end <= elements[end]);
    }
}

/// Of all meshes; how many ends there are.
std::size_t expect_ends(const Geometry& geometry, const std::vector<Element>& elements) {
    std::size_t count = 0;
    for (std::uint32_t item = 0; item < geometry.items.size(); ++item) {
        if (geometry.items[item].kind != ItemKind::mesh)
            continue;
        std::vector<std::uint32_t> expected;
        for (std::size_t i = 1; i < elements.size(); ++i)
            if (elements[i].item == item && elements[i].triangle > 0
                && parts_with(geometry, elements[i]) != parts_with(geometry, elements[i - 1]))
                expected.push_back(elements[i].triangle);
        EXPECT_EQ(stretch_ends(geometry, item), expected);
        count += expected.size();
    }
    return count;
}

TEST(NamedParts, TellTheStretchesThatAllPartsTell) {
    std::mt19937 random(7);
    std::size_t deep = 0;
    std::size_t parted = 0;
    for (int round = 0; round < 500; ++round) {
        Geometry geometry = random_geometry(random);
        const std::vector<Element> elements = elements_of(geometry);
        add_parts(random, elements, 0, elements.size(), NamedPart::none, 3, geometry);
        expect_stretches(geometry, elements);
        parted += expect_ends(geometry, elements);
        for (const NamedPart& part : geometry.named_parts)
            deep += part.parent != NamedPart::none ? 1 : 0;
        for (std::uint32_t part = 0; part < geometry.named_parts.size(); ++part)
            EXPECT_EQ(
                has_parts_within(geometry, part),
                std::ranges::count(geometry.named_parts, part, &NamedPart::parent) > 0);
    }
    EXPECT_GT(deep, 500U);
    EXPECT_GT(parted, 500U);
}

} // namespace
} // namespace vera
