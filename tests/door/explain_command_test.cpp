// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <sstream>
#include <vector>

#include "door/program.h"
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace vera {
namespace {

/// A mirror on a floor, glass before one of two lights, and an instance.
const char* const busy_scene = "PROJECTION 0 2 8  -2 0 0  2 0 0  -2 4 0\n"
                               "LI 3 6 5  40 1 1 1\n"
                               "LI -3 6 5  20 1 1 0.5\n"
                               "CM grey\n"
                               "P4 -9 0 9  9 0 9  9 0 -9  -9 0 -9\n"
                               "CM mirror\n"
                               "SP 0 1.5 -1 1.5\n"
                               "SSC ball TR 1.5 3 2\n"
                               "MA grey DRF 0.7 0.7 0.7 ARF 0.1 0 0\n"
                               "MA mirror RAB 0.5 0.5 0.5 DRF 0.2 0.2 0.2 SPC 0.9\n"
                               "MA glass TAB 0.9 0.8 0.7\n"
                               "SCENE ball CM glass SP 0 0 0 0.5\n";

std::string explained(const ScratchFolder& folder, const std::string& options) {
    const ProgramRun run = run_vera(folder, "explain a.vera " + options);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return run.out;
}

void expect_parts(const std::string& text, std::initializer_list<const char*> parts) {
    for (const char* part : parts)
        EXPECT_NE(text.find(part), std::string::npos) << part << '\n' << text;
}

TEST(ExplainCommand, TellsTheRayTreeTermByTerm) {
    const ScratchFolder folder;
    folder.write("a.vera", busy_scene);
    expect_parts(
        explained(folder, "32 45 --raster 64x64"),
        {"Pixel 32 45 of 64 x 64",
         "Ray 1, the view ray",
         "meets         sphere 2, from the outside",
         "written at    a.vera:7:1",
         "material      mirror",
         "light 2",
         "L.N =",
         "Amb ",
         "Dif light 1",
         "Spk light 2",
         "Slm ",
         "RAB 0.5 0.5 0.5 times the colour of ray 2",
         "Ray 2, mirrored by ray 1, level 2",
         "weight        0.5 0.5 0.5",
         "direct.light1.diffuse",
         "mirrored.light2.diffuse",
         "rounding",
         "255 times that"});
    expect_parts(
        explained(folder, "32 45 --raster 64x64 --depth 1"),
        {"RAB 0.5 0.5 0.5: not followed, RTDEPTH ends here"});
}

TEST(ExplainCommand, TellsWhoShadowsAndFiltersALight) {
    const ScratchFolder folder;
    folder.write("a.vera", busy_scene);
    const std::string shadowed = explained(folder, "20 60 --raster 64x64 --json");
    const auto json = nlohmann::json::parse(shadowed);
    EXPECT_EQ(json["version"], 1);
    std::size_t opaque = 0;
    std::size_t glass = 0;
    for (int x = 0; x < 64; x += 4) {
        const auto row = nlohmann::json::parse(
            explained(folder, std::to_string(x) + " 58 --raster 64x64 --depth 1 --json"));
        for (const auto& light : row["rays"][0]["lights"])
            for (const auto& between : light["between"]) {
                const bool blocks = between["tab"] == nlohmann::json({0.0, 0.0, 0.0});
                const auto& object = between["object"];
                EXPECT_EQ(object["number"], blocks ? 2 : 3);
                EXPECT_EQ(object["line"], blocks ? 7 : 12);
                EXPECT_EQ(object["subscenes"].size(), blocks ? 0U : 1U);
                (blocks ? opaque : glass) += 1;
            }
    }
    EXPECT_GT(opaque, 0U);
    EXPECT_GT(glass, 0U);
}

/// The terms of the rays of the JSON, added in their order, are the colours, and these those of the
/// rays above, to the bit: nothing is left out, nothing rounded.
void expect_exact_sums(const nlohmann::json& json) {
    for (const auto& ray : json["rays"])
        for (std::size_t channel = 0; channel < 3; ++channel) {
            double sum = ray["terms"][0]["value"][channel];
            for (std::size_t i = 1; i < ray["terms"].size(); ++i) {
                sum += ray["terms"][i]["value"][channel].get<double>();
                ASSERT_EQ(sum, ray["terms"][i]["sum"][channel]);
            }
            ASSERT_EQ(sum, ray["color"][channel]);
            if (ray["hit"].is_null())
                continue;
            double diffuse = 0;
            double highlight = 0;
            for (const auto& light : ray["lights"]) {
                diffuse += light["diffuse"][channel].get<double>();
                highlight += light["highlight"][channel].get<double>();
            }
            ASSERT_EQ(diffuse, ray["terms"][1]["value"][channel]);
            ASSERT_EQ(highlight, ray["terms"][2]["value"][channel]);
        }
    for (std::size_t channel = 0; channel < 3; ++channel) {
        float sum = 0;
        for (const auto& layer : json["layers"]) {
            sum += layer["value"][channel].get<float>();
            ASSERT_EQ(sum, layer["sum"][channel].get<float>());
        }
        const double full = 255.0 * std::min(1.0, std::max(0.0, static_cast<double>(sum)));
        ASSERT_EQ(std::floor(full + 0.5), json["bytes"][channel]);
    }
}

TEST(ExplainCommand, AddsUpToThePicturesByteExactly) {
    const ScratchFolder folder;
    folder.write("a.vera", busy_scene);
    const std::string options = " --raster 32x32 --depth 4 --sky 0.1 0.2 0.3 --ambient 0.1 0.1 0.1";
    ASSERT_EQ(run_vera(folder, "render a.vera -o a.ppm --antialias off" + options).exit_code, 0);
    const std::string picture = folder.read("a.ppm");
    const std::size_t header = picture.size() - std::size_t{3} * 32 * 32;
    for (std::size_t i = 0; i < 24; ++i) {
        const std::size_t x = i * 11 % 32;
        const std::size_t y = i * 5 % 32;
        const auto json = nlohmann::json::parse(
            explained(folder, std::to_string(x) + ' ' + std::to_string(y) + options + " --json"));
        expect_exact_sums(json);
        for (std::size_t channel = 0; channel < 3; ++channel)
            ASSERT_EQ(
                json["bytes"][channel],
                static_cast<unsigned char>(picture[header + 3 * (32 * y + x) + channel]))
                << x << ' ' << y;
    }
}

TEST(ExplainCommand, DrawsTheRays) {
    const ScratchFolder folder;
    folder.write("a.vera", busy_scene);
    explained(folder, "32 45 --raster 64x64 --svg rays.svg");
    const std::string svg = folder.read("rays.svg");
    expect_parts(
        svg, {"<svg xmlns", "view ray", "mirrored ray", "light 1", "sphere 2, mirror", "</svg>\n"});
    explained(folder, "32 45 --raster 64x64 --svg again.svg");
    EXPECT_EQ(folder.read("again.svg"), svg);
    // Not a picture of rays alone: the scene's outlines are there.
    EXPECT_NE(svg.find("<polyline points="), std::string::npos);
    EXPECT_EQ(explained(folder, "1 1 --raster 64x64 --svg -").substr(0, 5), "<?xml");
}

/// The area of the largest triangle between points of the drawing's lines of the scene.
double largest_triangle(const std::string& svg) {
    std::vector<std::array<double, 2>> points;
    const std::string before = "<polyline points=\"";
    for (std::size_t at = svg.find(before); at != std::string::npos;
         at = svg.find(before, at + 1)) {
        const std::size_t first = at + before.size();
        std::string numbers = svg.substr(first, svg.find('"', first) - first);
        std::ranges::replace(numbers, ',', ' ');
        std::istringstream stream(numbers);
        for (std::array<double, 2> point = {}; stream >> point[0] >> point[1];)
            points.push_back(point);
    }
    double largest = 0;
    for (const auto& a : points)
        for (const auto& b : points)
            for (const auto& c : points)
                largest = std::max(
                    largest,
                    std::abs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / 2);
    return largest;
}

TEST(ExplainCommand, DrawsTheSurfaceThatIsMetFromWhereItIsNotEdgeOn) {
    const ScratchFolder folder;

    // A square of 2 x 2 and the viewer straight before it, 6 away: seen wholly from aside, the
    // square would be a line.
    const struct {
        const char* square;
        const char* camera;
        const char* light;
    } scenes[] = {
        {"-1 -1 0  1 -1 0  1 1 0  -1 1 0", "0 0 6  -2 -2 0  2 -2 0  -2 2 0", "0 0 6"},
        {"0 -1 -1  0 -1 1  0 1 1  0 1 -1", "6 0 0  0 -2 2  0 -2 -2  0 2 2", "6 0 0"},
        {"-1 0 -1  1 0 -1  1 0 1  -1 0 1", "0 6 0  -2 0 2  2 0 2  -2 0 -2", "0 6 0"},
    };

    for (const auto& [square, camera, light] : scenes) {
        folder.write(
            "a.vera",
            fmt::format(
                "PROJECTION {}\nLI {} 30 1 1 1\nMA a DRF 1 1 1 CM a P4 {}\n",
                camera,
                light,
                square));
        explained(folder, "16 16 --raster 33x33 --svg rays.svg");
        EXPECT_GT(largest_triangle(folder.read("rays.svg")), 4000) << square;
    }
}

TEST(ExplainCommand, WritesHugeNumbersShort) {
    const ScratchFolder folder;
    folder.write(
        "a.vera",
        "PROJECTION 0 0 6e60  -2e60 -2e60 0  2e60 -2e60 0  -2e60 2e60 0\n"
        "LI 0 0 6e60 1e300 1e9 1 1\n"
        "MA a DRF 1 1 1 SDI 1e300 1e-300 0.1 CM a SP 0 0 0 1e60\n");
    for (const std::string& text :
         {explained(folder, "16 16 --raster 33x33"), run_vera(folder, "info a.vera").out}) {
        std::size_t digits = 0;
        for (const char letter : text) {
            digits = std::isdigit(static_cast<unsigned char>(letter)) != 0 ? digits + 1 : 0;
            ASSERT_LT(digits, 20U) << text;
        }
    }
}

/// What a ray's visits, and those of a shadow ray, list adds up to what was counted.
void expect_counted_visits(const nlohmann::json& ray) {
    std::size_t cells = 0;
    std::size_t tests = 0;
    for (const auto& visit : ray["visits"]) {
        cells += visit.contains("leaf_of") ? 0U : 1U;
        if (!visit.contains("objects"))
            continue;
        EXPECT_LE(visit["objects"].size(), visit["listed"]);
        for (const auto& object : visit["objects"])
            tests += object["outcome"] == "missed" || object["outcome"] == "met"
                ? object.count("object")
                : 0U;
    }
    EXPECT_EQ(cells, ray["cells"]);
    EXPECT_EQ(tests, ray["tests"]);
}

/// All objects in the lists that a ray visits.
std::vector<nlohmann::json> visited_objects(const nlohmann::json& ray) {
    std::vector<nlohmann::json> all;
    for (const auto& visit : ray["visits"])
        for (const auto& object : visit.value("objects", nlohmann::json::array()))
            all.push_back(object);
    return all;
}

std::size_t count_outcomes(const nlohmann::json& ray, const char* outcome) {
    std::size_t count = 0;
    for (const auto& object : visited_objects(ray))
        count += object["outcome"] == outcome ? 1U : 0U;
    return count;
}

bool meets_its_hit(const nlohmann::json& ray) {
    for (const auto& object : visited_objects(ray))
        if (object["outcome"] == "met" && object["object"] == ray["hit"]["object"]
            && object["distance"] == ray["hit"]["distance"])
            return true;
    return false;
}

TEST(ExplainCommand, ListsWhatRaysVisit) {
    const ScratchFolder folder;
    folder.write("a.vera", busy_scene);
    for (const std::string index : {"grid", "bvh"}) {
        const std::string options = "36 45 --raster 64x64 --visits --index " + index;
        const auto json = nlohmann::json::parse(explained(folder, options + " --json"));
        std::size_t entered = 0;
        std::size_t hits = 0;
        std::size_t met = 0;
        for (const auto& ray : json["rays"]) {
            expect_counted_visits(ray);
            if (ray["hit"].is_null())
                continue;
            for (const auto& light : ray["lights"])
                if (light["shadow_ray"]) {
                    expect_counted_visits(light);
                    entered += count_outcomes(light, "entered");
                }
            entered += count_outcomes(ray, "entered");
            met += meets_its_hit(ray) ? 1U : 0U;
            hits += 1;
        }
        EXPECT_GT(entered, 0U) << index;
        EXPECT_GT(hits, 0U) << index;
        EXPECT_EQ(met, hits) << index;
        expect_parts(
            explained(folder, options),
            {index == "grid" ? "visits        grid 0 of the scene, level 1" : "boxes of the scene",
             "ball, called at a.vera:8:1: entered",
             "sphere 2 (a.vera:7:1): met at distance "});
        explained(folder, options + " --svg visits.svg");
        expect_parts(folder.read("visits.svg"), {"id=\"visited\"", "the view ray is tested"});
    }
    EXPECT_EQ(explained(folder, "36 45 --raster 64x64").find("visits  "), std::string::npos);
}

/// Names of mesh files are in whatever encoding, and JSON is in UTF-8.
TEST(ExplainCommand, TellsNamesOfPartsAndMaterialsInAnyEncoding) {
    const ScratchFolder folder;
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\no \xE9\ng b c\nusemtl caf\xE9\nf 1 2 3\n");
    const ProgramRun text = run_vera(folder, "explain a.obj 25 35 --raster 64x64 -q");
    EXPECT_NE(text.out.find("  is part of    \xE9, within it b c\n"), std::string::npos)
        << text.out;
    const ProgramRun run = run_vera(folder, "explain a.obj 25 35 --raster 64x64 --json -q");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(nlohmann::json::parse(run.out)["rays"][0]["hit"]["material"], "caf\xEF\xBF\xBD")
        << run.out;
}

TEST(ExplainCommand, RefusesVisitsThatItCannotList) {
    const ScratchFolder folder;
    folder.write("a.vera", busy_scene);
    const ProgramRun run = run_vera(folder, "explain a.vera 1 1 --index brute --visits");
    EXPECT_EQ(run.exit_code, 2);
    EXPECT_NE(run.err.find("take --index grid or --index bvh"), std::string::npos) << run.err;
    // Glass before glass: each level of rays has twice as many.
    std::string panes = "PROJECTION 0 0 1  -1 -1 0  1 -1 0  -1 1 0\nLI 0 9 0 1 1 1 1\n"
                        "MA glass RAB 0.5 0.5 0.5 TAB 0.5 0.5 0.5\nCM glass\n";
    for (int i = 0; i < 800; ++i) {
        const std::string z = " -" + std::to_string(1 + i / 40) + " ";
        panes += "P3 -9 -9" + z + "9 -9" + z + "0 9" + z + "\n"; // forty times each
    }
    folder.write("b.vera", panes);
    const ProgramRun many =
        run_vera(folder, "explain b.vera 3 3 --raster 8x8 --depth 11 --visits --index grid");
    EXPECT_EQ(many.exit_code, 1);
    EXPECT_NE(many.err.find("visit more than 100000"), std::string::npos) << many.err;
    EXPECT_NE(many.err.find("--depth 2"), std::string::npos) << many.err;
}

TEST(ExplainCommand, RefusesPixelsThatThePictureDoesNotHave) {
    const ScratchFolder folder;
    folder.write("a.vera", busy_scene);

    const struct {
        const char* arguments;
        const char* problem;
    } wrong[] = {
        {"64 0", "X takes a whole number from 0 to 63; found 64"},
        {"0 32", "Y takes a whole number from 0 to 31; found 32"},
        {"1.5 0", "X takes a whole number from 0 to 63; found 1.5"},
        {"-1 0", "X takes a whole number from 0 to 63; found -1"},
        {"5", "Y is missing; write vera explain SCENE X Y"},
        {"5 left", "Y (row of the pixel, 0 at the top) takes a number; found 'left'"},
        {"5 5 --threads -1", "--threads takes a whole number from 0 to 1024; found -1"},
        {"5 5 --svg rays.png", "--svg writes SVG; found 'rays.png'; name it as in rays.svg"},
    };

    for (const auto& [arguments, problem] : wrong) {
        const ProgramRun run =
            run_vera(folder, std::string("explain a.vera ") + arguments + " --raster 64x32");
        EXPECT_EQ(run.exit_code, 2) << arguments;
        EXPECT_EQ(run.out, "");
        EXPECT_NE(run.err.find(problem), std::string::npos) << run.err;
    }
}

TEST(ExplainCommand, RefusesARayTreeThatNobodyCouldRead) {
    const ScratchFolder folder;
    folder.write(
        "a.vera",
        "PROJECTION 0 0 1  -1 -1 0  1 -1 0  -1 1 0\nLI 0 9 0 1 1 1 1\n"
        "CM glass P3 -9 -9 -1 9 -9 -1 0 9 -1 P3 -9 -9 -2 9 -9 -2 0 9 -2 P3 -9 -9 -3 9 -9 -3 0 9 "
        "-3\n"
        "MA glass RAB 0.5 0.5 0.5 TAB 0.5 0.5 0.5\n");
    const ProgramRun run = run_vera(folder, "explain a.vera 3 3 --raster 8x8 --depth 60");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(run.err.find("has more than 10000 rays"), std::string::npos) << run.err;
    EXPECT_NE(run.err.find("--depth 8"), std::string::npos) << run.err;
}

TEST(RenderLayers, AreWrittenBesideThePicture) {
    const ScratchFolder folder;
    folder.write("a.vera", busy_scene);
    const std::string command = "render a.vera --raster 40x33 ";
    const ProgramRun run = run_vera(folder, command + "-o a.png --layers a.exr");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    ASSERT_EQ(run_vera(folder, command + "-o b.png").exit_code, 0);
    EXPECT_EQ(folder.read("a.png"), folder.read("b.png"));
    const std::string layers = folder.read("a.exr");
    expect_parts(
        layers,
        {"direct.light1.diffuse.R",
         "refracted.firmament.B",
         "rounding.G",
         "material.id",
         "Encoding"});
    ASSERT_EQ(
        run_vera(
            folder, command + "-o c.png --layers c.exr --index grid --threads 1 --antialias off")
            .exit_code,
        0);
    // But for the settings that it tells, of the same length here: all that follows is the same.
    const std::string others = folder.read("c.exr");
    const std::size_t pixels = std::size_t{40} * 33;
    EXPECT_EQ(layers.substr(layers.size() - pixels), others.substr(others.size() - pixels));
}

TEST(RenderLayers, AreRefusedWhereTheyCannotBe) {
    const ScratchFolder folder;
    folder.write("a.vera", busy_scene);

    const struct {
        const char* options;
        const char* problem;
        int exit_code;
    } wrong[] = {
        {"--layers a.png", "--layers writes EXR; name the file so, as in layers.exr", 2},
        {"--layers -", "--layers writes EXR", 2},
        {"--layers a.exr --strategy depth", "--layers are those of rays", 2},
        {"--layers none/a.exr", "make its folder first", 3},
    };

    for (const auto& [options, problem, exit_code] : wrong) {
        const ProgramRun run =
            run_vera(folder, std::string("render a.vera --raster 8x8 -o a.ppm ") + options);
        EXPECT_EQ(run.exit_code, exit_code) << options;
        EXPECT_NE(run.err.find(problem), std::string::npos) << run.err;
        EXPECT_EQ(folder.file_count(), 1U) << options;
    }
}

TEST(RenderLayers, FollowTheFactorsOfLights) {
    const ScratchFolder folder;
    folder.write("a.vera", busy_scene);
    folder.write("two.ctl", "RASTER 8 8 SHADOWS LIGHTS 0 2");
    folder.write("one.ctl", "RASTER 8 8\nLIGHTS 1");
    const auto json = nlohmann::json::parse(explained(folder, "4 5 -c two.ctl --json"));
    EXPECT_EQ(json["rays"][0]["lights"][0]["intensity"], nlohmann::json({0.0, 0.0, 0.0}));
    const ProgramRun run = run_vera(folder, "render a.vera -c one.ctl -o a.png");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_NE(
        run.err.find("one.ctl:2:1: error: LIGHTS gives 1 factor, but the scene has 2 lights"),
        std::string::npos)
        << run.err;
}

TEST(ExplainCommand, HelpsWithExamples) {
    const ScratchFolder folder;
    const ProgramRun run = run_vera(folder, "explain --help");
    EXPECT_EQ(run.exit_code, 0);
    EXPECT_NE(run.out.find("Examples:"), std::string::npos);
}

} // namespace
} // namespace vera
