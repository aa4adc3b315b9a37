// SPDX-License-Identifier: Apache-2.0
#include "sample_spheres.h"

#include <cmath>
#include <initializer_list>
#include <limits>
#include <random>

namespace vera::testing {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float smallest = std::numeric_limits<float>::denorm_min();

class Dice {
public:
    explicit Dice(std::uint64_t seed)
        : random_(seed) {}

    std::size_t below(std::size_t count) { return random_() % count; }

    bool one_in(std::size_t count) { return below(count) == 0; }

    float any_of(std::initializer_list<float> values) {
        return *(values.begin() + static_cast<std::ptrdiff_t>(below(values.size())));
    }

private:
    std::mt19937_64 random_;
};

} // namespace

SampleSpheres random_spheres(std::uint64_t seed, std::size_t count) {
    Dice dice(seed);
    SampleSpheres spheres;
    for (std::size_t i = 0; i < count; ++i) {
        std::array<float, 4> sphere;
        for (std::size_t axis = 0; axis < 3; ++axis)
            sphere[axis] = dice.any_of({-4, -2, -1, -0.5F, -0.0F, 0, 0.1F, 1, 2, 4});
        sphere[3] = dice.any_of({0, -0.0F, 0x1p-20F, 0.1F, 0.5F, 0.5F, 1, 1, 2, 5});
        if (i > 0 && dice.one_in(6))
            sphere = spheres[dice.below(i)];
        spheres.push_back(sphere);
    }
    return spheres;
}

SampleSpheres scaled_and_shifted(SampleSpheres spheres, float factor, float offset) {
    for (std::array<float, 4>& sphere : spheres) {
        for (std::size_t axis = 0; axis < 3; ++axis)
            sphere[axis] = factor * sphere[axis] + offset;
        sphere[3] *= factor;
    }
    return spheres;
}

SampleSpheres close_shells(std::uint64_t seed, std::size_t count) {
    Dice dice(seed);
    SampleSpheres spheres;
    const float size = dice.any_of({1, 1000, 0x1p-10F});
    for (std::size_t i = 0; i < count; ++i) {
        const float aside = dice.any_of({0, 0, 1e-12F, -1e-9F});
        const float larger = 0x1p-23F * static_cast<float>(dice.below(count));
        spheres.push_back({aside, dice.any_of({0, 1e-12F}), 0, size * (1 + larger)});
    }
    return spheres;
}

SampleSpheres mixed_spheres(std::uint64_t seed, std::size_t count) {
    Dice dice(seed);
    SampleSpheres spheres = random_spheres(seed, count);
    for (std::array<float, 4>& sphere : spheres) {
        const float factor = dice.any_of({smallest, 1e-38F, 1e-30F, 1e-6F, 1, 1e6F, 1e30F, 1e37F});
        const bool all = !dice.one_in(4);
        for (std::size_t i = 0; i < 4; ++i)
            if (all || i == 3)
                sphere[i] *= factor;
    }
    return spheres;
}

SampleSpheres small_spheres_beside_large(std::uint64_t seed, std::size_t small) {
    Dice dice(seed);
    SampleSpheres spheres = scaled_and_shifted(
        random_spheres(seed, small), dice.any_of({0x1p-5F, 0x1p-18F, 0x1p-40F}), 0);
    const std::size_t axis = dice.below(3);
    const float place = dice.any_of({0, 0, 0x1p-30F, 0x1p-12F, 1});
    for (std::array<float, 4>& sphere : spheres)
        sphere[axis] += place;
    for (const std::array<float, 4>& sphere : random_spheres(seed + 1, 1 + dice.below(5)))
        spheres.push_back(sphere);
    return spheres;
}

SampleSpheres with_broken_numbers(SampleSpheres spheres, std::uint64_t seed) {
    Dice dice(seed);
    for (std::array<float, 4>& sphere : spheres)
        if (dice.one_in(6)) {
            const std::size_t which = dice.below(4);
            sphere[which] = which == 3 && dice.one_in(2)
                ? dice.any_of({-1, -smallest})
                : dice.any_of({std::nanf(""), infinity, -infinity});
        }
    return spheres;
}

SampleSpheres ball_of_balls(std::size_t around) {
    SampleSpheres spheres = {{0, 0, 0, 1}};
    for (std::size_t i = 0; i < around; ++i)
        for (std::size_t j = 0; j < around; ++j) {
            const auto x = 2 * static_cast<float>(i) / static_cast<float>(around) - 1;
            const auto y = 2 * static_cast<float>(j) / static_cast<float>(around) - 1;
            const float z = (i + j) % 2 == 0 ? 1.0F : -1.0F;
            const float length = std::sqrt(x * x + y * y + z * z);
            spheres.push_back({1.1F * x / length, 1.1F * y / length, 1.1F * z / length, 0.1F});
        }
    return spheres;
}

SampleMesh places_about(const SampleSpheres& spheres) {
    SampleMesh places;
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const auto& [x, y, z, r] = spheres[i];
        switch (i % 3) {
        case 0: // the first and the second lie on a line that touches the sphere
            places.add_triangle({x + r, y, z}, {x + r, y + r, z}, {x, y, z});
            break;
        case 1:
            places.add_triangle({x, y - r, z}, {x, y - r, z + r}, {x, y, z - r});
            break;
        default:
            places.add_triangle({x, y, z}, {x - r, y, z}, {x + 0.6F * r, y + 0.8F * r, z});
            break;
        }
    }
    return places;
}

} // namespace vera::testing
