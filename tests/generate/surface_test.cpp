// SPDX-License-Identifier: Apache-2.0
#include "vera/generate/surface.h"

#include <algorithm>
#include <map>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr double pi = std::numbers::pi;

struct Sample {
    const char* name;
    Surface surface;
    bool closed;
};

std::vector<Sample> samples() {
    std::vector<Sample> list;
    list.push_back(
        {"sphere",
         {Formula("cos(u)*cos(v)"),
          Formula("sin(v)"),
          Formula("sin(u)*cos(v)"),
          0,
          2 * pi,
          -pi / 2,
          pi / 2},
         true});
    list.push_back(
        {"torus",
         {Formula("(2+cos(v))*cos(u)"),
          Formula("sin(v)"),
          Formula("(2+cos(v))*sin(u)"),
          0,
          2 * pi,
          0,
          2 * pi},
         true});
    list.push_back(
        {"waves", {Formula("u"), Formula("sin(5*u*u)/5"), Formula("v"), -1, 1, -1, 1}, false});
    list.push_back({"fold", {Formula("u"), Formula("abs(u-v)"), Formula("v"), 0, 1, 0, 1}, false});
    list.push_back({"root", {Formula("u"), Formula("sqrt(u)"), Formula("v"), 0, 1, 0, 1}, false});
    list.push_back({"plane", {Formula("u"), Formula("0"), Formula("v"), 0, 1, 0, 1}, false});
    return list;
}

/// The distance of a point from a triangle (Ericson 2005, section 5.1.5, by its regions).
double distance(Vec3 p, Vec3 a, Vec3 b, Vec3 c) {
    const auto to_segment = [&](Vec3 from, Vec3 to) {
        const Vec3 side = to - from;
        const double t = std::clamp(dot(p - from, side) / dot(side, side), 0.0, 1.0);
        return length(p - from - t * side);
    };
    const Vec3 normal = cross(b - a, c - a);
    const bool inside = dot(cross(b - a, p - a), normal) >= 0
        && dot(cross(c - b, p - b), normal) >= 0 && dot(cross(a - c, p - c), normal) >= 0;
    if (inside)
        return std::abs(dot(p - a, normal)) / length(normal);
    return std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

double distance(Vec3 p, const Mesh& mesh) {
    double least = 1e9;
    for (std::size_t i = 0; i < mesh.position_indices.size(); i += 3)
        least = std::min(
            least,
            distance(
                p,
                mesh.positions[mesh.position_indices[i]],
                mesh.positions[mesh.position_indices[i + 1]],
                mesh.positions[mesh.position_indices[i + 2]]));
    return least;
}

Vec3 place(const Surface& surface, double u, double v) {
    return {surface.x.at(u, v).value, surface.y.at(u, v).value, surface.z.at(u, v).value};
}

TEST(Surface, LiesNowhereFartherFromItsTrianglesThanIsAllowed) {
    for (const Sample& sample : samples()) {
        constexpr double deviation = 0.02;
        const Surface& s = sample.surface;
        const Mesh mesh = tessellated(s, {.allowed = deviation_of(deviation)});
        double farthest = 0;
        constexpr int steps = 37;
        for (int i = 0; i <= steps; ++i)
            for (int j = 0; j <= steps; ++j) {
                const double u = s.u_begin + (s.u_end - s.u_begin) * i / steps;
                const double v = s.v_begin + (s.v_end - s.v_begin) * j / steps;
                farthest = std::max(farthest, distance(place(s, u, v), mesh));
            }
        EXPECT_LE(farthest, deviation) << sample.name;
        // It is no waste either: curved ones come within a factor of what is allowed.
        if (sample.closed) {
            EXPECT_GT(farthest, deviation / 8) << sample.name;
        }
    }
}

TEST(Surface, HasNoGaps) {
    for (const Sample& sample : samples()) {
        const Mesh mesh = tessellated(sample.surface, {.allowed = deviation_of(0.01)});
        std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
        const auto& indices = mesh.position_indices;
        for (std::size_t i = 0; i < indices.size(); i += 3)
            for (std::size_t c = 0; c < 3; ++c)
                ++sides[{indices[i + c], indices[i + (c + 1) % 3]}];
        const Surface& s = sample.surface;
        for (const auto& [side, count] : sides) {
            EXPECT_EQ(count, 1) << sample.name;
            if (sides.contains({side.second, side.first}))
                continue;
            EXPECT_FALSE(sample.closed) << sample.name;
            // Of an open one, only sides along the border of the ranges have no partner; in all
            // samples that are open, x and z are u and v.
            const Vec3 a = mesh.positions[side.first];
            const Vec3 b = mesh.positions[side.second];
            const bool on_border = (a.x == b.x && (a.x == s.u_begin || a.x == s.u_end))
                || (a.z == b.z && (a.z == s.v_begin || a.z == s.v_end));
            EXPECT_TRUE(on_border) << sample.name;
        }
    }
}

TEST(Surface, HasItsOwnNormalsAlsoAtPoles) {
    const Mesh mesh = tessellated(samples()[0].surface, {.allowed = deviation_of(0.01)});
    ASSERT_EQ(mesh.normal_indices.size(), mesh.position_indices.size());
    for (std::size_t i = 0; i < mesh.position_indices.size(); ++i) {
        const Vec3 position = mesh.positions[mesh.position_indices[i]];
        const Vec3 normal = mesh.normals[mesh.normal_indices[i]];
        EXPECT_NEAR(std::abs(dot(position, normal)), 1, 1e-6);
    }
}

TEST(Surface, AdaptsToHowMuchItBends) {
    // Flat on one half, waves on the other.
    const Surface surface = {
        Formula("u"), Formula("max(0, u)^3*sin(20*v)"), Formula("v"), -1, 1, 0, 1};
    const Mesh mesh = tessellated(surface, {.allowed = deviation_of(0.005)});
    const auto flat = std::count_if(
        mesh.positions.begin(), mesh.positions.end(), [](Vec3 p) { return p.x < -0.1; });
    EXPECT_LT(static_cast<double>(flat), 0.1 * static_cast<double>(mesh.positions.size()));
}

TEST(Surface, KeepsPixelsOfACamera) {
    const Surface surface = samples()[0].surface;
    Camera camera;
    camera.viewpoint = {0, 0, 5};
    camera.lower_left = {-1.5, -1.5, 0};
    camera.lower_right = {1.5, -1.5, 0};
    camera.upper_left = {-1.5, 1.5, 0};
    const double pixels = 0.5;
    const Mesh mesh = tessellated(surface, {.allowed = deviation_of_pixels(pixels, camera, 100)});
    // A pixel at the depth of the ball's centre is 0.03 wide, at its nearest point 0.024.
    double farthest = 0;
    for (int i = 0; i < 60; ++i)
        for (int j = 0; j <= 30; ++j)
            farthest = std::max(
                farthest, distance(place(surface, 2 * pi * i / 60, pi * j / 30 - pi / 2), mesh));
    EXPECT_LT(farthest, pixels * 0.03);
    EXPECT_GT(farthest, pixels * 0.03 / 20);
}

std::string refusal(const Surface& surface, double deviation, std::size_t most) {
    try {
        tessellated(surface, {.allowed = deviation_of(deviation), .most_triangles = most});
    } catch (const SurfaceError& error) {
        return error.what();
    }
    return "";
}

TEST(Surface, IsRefusedWhereItTakesTooMuchOrHasNoValue) {
    using testing::HasSubstr;
    EXPECT_THAT(refusal(samples()[1].surface, 1e-5, 10'000), HasSubstr("triangles, and 10000 are"));
    const auto of_y = [](const char* y) {
        return Surface{Formula("u"), Formula(y), Formula("v"), -1, 1, -1, 1};
    };
    EXPECT_THAT(
        refusal(of_y("1/u"), 0.01, 10'000), HasSubstr("y has no finite value at u = 0, v = -"));
    EXPECT_THAT(refusal(of_y("log(u)"), 0.01, 10'000), HasSubstr("y has no finite value at u = "));
    EXPECT_THAT(
        refusal(of_y("1/(u*u+v*v)"), 0.01, 100'000),
        HasSubstr("y has no finite value at u = 0, v = 0"));
    EXPECT_THAT(refusal(of_y("1/(3*u-1)"), 0.01, 10'000), HasSubstr("near u = 0.33"));
    EXPECT_THAT(
        refusal(of_y("log(-1)"), 0.01, 10'000),
        HasSubstr("y has a finite value nowhere in the ranges of u and v"));
    EXPECT_THAT(
        refusal(of_y("sqrt(u-2)"), 0.01, 10'000), HasSubstr("y has a finite value nowhere"));
    EXPECT_THAT(refusal(of_y("1/0"), 0.01, 10'000), HasSubstr("y has a finite value nowhere"));
    // Squares of what is large overflow, which is no reason.
    EXPECT_THAT(refusal(of_y("exp(400*u)"), 0.01, 10'000), HasSubstr("triangles, and 10000 are"));
}

std::string advice(const Surface& surface, double deviation, std::size_t most = 1000) {
    try {
        tessellated(surface, {.allowed = deviation_of(deviation), .most_triangles = most});
    } catch (const SurfaceError& error) {
        return std::string(error.what()) + "; " + error.remedy;
    }
    return "";
}

TEST(Surface, IsRefusedWhereItsNumbersDoNotSuitIt) {
    using testing::HasSubstr;
    const auto of = [](const char* x, const char* y, const char* z) {
        return Surface{Formula(x), Formula(y), Formula(z), 0, 1, 0, 1};
    };
    EXPECT_THAT(
        advice(of("u+1", "v", "u"), 1e-18),
        HasSubstr("numbers near 1.2 are rounded too coarsely for a deviation of 1e-18"));
    const Surface far = of("u+1e9", "v", "u*v");
    EXPECT_THAT(
        advice(far, 0.001),
        HasSubstr("numbers near 1e+09 are rounded too coarsely for a deviation of 0.001; leave out "
                  "what only moves the surface (TR in a scene moves it), or allow a deviation of "
                  "about 1"));
    EXPECT_EQ(advice(far, 1.5), ""); // the advice is good
    EXPECT_THAT(
        advice(of("1e80*u", "v", "u"), 1e77), HasSubstr("goes farther than 1e+67 from the origin"));
    EXPECT_THAT(
        advice(of("1e-200*u", "1e-200*v", "0"), 1e-203), HasSubstr("1.4e-200 across, too small"));
    EXPECT_THAT(advice(of("u", "u", "u"), 0.001), HasSubstr("has no area: all of it is one line"));
    EXPECT_THAT(advice(of("u+v", "0.1*(u+v)", "0"), 0.001), HasSubstr("one line"));
    EXPECT_THAT(advice(of("1", "2", "3"), 0.001), HasSubstr("one point"));
    EXPECT_THAT(
        advice(of("u", "sin(9*u)", "v"), 1e-9),
        testing::EndsWith("triangles, and 1000 are allowed; allow a larger deviation"));
    // Narrow, but a surface.
    EXPECT_EQ(advice(of("u", "1e-9*v", "0"), 0.001), "");
}

TEST(Surface, IsTheSameForAnyNumberOfThreads) {
    const Surface surface = samples()[1].surface;
    const auto mesh = [&](std::size_t threads) {
        const ThreadLimit limit(threads);
        return tessellated(surface, {.allowed = deviation_of(0.01)});
    };
    const Mesh one = mesh(1);
    for (const std::size_t threads : {2U, 7U}) {
        const Mesh other = mesh(threads);
        EXPECT_EQ(one.positions, other.positions);
        EXPECT_EQ(one.position_indices, other.position_indices);
        EXPECT_EQ(one.normals, other.normals);
    }
}

} // namespace
} // namespace vera
