// SPDX-License-Identifier: Apache-2.0
#include "vera/image/image_file.h"

#include "vera/base/check.h"
#include "vera/base/diagnostic.h"
#include "vera/base/output_file.h"
#include "vera/image/codecs.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace vera {

namespace {

struct NamedFormat {
    std::string_view name;
    ImageFileFormat format;
};

constexpr std::array formats = {
    NamedFormat{"png", ImageFileFormat::png8},
    NamedFormat{"png16", ImageFileFormat::png16},
    NamedFormat{"exr", ImageFileFormat::exr_half},
    NamedFormat{"exr-float", ImageFileFormat::exr_float},
    NamedFormat{"jpeg", ImageFileFormat::jpeg},
    NamedFormat{"ppm", ImageFileFormat::ppm8},
    NamedFormat{"ppm16", ImageFileFormat::ppm16},
    NamedFormat{"pfm", ImageFileFormat::pfm},
    NamedFormat{"vra", ImageFileFormat::vra8},
    NamedFormat{"vra16", ImageFileFormat::vra16}};

std::string in_small_letters(std::string_view text) {
    std::string small(text);
    for (char& letter : small)
        if (letter >= 'A' && letter <= 'Z')
            letter = static_cast<char>(letter - 'A' + 'a');
    return small;
}

std::size_t sample_count(const Image& image) {
    return std::visit([](const auto& samples) { return samples.size(); }, image.samples);
}

std::string shown_name(const std::filesystem::path& path) {
    return path == "-" ? "standard input" : path.string();
}

} // namespace

std::optional<ImageFileFormat> format_from_extension(const std::filesystem::path& path) {
    const std::string extension = in_small_letters(path.extension().native());
    for (const std::string_view known : {"png", "exr", "jpg", "jpeg", "ppm", "pfm", "vra"})
        if (extension.size() == known.size() + 1 && extension.ends_with(known))
            return format_from_name(known);
    return std::nullopt;
}

std::optional<ImageFileFormat> format_from_name(std::string_view name) {
    const std::string small = in_small_letters(name);
    if (small == "jpg")
        return ImageFileFormat::jpeg;
    for (const NamedFormat& known : formats)
        if (known.name == small)
            return known.format;
    return std::nullopt;
}

std::string format_names() {
    std::string names;
    for (const NamedFormat& known : formats) {
        names += names.empty() ? "" : ", ";
        names += known.name;
    }
    return names;
}

SampleType sample_type(ImageFileFormat format) {
    switch (format) {
    case ImageFileFormat::png8:
    case ImageFileFormat::jpeg:
    case ImageFileFormat::ppm8:
    case ImageFileFormat::vra8:
        return SampleType::integer8;
    case ImageFileFormat::png16:
    case ImageFileFormat::ppm16:
    case ImageFileFormat::vra16:
        return SampleType::integer16;
    default:
        return SampleType::float32;
    }
}

void write_image(
    const Image& image,
    OutputFile& file,
    ImageFileFormat format,
    const PictureMetadata& metadata,
    const ImageWriteSettings& settings) {
    VERA_CHECK(image.width > 0 && image.height > 0);
    VERA_CHECK(sample_count(image) == 3 * image.width * image.height);
    VERA_CHECK(sample_type(image) == sample_type(format));
    switch (format) {
    case ImageFileFormat::png8:
    case ImageFileFormat::png16:
        return detail::write_png(image, file, metadata, settings);
    case ImageFileFormat::jpeg:
        return detail::write_jpeg(image, file, metadata, settings);
    case ImageFileFormat::exr_half:
        return detail::write_exr(image, file, metadata, detail::ExrSamples::half);
    case ImageFileFormat::exr_float:
        return detail::write_exr(image, file, metadata, detail::ExrSamples::float32);
    case ImageFileFormat::ppm8:
    case ImageFileFormat::ppm16:
        return detail::write_ppm(image, file, metadata);
    case ImageFileFormat::pfm:
        return detail::write_pfm(image, file);
    case ImageFileFormat::vra8:
    case ImageFileFormat::vra16:
        return detail::write_vra(image, file, metadata, settings);
    }
}

void write_image(
    const Image& image,
    const std::filesystem::path& path,
    ImageFileFormat format,
    const PictureMetadata& metadata,
    const ImageWriteSettings& settings) {
    OutputFile file(path);
    write_image(image, file, format, metadata, settings);
    file.commit();
}

Image decoded_image(std::span<const std::byte> bytes, const std::string& name) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with("\x89PNG"))
        return detail::read_png(bytes, name);
    if (text.starts_with("\xff\xd8"))
        return detail::read_jpeg(bytes, name);
    if (text.starts_with("\x76\x2f\x31\x01"))
        return detail::read_exr(bytes, name);
    if (text.starts_with("\x89VRA"))
        return detail::read_vra(bytes, name);
    if (text.starts_with("P6"))
        return detail::read_ppm(bytes, name);
    if (text.starts_with("PF"))
        return detail::read_pfm(bytes, name);
    detail::throw_damaged(
        name, text.empty() ? "it is empty" : "its first bytes are those of no format known here");
}

std::vector<std::byte> file_bytes(const std::filesystem::path& path, std::size_t most_streamed) {
    struct OpenFile {
        int descriptor;
        bool ours;

        ~OpenFile() {
            if (ours && descriptor >= 0)
                close(descriptor);
        }
    };

    const std::string name = shown_name(path);
    const bool standard_input = path == "-";
    const OpenFile file = {
        standard_input ? STDIN_FILENO : open(path.c_str(), O_RDONLY | O_CLOEXEC), !standard_input};
    struct stat status = {};
    if (file.descriptor < 0 || fstat(file.descriptor, &status) != 0)
        throw std::system_error(
            errno, std::generic_category(), fmt::format("cannot read '{}'", name));

    const std::size_t size = S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0;
    return bytes_to_end<std::vector<std::byte>>(file.descriptor, name, size, most_streamed);
}

Image read_image(const std::filesystem::path& path) {
    return decoded_image(file_bytes(path), shown_name(path));
}

namespace detail {

void throw_damaged(const std::string& name, const std::string& problem) {
    throw InputError({Diagnostic{
        .place = {.file = name},
        .problem = "this is no picture that can be read: " + problem,
        .remedy = "give a whole PNG, EXR, JPEG, PPM (P6), PFM (PF) or VRA file"}});
}

void check_plausible(
    std::size_t width,
    std::size_t height,
    std::size_t pixel_bits,
    std::size_t file_bytes,
    const std::string& name) {
    // One colour everywhere: deflate makes a byte of about 1032.
    constexpr std::size_t most_packed = 1040;
    constexpr std::size_t slack = 1 << 16;
    const std::size_t most = slack + 8 * most_packed * file_bytes / pixel_bits;
    if (width == 0 || height == 0)
        throw_damaged(name, "it has no pixels");
    if (height > most / width)
        throw_damaged(
            name,
            fmt::format(
                "{} bytes cannot hold the {} x {} pixels that its header promises",
                file_bytes,
                width,
                height));
}

std::string plain_name(const std::string& name, std::size_t longest) {
    std::string plain = name.substr(0, longest);
    for (char& letter : plain)
        if (letter < ' ' || letter > '~')
            letter = '?';
    return plain.empty() ? "Comment" : plain;
}

} // namespace detail

} // namespace vera
