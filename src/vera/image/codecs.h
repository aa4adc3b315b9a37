// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/image.h"
#include "vera/image/image_file.h"

#include <cstddef>
#include <span>
#include <string>

namespace vera::detail {

// One writer and one reader a format, each in a source file of its own, the only one that knows the
// format's library. Writers take an image that is not empty and has the right sample type; they
// encode row by row and leave it to the caller to commit.

void write_png(
    const Image& image,
    OutputFile& file,
    const PictureMetadata& metadata,
    const ImageWriteSettings& settings);
void write_jpeg(
    const Image& image,
    OutputFile& file,
    const PictureMetadata& metadata,
    const ImageWriteSettings& settings);
enum class ExrSamples { half, float32 };
void write_exr(
    const Image& image, OutputFile& file, const PictureMetadata& metadata, ExrSamples samples);
void write_ppm(const Image& image, OutputFile& file, const PictureMetadata& metadata);
void write_pfm(const Image& image, OutputFile& file);

void write_vra(
    const Image& image,
    OutputFile& file,
    const PictureMetadata& metadata,
    const ImageWriteSettings& settings);

Image read_png(std::span<const std::byte> bytes, const std::string& name);
Image read_jpeg(std::span<const std::byte> bytes, const std::string& name);
Image read_exr(std::span<const std::byte> bytes, const std::string& name);
Image read_ppm(std::span<const std::byte> bytes, const std::string& name);
Image read_pfm(std::span<const std::byte> bytes, const std::string& name);
Image read_vra(std::span<const std::byte> bytes, const std::string& name);

/// Throws the InputError for a picture that cannot be read.
[[noreturn]] void throw_damaged(const std::string& name, const std::string& problem);

/// Throws InputError when a picture cannot be as large as a file of so many bytes says it is, a
/// pixel taking so many bits before deflate or the like packs them. Keeps a damaged header from
/// costing all memory.
void check_plausible(
    std::size_t width,
    std::size_t height,
    std::size_t pixel_bits,
    std::size_t file_bytes,
    const std::string& name);

/// The text with what is not printable ASCII replaced by '?', at most so many bytes, and never
/// empty: a name that every format can hold.
std::string plain_name(const std::string& name, std::size_t longest);

} // namespace vera::detail
