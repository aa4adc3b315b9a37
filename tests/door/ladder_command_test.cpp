// SPDX-License-Identifier: Apache-2.0
#include "vera/image/image_file.h"

#include "door/program.h"
#include <nlohmann/json.hpp>

namespace vera {
namespace {

/// The small scene with a mirror, a highlight and a second light.
const std::string full_scene = std::string(small_scene)
    + "LI -4 5 6 20 1 0.9 0.8  CM silver  SP 2 0.6 2 0.6\n"
      "MA silver DRF 0.2 0.2 0.2 RAB 0.6 0.6 0.6 SPC 0.95\n";

constexpr const char* small_picture = " --raster 48x36 --depth 3 --ambient 0.2 0.2 0.2 -q";

const char* const file_names[] = {
    "1-flat.png",
    "2-antialiased.png",
    "3-diffuse.png",
    "4-highlights.png",
    "5-rays.png",
    "difference-1-2.png",
    "difference-2-3.png",
    "difference-3-4.png",
    "difference-4-5.png",
    "ladder.json",
    "sheet.svg"};

std::size_t files_in(const std::filesystem::path& folder) {
    return static_cast<std::size_t>(std::distance(
        std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator()));
}

nlohmann::json report(const ScratchFolder& folder, const std::string& name) {
    return nlohmann::json::parse(folder.read(name + "/ladder.json"));
}

TEST(LadderCommand, WritesEachStepTheDifferencesASheetAndAReport) {
    const ScratchFolder folder;
    folder.write("a.vera", full_scene);
    const ProgramRun run =
        run_vera(folder, std::string("ladder a.vera -o steps --json") + small_picture);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_EQ(run.err, "");
    for (const char* name : file_names)
        EXPECT_TRUE(std::filesystem::exists(folder.path() / "steps" / name)) << name;
    EXPECT_EQ(files_in(folder.path() / "steps"), std::size(file_names));
    EXPECT_EQ(run.out, folder.read("steps/ladder.json"));

    const nlohmann::json json = report(folder, "steps");
    ASSERT_EQ(json["steps"].size(), 5U);
    EXPECT_EQ(json["steps"][0]["rays"]["view_rays"], 48 * 36);
    EXPECT_EQ(json["steps"][3]["rays"]["shadow_rays"], 0);
    EXPECT_GT(json["steps"][4]["rays"]["shadow_rays"], 0);
    EXPECT_GT(json["steps"][4]["rays"]["mirrored_rays"], 0);
    for (std::size_t i = 1; i < 5; ++i) {
        EXPECT_GT(json["steps"][i]["difference"]["changed_pixels"], 0) << i;
        EXPECT_FALSE(json["steps"][i].contains("unchanged")) << i;
    }
}

TEST(LadderCommand, EndsWithThePictureThatIsRenderedWithTheSameSettings) {
    const ScratchFolder folder;
    folder.write("a.vera", full_scene);
    for (const std::string exposure : {"", " --exposure 0.6"}) {
        ASSERT_EQ(
            run_vera(folder, "ladder a.vera -o steps" + exposure + small_picture).exit_code, 0);
        ASSERT_EQ(
            run_vera(folder, "render a.vera -o a.png" + exposure + small_picture).exit_code, 0);
        EXPECT_EQ(
            read_image(folder.path() / "steps/5-rays.png").samples,
            read_image(folder.path() / "a.png").samples)
            << exposure;
    }
}

/// The bytes of the PNG from which its text of that name is read.
std::string text_of(const std::string& png, const std::string& name) {
    const std::size_t at = png.find("tEXt" + name + '\0');
    if (at == std::string::npos)
        return {};
    const std::size_t first = at + 5 + name.size();
    return png.substr(first, png.find("tEXt", first) - first);
}

TEST(LadderCommand, WritesPicturesThatTellOfThemselvesAsRenderDoes) {
    const ScratchFolder folder;
    folder.write("a.vera", full_scene);
    for (const std::string exposure : {"", " --exposure 0.6"}) {
        ASSERT_EQ(
            run_vera(folder, "ladder a.vera -o steps" + exposure + small_picture).exit_code, 0);
        ASSERT_EQ(
            run_vera(folder, "render a.vera -o a.png" + exposure + small_picture).exit_code, 0);
        const std::string last = folder.read("steps/5-rays.png");
        for (const char* name : {"Software", "Scene hash", "Camera"}) {
            EXPECT_NE(text_of(last, name), "") << name;
            EXPECT_EQ(
                text_of(last, name).substr(0, 20),
                text_of(folder.read("a.png"), name).substr(0, 20));
        }
        EXPECT_EQ(text_of(last, "Title").substr(0, 26), "Shadows, mirrors and glass");
        const std::string settings = text_of(last, "Settings");
        EXPECT_NE(settings.find("RASTER 48 36 RTDEPTH 3"), std::string::npos) << settings;
        EXPECT_EQ(settings.find("EXPMES"), std::string::npos) << settings;
        EXPECT_EQ(settings.find("LIGHTS") == std::string::npos, exposure.empty()) << settings;
        EXPECT_NE(
            text_of(folder.read("steps/1-flat.png"), "Settings").find("RTDEPTH 1"),
            std::string::npos);
    }
}

TEST(LadderCommand, CountsProbeRaysApart) {
    const ScratchFolder folder;
    folder.write("a.vera", full_scene);
    ASSERT_EQ(
        run_vera(folder, "ladder a.vera -o steps --raster 1x1 --antialias off -q").exit_code, 0);
    const std::string one = folder.read("steps/sheet.svg");
    EXPECT_NE(one.find(">1 ray<"), std::string::npos);
    EXPECT_EQ(one.find(">1 rays<"), std::string::npos);
    for (const char* kind : {">view<", ">probe<", ">shadow<", ">mirrored<", ">refracted<"})
        EXPECT_NE(one.find(kind), std::string::npos) << kind;
}

TEST(LadderCommand, SaysWhichStepsChangeNothing) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    const ProgramRun run =
        run_vera(folder, "ladder a.vera -o steps --width 40 --shadows off --antialias off");
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_NE(run.err.find("2-antialiased.png"), std::string::npos) << run.err;
    EXPECT_NE(
        run.err.find("changes nothing: the settings leave anti-aliasing off"), std::string::npos)
        << run.err;
    const nlohmann::json json = report(folder, "steps");
    EXPECT_EQ(json["width"], 40);
    EXPECT_FALSE(json["steps"][2].contains("unchanged"));
    for (const std::size_t step : {1U, 3U, 4U}) {
        EXPECT_TRUE(json["steps"][step].contains("unchanged")) << step;
        EXPECT_EQ(json["steps"][step]["difference"]["changed_pixels"], 0) << step;
    }
    EXPECT_NE(folder.read("steps/sheet.svg").find("Changes nothing here"), std::string::npos);
}

TEST(LadderCommand, KeepsOffFoldersThatItDidNotWrite) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    std::filesystem::create_directory(folder.path() / "mine");
    folder.write("mine/letter.txt", "dear");
    const std::string ladder = "ladder a.vera --raster 8x8 -q -o ";

    const ProgramRun refused = run_vera(folder, ladder + "mine");
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(
        refused.err.find("'mine' holds files that 'vera ladder' did not write"), std::string::npos)
        << refused.err;
    EXPECT_EQ(files_in(folder.path() / "mine"), 1U);
    EXPECT_EQ(run_vera(folder, ladder + "mine --overwrite").exit_code, 0);
    EXPECT_EQ(folder.read("mine/letter.txt"), "dear");
    EXPECT_EQ(run_vera(folder, ladder + "mine").exit_code, 0); // its own now

    const ProgramRun file = run_vera(folder, ladder + "a.vera");
    EXPECT_EQ(file.exit_code, 2);
    EXPECT_NE(file.err.find("is a file"), std::string::npos) << file.err;
    const ProgramRun piped = run_vera(folder, ladder + "-");
    EXPECT_EQ(piped.exit_code, 2);
    EXPECT_NE(piped.err.find("standard output cannot take it"), std::string::npos) << piped.err;
    const ProgramRun nowhere = run_vera(folder, ladder + "no/where");
    EXPECT_EQ(nowhere.exit_code, 3);
    EXPECT_NE(nowhere.err.find("cannot make the folder 'no/where'"), std::string::npos)
        << nowhere.err;
}

TEST(LadderCommand, LeavesNoFolderWhereItFails) {
    const ScratchFolder folder;
    folder.write("a.vera", small_scene);
    for (const char* wrong : {"--width 0", "--width 1.5", "--width 2000000", "--threads -1"}) {
        const ProgramRun run =
            run_vera(folder, std::string("ladder a.vera -o steps --raster 8x8 ") + wrong);
        EXPECT_EQ(run.exit_code, 2) << wrong << run.err;
    }
    EXPECT_EQ(run_vera(folder, "ladder b.vera -o steps").exit_code, 3);
    const ProgramRun stopped = run_vera(
        folder,
        "ladder a.vera -o steps --raster 9000x9000 -q & child=$!; sleep 0.5; kill -INT $child; "
        "wait $child");
    EXPECT_EQ(stopped.exit_code, 130) << stopped.err;
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "steps"));
    EXPECT_EQ(folder.file_count(), 1U);
}

/// The scene hash that a picture of the scene tells.
std::string hash_of(const ScratchFolder& folder, const std::string& scene) {
    folder.write("a.vera", scene);
    EXPECT_EQ(run_vera(folder, std::string("render a.vera -o a.png") + small_picture).exit_code, 0);
    return text_of(folder.read("a.png"), "Scene hash").substr(0, 16);
}

TEST(RenderCommand, TellsVersionsOfASceneApartByAHash) {
    const ScratchFolder folder;
    const std::string scene = full_scene;
    const std::string hash = hash_of(folder, scene);
    EXPECT_EQ(hash, hash_of(folder, scene));
    std::set<std::string> hashes = {hash};
    // Bytes at every place of a word of eight, and lengths that differ by nothing else.
    for (std::size_t i = 1; i <= 9; ++i)
        hashes.insert(hash_of(folder, scene + std::string(i, ' ')));
    for (std::size_t i = 0; i < 9; ++i)
        hashes.insert(
            hash_of(folder, scene + std::string(i, ' ') + '\n' + std::string(9 - i, ' ')));
    EXPECT_EQ(hashes.size(), 19U);
}

} // namespace
} // namespace vera
