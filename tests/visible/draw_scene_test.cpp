// SPDX-License-Identifier: Apache-2.0
// That every stage of a drawing ends soon after it is told to, and tells how far it is. All in one
// thread, so that the calls of the progress come in one order.
#include "vera/accel/brute_force.h"
#include "vera/base/parallel.h"
#include "vera/drawing/drawing_file.h"
#include "vera/visible/covered_areas.h"
#include "vera/visible/draw_scene.h"
#include "vera/visible/drawn_borders.h"
#include "vera/visible/hidden_parts.h"
#include "vera/visible/map_check.h"
#include "vera/visible/map_raster.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/region_outlines.h"
#include "vera/visible/trapping.h"
#include "vera/visible/underlays.h"

#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "accel/random_scene.h"
#include "visible/cameras.h"
#include "visible/screen_scenes.h"
#include <gtest/gtest.h>

namespace vera {
namespace {

constexpr DrawingStyle styles[] = {
    DrawingStyle::flat,
    DrawingStyle::shaded,
    DrawingStyle::ids,
    DrawingStyle::lines,
    DrawingStyle::hidden_lines,
    DrawingStyle::toon};

/// Curved and plane things that pass through each other, in the light of two lamps.
struct Sample {
    Sample() {
        testing::RandomSceneSettings random;
        random.items = 12;
        scene = testing::random_scene(3, random);
        scene.lights.resize(2);
        scene.lights[0].position = {-6, 5, 4};
        scene.lights[1].position = {1, 7, -3};
        camera = testing::camera_number(1);
        picture.width = picture.height = 100;
        picture.firmament = Firmament{{0.2, 0.3, 0.8}, {0.9, 0.8, 0.7}, {0.3, 0.4, 0.1}};
    }

    DrawnScene
    draw(const DrawSettings& settings, const Progress& progress, const CancelFlag* flag) const {
        cancel = flag;
        return draw_scene(scene, camera, picture, settings, progress, flag);
    }

    Scene scene;
    Camera camera;
    PictureSettings picture;
    mutable const CancelFlag* cancel = nullptr; ///< of the drawing that is being made
};

/// All ways to draw: each style, with and without lines of shadows, by each engine, and compared
/// with rays.
std::vector<DrawSettings> all_settings(const Sample& sample, const RayIndex& index) {
    std::vector<DrawSettings> all;
    for (const DrawingStyle style : styles) {
        DrawSettings& settings = all.emplace_back();
        settings.style = style;
        settings.deviation = 0.5;
        settings.shadow_lines = has_lines(style);
    }
    all.push_back(all.front());
    all.back().engine = VisibilityEngine::sweep;
    all.push_back(all.front());
    all.back().check = [&](const PrimitiveMap& map, const Progress& progress) {
        const MapCheckSettings settings = {2000, 100, 100, 0.5};
        check_map(map, sample.scene, sample.camera, index, settings, progress, sample.cancel);
    };
    return all;
}

/// The curved borders of the sample's areas.
DrawnBorders borders_of(const Sample& sample, const CancelFlag* cancel) {
    constexpr double deviation = 0.5;
    const CameraMap camera_map(sample.camera);
    const Facets all = facets(sample.scene, [&](Vec3 point) {
        return deviation
            * camera_map.size_of_pixel(sample.picture.width, sample.picture.height, point);
    });
    const DrawnFaces faces = drawn_faces(sample.scene, all, FaceUnit::plane, sample.camera);
    ScreenScene screen = screen_scene(all, camera_map, faces.of_facet);
    sort_by_place(screen);
    const VisibleMap map = visible_map(screen, whole_pieces(screen).pieces);
    return curved_borders(
        {sample.scene, sample.camera, camera_map, sample.picture, all, faces, map, deviation},
        {},
        cancel);
}

TEST(DrawScene, LinesAreTheSameHoweverWhatIsSeenWasFound) {
    for (int seed = 0; seed < 50; ++seed) {
        testing::RandomSceneSettings random;
        random.items = static_cast<std::size_t>(4 + seed % 9);
        Sample sample;
        const std::vector<PointLight> lights = sample.scene.lights;
        sample.scene = testing::random_scene(static_cast<std::uint64_t>(seed), random);
        sample.scene.lights = lights;
        sample.camera = testing::camera_number(seed);
        DrawSettings settings;
        settings.style = DrawingStyle::hidden_lines;
        settings.deviation = 0.5;
        settings.shadow_lines = seed % 2 == 0;
        std::string by_cells;
        write_svg(sample.draw(settings, {}, nullptr).drawing, {}, by_cells);
        settings.engine = VisibilityEngine::sweep;
        std::string by_sweep;
        write_svg(sample.draw(settings, {}, nullptr).drawing, {}, by_sweep);
        EXPECT_TRUE(by_cells == by_sweep) << "seed " << seed;
    }
}

TEST(DrawScene, OutlinesThatAreMadeWhileTheyAreWrittenAreTheSame) {
    Sample sample;
    for (const DrawingStyle style :
         {DrawingStyle::flat, DrawingStyle::shaded, DrawingStyle::toon}) {
        sample.picture.shadows = style != DrawingStyle::toon;
        DrawSettings settings;
        settings.style = style;
        settings.deviation = 0.5;
        std::string now;
        write_svg(sample.draw(settings, {}, nullptr).drawing, {}, now);
        settings.outlines = FaceOutlines::later;
        for (const std::size_t threads : {1U, 2U, 7U}) {
            const ThreadLimit limit(threads);
            std::string later;
            write_svg(sample.draw(settings, {}, nullptr).drawing, {}, later);
            EXPECT_TRUE(later == now) << static_cast<int>(style) << ' ' << threads;
        }
        EXPECT_GT(now.size(), 3000U);
    }
}

TEST(DrawScene, TellsHowFarItIsAndNeverGoesBack) {
    const ThreadLimit one(1);
    const Sample sample;
    const auto index = make_brute_force(sample.scene);
    for (const DrawSettings& settings : all_settings(sample, *index)) {
        std::vector<double> told;
        sample.draw(
            settings, [&](double done) { told.push_back(done); }, nullptr);
        ASSERT_GT(told.size(), 40U);
        EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
        EXPECT_EQ(told.front(), 0);
        EXPECT_NEAR(told.back(), 1, 1e-9);
        double widest = 0;
        for (std::size_t i = 1; i < told.size(); ++i)
            widest = std::max(widest, told[i] - told[i - 1]);
        EXPECT_LT(widest, 0.5) << "no stage is untold";
    }
}

TEST(DrawScene, EndsWithinAStepOfTheProgressWhereverItIsToldTo) {
    const ThreadLimit one(1);
    const Sample sample;
    const auto index = make_brute_force(sample.scene);
    for (const DrawSettings& settings : all_settings(sample, *index)) {
        std::size_t calls = 0;
        sample.draw(
            settings, [&](double) { ++calls; }, nullptr);
        // The last call is behind everything.
        const std::size_t step = 1 + calls / 24;
        for (std::size_t last = 0; last + 1 < calls; last += step) {
            CancelFlag cancel;
            std::size_t call = 0;
            std::size_t after = 0;
            const auto progress = [&](double) {
                after += cancel.raised() ? 1 : 0;
                if (call++ == last)
                    cancel.raise();
            };
            EXPECT_THROW(sample.draw(settings, progress, &cancel), Cancelled)
                << "raised in call " << last << " of " << calls;
            // Stages within stages tell that they begin.
            EXPECT_LE(after, 3U) << "raised in call " << last << " of " << calls;
        }
    }
}

/// How many turns of its loops a stage takes at most before it looks at the flag.
constexpr std::size_t some = 20'000;

TEST(DrawScene, EveryStageEndsThatIsTooLongToWaitFor) {
    const ThreadLimit one(1);
    CancelFlag raised;
    raised.raise();
    ScreenScene screen = testing::scattered(1, some, screen_size / 100);
    const VisiblePieces pieces = cell_raster(screen);
    const VisibleMap map = visible_map(screen, pieces);
    const RegionOutlines regions(map, straight_borders(map, {}));
    const std::vector<DrawingColor> colors(regions.count());
    const ScreenEdges edges = screen_edges(screen);
    std::vector<std::uint32_t> drawn(edges.edges.size());
    std::iota(drawn.begin(), drawn.end(), 0U);
    const Sample sample;
    const Facets all = facets(sample.scene, [](Vec3) { return 0.1; });

    const std::function<void()> stages[] = {
        [&] {
            facets(
                sample.scene, [](Vec3) { return 0.1; }, &raised);
        },
        [&] { drawn_faces(sample.scene, all, FaceUnit::plane, sample.camera, &raised); },
        [&] {
            screen_scene(
                all,
                CameraMap(sample.camera),
                std::vector<std::uint32_t>(all.triangles.size()),
                1e9,
                &raised);
        },
        [&] { sort_by_place(screen, &raised); },
        [&] { cell_raster(screen, {}, &raised); },
        [&] { cell_raster_after({}, {}, pieces, screen, {}, &raised); },
        [&] { whole_pieces(screen, {}, &raised, VisibilityEngine::sweep); },
        [&] { cut_penetrations(screen, std::vector(1, std::pair(0U, 1U)), &raised); },
        [&] { visible_map(screen, pieces, {}, &raised); },
        [&] { covered_areas(map, {}, &raised); },
        [&] { borders_of(sample, &raised); },
        [&] { widths_of_regions(regions, {}, &raised); },
        [&] { underlays(regions, colors, {}, &raised); },
        [&] { hidden_parts(screen, edges, drawn, pieces, {}, {}, &raised); },
        [&] { MapRaster(map, 100, 100, &raised); },
    };
    for (std::size_t i = 0; i < std::size(stages); ++i)
        EXPECT_THROW(stages[i](), Cancelled) << "stage " << i;
}

TEST(DrawScene, LongLoopsOfTheMapAndOfAreasLookAgainAndAgain) {
    const ThreadLimit one(1);
    const ScreenScene screen = testing::scattered(1, some, screen_size / 100);
    const VisiblePieces pieces = cell_raster(screen);
    const VisibleMap map = visible_map(screen, pieces);
    const RegionOutlines regions(map, straight_borders(map, {}));
    const std::vector<DrawingColor> colors(regions.count());
    const ScreenEdges edges = screen_edges(screen);
    std::vector<std::uint32_t> drawn(edges.edges.size());
    std::iota(drawn.begin(), drawn.end(), 0U);

    using Stage = std::function<void(const Progress&, const CancelFlag*)>;
    const Stage stages[] = {
        [&](const auto&... told) { visible_map(screen, pieces, told...); },
        [&](const auto&... told) { covered_areas(map, told...); },
        [&](const auto&... told) { widths_of_regions(regions, told...); },
        [&](const auto&... told) { underlays(regions, colors, told...); },
        [&](const auto&... told) { hidden_parts(screen, edges, drawn, pieces, {}, told...); },
        [&](const Progress& progress, const CancelFlag* cancel) {
            cell_raster(screen, progress, cancel);
        },
    };
    for (std::size_t i = 0; i < std::size(stages); ++i) {
        std::size_t calls = 0;
        stages[i]([&](double) { ++calls; }, nullptr);
        EXPECT_GE(calls, 8U) << "stage " << i;
        for (std::size_t last = 0; last + 1 < calls; last += 1 + calls / 8) {
            CancelFlag cancel;
            std::size_t call = 0;
            const auto progress = [&](double) {
                EXPECT_LE(call, last + 3) << "stage " << i;
                if (call++ == last)
                    cancel.raise();
            };
            EXPECT_THROW(stages[i](progress, &cancel), Cancelled) << "stage " << i;
        }
    }
}

} // namespace
} // namespace vera
