// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/drawing_file.h"

#include "vera/base/output_file.h"
#include "vera/drawing/svg_areas.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace vera {

namespace {

constexpr std::pair<std::string_view, DrawingFormat> format_of_name[] = {
    {"svg", DrawingFormat::svg},
    {"pdf", DrawingFormat::pdf},
    {"eps", DrawingFormat::eps},
    {"dxf", DrawingFormat::dxf}};

char small_letter(char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

} // namespace

std::optional<DrawingFormat> drawing_format_from_extension(const std::filesystem::path& path) {
    const std::string extension = path.extension().string();
    if (extension.empty())
        return std::nullopt;
    return drawing_format_from_name(std::string_view(extension).substr(1));
}

std::optional<DrawingFormat> drawing_format_from_name(std::string_view name) {
    for (const auto& [known, format] : format_of_name)
        if (std::ranges::equal(name, known, {}, small_letter))
            return format;
    return std::nullopt;
}

std::string drawing_format_names() {
    std::string names;
    for (const auto& [name, format] : format_of_name)
        names.append(names.empty() ? "" : ", ").append(name);
    return names;
}

std::vector<LineStyle> default_line_styles() {
    return {
        {.line_class = LineClass::silhouette, .width = 1.5},
        {.line_class = LineClass::crease, .width = 0.75},
        {.line_class = LineClass::intersection, .width = 0.75},
        {.line_class = LineClass::shadow, .width = 0.5},
        {.line_class = LineClass::hidden, .width = 0.5, .dashes = {3, 2}}};
}

void write_drawing(
    const Drawing& drawing,
    const std::filesystem::path& path,
    DrawingFormat format,
    const DrawingSettings& settings) {
    OutputFile file(path);
    write_drawing(drawing, file, format, settings);
    file.commit();
}

void write_drawing(
    const Drawing& drawing,
    OutputFile& file,
    DrawingFormat format,
    const DrawingSettings& settings,
    const Progress& progress,
    const CancelFlag* cancel) {
    std::string bytes;
    switch (format) {
    case DrawingFormat::svg:
        return detail::write_svg_file(drawing, settings, file, progress, cancel);
    case DrawingFormat::pdf:
        write_pdf(drawing, settings, bytes, progress, cancel);
        break;
    case DrawingFormat::eps:
        write_eps(drawing, settings, bytes, progress, cancel);
        break;
    case DrawingFormat::dxf:
        write_dxf(drawing, settings, bytes, progress, cancel);
        break;
    }
    file.write(bytes);
}

} // namespace vera
