// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/simd_level.h"
#include "vera/scene/crossings.h"
#include "vera/shade/place_blocks.h"

#include <bit>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace vera {
namespace {

bool same_bits(double a, double b) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// The sign of a zero is nothing that a picture shows.
void expect_same(double found, double expected, const std::string& what) {
    ASSERT_TRUE(same_bits(found + 0.0, expected + 0.0) || (found != found && expected != expected))
        << what << ": found " << found << ", expected " << expected;
}

void expect_same(Vec3 found, Vec3 expected, const std::string& what) {
    expect_same(found.x, expected.x, what);
    expect_same(found.y, expected.y, what);
    expect_same(found.z, expected.z, what);
}

void expect_same(Color found, Color expected, const std::string& what) {
    expect_same(Vec3{found.r, found.g, found.b}, Vec3{expected.r, expected.g, expected.b}, what);
}

struct Sample {
    SurfacePoint surface;
    Vec3 direction;
    Material material;
};

/// Places, materials and lights made of few values, so that lights lie in the plane of a surface or
/// in the very place, highlights end where they are seen, and total reflection just begins.
class Random {
public:
    explicit Random(std::uint32_t seed)
        : random_(seed) {}

    template <std::size_t Count>
    double one_of(const double (&values)[Count]) {
        return values[random_() % Count];
    }

    Vec3 vector() {
        static constexpr double values[] = {-2, -1, -0.5, -0.0, 0, 0.1, 0.5, 1, 3};
        return {one_of(values), one_of(values), one_of(values)};
    }

    /// Also where squares of lengths overflow or vanish.
    double scale() {
        static constexpr double scales[] = {1, 1, 1, 1, 1, 1e-150, 1e150, 1e-310, 1e-30, 1e308};
        return one_of(scales);
    }

    Vec3 direction() {
        while (true)
            if (const Vec3 a = vector(); !(a == Vec3{}))
                return normalized(a);
    }

    Color color() {
        static constexpr double values[] = {0, 0, 0, 0.25, 0.7, 1, 2};
        return {one_of(values), one_of(values), one_of(values)};
    }

    Sample sample() {
        static constexpr double spc[] = {1, 1, 0.5, 0, -1, 0.99};
        static constexpr double ref[] = {1, 1.5, 0.75, 1.25, 2};
        Sample result;
        result.surface.point = scale() * vector();
        result.surface.point_error = 0x1p-50 * max_component(abs(result.surface.point));
        result.surface.geometric_normal = direction();
        result.surface.shading_normal =
            random_() % 2 == 0 ? result.surface.geometric_normal : direction();
        result.direction = direction();
        result.material.drf = color();
        result.material.arf = color();
        result.material.san = color();
        result.material.spc = one_of(spc);
        result.material.ref = one_of(ref);
        return result;
    }

    PointLight light() {
        static constexpr double intensities[] = {0, 1, 50, 1e300};
        PointLight result;
        result.position = scale() * vector();
        result.intensity = one_of(intensities);
        result.color = color();
        result.falloff = random_() % 2 == 0 ? Falloff::none : Falloff::inverse_square;
        return result;
    }

private:
    std::mt19937 random_;
};

constexpr BlockLanes bit(std::size_t lane) {
    return BlockLanes{1} << lane;
}

/// Blocks of the samples, the last of them not full.
std::vector<PlaceBlock> blocks_of(const std::vector<Sample>& samples) {
    std::vector<PlaceBlock> blocks((samples.size() + block_size - 1) / block_size);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        PlaceBlock& block = blocks[i / block_size];
        const std::size_t lane = i % block_size;
        put_surface(block, lane, samples[i].surface, samples[i].direction);
        put_material(block, lane, samples[i].material);
        block.lanes |= bit(lane);
        block.refracting |= i % 3 == 0 ? 0 : bit(lane);
    }
    turn_to_viewer(blocks);
    return blocks;
}

void expect_same(const Incidence& found, const Incidence& expected) {
    expect_same(found.point, expected.point, "point");
    expect_same(found.to_viewer, expected.to_viewer, "R");
    expect_same(found.normal, expected.normal, "N");
    expect_same(found.geometric_normal, expected.geometric_normal, "the face's normal");
    expect_same(found.mirrored, expected.mirrored, "S");
    expect_same(found.cos_viewer, expected.cos_viewer, "R.N");
    EXPECT_EQ(found.from_outside, expected.from_outside);
}

/// What a light gives to one place, as the blocks say and as unshadowed() says.
void expect_same_light(
    const LightBlock& found,
    std::size_t lane,
    const Sample& sample,
    const Incidence& at,
    const PointLight& light) {
    const LightTerms expected = unshadowed(at, sample.material, light);
    ASSERT_EQ((found.lit & bit(lane)) != 0, !is_black(expected));
    if (is_black(expected))
        return;
    expect_same(color_at(found.diffuse, lane), expected.diffuse, "diffuse");
    expect_same(color_at(found.highlight, lane), expected.highlight, "highlight");
    Ray ray;
    ray.origin = sample.surface.point;
    ray.origin_error = sample.surface.point_error;
    ray.direction = light.position - ray.origin;
    expect_same(vector_at(found.to_light, lane), ray.direction, "to the light");
    expect_same(found.shadow_end[lane], 1 - coincidence_tolerance(ray, 1), "end of shadow ray");
}

void expect_same_refraction(
    const RefractionBlock& found, std::size_t lane, const Sample& sample, const Incidence& at) {
    const std::optional<Vec3> expected = refracted(at, sample.material.ref);
    ASSERT_EQ((found.totally_reflected & bit(lane)) != 0, !expected.has_value());
    if (expected)
        expect_same(vector_at(found.direction, lane), *expected, "refracted");
}

void expect_the_formula(std::uint32_t seed) {
    Random random(seed);
    std::vector<Sample> samples;
    for (std::size_t i = 0; i < 8 * block_size - 3; ++i)
        samples.push_back(random.sample());
    std::vector<PlaceBlock> blocks = blocks_of(samples);
    std::vector<LocalTerms> terms;
    const Color ambient = random.color();
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const Incidence at = incidence(samples[i].surface, samples[i].direction);
        expect_same(incidence_at(blocks[i / block_size], i % block_size), at);
        terms.push_back(unlit(at, samples[i].material, ambient));
    }

    std::vector<LightBlock> lights(blocks.size());
    for (int round = 0; round < 3; ++round) {
        const PointLight light = random.light();
        light_up(blocks, light, lights);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const Incidence at = incidence(samples[i].surface, samples[i].direction);
            LightBlock& found = lights[i / block_size];
            const std::size_t lane = i % block_size;
            expect_same_light(found, lane, samples[i], at, light);
            const Color visibility = random.color();
            put(found.visibility, lane, visibility);
            const LightTerms given = unshadowed(at, samples[i].material, light);
            if (!is_black(given))
                terms[i] += visibility * given;
        }
        add_light(blocks, lights);
    }

    std::vector<BlockRows> colors(blocks.size());
    reflected_light(blocks, ambient, colors);
    std::vector<RefractionBlock> refractions(blocks.size());
    refract(blocks, refractions);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const PlaceBlock& block = blocks[i / block_size];
        const std::size_t lane = i % block_size;
        expect_same(
            color_at(colors[i / block_size], lane)
                + luminosity(block.cos_viewer[lane], samples[i].material),
            sum(terms[i]),
            "sum");
        if (i % 3 != 0)
            expect_same_refraction(
                refractions[i / block_size],
                lane,
                samples[i],
                incidence(samples[i].surface, samples[i].direction));
    }
}

TEST(PlaceBlocks, GiveTheBitsOfTheFormulaWithEveryInstructionSet) {
    EXPECT_FALSE(simd_levels().empty());
    for (const std::string& level : simd_levels()) {
        ASSERT_TRUE(limit_simd(level));
        for (std::uint32_t seed = 0; seed < 500 && !HasFatalFailure(); ++seed) {
            SCOPED_TRACE(level + ", seed " + std::to_string(seed));
            expect_the_formula(seed);
        }
    }
    EXPECT_TRUE(limit_simd(""));
}

TEST(PlaceBlocks, LetNoLightComeToLanesWithoutAPlace) {
    Random random(1);
    std::vector<PlaceBlock> blocks = blocks_of(std::vector<Sample>(block_size, random.sample()));
    blocks[0].lanes = 0x05;
    const Incidence at = incidence_at(blocks[0], 0);
    PointLight light;
    light.position = at.point + 2 * at.normal + 2 * at.geometric_normal;
    std::vector<LightBlock> lights(1);
    light_up(blocks, light, lights);
    EXPECT_EQ(lights[0].lit & ~BlockLanes{0x05}, 0U);
}

} // namespace
} // namespace vera
