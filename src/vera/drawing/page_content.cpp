// SPDX-License-Identifier: Apache-2.0
#include "vera/drawing/page_content.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/drawing/open_groups.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include <fmt/format.h>

namespace vera::detail {

namespace {

class PageWriter {
public:
    PageWriter(const Lattice& lattice, const Gradients& gradients)
        : gradients_(gradients)
        , units_per_pixel_(gradients.count() > 0 ? 1 : lattice.units_per_pixel())
        , digits_(gradients.count() > 0 ? lattice.digits() : 0)
        , scale_digits_(9 + lattice.digits() - digits_) {}

    /// From units, counted from the top, to points, counted from the bottom.
    void begin_page(PageSize page, double pixels_wide) {
        const std::string scale =
            decimal(page.width / (pixels_wide * units_per_pixel_), scale_digits_);
        text_ += fmt::format("q\n{0} 0 0 -{0} 0 {1} cm\n", scale, decimal(page.height, 6));
    }

    void end_page() { text_ += "Q\n"; }

    void write(const std::string& text) { text_ += text; }

    void fill_picture(const Drawing& drawing) {
        set_paint(fill_paint_, color_paint(*drawing.background, "rg"));
        text_ += fmt::format("0 0 {} {} re\nf\n", length(drawing.width), length(drawing.height));
    }

    void fill(std::span<const SnappedPath> rings, const FilledOutline& outline) {
        set_paint(
            fill_paint_,
            outline.gradient ? gradient_paint(*outline.gradient, "cs", "scn")
                             : color_paint(outline.color, "rg"));
        write_paths(rings);
        text_ += "f\n";
    }

    void stroke_seams(std::span<const SnappedPath> seams, const FilledOutline& outline) {
        set_paint(
            stroke_paint_,
            outline.gradient ? gradient_paint(*outline.gradient, "CS", "SCN")
                             : color_paint(outline.color, "RG"));
        write_paths(seams);
        text_ += "S\n";
    }

    /// A line style that stays until the next one.
    void set_pen(double width, int cap, const std::vector<double>& dashes) {
        text_ += fmt::format("{} w {} J 1 j [", length(width), cap);
        for (const double& dash : dashes)
            text_.append(&dash == dashes.data() ? "" : " ").append(length(dash));
        text_ += "] 0 d\n";
    }

    void stroke(std::span<const SnappedPath> lines, DrawingColor color) {
        set_paint(stroke_paint_, color_paint(color, "RG"));
        write_paths(lines);
        text_ += "S\n";
    }

    std::string take() { return std::move(text_); }

private:
    /// What is painted with, for a purpose: what tells it from others, and what sets it.
    struct Paint {
        std::string what;
        std::string operators;
    };

    static Paint color_paint(DrawingColor color, const char* operation) {
        const std::string numbers = components(color);
        return {numbers, numbers + " " + operation + "\n"};
    }

    Paint gradient_paint(const Gradient& gradient, const char* space, const char* operation) const {
        const std::string pattern = fmt::format("/P{}", gradients_.number_of(gradient));
        return {pattern, fmt::format("/Pattern {} {} {}\n", space, pattern, operation)};
    }

    /// PDF has a paint to fill and one to stroke with; PostScript has only the one set last.
    void set_paint(std::string& purpose, const Paint& paint) {
        if (purpose != paint.what || last_paint_ != paint.what)
            text_ += paint.operators;
        purpose = last_paint_ = paint.what;
    }

    void write_paths(std::span<const SnappedPath> paths) {
        for (const SnappedPath& path : paths) {
            write_point(path.points.front());
            text_ += "m\n";
            for_each_segment(
                path,
                [&](SnappedPoint point) {
                    write_point(point);
                    text_ += "l\n";
                },
                [&](const DrawingArc& arc, SnappedPoint point) { write_arc(arc, point); });
            if (path.closed)
                text_ += "h\n";
        }
    }

    void write_arc(const DrawingArc& arc, SnappedPoint last) {
        for (const SnappedCurve& curve : curves_along(arc, last)) {
            for (const SnappedPoint point : {curve.first, curve.second, curve.end})
                write_point(point);
            text_ += "c\n";
        }
    }

    void write_point(SnappedPoint point) {
        for (const std::int64_t coordinate : {point.x, point.y})
            text_.append(decimal(coordinate, digits_)).append(" ");
    }

    std::string length(double pixels) const { return decimal(pixels * units_per_pixel_, 4); }

    const Gradients& gradients_;
    // Poppler paints no gradient where the page is scaled to less than a thousandth: with gradients
    // a unit is a whole pixel, else one of the lattice.
    double units_per_pixel_;
    int digits_; ///< of coordinates, behind the point
    int scale_digits_;
    std::string text_;
    // What they are set to, in the words of Paint; empty before they are.
    std::string fill_paint_;
    std::string stroke_paint_;
    std::string last_paint_; ///< of the two
};

/// That of the outline or, of one that has none, one by its id, as the underlays have: where an
/// object is hidden they are seen, and so are to be hidden as well.
std::shared_ptr<const DrawingGroup> told_group(const FilledOutline& outline) {
    if (outline.group || outline.id.empty())
        return outline.group;
    return std::make_shared<const DrawingGroup>(DrawingGroup{.id = outline.id});
}

/// Down to which depth there are no more groups than are told.
std::size_t told_depth(const Layers& layers) {
    std::vector<std::size_t> of_depth;
    OpenGroups groups;
    for (const FilledPath& fill : layers.fills)
        groups.go_to(
            told_group(*fill.outline),
            [&](const DrawingGroup&, std::size_t depth) {
                of_depth.resize(std::max(of_depth.size(), depth + 1));
                ++of_depth[depth];
            },
            [] {});
    std::size_t depth = 0;
    for (std::size_t told = 0; depth < of_depth.size(); ++depth)
        if ((told += of_depth[depth]) > most_page_groups)
            break;
    return depth;
}

/// Marks of the groups between the outlines, but for those that are not told.
class GroupWriter {
public:
    GroupWriter(const Layers& layers, const PageMarks& marks, PageWriter& page)
        : told_depth_(told_depth(layers))
        , marks_(marks)
        , page_(page) {}

    void go_to(const std::shared_ptr<const DrawingGroup>& group) {
        groups_.go_to(
            group,
            [&](const DrawingGroup& begun, std::size_t depth) {
                open_ = depth + 1;
                if (depth < told_depth_)
                    page_.write(
                        marks_.begin_group(begun.name.empty() ? begun.id : begun.name, depth));
            },
            [&] {
                if (--open_ < told_depth_)
                    page_.write(marks_.end_group);
            });
    }

private:
    std::size_t told_depth_;
    const PageMarks& marks_;
    PageWriter& page_;
    OpenGroups groups_;
    std::size_t open_ = 0;
};

} // namespace

std::vector<std::string> layer_names(const Layers& layers) {
    std::vector<std::string> names;
    if (layers.is_filled)
        names.emplace_back(fills_name);
    for (const LineLayer& layer : layers.lines)
        names.push_back(layer.name);
    return names;
}

std::string page_content(
    const Drawing& drawing,
    const DrawingSettings& settings,
    const Lattice& lattice,
    const Layers& layers,
    const Gradients& gradients,
    const PageMarks& marks,
    const Progress& progress,
    const CancelFlag* cancel) {
    constexpr int butt_cap = 0;
    constexpr int round_cap = 1;
    const std::vector<std::string> names = layer_names(layers);
    std::size_t number = 0;
    StageProgress stages(progress, static_cast<double>(1 + layers.lines.size()));

    PageWriter page(lattice, gradients);
    page.begin_page(page_size(drawing, settings), drawing.width);
    if (drawing.background)
        page.fill_picture(drawing);
    if (layers.is_filled) {
        page.write(marks.begin_layer(number, names[number]));
        ++number;
        page.set_pen(settings.seam_width, butt_cap, {});
        GroupWriter groups(layers, marks, page);
        const LongLoop loop(
            layers.fills.size() + drawing.areas.count(), stages.next(1), cancel, 256);
        for_each_block_of_fills(
            drawing, layers, lattice, [&](std::size_t done, std::span<const FilledPath> fills) {
                for (const FilledPath& fill : fills) {
                    loop.turn(done++);
                    groups.go_to(told_group(*fill.outline));
                    page.fill(fill.rings, *fill.outline);
                    if (!fill.seams.empty())
                        page.stroke_seams(fill.seams, *fill.outline);
                }
            });
        groups.go_to(nullptr);
        page.write(marks.end_layer);
    }
    for (const LineLayer& layer : layers.lines) {
        page.write(marks.begin_layer(number, names[number]));
        ++number;
        const LineStyle& style = layer.style;
        page.set_pen(style.width, style.dashes.empty() ? round_cap : butt_cap, style.dashes);
        for_each_line(
            drawing, layer, lattice, stages.next(1), cancel, [&](const SnappedPath& line) {
                page.stroke({&line, 1}, style.color);
            });
        page.write(marks.end_layer);
    }
    page.end_page();
    return page.take();
}

} // namespace vera::detail
