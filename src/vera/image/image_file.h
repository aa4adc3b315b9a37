// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/read_bytes.h"
#include "vera/image/image.h"

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace vera {

class OutputFile;

enum class ImageFileFormat {
    png8,
    png16,
    exr_half,
    exr_float,
    jpeg,
    ppm8,
    ppm16,
    pfm,
    vra8,
    vra16
};

/// The format that a file's extension stands for, in capitals or not: .png, .exr (half), .jpg,
/// .jpeg, .ppm, .pfm and .vra; the formats of 8 bits for .png, .ppm and .vra.
std::optional<ImageFileFormat> format_from_extension(const std::filesystem::path& path);

/// The format of a name that a user may write: png, png16, exr, exr-float, jpeg or jpg, ppm, ppm16,
/// pfm, vra, vra16; in capitals or not.
std::optional<ImageFileFormat> format_from_name(std::string_view name);

/// The names, one a format, as a message lists them: "png, png16, ...".
std::string format_names();

/// The samples that an image must have to be written in the format.
SampleType sample_type(ImageFileFormat format);

struct ImageWriteSettings {
    int jpeg_quality = 95;     ///< 1 to 100; colours are never subsampled
    int png_compression = 1;   ///< 0 (none) to 9 (small by a seventh, and slow)
    unsigned raster_error = 0; ///< RasterWriteSettings::largest_error, for vra and vra16
};

/// Writes the picture, whole or not at all; "-" is standard output. The same image, metadata and
/// settings give the same bytes. The image must not be empty and must have the format's sample
/// type. Needs memory for some rows, not for the picture. Throws std::system_error or
/// std::runtime_error, which name the path, when the picture cannot be written.
void write_image(
    const Image& image,
    const std::filesystem::path& path,
    ImageFileFormat format,
    const PictureMetadata& metadata = {},
    const ImageWriteSettings& settings = {});

/// The same into a file that was opened earlier, so that what makes it impossible shows before the
/// picture is computed. The caller commits.
void write_image(
    const Image& image,
    OutputFile& file,
    ImageFileFormat format,
    const PictureMetadata& metadata = {},
    const ImageWriteSettings& settings = {});

/// The picture in a file of any of the formats, told apart by their first bytes; "-" is standard
/// input. Grey pictures become coloured ones, an alpha channel is left out, samples come as they
/// are stored: 8 bits, 16 bits or float. Throws InputError when the file is damaged or no such
/// picture, std::system_error when it cannot be read, std::runtime_error when the memory does not
/// suffice.
Image read_image(const std::filesystem::path& path);

/// All bytes of a file, or of standard input where the path is "-". Throws std::system_error, and
/// InputError when it is no regular file and more than so many bytes come from it.
std::vector<std::byte>
file_bytes(const std::filesystem::path& path, std::size_t most_streamed = most_streamed_bytes);

/// The picture in the bytes of a file; the name is for messages.
Image decoded_image(std::span<const std::byte> bytes, const std::string& name);

} // namespace vera
