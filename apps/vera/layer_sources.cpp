// SPDX-License-Identifier: Apache-2.0
#include "layer_sources.h"

#include "vera/formats/control_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>
#include <string_view>

#include "layer_attributes.h"
#include <fmt/format.h>

namespace vera {

namespace {

constexpr const char* depth_channel = "Z";

/// The number, from 0, of the light that a layer's name names, as in "direct.light2.diffuse.R".
std::optional<std::size_t> light_of(std::string_view name) {
    constexpr std::string_view word = ".light";
    const std::size_t found = name.find(word);
    if (found == std::string_view::npos)
        return std::nullopt;
    const char* const begin = name.data() + found + word.size();
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(begin, name.data() + name.size(), number);
    if (error != std::errc() || number == 0)
        return std::nullopt;
    return number - 1;
}

std::optional<std::size_t> color_of(std::string_view name) {
    constexpr std::array<std::string_view, 3> endings = {".R", ".G", ".B"};
    for (std::size_t i = 0; i < endings.size(); ++i)
        if (name.ends_with(endings[i]))
            return i;
    return std::nullopt;
}

double& component(Color& color, std::size_t i) {
    return i == 0 ? color.r : i == 1 ? color.g : color.b;
}

[[noreturn]] void refuse_file(const std::string& name, const std::string& problem) {
    throw InputError({Diagnostic{
        .place = {.file = name},
        .problem = problem,
        .remedy = "name the EXR file that 'vera render SCENE -o PICTURE --layers FILE' has "
                  "written, or write it anew"}});
}

LayersReader reader_of(const SourceText& file) {
    if (!file.text().starts_with("\x76\x2f\x31\x01"))
        refuse_file(file.name(), "this is no EXR file, and layers are in one");
    try {
        return {std::as_bytes(std::span(file.text())), file.name()};
    } catch (const InputError& error) {
        refuse_file(file.name(), error.diagnostics().front().problem);
    }
}

} // namespace

LayerSources::LayerSources(const std::string& path)
    : file_(path)
    , reader_(reader_of(file_)) {
    read_settings();
    find_layers();
}

void LayerSources::refuse(const std::string& problem) const {
    refuse_file(file_.name(), problem);
}

void LayerSources::read_settings() {
    const std::string text = reader_.text(layer_attributes::settings);
    if (text.empty())
        refuse(
            fmt::format("no file of layers: it has no attribute {}", layer_attributes::settings));
    std::vector<Diagnostic> warnings;
    settings_ = read_control_text(SourceText(file_.name(), text), {}, warnings);
    if (settings_.width != width() || settings_.height != height())
        refuse("its size is not that of its settings");

    std::istringstream factors(reader_.text(layer_attributes::light_factors));
    std::string word;
    std::size_t count = 0;
    while (factors >> word)
        ++count;
    light_factors_ = numbers(layer_attributes::light_factors, count);
    const std::vector<double> ambient = numbers(layer_attributes::ambient, 3);
    settings_.light_factors = light_factors_;
    settings_.ambient = {ambient[0], ambient[1], ambient[2]};
    settings_.exposure.reset();
}

std::vector<double> LayerSources::numbers(const char* attribute, std::size_t count) const {
    std::istringstream words(reader_.text(attribute));
    std::vector<double> result;
    std::string word;
    while (words >> word) {
        double value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value))
            refuse(fmt::format("its attribute {} is damaged", attribute));
        result.push_back(value);
    }
    if (result.size() != count)
        refuse(fmt::format("its attribute {} is damaged", attribute));
    return result;
}

void LayerSources::find_layers() {
    const std::size_t ambient = light_count();
    bool has_depth = false;
    for (const LayerChannel& channel : reader_.channels()) {
        has_depth = has_depth || channel.name == depth_channel;
        const auto color = color_of(channel.name);
        if (!color)
            continue;
        std::size_t source = ambient + 1;
        if (const auto light = light_of(channel.name)) {
            if (*light >= light_count())
                refuse(fmt::format("its layer {} is of no light", channel.name));
            source = *light;
        } else if (channel.name.find(".ambient.") != std::string::npos) {
            source = ambient;
        }
        channels_.push_back(channel.name);
        parts_.push_back({source, *color});
    }
    if (!has_depth || channels_.empty())
        refuse("no file of layers: its channels are others");
    channels_.emplace_back(depth_channel);
}

std::vector<SourceLight> LayerSources::row(std::size_t y) const {
    std::vector<float> samples(channels_.size() * width());
    reader_.read_row(y, channels_, samples);
    std::vector<SourceLight> pixels(width());
    for (SourceLight& pixel : pixels)
        pixel.sources.resize(light_count() + 1);
    for (std::size_t channel = 0; channel < parts_.size(); ++channel)
        for (std::size_t x = 0; x < width(); ++x) {
            const auto [source, color] = parts_[channel];
            SourceLight& pixel = pixels[x];
            Color& sum = source < pixel.sources.size() ? pixel.sources[source] : pixel.fixed;
            component(sum, color) += static_cast<double>(samples[channel * width() + x]);
        }
    for (std::size_t x = 0; x < width(); ++x)
        pixels[x].sees = std::isfinite(samples[parts_.size() * width() + x]);
    return pixels;
}

} // namespace vera
