// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/formats/source_text.h"
#include "vera/image/layers_file.h"
#include "vera/math/color.h"
#include "vera/scene/picture_settings.h"

#include <cstddef>
#include <string>
#include <vector>

namespace vera {

/// The light of a pixel, or a sum of many, apart by what scales it.
struct SourceLight {
    std::vector<Color> sources; ///< of each light, and of AMBIENT behind them
    Color fixed;                ///< self-luminosity and firmament
    bool sees = false;          ///< whether anything is seen there
};

/// A file of layers (docs/explaining.md) read as light by source.
class LayerSources {
public:
    /// Maps the file. Throws InputError when it is damaged, or none that 'vera render --layers' has
    /// written, and std::system_error when it cannot be read.
    explicit LayerSources(const std::string& path);

    std::size_t width() const { return reader_.width(); }

    std::size_t height() const { return reader_.height(); }

    std::size_t light_count() const { return light_factors_.size(); }

    /// What the picture was rendered with. LIGHTS holds what each light was multiplied by in all,
    /// and AMBIENT is as it was scaled: EXPMES is part of both, and off.
    const PictureSettings& settings() const { return settings_; }

    /// The pixels of row y.
    std::vector<SourceLight> row(std::size_t y) const;

private:
    [[noreturn]] void refuse(const std::string& problem) const;
    void read_settings();
    std::vector<double> numbers(const char* attribute, std::size_t count) const;
    void find_layers();

    /// A channel, and which number of a SourceLight it is part of.
    struct Part {
        std::size_t source = 0; ///< beyond the sources: the fixed light
        std::size_t color = 0;
    };

    SourceText file_;
    LayersReader reader_;
    PictureSettings settings_;
    std::vector<double> light_factors_;
    std::vector<std::string> channels_; ///< and Z behind them
    std::vector<Part> parts_;
};

} // namespace vera
