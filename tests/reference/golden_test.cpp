// SPDX-License-Identifier: Apache-2.0
#include "vera/accel/grid_tree.h"
#include "vera/image/image_file.h"
#include "vera/render/render_scene.h"

#include <cstdlib>

#include "reference/example_scenes.h"

namespace vera::reference {
namespace {

class GoldenPicture : public testing::TestWithParam<std::string> {};

// Made again with VERA_BLESS=1, and then to be looked at.
TEST_P(GoldenPicture, IsTheSameToTheByte) {
    auto [scene, settings] = example(GetParam(), 160);
    const auto index = make_grid_tree(scene);
    const Image image =
        render_scene(scene, *scene.camera, *index, settings, SampleType::integer8).image;

    const std::string name = std::filesystem::path(GetParam()).stem().string() + ".png";
    const std::filesystem::path golden = source_folder() / "tests/golden" / name;
    if (std::getenv("VERA_BLESS"))
        write_image(image, golden, ImageFileFormat::png8);
    ASSERT_TRUE(std::filesystem::exists(golden)) << "make it with VERA_BLESS=1 and look at it";
    const Image expected = read_image(golden);
    if (image.samples == expected.samples && image.width == expected.width)
        return;

    const std::filesystem::path found = std::filesystem::path(testing::TempDir()) / name;
    write_image(image, found, ImageFileFormat::png8);
    FAIL() << "the picture is no longer " << golden << " but " << found;
}

INSTANTIATE_TEST_SUITE_P(Examples, GoldenPicture, testing::ValuesIn(example_files()), example_name);

} // namespace
} // namespace vera::reference
