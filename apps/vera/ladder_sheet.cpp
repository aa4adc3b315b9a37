// SPDX-License-Identifier: Apache-2.0
#include "ladder_sheet.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <sstream>

#include <fmt/format.h>

namespace vera {

namespace {

// Of the page, in pixels.
constexpr double margin = 56;
constexpr double gutter = 48;
constexpr double picture_width = 640;
constexpr double thumbnail_width = 208;
constexpr double head_height = 132;
constexpr double caption_gap = 18; ///< between a picture and what is below it
constexpr double line_height = 21;
constexpr double row_gap = 44;
constexpr std::size_t letters_in_line = 50;

constexpr char head[] =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" width="{0:.0f}" height="{1:.0f}" viewBox="0 0 {0:.0f} {1:.0f}">
<style>
text {{ font-family: "Helvetica Neue", Helvetica, Arial, "Liberation Sans", "DejaVu Sans", sans-serif; fill: #24272b; }}
.head {{ font-size: 34px; font-weight: 300; }}
.title {{ font-size: 20px; font-weight: 600; }}
.text {{ font-size: 15px; fill: #4a4f55; }}
.small {{ font-size: 13px; fill: #6b7178; }}
.number {{ font-size: 20px; font-weight: 600; fill: #b0532c; }}
</style>
<rect width="100%" height="100%" fill="#f7f5f1"/>
)";

struct RayKind {
    const char* name;
    const char* color;
    std::uint64_t (*count)(const RenderStatistics&);
};

constexpr std::array<RayKind, 5> ray_kinds = {{
    {"view", "#5b7d9c", [](const RenderStatistics& c) { return c.view_rays; }},
    {"probe", "#a9bccb", [](const RenderStatistics& c) { return c.probe_rays; }},
    {"shadow", "#3c4046", [](const RenderStatistics& c) { return c.shadow_rays; }},
    {"mirrored", "#c08a3a", [](const RenderStatistics& c) { return c.mirrored_rays; }},
    {"refracted", "#58a79c", [](const RenderStatistics& c) { return c.refracted_rays; }},
}};

std::uint64_t all_rays(const RenderStatistics& counts) {
    std::uint64_t sum = 0;
    for (const RayKind& kind : ray_kinds)
        sum += kind.count(counts);
    return sum;
}

std::string escaped(const std::string& text) {
    std::string result;
    for (const char letter : text)
        switch (letter) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        // XML has no control characters.
        default:
            result += static_cast<unsigned char>(letter) < 0x20 ? ' ' : letter;
        }
    return result;
}

std::string text_at(double x, double y, const char* kind, const std::string& text) {
    return fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\">{}</text>\n", x, y, kind, escaped(text));
}

/// The words in lines of about so many letters.
std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines(1);
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (!lines.back().empty() && lines.back().size() + 1 + word.size() > letters_in_line)
            lines.emplace_back();
        lines.back() += (lines.back().empty() ? "" : " ") + word;
    }
    return lines;
}

std::string image_at(double x, double y, double width, double height, const std::string& png) {
    return fmt::format(
        "<image x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" "
        "xlink:href=\"data:image/png;base64,{}\"/>\n",
        x,
        y,
        width,
        height,
        base64(png));
}

/// 12 345 678, with spaces that do not break.
std::string grouped(std::uint64_t number) {
    std::string digits = std::to_string(number);
    for (std::size_t place = digits.size(); place > 3;) {
        place -= 3;
        digits.insert(place, "\u2009");
    }
    return digits;
}

std::string rays_text(const RenderStatistics& counts) {
    const std::uint64_t rays = all_rays(counts);
    return grouped(rays) + (rays == 1 ? " ray" : " rays");
}

std::string step_cell(const Sheet& sheet, std::size_t number, double x, double y) {
    const SheetStep& step = sheet.steps[number];
    const double aspect = static_cast<double>(sheet.height) / static_cast<double>(sheet.width);
    const double height = picture_width * aspect;
    std::string svg = image_at(x, y, picture_width, height, step.picture);
    double line = y + height + caption_gap + 16;
    svg += text_at(x, line, "number", std::to_string(number + 1));
    svg += text_at(x + 26, line, "title", step.title);
    line += 8;
    for (const std::string& words : lines_of(step.text))
        svg += text_at(x + 26, line += line_height, "text", words);
    svg += text_at(x + 26, line += line_height + 6, "small", rays_text(step.counts));
    if (!step.difference.empty()) {
        const double left = x + picture_width - thumbnail_width;
        const double top = y + height + caption_gap;
        svg += image_at(left, top, thumbnail_width, thumbnail_width * aspect, step.difference);
        svg += text_at(left, top + thumbnail_width * aspect + 18, "small", step.difference_text);
    }
    return svg;
}

/// The rays of each step as bars.
std::string cost_cell(const Sheet& sheet, double x, double y) {
    std::uint64_t most = 1;
    for (const SheetStep& step : sheet.steps)
        most = std::max(most, all_rays(step.counts));
    std::string svg = text_at(x, y + 20, "title", "What each step costs, in rays");
    double place = x;
    for (const RayKind& kind : ray_kinds) {
        svg += fmt::format(
            "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"12\" height=\"12\" fill=\"{}\"/>\n",
            place,
            y + 42,
            kind.color);
        svg += text_at(place + 18, y + 53, "text", kind.name);
        place += 110;
    }
    double line = y + 96;
    for (std::size_t i = 0; i < sheet.steps.size(); ++i, line += 68) {
        const RenderStatistics& counts = sheet.steps[i].counts;
        svg += text_at(x, line, "number", std::to_string(i + 1));
        svg += text_at(
            x + 26,
            line,
            "text",
            fmt::format("{}, {:.2g} s", rays_text(counts), sheet.steps[i].seconds));
        double left = x + 26;
        for (const RayKind& kind : ray_kinds) {
            const double width = (picture_width - 26) * static_cast<double>(kind.count(counts))
                / static_cast<double>(most);
            if (width > 0)
                svg += fmt::format(
                    "<rect x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"18\" "
                    "fill=\"{}\"/>\n",
                    left,
                    line + 10,
                    width,
                    kind.color);
            left += width;
        }
    }
    return svg;
}

} // namespace

std::string base64(const std::string& bytes) {
    constexpr char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t three = 0;
        for (std::size_t k = 0; k < 3; ++k)
            three =
                three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
        for (std::size_t k = 0; k < 4; ++k)
            text += i + k > bytes.size() ? '=' : letters[three >> (18 - 6 * k) & 63];
    }
    return text;
}

std::string sheet_svg(const Sheet& sheet) {
    const double picture_height =
        picture_width * static_cast<double>(sheet.height) / static_cast<double>(sheet.width);
    const double caption_height = std::max(
        150.0,
        thumbnail_width * static_cast<double>(sheet.height) / static_cast<double>(sheet.width)
            + 24);
    const double row_height = picture_height + caption_gap + caption_height + row_gap;
    const std::size_t rows = (sheet.steps.size() + 2) / 2;
    const double width = 2 * margin + 2 * picture_width + gutter;
    // The cell of the costs may be higher than a picture that is wide and low.
    const double cost_height = 100 + 68.0 * static_cast<double>(sheet.steps.size());
    const double height = head_height + static_cast<double>(rows - 1) * row_height
        + std::max(row_height, cost_height + row_gap);

    std::string svg = fmt::format(head, width, height);
    svg += fmt::format("<title>{}</title>\n", escaped(sheet.title + ": one effect more each time"));
    svg += text_at(margin, 74, "head", sheet.title);
    svg += text_at(margin, 102, "text", "The same scene, with one effect more each time");
    for (std::size_t i = 0; i <= sheet.steps.size(); ++i) {
        const double x = margin + (i % 2 == 0 ? 0 : picture_width + gutter);
        const std::size_t row = i / 2;
        const double y = head_height + static_cast<double>(row) * row_height;
        svg += i < sheet.steps.size() ? step_cell(sheet, i, x, y) : cost_cell(sheet, x, y);
    }
    return svg + "</svg>\n";
}

} // namespace vera
