// SPDX-License-Identifier: Apache-2.0
// Pictures whose rays are found for each primitive, by the program as users run it.
#include <string>
#include <utility>
#include <vector>

#include "door/picture.h"
#include <nlohmann/json.hpp>

namespace vera {
namespace {

/// Faces along axes and planes of the grid, seen along one, coincident ones, a subscene called
/// twice, a mirror, glass and a sphere: steep and level rays, and many of few values.
const char* const degenerate_scene = "PROJECTION 0 0 8  -2 -2 0  2 -2 0  -2 2 0\n"
                                     "LI 0 0 8  80 1 1 1\n"
                                     "LI 3 5 2  60 1 0.8 0.6\n"
                                     "CM grey\n"
                                     "P4 -2 -2 -1  2 -2 -1  2 2 -1  -2 2 -1\n"
                                     "P4 -2 -1 -1  2 -1 -1  2 -1 3  -2 -1 3\n"
                                     "P4 -2 -1 -1  2 -1 -1  2 -1 3  -2 -1 3\n"
                                     "CM mirror\n"
                                     "P4 -1 -1 -1  -1 1 -1  -1 1 1  -1 -1 1\n"
                                     "CM glass\n"
                                     "SP 0.5 0 0  0.5\n"
                                     "CM grey\n"
                                     "SSC box TR 0 0.5 0\n"
                                     "SSC box RT 0 45 0 SC 0.5 TR 1 -0.5 1\n"
                                     "MA grey DRF 0.7 0.7 0.5 ARF 0.1 0.1 0.1\n"
                                     "MA mirror DRF 0.1 0.1 0.1 RAB 0.8 0.7 0.7\n"
                                     "MA glass DRF 0.1 0.1 0.1 TAB 0.7 0.9 0.8 REF 1.3\n"
                                     "SCENE box\n"
                                     "P3 -0.5 0 0.5  0.5 0 0.5  0 1 0.5\n"
                                     "P3 0.5 0 0.5  0.5 0 -0.5  0 1 0.5\n"
                                     "P4 -0.5 0 -0.5  0.5 0 -0.5  0.5 0 0.5  -0.5 0 0.5\n";

class PrimitiveQueryOf : public testing::TestWithParam<const char*> {};

TEST_P(PrimitiveQueryOf, GivesTheSamePictureAsRaysToTheByte) {
    const ScratchFolder folder;
    const std::string scene = std::string(VERA_SOURCE_DIR "/scenes/") + GetParam();
    for (const char* antialias : {"on", "off"}) {
        const std::string options = "-c " + scene + ".ctl --raster 32x24 --antialias " + antialias;
        const auto expected = picture(folder, scene + ".vera", options);
        for (const char* queries : {"auto", "trees"})
            EXPECT_TRUE(
                picture(
                    folder,
                    scene + ".vera",
                    options + " --strategy primitive-query --queries " + queries)
                == expected)
                << antialias << ", " << queries;
    }
}

INSTANTIATE_TEST_SUITE_P(
    Examples,
    PrimitiveQueryOf,
    testing::Values("still_life", "flange", "glass", "polygons", "mirror_room"),
    [](const auto& example) { return std::string(example.param); });

TEST(PrimitiveQuery, GivesTheSamePictureHoweverItAsks) {
    const ScratchFolder folder;
    folder.write("a.vera", degenerate_scene);
    const std::string options = "--raster 60x60 --antialias off --depth 4";
    const auto expected = picture(folder, "a.vera", options);
    for (const char* more :
         {"",
          " --queries sweep",
          " --queries groups",
          " --queries nested",
          " --queries trees",
          " --threads 1",
          " --threads 2",
          " --threads 3",
          " --threads 8",
          " --queries nested --threads 1",
          " --queries nested --threads 3",
          " --queries trees --threads 2",
          " --queries trees --threads 8",
          " --generation-size 1000 --threads 1",
          " --generation-size 64 --threads 2"})
        EXPECT_TRUE(
            picture(folder, "a.vera", options + " --strategy primitive-query" + more) == expected)
            << more;
}

TEST(PrimitiveQuery, TellsOfEachGenerationWhatItTook) {
    const ScratchFolder folder;
    folder.write("a.vera", degenerate_scene);
    const ProgramRun run = run_vera(
        folder,
        "render a.vera -o a.png --raster 60x60 --antialias off --depth 3 --strategy "
        "primitive-query --queries sweep --json");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    const auto json = nlohmann::json::parse(run.out);
    const auto& generations = json["generations"];
    ASSERT_EQ(generations.size(), 9U)
        << "view rays, two lights; what they send on, two lights, twice";
    for (std::size_t i = 0; i < 9; ++i)
        EXPECT_EQ(generations[i]["kind"], i % 3 == 0 ? "rays" : "shadow");
    EXPECT_EQ(generations[0]["rays"], 3600);
    for (const std::size_t of_one_point : {0U, 1U, 2U})
        EXPECT_EQ(generations[of_one_point]["crossings"], 0) << of_one_point;
    EXPECT_GT(generations[6]["crossings"], 0) << "a sphere of glass spreads rays";
    const ProgramRun by_trees = run_vera(
        folder,
        "render a.vera -o a.png --raster 60x60 --antialias off --depth 3 --strategy "
        "primitive-query --queries trees --json");
    ASSERT_EQ(by_trees.exit_code, 0) << by_trees.err;
    const auto of_trees = nlohmann::json::parse(by_trees.out)["generations"];
    ASSERT_EQ(of_trees.size(), 9U);
    for (const std::size_t i : {0U, 6U}) {
        EXPECT_EQ(of_trees[i]["rays"], generations[i]["rays"]);
        EXPECT_EQ(of_trees[i]["crossings"], 0);
        EXPECT_EQ(of_trees[i]["rectangles"], 0) << "of sweeps";
        EXPECT_GT(of_trees[i]["nodes"], 30);
        EXPECT_GT(of_trees[i]["steps"], of_trees[i]["nodes"]);
        EXPECT_EQ(generations[i]["nodes"], 0);
    }
    const ProgramRun told =
        run_vera(folder, "render a.vera -o a.png --raster 20x20 --strategy primitive-query");
    EXPECT_NE(told.err.find(" generations of "), std::string::npos) << told.err;
}

TEST(PrimitiveQuery, TellsNothingOfSweepsThatItDoesNotMake) {
    const ScratchFolder folder;
    folder.write("a.vera", degenerate_scene);
    const std::string render =
        "render a.vera -o a.png --raster 20x20 --antialias off --strategy primitive-query";
    for (const std::string queries : {"auto", "sweep", "groups", "nested", "trees"}) {
        const ProgramRun told = run_vera(folder, render + " --queries " + queries);
        ASSERT_EQ(told.exit_code, 0) << told.err;
        EXPECT_EQ(told.err.find("pairs in sweeps") == std::string::npos, queries == "trees")
            << told.err;
        EXPECT_EQ(
            told.err.find("nodes of trees") != std::string::npos,
            queries == "trees" || queries == "nested")
            << told.err;
        const ProgramRun run = run_vera(folder, render + " --json --queries " + queries);
        ASSERT_EQ(run.exit_code, 0) << run.err;
        const auto json = nlohmann::json::parse(run.out);
        for (const auto& generation : json["generations"]) {
            EXPECT_EQ(generation["apart"], 0);
            EXPECT_EQ(
                generation["tests"].get<int>(),
                generation["reports"].get<int>() + generation["begun_within"].get<int>())
                << queries;
            EXPECT_TRUE(queries != "trees" || generation["pairs"] == 0);
        }
    }
}

TEST(PrimitiveQuery, RefusesWhatMeansNothingToIt) {
    const ScratchFolder folder;
    folder.write("a.vera", degenerate_scene);
    const std::pair<const char*, const char*> wrong[] = {
        {"--queries sweep",
         "--queries is of --strategy primitive-query: give that, or leave --queries out"},
        {"--generation-size 5 --strategy depth",
         "--generation-size is of --strategy primitive-query: give that, or leave "
         "--generation-size out"},
        {"--strategy primitive-query --queries all",
         "--queries takes auto, sweep, groups, nested or trees; found 'all'"},
        {"--strategy primitive-query --generation-size -1", "--generation-size"},
        {"--strategy primitive-query --index grid",
         "--index grid finds hits ray by ray, and --strategy primitive-query for each primitive: "
         "leave one of them out"},
        {"--strategy primitive-query --layers a.exr",
         "--layers are those of rays: leave out --strategy, or give --strategy rays"}};
    for (const auto& [options, message] : wrong) {
        const ProgramRun run = run_vera(folder, std::string("render a.vera -o a.png ") + options);
        EXPECT_EQ(run.exit_code, 2) << options;
        EXPECT_NE(run.err.find(message), std::string::npos) << run.err;
    }
    EXPECT_EQ(folder.file_count(), 1U);
}

} // namespace
} // namespace vera
