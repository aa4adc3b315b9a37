// SPDX-License-Identifier: Apache-2.0
#include "theory/terrains.h"

#include <algorithm>
#include <array>
#include <random>
#include <utility>

namespace vera::testing {

namespace {

class TerrainMaker {
public:
    TerrainMaker(std::uint64_t seed, const TerrainShape& shape)
        : random_(seed)
        , shape_(shape) {}

    ScreenScene scene() {
        for (std::int32_t row = 0; row <= shape_.rows; ++row)
            for (std::int32_t column = 0; column <= shape_.columns; ++column)
                scene_.vertices.push_back(vertex(row, column));
        for (std::int32_t row = 0; row < shape_.rows; ++row)
            for (std::int32_t column = 0; column < shape_.columns; ++column)
                add_quadrangle(row, column);
        return std::move(scene_);
    }

private:
    std::int32_t below(std::int32_t end) {
        return static_cast<std::int32_t>(random_() % static_cast<std::uint64_t>(end));
    }

    ScreenVertex vertex(std::int32_t row, std::int32_t column) {
        // Some of the picture stays free at the sides.
        const std::int32_t width = screen_size / (shape_.columns + 2) / 12 * 12;
        const std::int32_t left = shape_.narrowing * width / 4 * row / shape_.rows;
        const std::int32_t across = shape_.columns * width - 2 * left;
        const std::int64_t depth = depth_size / (shape_.rows + 2) / 3 * 3;
        const std::int32_t height =
            screen_size / (2 * shape_.heights + shape_.rise * shape_.rows + 2);
        const bool is_inner = row > 0 && row < shape_.rows && column > 0 && column < shape_.columns;
        const std::int32_t aside = is_inner && shape_.is_shaken ? below(3) - 1 : 0;
        const std::int32_t back = is_inner && shape_.is_shaken ? below(3) - 1 : 0;
        const std::int32_t up =
            row == 0 ? 0 : std::max(below(shape_.heights + shape_.flat) - shape_.flat, 0);
        return {
            {width + left
                 + static_cast<std::int32_t>(std::int64_t{across} * column / shape_.columns)
                 + aside * width / 3,
             (2 * up + shape_.rise * row) * height},
            depth_size - (row + 1) * depth - back * depth / 3};
    }

    void add_quadrangle(std::int32_t row, std::int32_t column) {
        const auto corner = [&](std::int32_t r, std::int32_t c) {
            return static_cast<std::uint32_t>(r * (shape_.columns + 1) + c);
        };
        const std::uint32_t a = corner(row, column);
        const std::uint32_t b = corner(row, column + 1);
        const std::uint32_t c = corner(row + 1, column + 1);
        const std::uint32_t d = corner(row + 1, column);
        if (below(2) == 0) {
            add({a, b, d});
            add({b, c, d});
        } else {
            add({a, b, c});
            add({a, c, d});
        }
    }

    void add(std::array<std::uint32_t, 3> vertices) {
        const std::uint32_t number = count_++;
        switch (shape_.sources) {
        case TerrainSources::each_its_own:
            add_triangle(scene_, vertices, number);
            break;
        case TerrainSources::of_a_quadrangle:
            add_triangle(scene_, vertices, number / 2);
            break;
        case TerrainSources::one_of_three:
            add_triangle(scene_, vertices, static_cast<std::uint32_t>(below(3)));
            break;
        }
    }

    std::mt19937_64 random_;
    TerrainShape shape_;
    ScreenScene scene_;
    std::uint32_t count_ = 0;
};

} // namespace

ScreenScene terrain(std::uint64_t seed, const TerrainShape& shape) {
    return TerrainMaker(seed, shape).scene();
}

ScreenScene steep_terrain(std::uint64_t seed, std::int32_t side) {
    TerrainShape shape;
    shape.columns = side;
    shape.rows = side;
    shape.heights = 10007;
    shape.rise = 0;
    return terrain(seed, shape);
}

ScreenScene behind_a_slope(ScreenScene scene) {
    std::int64_t nearest = 0;
    for (const ScreenVertex& vertex : scene.vertices)
        nearest = std::max(nearest, vertex.nearness);
    const auto first = static_cast<std::uint32_t>(scene.vertices.size());
    const auto source = static_cast<std::uint32_t>(scene.triangles.size());
    scene.vertices.push_back({{0, 0}, depth_size});
    scene.vertices.push_back({{screen_size, 0}, depth_size});
    scene.vertices.push_back({{screen_size, screen_size}, (nearest + depth_size) / 2});
    scene.vertices.push_back({{0, screen_size}, (nearest + depth_size) / 2});
    add_triangle(scene, {first, first + 1, first + 2}, source);
    add_triangle(scene, {first, first + 2, first + 3}, source);
    return scene;
}

ScreenScene turned_over(const ScreenScene& scene) {
    ScreenScene result;
    result.vertices = scene.vertices;
    for (ScreenVertex& vertex : result.vertices)
        vertex.point.y = screen_size - vertex.point.y;
    for (const ScreenTriangle& triangle : scene.triangles)
        add_triangle(result, triangle.vertices, triangle.source);
    return result;
}

} // namespace vera::testing
