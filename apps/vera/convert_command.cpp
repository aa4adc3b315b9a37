// SPDX-License-Identifier: Apache-2.0
#include "vera/base/diagnostic.h"
#include "vera/base/output_file.h"
#include "vera/base/version.h"
#include "vera/image/converted_image.h"
#include "vera/image/dither.h"
#include "vera/image/image_file.h"
#include "vera/image/indexed_file.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <map>
#include <optional>

#include "command.h"
#include "interrupt.h"
#include "messages.h"
#include "option_values.h"
#include "picture_source.h"
#include "progress_display.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

namespace fs = std::filesystem;

constexpr double jpeg_quality_by_default = 95;
constexpr double delay_by_default = 10;

struct Request {
    std::vector<std::string> paths; ///< pictures to read, and at the end what to write
    std::string format;
    std::optional<double> colors;
    std::string palette;
    std::optional<Dither> dither;
    bool palette_for_all = false;
    std::string crop;
    double exposure = 0;
    double error = 0;
    std::optional<double> jpeg_quality;
    std::optional<double> delay;
    double threads = 0;

    std::string output() const { return paths.back(); }

    std::vector<std::string> inputs() const { return {paths.begin(), paths.end() - 1}; }

    bool is_reduced() const { return colors || !palette.empty(); }
};

/// What is written: a GIF, or one of the formats that hold any colours.
struct Format {
    std::optional<ImageFileFormat> of_image;

    bool is_gif() const { return !of_image; }
};

std::optional<Format> format_named(const std::string& name) {
    if (CLI::detail::to_lower(name) == "gif")
        return Format{};
    if (const auto format = format_from_name(name))
        return Format{format};
    return std::nullopt;
}

Format output_format(const Request& request) {
    const std::string names = format_names() + ", gif";
    if (!request.format.empty()) {
        if (const auto format = format_named(request.format))
            return *format;
        throw CommandLineError(
            fmt::format("--format does not know '{}'; it knows {}", request.format, names));
    }
    const fs::path output = request.output();
    if (output == "-")
        throw CommandLineError("a picture on standard output needs --format, as in --format png");
    if (fs::is_directory(output))
        throw CommandLineError(fmt::format(
            "pictures in the folder '{}' need --format, as in --format png", request.output()));
    if (!output.has_filename())
        throw CommandLineError(fmt::format(
            "there is no folder '{}'; make it first, or name a file", request.output()));
    if (CLI::detail::to_lower(output.extension().string()) == ".gif")
        return {};
    if (const auto format = format_from_extension(output))
        return {format};
    throw CommandLineError(fmt::format(
        "cannot tell the format of '{}' by its name; {}give --format with one of {}",
        request.output(),
        similar_file(output, {".png", ".exr", ".jpg", ".jpeg", ".ppm", ".pfm", ".vra", ".gif"}),
        names));
}

bool is_vra(const Format& format) {
    return format.of_image == ImageFileFormat::vra8 || format.of_image == ImageFileFormat::vra16;
}

void check_output(const Request& request, const Format& format) {
    if (request.error != 0 && !is_vra(format))
        throw CommandLineError(
            "--error is for VERA's compressed raster; write a .vra, or leave it out");
    if (request.error != 0 && request.is_reduced())
        throw CommandLineError(
            "--error would change the colours that --colors and --palette choose; leave one out");
    if (request.jpeg_quality && format.of_image != ImageFileFormat::jpeg)
        throw CommandLineError("--quality is for JPEG; write a .jpg, or leave it out");
    const bool is_one = request.inputs().size() == 1;
    if (request.delay && (!format.is_gif() || is_one || fs::is_directory(request.output())))
        throw CommandLineError(
            "--delay is for one GIF that shows several pictures in turn; name more of them and a "
            ".gif, or leave it out");
    if (request.palette_for_all && is_one)
        throw CommandLineError(
            "--palette-for-all is for several pictures; name more, or leave it out");
    if (is_one || format.is_gif() || fs::is_directory(request.output()))
        return;
    throw CommandLineError(fmt::format(
        "{} pictures do not go into '{}'; name a folder that is there, or a .gif to show them in "
        "turn",
        request.inputs().size(),
        request.output()));
}

/// That what reduces colours goes together, and into the format.
void check_colors(const Request& request, const Format& format) {
    if (request.colors && !request.palette.empty())
        throw CommandLineError(
            "--colors chooses colours and --palette names them; give one of them");
    if (!request.is_reduced() && !format.is_gif() && (request.dither || request.palette_for_all))
        throw CommandLineError(fmt::format(
            "{} needs --colors N or --palette NAME",
            request.dither ? "--dither" : "--palette-for-all"));
    if (!request.is_reduced() || format.is_gif())
        return;
    if (format.of_image == ImageFileFormat::jpeg)
        throw CommandLineError(
            "JPEG does not keep the colours of a palette; write a .png or .gif instead");
    if (sample_type(*format.of_image) != SampleType::integer8)
        throw CommandLineError(
            "colours of a palette have 8 bits; write png, gif, ppm or vra instead");
}

/// What works on rows tells how far it is, and can be stopped.
class RowProgress {
public:
    RowProgress(const Console& console, std::size_t rows)
        : display_(console, "colours")
        , progress_(display_.callback())
        , cancel_(console.cancel)
        , rows_(rows) {}

    void row() {
        cancel_.throw_if_raised();
        if (progress_)
            progress_(static_cast<double>(++done_) / static_cast<double>(rows_));
    }

private:
    CancellableWork work_;
    ProgressDisplay display_;
    Progress progress_;
    const CancelFlag& cancel_;
    std::size_t rows_;
    std::size_t done_ = 0;
};

/// No more than 256 colours can need, with long comments.
std::vector<std::byte> palette_bytes(const std::string& name) {
    constexpr std::size_t most = std::size_t{1} << 20U;
    std::error_code unknown;
    const std::uintmax_t size = fs::file_size(name, unknown); // of a pipe it is not known
    std::vector<std::byte> bytes;
    if (unknown || size <= most)
        bytes = file_bytes(name, most);
    if (!unknown && size > most)
        throw InputError({Diagnostic{
            .place = {.file = name},
            .problem = "this is no palette: it has more than a million bytes",
            .remedy = "write one colour of #rrggbb a line, at most 256"}});
    return bytes;
}

Palette given_palette(const std::string& name) {
    if (const auto palette = named_palette(name))
        return *palette;
    if (!fs::exists(name))
        throw CommandLineError(fmt::format(
            "--palette knows no '{}', and there is no such file; it knows {}",
            name,
            palette_names()));
    const std::vector<std::byte> bytes = palette_bytes(name);
    return palette_from_text({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, name);
}

Palette chosen_palette(const Request& request, const std::vector<const PictureSource*>& sources) {
    if (!request.palette.empty())
        return given_palette(request.palette);
    ColorHistogram histogram;
    for (const PictureSource* source : sources)
        source->add_to(histogram);
    constexpr std::size_t most_colors = 256;
    return optimal_palette(
        histogram, request.colors ? static_cast<std::size_t>(*request.colors) : most_colors);
}

/// The picture in a palette's colours, as it is asked for; source and progress must outlive it.
IndexedPicture reduced(
    const Request& request,
    const PictureSource& source,
    const Palette& palette,
    RowProgress& progress) {
    const auto rows = std::make_shared<PictureRows>(source.rows());
    const auto reducer = std::make_shared<ColorReducer>(
        palette, request.dither.value_or(Dither::floyd_steinberg), source.width());
    return {source.width(), source.height(), palette, [=, &progress](std::span<std::uint8_t> row) {
                progress.row();
                reducer->reduce(rows->next(), row);
            }};
}

Image with_colors(const IndexedPicture& picture) {
    Image image = blank_image(picture.width, picture.height, SampleType::integer8);
    auto* sample = std::get<std::vector<std::uint8_t>>(image.samples).data();
    std::vector<std::uint8_t> numbers(picture.width);
    for (std::size_t y = 0; y < picture.height; ++y) {
        picture.next_row(numbers);
        for (const std::uint8_t number : numbers)
            sample = std::copy_n(picture.palette[number].begin(), 3, sample);
    }
    return image;
}

ImageWriteSettings write_settings(const Request& request, const Format& format) {
    const unsigned scale = format.of_image == ImageFileFormat::vra16 ? 257 : 1;
    return {
        .jpeg_quality = static_cast<int>(
            number_of("--quality", request.jpeg_quality.value_or(jpeg_quality_by_default), 1, 100)),
        .raster_error = scale * whole_of("--error", request.error, 0, 127)};
}

PictureMetadata metadata() {
    return {{"Software", fmt::format("vera {}", version)}};
}

void write_reduced(
    const Request& request,
    const Format& format,
    const PictureSource& source,
    const Palette& palette,
    OutputFile& file,
    const Console& console) {
    RowProgress progress(console, source.height());
    const IndexedPicture picture = reduced(request, source, palette, progress);
    if (format.is_gif())
        write_gif({&picture, 1}, file);
    else if (format.of_image == ImageFileFormat::png8)
        write_indexed_png(picture, file, metadata());
    else
        write_image(
            with_colors(picture),
            file,
            *format.of_image,
            metadata(),
            write_settings(request, format));
}

/// The caller commits.
void write_one(
    const Request& request,
    const Format& format,
    PictureSource& source,
    OutputFile& file,
    const Palette* palette_of_all,
    const Console& console) {
    if (format.is_gif() || request.is_reduced()) {
        source.display();
        const Palette palette =
            palette_of_all != nullptr ? *palette_of_all : chosen_palette(request, {&source});
        write_reduced(request, format, source, palette, file, console);
    } else {
        write_image(
            source.image(sample_type(*format.of_image)),
            file,
            *format.of_image,
            metadata(),
            write_settings(request, format));
    }
}

std::vector<PictureSource> sources_of(const Request& request) {
    std::vector<PictureSource> sources;
    sources.reserve(request.inputs().size());
    for (const std::string& path : request.inputs()) {
        sources.emplace_back(path, request.crop, request.exposure);
        sources.back().display();
    }
    return sources;
}

std::vector<const PictureSource*> pointers(const std::vector<PictureSource>& sources) {
    std::vector<const PictureSource*> all;
    all.reserve(sources.size());
    for (const PictureSource& source : sources)
        all.push_back(&source);
    return all;
}

void write_animation(const Request& request, const Console& console) {
    const std::vector<PictureSource> sources = sources_of(request);
    for (std::size_t i = 1; i < sources.size(); ++i)
        if (sources[i].width() != sources[0].width() || sources[i].height() != sources[0].height())
            throw InputError({Diagnostic{
                .place = {.file = request.inputs()[i]},
                .problem = fmt::format(
                    "it has {} x {} pixels, and '{}' has {} x {}",
                    sources[i].width(),
                    sources[i].height(),
                    request.inputs()[0],
                    sources[0].width(),
                    sources[0].height()),
                .remedy = "pictures of one GIF have one size; --crop can cut them to one"}});
    OutputFile file(request.output());
    const Palette palette = chosen_palette(request, pointers(sources));
    RowProgress progress(console, sources.size() * sources[0].height());
    std::vector<IndexedPicture> pictures;
    pictures.reserve(sources.size());
    for (const PictureSource& source : sources)
        pictures.push_back(reduced(request, source, palette, progress));
    write_gif(
        pictures, file, whole_of("--delay", request.delay.value_or(delay_by_default), 2, 65535));
    file.commit();
}

/// Where each of the pictures goes. Throws CommandLineError where they cannot all go there.
std::vector<fs::path> series_outputs(const Request& request) {
    std::map<fs::path, std::string> inputs_by_output;
    std::vector<fs::path> outputs;
    for (const std::string& input : request.inputs()) {
        if (input == "-")
            throw CommandLineError(
                "a picture from standard input has no name for the one to write: convert it alone");
        fs::path output = fs::path(request.output()) / fs::path(input).stem();
        std::string extension = CLI::detail::to_lower(request.format);
        // png16 and the like are .png.
        extension.erase(std::min(extension.find_first_of("0123456789-"), extension.size()));
        output += "." + extension;
        if (const auto [other, is_new] = inputs_by_output.emplace(output, input); !is_new)
            throw CommandLineError(fmt::format(
                "'{}' and '{}' would both become '{}'; convert one of them alone",
                other->second,
                input,
                output.string()));
        if (fs::exists(output) && fs::equivalent(output, input))
            throw CommandLineError(
                fmt::format("'{}' would be written over itself; choose another folder", input));
        outputs.push_back(std::move(output));
    }
    return outputs;
}

/// Each picture is read once. None gets its name where one of them cannot be read or written (into
/// a pipe each goes as it is read).
void write_series(const Request& request, const Format& format, const Console& console) {
    const std::vector<fs::path> outputs = series_outputs(request);
    std::vector<PictureSource> sources;
    std::optional<Palette> palette;
    if (request.palette_for_all) {
        sources = sources_of(request);
        palette = chosen_palette(request, pointers(sources));
    } else if (!request.palette.empty()) {
        palette = given_palette(request.palette); // once: it may come from a pipe
    }
    std::deque<OutputFile> files;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        OutputFile& file = files.emplace_back(outputs[i]);
        const Palette* const given = palette ? &*palette : nullptr;
        if (request.palette_for_all) {
            write_one(request, format, sources[i], file, given, console);
        } else {
            PictureSource source(request.inputs()[i], request.crop, request.exposure);
            write_one(request, format, source, file, given, console);
        }
        file.finish();
    }
    for (OutputFile& file : files)
        file.commit();
}

void convert(const Request& request, const Console& console) {
    if (request.paths.size() < 2)
        throw CommandLineError(
            "convert takes the picture to read and the one to write, as in a.exr b.png");
    const Format format = output_format(request);
    if (request.colors)
        whole_of("--colors", *request.colors, 2, 256);
    number_of("--exposure", request.exposure, -20, 20);
    write_settings(request, format);
    check_output(request, format);
    check_colors(request, format);
    const ThreadLimit limit = thread_limit(request.threads);
    if (fs::is_directory(request.output())) {
        write_series(request, format, console);
    } else if (request.inputs().size() > 1) {
        write_animation(request, console);
    } else {
        PictureSource source(request.inputs()[0], request.crop, request.exposure);
        OutputFile file(request.output());
        write_one(request, format, source, file, nullptr, console);
        file.commit();
    }
}

} // namespace

/// vera convert IN... OUT
void add_convert_command(CLI::App& app, Console& console) {
    const auto request = std::make_shared<Request>();
    const std::map<std::string, Dither> dithers = {
        {"none", Dither::none},
        {"floyd-steinberg", Dither::floyd_steinberg},
        {"blue-noise", Dither::blue_noise}};

    CLI::App* command =
        app.add_subcommand("convert", "a picture in another format, or in fewer colours");
    command
        ->add_option(
            "pictures",
            request->paths,
            "to read, and at the end the one to write, or a folder for several")
        ->required()
        ->type_name("IN... OUT");
    command
        ->add_option(
            "--format",
            request->format,
            "to write, where the name does not tell: " + format_names() + ", gif")
        ->type_name("NAME");
    command
        ->add_option(
            "--crop", request->crop, "this part alone, in pixels from the upper left corner")
        ->type_name("WxH+X+Y");
    command
        ->add_option(
            "--exposure", request->exposure, "stops: each doubles the light, or halves it below 0")
        ->type_name("STOPS")
        ->capture_default_str();
    command
        ->add_option(
            "--error",
            request->error,
            "of .vra: no sample changes by more than this of 255; 0 loses nothing")
        ->type_name("N")
        ->capture_default_str();
    command->add_option("--quality", request->jpeg_quality, "of a JPEG picture, 1 to 100, else 95")
        ->type_name("Q");
    const char* const group = "Colours";
    command->add_option("--colors", request->colors, "the best so many, 2 to 256; 256 for GIF")
        ->type_name("N")
        ->group(group);
    command
        ->add_option(
            "--palette",
            request->palette,
            palette_names() + ", or a text file of #rrggbb, one a line")
        ->type_name("NAME|FILE")
        ->group(group);
    command
        ->add_option(
            "--dither", request->dither, "how to mix colours; floyd-steinberg when left out")
        ->transform(CLI::CheckedTransformer(dithers).description(""))
        ->type_name("none|floyd-steinberg|blue-noise")
        ->group(group);
    command
        ->add_flag(
            "--palette-for-all", request->palette_for_all, "several pictures share their colours")
        ->group(group);
    command
        ->add_option(
            "--delay",
            request->delay,
            "hundredths of a second a picture, in a GIF of several, else 10")
        ->type_name("N")
        ->group(group);
    add_threads_option(*command, request->threads);
    add_console_options(*command, console);
    command->footer("Examples:\n"
                    "  vera convert picture.exr picture.png --exposure 0.5\n"
                    "  vera convert picture.png picture.vra --error 1\n"
                    "  vera convert picture.vra part.png --crop 320x240+10+20\n"
                    "  vera convert picture.png small.png --colors 16 --dither blue-noise\n"
                    "  vera convert picture.png old.gif --palette ega16\n"
                    "  vera convert 1.png 2.png 3.png film.gif --colors 64 --delay 4\n"
                    "  vera convert 1.png 2.png out --format png --colors 32 --palette-for-all");

    command->callback([request, &console] { convert(*request, console); });
}

} // namespace vera
