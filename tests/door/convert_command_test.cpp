// SPDX-License-Identifier: Apache-2.0
#include "vera/image/image_file.h"

#include <set>

#include "door/program.h"
#include <gmock/gmock.h>

namespace vera {
namespace {

using testing::HasSubstr;

using Rgb8 = std::array<std::uint8_t, 3>;

std::set<Rgb8> colors_of(const Image& image) {
    const auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
    std::set<Rgb8> colors;
    for (std::size_t i = 0; i < samples.size(); i += 3)
        colors.insert({samples[i], samples[i + 1], samples[i + 2]});
    return colors;
}

/// A small picture of many colours, as a.png and a.vra.
class ConvertCommand : public testing::Test {
protected:
    ConvertCommand() {
        Image image = blank_image(60, 40, SampleType::integer8);
        auto& samples = std::get<std::vector<std::uint8_t>>(image.samples);
        for (std::size_t i = 0; i < samples.size(); ++i)
            samples[i] = static_cast<std::uint8_t>(i / 3 % 60 * 4 + i % 3 * (i / 180));
        write_image(image, folder.path() / "a.png", ImageFileFormat::png8);
        write_image(image, folder.path() / "a.vra", ImageFileFormat::vra8);
    }

    Image read(const std::string& name) const { return read_image(folder.path() / name); }

    /// The command must be refused as wrong; what it says.
    std::string refusal(const std::string& arguments) const {
        const std::size_t before = folder.file_count();
        const ProgramRun run = run_vera(folder, "convert " + arguments);
        EXPECT_EQ(run.exit_code, 2) << arguments << '\n' << run.err;
        EXPECT_EQ(folder.file_count(), before) << arguments;
        return run.err;
    }

    void must_run(const std::string& arguments) const {
        const ProgramRun run = run_vera(folder, "convert " + arguments);
        EXPECT_EQ(run.exit_code, 0) << arguments << '\n' << run.err;
    }

    ScratchFolder folder;
};

TEST_F(ConvertCommand, GoesFromEachFormatToEachOther) {
    const Image image = read("a.png");
    for (const char* name : {"b.png", "b.ppm", "b.vra", "b.exr", "b.pfm"}) {
        must_run(std::string("a.png ") + name);
        for (const char* back : {"c.png", "c.vra", "c.ppm"}) {
            must_run(std::string(name) + ' ' + back);
            EXPECT_EQ(read(back).samples, image.samples) << name << ' ' << back;
        }
    }
    must_run("a.png b.jpg --quality 90");
    must_run("a.png --format png16 - > wide.png");
    EXPECT_EQ(sample_type(read("wide.png")), SampleType::integer16);
}

TEST_F(ConvertCommand, CutsAndBrightens) {
    must_run("a.vra b.png --crop 10x7+50+33");
    must_run("a.png c.png --crop 10x7+50+33");
    EXPECT_EQ(read("b.png").width, 10U);
    EXPECT_EQ(read("b.png").height, 7U);
    EXPECT_EQ(read("b.png").samples, read("c.png").samples);
    must_run("a.png dark.exr --exposure -1");
    must_run("dark.exr same.png --exposure 1");
    const auto same = std::get<std::vector<std::uint8_t>>(read("same.png").samples);
    const auto before = std::get<std::vector<std::uint8_t>>(read("a.png").samples);
    for (std::size_t i = 0; i < same.size(); ++i)
        ASSERT_NEAR(same[i], before[i], 1);
}

TEST_F(ConvertCommand, KeepsTheErrorOfACompressedRaster) {
    must_run("a.png b.vra --error 3");
    const auto lossy = std::get<std::vector<std::uint8_t>>(read("b.vra").samples);
    const auto before = std::get<std::vector<std::uint8_t>>(read("a.png").samples);
    for (std::size_t i = 0; i < lossy.size(); ++i)
        ASSERT_NEAR(lossy[i], before[i], 3);
}

TEST_F(ConvertCommand, TakesColoursOfACompressedRasterAsOfAnyPicture) {
    for (const char* dither : {"none", "floyd-steinberg", "blue-noise"}) {
        must_run(std::string("a.png b.png --colors 5 --dither ") + dither);
        must_run(std::string("a.vra c.png --colors 5 --threads 2 --dither ") + dither);
        EXPECT_EQ(folder.read("b.png"), folder.read("c.png"));
        EXPECT_LE(colors_of(read("b.png")).size(), 5U);
        must_run(std::string("a.png d.ppm --colors 5 --dither ") + dither);
        EXPECT_EQ(read("d.ppm").samples, read("b.png").samples);
    }
}

TEST_F(ConvertCommand, TakesPalettesByNameAndFromFiles) {
    folder.write("p.txt", "#102030 ; night\n#ffffff\n");
    must_run("a.png b.png --palette p.txt");
    EXPECT_EQ(colors_of(read("b.png")), (std::set<Rgb8>{{16, 32, 48}, {255, 255, 255}}));
    must_run("a.png b.png --palette bw");
    EXPECT_EQ(colors_of(read("b.png")), (std::set<Rgb8>{{0, 0, 0}, {255, 255, 255}}));
    folder.write("wrong.txt", "#102030\nblue\n");
    const ProgramRun run = run_vera(folder, "convert a.png b.png --palette wrong.txt");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr("wrong.txt:2:1: error: expected a colour, found 'blue'"));
}

TEST_F(ConvertCommand, WritesGifsAndSeries) {
    must_run("a.png b.gif");
    EXPECT_EQ(folder.read("b.gif").substr(0, 6), "GIF89a");
    must_run("a.png a.vra film.gif --colors 8 --delay 5");
    EXPECT_THAT(folder.read("film.gif"), HasSubstr("NETSCAPE2.0"));
    std::filesystem::create_directory(folder.path() / "out");
    must_run("a.png b.exr --exposure 2");
    must_run("a.png b.exr out --format png --colors 6 --dither none --palette-for-all");
    std::set<Rgb8> all = colors_of(read("out/a.png"));
    all.merge(colors_of(read("out/b.png")));
    EXPECT_LE(all.size(), 6U);
    EXPECT_THAT(refusal("a.png a.vra out --format png"), HasSubstr("would both become"));
    EXPECT_THAT(refusal("a.png b.exr c.png"), HasSubstr("2 pictures do not go into 'c.png'"));
    must_run("a.png cut.png --crop 5x5+0+0");
    const ProgramRun sizes = run_vera(folder, "convert a.png cut.png no.gif");
    EXPECT_EQ(sizes.exit_code, 1);
    EXPECT_THAT(
        sizes.err, HasSubstr("cut.png: error: it has 5 x 5 pixels, and 'a.png' has 60 x 40"));
}

TEST_F(ConvertCommand, RunsTheExamplesOfItsHelp) {
    const Image image = blank_image(330, 260, SampleType::integer8);
    for (const char* name : {"picture.png", "1.png", "2.png", "3.png"})
        write_image(image, folder.path() / name, ImageFileFormat::png8);
    must_run("picture.png picture.exr");
    std::filesystem::create_directory(folder.path() / "out");
    const std::string help = run_vera(folder, "convert --help").out;
    const std::string command = "  vera convert ";
    int examples = 0;
    for (std::size_t at = help.find(command, help.find("Examples:")); at != std::string::npos;
         at = help.find(command, at + 1), ++examples) {
        const std::size_t first = at + command.size();
        must_run(help.substr(first, help.find('\n', first) - first));
    }
    EXPECT_GE(examples, 5);
}

TEST_F(ConvertCommand, RefusesWhatMakesNoSense) {
    EXPECT_THAT(
        refusal("a.png b.png --colors 0"),
        HasSubstr("--colors takes a whole number from 2 to 256; found 0"));
    EXPECT_THAT(refusal("a.png"), HasSubstr("takes the picture to read and the one to write"));
    EXPECT_THAT(refusal("a.png b.xyz"), HasSubstr("give --format with one of png"));
    EXPECT_THAT(refusal("a.png b.gfi"), HasSubstr("did you mean 'b.gif'"));
    EXPECT_THAT(refusal("a.png no/"), HasSubstr("there is no folder 'no/'; make it first"));
    EXPECT_THAT(refusal("a.png -"), HasSubstr("needs --format"));
    EXPECT_THAT(refusal("a.png b.png --format tiff"), HasSubstr("does not know 'tiff'"));
    EXPECT_THAT(refusal("a.png b.png --colors 1"), HasSubstr("from 2 to 256; found 1"));
    EXPECT_THAT(refusal("a.png b.png --colors 5.5"), HasSubstr("whole number"));
    EXPECT_THAT(refusal("a.png b.png --colors 5 --palette bw"), HasSubstr("give one of them"));
    EXPECT_THAT(refusal("a.png b.png --palette vga"), HasSubstr("knows no 'vga'"));
    EXPECT_THAT(refusal("a.png b.png --dither none"), HasSubstr("needs --colors N"));
    EXPECT_THAT(refusal("a.png b.png --colors 5 --dither some"), HasSubstr("--dither"));
    EXPECT_THAT(refusal("a.png b.jpg --colors 5"), HasSubstr("JPEG does not keep"));
    EXPECT_THAT(refusal("a.png b.exr --colors 5"), HasSubstr("have 8 bits"));
    EXPECT_THAT(refusal("a.png b.png --error 2"), HasSubstr("--error is for"));
    EXPECT_THAT(refusal("a.png b.vra --error 128"), HasSubstr("from 0 to 127"));
    EXPECT_THAT(refusal("a.png b.vra --error 2 --colors 4"), HasSubstr("leave one out"));
    EXPECT_THAT(refusal("a.png b.png --quality 5"), HasSubstr("--quality is for JPEG"));
    EXPECT_THAT(refusal("a.png b.png --exposure nan"), HasSubstr("--exposure"));
    for (const char* crop : {"5x5", "0x5+1+1", "5x5+1+1x", "-5x5+1+1"})
        EXPECT_THAT(refusal(std::string("a.png b.png --crop ") + crop), HasSubstr("--crop takes"));
    for (const char* crop :
         {"60x40+1+0", "99999999999x5+0+0", "5x5+1+99999999999999999999999999999999"})
        EXPECT_THAT(
            refusal(std::string("a.png b.png --crop ") + crop),
            HasSubstr("is not within the picture, which has 60 x 40 pixels; take less"));
    std::filesystem::create_directory(folder.path() / "out");
    for (const char* no_film : {"a.png b.png", "a.png b.gif", "a.png a.vra out --format gif"})
        EXPECT_THAT(
            refusal(std::string(no_film) + " --delay 10"),
            HasSubstr("--delay is for one GIF that shows several pictures in turn"));
    for (const char* one : {"a.png b.gif", "a.png b.png --colors 9"})
        EXPECT_THAT(
            refusal(std::string(one) + " --palette-for-all"),
            HasSubstr("--palette-for-all is for several pictures"));
    EXPECT_THAT(refusal("- out --format png"), HasSubstr("convert it alone"));
    EXPECT_THAT(refusal("a.png b.png --quality 95"), HasSubstr("--quality is for JPEG"));
    EXPECT_EQ(run_vera(folder, "convert none.png b.png").exit_code, 3);
    const ProgramRun endless = run_vera(folder, "convert a.png b.png --palette /dev/zero");
    EXPECT_EQ(endless.exit_code, 1);
    EXPECT_THAT(endless.err, HasSubstr("more than 1 MiB came from this pipe or device"));
    folder.write("long.txt", std::string((1U << 20U) + 1, '\n'));
    const ProgramRun longest = run_vera(folder, "convert a.png b.png --palette long.txt");
    EXPECT_EQ(longest.exit_code, 1);
    EXPECT_THAT(longest.err, HasSubstr("this is no palette: it has more than a million bytes"));
    folder.write("broken.png", "no picture");
    EXPECT_EQ(run_vera(folder, "convert broken.png b.png").exit_code, 1);
}

TEST_F(ConvertCommand, ReadsEachOfSeveralPicturesOnce) {
    std::filesystem::create_directory(folder.path() / "out");
    for (const char* options : {"", "--colors 8", "--colors 8 --palette-for-all"}) {
        // A pipe has nothing to read again: its second reader would wait for ever.
        const ProgramRun run = run_vera(
            folder,
            std::string("convert pipe.png a.png out --format png ") + options,
            "rm -f pipe.png; mkfifo pipe.png; cat a.png >pipe.png & timeout 60");
        EXPECT_EQ(run.exit_code, 0) << options << '\n' << run.err;
        EXPECT_EQ(read("out/pipe.png").samples, read("out/a.png").samples) << options;
    }
}

TEST_F(ConvertCommand, WritesMorePicturesThanAProcessMayHaveFiles) {
    std::filesystem::create_directory(folder.path() / "out");
    constexpr int pictures = 60;
    std::string names;
    for (int i = 0; i < pictures; ++i) {
        const std::string name = std::to_string(i) + ".ppm";
        folder.write(name, "P6\n1 1\n255\nabc");
        names += name + " ";
    }
    const ProgramRun run =
        run_vera(folder, "convert " + names + "out --format png", "ulimit -n 40;");
    EXPECT_EQ(run.exit_code, 0) << run.err;
    std::size_t written = 0;
    for (const auto& file : std::filesystem::directory_iterator(folder.path() / "out"))
        written += file.path().extension() == ".png" ? 1 : 0;
    EXPECT_EQ(written, pictures);
}

TEST_F(ConvertCommand, WritesNoneOfSeveralPicturesWhereOneCannotBeRead) {
    std::filesystem::create_directory(folder.path() / "out");
    folder.write("broken.png", folder.read("a.png").substr(0, 200));
    folder.write("z.vra", folder.read("a.vra").substr(0, 200));
    for (const char* wrong : {"none.png", "broken.png", "z.vra"}) {
        const ProgramRun run =
            run_vera(folder, std::string("convert a.png ") + wrong + " out --format ppm");
        EXPECT_NE(run.exit_code, 0) << wrong;
        EXPECT_THAT(run.err, HasSubstr(wrong));
        EXPECT_TRUE(std::filesystem::is_empty(folder.path() / "out")) << wrong;
    }
    must_run("a.png out --format ppm");
    EXPECT_FALSE(std::filesystem::is_empty(folder.path() / "out"));
}

} // namespace
} // namespace vera
