// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/image/image.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vera {

class OutputFile;

/// A channel of a picture in layers. By OpenEXR's convention its name is "LAYER.R", and layers
/// stand within layers as in "mirrored.light2.diffuse.R".
struct LayerChannel {
    enum class Type : std::uint8_t { float32, uint32 };

    std::string name;
    Type type = Type::float32;

    friend bool operator==(const LayerChannel&, const LayerChannel&) = default;
};

/// Writes a picture of many channels as one EXR file, some rows at a time. OpenEXR keeps channels
/// in the order of their names. Compressed without loss. The same rows and metadata give the same
/// bytes.
class LayersWriter {
public:
    /// The file must outlive it. Throws std::runtime_error that names the file.
    LayersWriter(
        OutputFile& file,
        std::size_t width,
        std::size_t height,
        std::vector<LayerChannel> channels,
        const PictureMetadata& metadata);
    ~LayersWriter();
    LayersWriter(const LayersWriter&) = delete;
    LayersWriter& operator=(const LayersWriter&) = delete;

    /// The next rows, from the top: words[(c * rows + row) * width + x] is channel c, its four
    /// bytes as they are. Throws as OutputFile does, and std::runtime_error.
    void write_rows(std::size_t rows, std::span<const std::uint32_t> words);

    /// After the last row. The caller commits the file.
    void finish();

private:
    struct Encoder;
    std::unique_ptr<Encoder> encoder_;
};

/// Reads such a file, or any EXR file of scan lines, from its bytes.
class LayersReader {
public:
    /// Throws InputError, which names the file, when it is damaged or none. The bytes must outlive
    /// it.
    LayersReader(std::span<const std::byte> bytes, const std::string& name);
    ~LayersReader();
    LayersReader(const LayersReader&) = delete;
    LayersReader& operator=(const LayersReader&) = delete;

    std::size_t width() const { return width_; }

    std::size_t height() const { return height_; }

    /// In the order of their names; halves among them as float32.
    const std::vector<LayerChannel>& channels() const { return channels_; }

    /// The attribute of that name, a text; empty where there is none.
    std::string text(const std::string& attribute) const;

    /// Row y, from the top, of some channels, which there must be: samples[c * width() + x]. Whole
    /// numbers become the nearest floats. Throws InputError when the file is damaged.
    void
    read_row(std::size_t y, std::span<const std::string> channels, std::span<float> samples) const;

private:
    struct Decoder;
    std::unique_ptr<Decoder> decoder_;
    std::size_t width_ = 0;
    std::size_t height_ = 0;
    std::vector<LayerChannel> channels_;
};

} // namespace vera
