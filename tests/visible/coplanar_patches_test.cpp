// SPDX-License-Identifier: Apache-2.0
// Which triangles of meshes become one face of a drawing, compared with a search through all pairs
// in whole numbers.
#include "vera/base/parallel.h"
#include "vera/visible/coplanar_patches.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include "visible/plane_meshes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

using testing::add_triangle;
using testing::below;
using testing::random_field;

using WholePoint = std::array<std::int64_t, 3>;

/// Of a mesh whose coordinates are whole numbers.
class WholeTriangles {
public:
    explicit WholeTriangles(const Mesh& mesh)
        : mesh_(mesh) {}

    /// Whether they are neighbours in one plane, word by word.
    bool are_neighbours(std::size_t one, std::size_t other) const {
        return one != other && have_opposite_sides(one, other) && are_in_one_plane(one, other)
            && dot(normal(one), normal(other)) > 0 && have_one_normal(one, other);
    }

private:
    static WholePoint step(const WholePoint& a, const WholePoint& b) {
        return {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
    }

    static std::int64_t dot(const WholePoint& a, const WholePoint& b) {
        return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    }

    std::uint32_t corner(std::size_t triangle, std::size_t i) const {
        return mesh_.position_indices[3 * triangle + i % 3];
    }

    WholePoint point(std::size_t triangle, std::size_t i) const {
        const Vec3 p = mesh_.positions[corner(triangle, i)];
        return {
            static_cast<std::int64_t>(p.x),
            static_cast<std::int64_t>(p.y),
            static_cast<std::int64_t>(p.z)};
    }

    WholePoint normal(std::size_t triangle) const {
        const WholePoint u = step(point(triangle, 0), point(triangle, 1));
        const WholePoint v = step(point(triangle, 0), point(triangle, 2));
        return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    }

    bool have_opposite_sides(std::size_t one, std::size_t other) const {
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k)
                if (corner(one, i) == corner(other, k + 1)
                    && corner(one, i + 1) == corner(other, k))
                    return true;
        return false;
    }

    bool are_in_one_plane(std::size_t one, std::size_t other) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (dot(normal(one), step(point(one, 0), point(other, k))) != 0)
                return false;
        return true;
    }

    bool have_one_normal(std::size_t one, std::size_t other) const {
        if (mesh_.normals.empty())
            return true;
        const auto of = [&](std::size_t triangle, std::size_t i) {
            return mesh_.normals[mesh_.normal_indices[3 * triangle + i]];
        };
        for (const std::size_t triangle : {one, other})
            for (std::size_t i = 0; i < 3; ++i)
                if (of(triangle, i) != of(one, 0))
                    return false;
        return true;
    }

    const Mesh& mesh_;
};

/// Passes the smallest number on between neighbours that no end parts until nothing changes.
std::vector<std::uint32_t>
patches_by_all_pairs(const Mesh& mesh, const std::vector<std::uint32_t>& ends = {}) {
    const WholeTriangles triangles(mesh);
    std::vector<std::uint32_t> first(mesh.triangle_count());
    std::iota(first.begin(), first.end(), 0U);
    const auto are_parted = [&](std::size_t one, std::size_t other) {
        return std::any_of(ends.begin(), ends.end(), [&](std::uint32_t end) {
            return (one < end) != (other < end);
        });
    };
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t one = 0; one < first.size(); ++one)
            for (std::size_t other = 0; other < first.size(); ++other)
                if (first[one] < first[other] && triangles.are_neighbours(one, other)
                    && !are_parted(one, other)) {
                    first[other] = first[one];
                    changed = true;
                }
    }
    return first;
}

/// With each by itself where the patches are none.
std::vector<std::uint32_t>
all_firsts(const Mesh& mesh, const std::vector<std::uint32_t>& ends = {}) {
    std::vector<std::uint32_t> first = coplanar_patches(mesh, ends);
    if (first.empty()) {
        first.resize(mesh.triangle_count());
        std::iota(first.begin(), first.end(), 0U);
    }
    return first;
}

std::size_t count_patches(const std::vector<std::uint32_t>& first) {
    return std::set<std::uint32_t>(first.begin(), first.end()).size();
}

/// Triangles between any of few points.
Mesh random_tangle(std::mt19937& random) {
    Mesh mesh;
    for (std::size_t i = 0; i < 7; ++i) {
        Vec3 point;
        for (double* const coordinate : {&point.x, &point.y, &point.z})
            *coordinate = static_cast<double>(below(random, 3));
        mesh.positions.push_back(point);
    }
    for (std::size_t i = 0; i < 14; ++i) {
        std::array<std::size_t, 3> corners = {};
        for (std::size_t& corner : corners)
            corner = below(random, mesh.positions.size());
        add_triangle(mesh, corners);
    }
    return mesh;
}

void add_normals(std::mt19937& random, Mesh& mesh) {
    mesh.normals = {{0, 0, 1}, {0, 0.6, 0.8}, {0, 0, 1}};
    for (std::size_t i = 0; i < mesh.position_indices.size(); ++i)
        mesh.normal_indices.push_back(below(random, 12) == 0 ? 1 : below(random, 2) == 0 ? 0 : 2);
}

TEST(CoplanarPatches, AreThoseOfASearchThroughAllPairs) {
    std::mt19937 random(57);
    std::size_t joined = 0;
    std::size_t apart = 0;
    for (std::size_t round = 0; round < 300; ++round) {
        Mesh mesh = round % 3 == 0 ? random_tangle(random)
                                   : random_field(random, 1 + below(random, 5), 1 + round % 3);
        if (round % 4 == 1)
            add_normals(random, mesh);
        const std::vector<std::uint32_t> expected = patches_by_all_pairs(mesh);
        ASSERT_EQ(all_firsts(mesh), expected) << "round " << round;
        joined += expected.size() - count_patches(expected);
        apart += count_patches(expected);
    }
    EXPECT_GT(joined, 1000U);
    EXPECT_GT(apart, 1000U);
}

TEST(CoplanarPatches, DoNotGoBeyondTheEndsOfStretches) {
    std::mt19937 random(58);
    std::size_t more = 0;
    for (std::size_t round = 0; round < 200; ++round) {
        const Mesh mesh = random_field(random, 2 + below(random, 3), 1);
        std::vector<std::uint32_t> ends;
        for (std::uint32_t i = 1; i < mesh.triangle_count(); ++i)
            if (below(random, 6) == 0)
                ends.push_back(i);
        const std::vector<std::uint32_t> expected = patches_by_all_pairs(mesh, ends);
        ASSERT_EQ(all_firsts(mesh, ends), expected) << "round " << round;
        more += count_patches(expected) - count_patches(patches_by_all_pairs(mesh));
    }
    EXPECT_GT(more, 200U);
}

TEST(CoplanarPatches, AreTheSameForAnyNumberOfThreads) {
    std::mt19937 random(3);
    const Mesh mesh = random_field(random, 120, 2); // vertices for several threads
    std::vector<std::uint32_t> one;
    for (const std::size_t threads : {1U, 2U, 7U}) {
        const ThreadLimit limit(threads);
        const std::vector<std::uint32_t> first = coplanar_patches(mesh);
        if (threads == 1)
            one = first;
        EXPECT_EQ(first, one);
    }
    EXPECT_GT(mesh.triangle_count(), count_patches(one) + 1000);
}

/// Two triangles with the side from (0, 0, 0) to (1, 1, 0).
Mesh two_triangles(double height) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, height}};
    mesh.position_indices = {0, 2, 1, 0, 1, 3};
    return mesh;
}

TEST(CoplanarPatches, TellTheSmallestAngleFromNone) {
    EXPECT_EQ(coplanar_patches(two_triangles(0)), (std::vector<std::uint32_t>{0, 0}));
    EXPECT_TRUE(coplanar_patches(two_triangles(1e-300)).empty());
}

TEST(CoplanarPatches, OfMoreThanMayHaveASideInCommonAreNone) {
    const auto copies = [](std::size_t count) {
        Mesh mesh = two_triangles(0);
        for (std::size_t i = 1; i < count; ++i)
            mesh.position_indices.insert(mesh.position_indices.end(), {0, 2, 1, 0, 1, 3});
        return coplanar_patches(mesh);
    };
    EXPECT_EQ(copies(64), std::vector<std::uint32_t>(128, 0));
    EXPECT_TRUE(copies(65).empty());
}

/// A fan of many triangles round one vertex takes no time that grows with their square.
TEST(CoplanarPatches, OfAWideFanAreOne) {
    constexpr std::uint32_t count = 50000;
    Mesh mesh;
    mesh.positions.push_back({0, 0, 0});
    for (std::uint32_t i = 0; i <= count; ++i)
        mesh.positions.push_back({1, static_cast<double>(i), 0});
    for (std::uint32_t i = 1; i <= count; ++i)
        mesh.position_indices.insert(mesh.position_indices.end(), {0, i, i + 1});
    EXPECT_EQ(coplanar_patches(mesh), std::vector<std::uint32_t>(count, 0));
}

} // namespace
} // namespace vera
