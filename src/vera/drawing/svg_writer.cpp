// SPDX-License-Identifier: Apache-2.0
#include "vera/base/long_loop.h"
#include "vera/base/output_file.h"
#include "vera/base/progress_part.h"
#include "vera/drawing/document_text.h"
#include "vera/drawing/gradient_numbers.h"
#include "vera/drawing/layers.h"
#include "vera/drawing/open_groups.h"
#include "vera/drawing/svg_areas.h"
#include "vera/drawing/svg_path.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace vera {

namespace {

using namespace detail;

/// Digits behind the point of lengths that are no coordinates.
constexpr int length_digits = 4;

/// In one block of memory: where text grows, it is there twice.
constexpr std::size_t most_text_of_gradients = std::size_t{1} << 18U;

class SvgWriter {
public:
    /// Into the text or, where there is a file, through it into that.
    SvgWriter(
        const Drawing& drawing,
        const DrawingSettings& settings,
        const Progress& progress,
        const CancelFlag* cancel,
        std::string& text,
        OutputFile* file = nullptr)
        : drawing_(drawing)
        , settings_(settings)
        , lattice_(settings.precision)
        , layers_(layers(
              drawing,
              settings,
              lattice_,
              LaterOutlines::some_at_a_time,
              progress_part(progress, 0, 2),
              cancel))
        , stages_(progress_part(progress, 1, 2), static_cast<double>(1 + layers_.lines.size()))
        , cancel_(cancel)
        , text_(text)
        , file_(file) {
        // Before the outlines take theirs, so that a layer's id is always the same.
        if (drawing.background)
            background_id_ = ids_.take("background");
        if (layers_.is_filled || drawing.later_fills.blocks > 0)
            fills_id_ = ids_.take("fills");
        for (const LineLayer& layer : layers_.lines)
            line_ids_.push_back(ids_.take(std::string(name_of(layer.style.line_class)) + "-lines"));
        // Likewise gradients, but for those of outlines that are made later.
        for (const FilledPath& fill : layers_.fills) {
            if (fill.outline->gradient)
                id_of(*fill.outline->gradient);
            has_seams_ = has_seams_ || !fill.seams.empty();
        }
    }

    void write() {
        const LaterFills& later = drawing_.later_fills;
        if (later.blocks == 0 || !later.have_gradients) {
            has_seams_ = has_seams_ || have_later_seams();
            write_before_fills();
            write_fills();
        } else if (file_ != nullptr && file_->seekable()) {
            write_fills_first();
        } else {
            hold_fills();
        }
        for (std::size_t i = 0; i < layers_.lines.size(); ++i)
            write_lines(layers_.lines[i], line_ids_[i]);
        text_ += "</svg>\n";
        if (file_ == nullptr)
            return;
        for (std::string& part : ready_) {
            file_->write(part);
            std::string().swap(part);
        }
        file_->write(text_);
    }

private:
    /// Whether a seam is left of outlines that are made later: the first that have some tell, as a
    /// rule.
    bool have_later_seams() const {
        const LaterFills& later = drawing_.later_fills;
        for (std::size_t i = 0; settings_.cover_seams && i < later.blocks; ++i) {
            const std::vector<FilledOutline> outlines = later.with_seams(i, cancel_);
            for (const FilledPath& path :
                 filled_paths(outlines, settings_, lattice_, layers_.passed, cancel_))
                if (!path.seams.empty())
                    return true;
        }
        return false;
    }

    void write_before_fills() {
        write_head();
        write_style();
        write_gradients();
        if (drawing_.background)
            text_ += fmt::format(
                "<rect id=\"{}\" width=\"{}\" height=\"{}\" fill=\"{}\"/>\n",
                background_id_,
                length(drawing_.width),
                length(drawing_.height),
                css_color(*drawing_.background));
    }

    /// The gradients that outlines refer to stand before them, and are known when all outlines were
    /// made. So these go into the file, and move behind what then is put before them.
    void write_fills_first() {
        write_fills();
        pass_on();
        is_holding_ = true;
        write_before_fills();
        pass_on();
        is_holding_ = false;
        std::uint64_t size = 0;
        for (const std::string& part : held_)
            size += part.size();
        file_->open_gap_before_all(size);
        std::uint64_t place = 0;
        for (std::string& part : held_) {
            file_->write_at(place, std::as_bytes(std::span(part)));
            place += part.size();
            std::string().swap(part);
        }
    }

    /// The same where nothing can be moved: the outlines wait as text.
    void hold_fills() {
        std::string before = std::exchange(text_, {});
        is_holding_ = true;
        write_fills();
        pass_on();
        is_holding_ = false;
        text_ = std::move(before);
        write_before_fills();
        write_parts(held_);
    }

    /// And forgets each when it is written.
    void write_parts(std::vector<std::string>& parts) {
        pass_on();
        for (std::string& part : parts) {
            text_ += part;
            std::string().swap(part);
            pass_on();
        }
    }

    /// What is written so far, into the file: the whole of a large drawing need not be there at a
    /// time. But what ends early must not have written a part of it into a pipe: for one the parts
    /// wait, as one text would be there twice where it grows.
    void pass_on() {
        if (is_holding_) {
            held_.emplace_back(text_); // as large as it is
            text_.clear();
            return;
        }
        if (file_ == nullptr)
            return;
        if (file_->seekable())
            file_->write(text_);
        else
            ready_.emplace_back(text_);
        text_.clear();
    }

    static std::string length(double value) { return decimal(value, length_digits); }

    void write_head() {
        const PageSize page = page_size(drawing_, settings_);
        const auto page_length = [&](double points, double pixels) {
            return settings_.page_width_millimeters > 0 ? length(points / 72 * 25.4) + "mm"
                                                        : length(pixels);
        };
        text_ += fmt::format(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
            "<svg xmlns=\"http://www.w3.org/2000/svg\" "
            "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" "
            "width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\">\n",
            page_length(page.width, drawing_.width),
            page_length(page.height, drawing_.height),
            length(drawing_.width),
            length(drawing_.height));
        write_element("title", drawing_.title);
        write_element("desc", drawing_.description);
    }

    /// Nothing when the element would be empty.
    void write_element(std::string_view element, std::string_view content) {
        if (!content.empty())
            text_ += fmt::format("<{0}>{1}</{0}>\n", element, xml_text(content));
    }

    void write_style() {
        std::string rules;
        if (has_seams_)
            rules += fmt::format(
                ".seam{{fill:none;stroke-width:{};stroke-linejoin:round}}\n",
                length(settings_.seam_width));
        if (!layers_.lines.empty())
            rules += ".line{fill:none;stroke-linecap:round;stroke-linejoin:round}\n";
        for (std::size_t i = 0; i < layers_.lines.size(); ++i)
            rules += rule(layers_.lines[i].style, line_ids_[i]);
        if (!rules.empty())
            text_ += "<style>\n" + rules + "</style>\n";
    }

    static std::string rule(const LineStyle& style, const std::string& name) {
        std::string dashes;
        for (const double dash : style.dashes)
            dashes.append(dashes.empty() ? "" : " ").append(length(dash));
        return fmt::format(
            ".{}{{stroke:{};stroke-width:{}{}{}}}\n",
            name,
            css_color(style.color),
            length(style.width),
            // A round cap would take half its width from either side of a gap.
            dashes.empty() ? "" : ";stroke-linecap:butt;stroke-dasharray:",
            dashes);
    }

    void write_gradients() {
        if (gradients_.count() == 0)
            return;
        text_ += "<defs>\n";
        write_parts(held_gradients_);
        text_ += gradients_text_ + "</defs>\n";
        std::string().swap(gradients_text_);
    }

    /// Of a gradient, which is written when its first outline comes.
    std::string id_of(const Gradient& gradient) {
        const auto [number, is_new] = gradients_.of(gradient);
        std::string id = fmt::format("g{}", number + 1);
        if (!is_new) {
            const auto other = other_gradient_ids_.find(number);
            return other == other_gradient_ids_.end() ? id : other->second;
        }
        if (const std::string unique = ids_.take(id); unique != id)
            id = other_gradient_ids_[number] = unique;
        write_gradient(gradient, id);
        if (gradients_text_.size() > most_text_of_gradients) {
            held_gradients_.emplace_back(gradients_text_);
            gradients_text_.clear();
        }
        return id;
    }

    void write_gradient(const Gradient& gradient, const std::string& id) {
        const bool linear = gradient.shape == Gradient::Shape::linear;
        const char* element = linear ? "linearGradient" : "radialGradient";
        gradients_text_ += fmt::format(
            R"(<{} id="{}" gradientUnits="userSpaceOnUse" {}>)",
            element,
            id,
            linear ? line_of(gradient) : circle_of(gradient));
        for (const GradientStop& stop : gradient.stops)
            gradients_text_ += fmt::format(
                R"(<stop offset="{}" stop-color="{}"/>)",
                length(stop.offset),
                css_color(stop.color));
        gradients_text_ += fmt::format("</{}>\n", element);
    }

    /// A digit more than those of outlines: colours may change fast along a short axis.
    std::string gradient_length(double value) const {
        return decimal(value, lattice_.digits() + 1);
    }

    std::string line_of(const Gradient& gradient) const {
        return fmt::format(
            R"(x1="{}" y1="{}" x2="{}" y2="{}")",
            gradient_length(gradient.start.x),
            gradient_length(gradient.start.y),
            gradient_length(gradient.start.x + gradient.axis.x),
            gradient_length(gradient.start.y + gradient.axis.y));
    }

    /// The circle of radius 1 about (0, 0), turned into the ellipse.
    std::string circle_of(const Gradient& gradient) const {
        return fmt::format(
            "cx=\"0\" cy=\"0\" r=\"1\" gradientTransform=\"matrix({} {} {} {} {} {})\"",
            gradient_length(gradient.axis.x),
            gradient_length(gradient.axis.y),
            gradient_length(gradient.other_axis.x),
            gradient_length(gradient.other_axis.y),
            gradient_length(gradient.start.x),
            gradient_length(gradient.start.y));
    }

    /// Nothing where nothing is filled.
    void write_fills() {
        if (layers_.is_filled)
            begin_fills();
        const Progress progress = stages_.next(1);
        const SharedAreas& areas = drawing_.areas;
        const LaterFills& later = drawing_.later_fills;
        const double whole = static_cast<double>(
            layers_.fills.size() + block_of_fills * later.blocks + areas.count());
        const auto tell = [&](std::size_t done) {
            stop_if_raised(cancel_);
            if (progress)
                progress(static_cast<double>(done) / whole);
        };
        for_each_block_of_outlines(
            layers_, [&](std::size_t done, std::span<const FilledPath> fills) {
                tell(done);
                write_block(fills);
            });
        std::size_t done = layers_.fills.size();
        for (std::size_t i = 0; i < later.blocks; ++i, done += block_of_fills) {
            tell(done);
            const std::vector<FilledOutline> outlines = later.block(i, cancel_);
            write_block(filled_paths(outlines, settings_, lattice_, layers_.passed, cancel_));
        }
        go_to_group(nullptr);
        for (std::size_t first = 0; first < areas.count();) {
            tell(done + first);
            const std::size_t last = end_of_block(areas, first);
            std::vector<std::string> parts = svg_areas(areas, lattice_, first, last);
            write_parts(parts);
            first = last;
        }
        if (layers_.is_filled)
            text_ += "</g>\n";
    }

    void begin_fills() {
        text_ += fmt::format(
            "<g id=\"{}\" inkscape:groupmode=\"layer\" inkscape:label=\"{}\">\n",
            fills_id_,
            fills_name);
    }

    void write_block(std::span<const FilledPath> fills) {
        if (!fills.empty() && !layers_.is_filled) {
            layers_.is_filled = true;
            begin_fills();
        }
        const std::vector<FillData> data = fill_data(fills);
        for (std::size_t i = 0; i < fills.size(); ++i) {
            go_to_group(fills[i].outline->group);
            write_fill(fills[i], data[i]);
            has_seams_ = has_seams_ || !fills[i].seams.empty();
        }
        pass_on();
    }

    /// Ends the groups that this one is no part of, and begins those that it is.
    void go_to_group(const std::shared_ptr<const DrawingGroup>& group) {
        groups_.go_to(
            group,
            [&](const DrawingGroup& begun, std::size_t) { begin_group(begun); },
            [&] { text_ += "</g>\n"; });
    }

    /// So few areas, and corners, that their text takes no room; one area at least.
    static std::size_t end_of_block(const SharedAreas& areas, std::size_t first) {
        constexpr std::size_t most_areas = 32768;
        constexpr std::size_t most_corners = std::size_t{1} << 18U;
        const auto corners_to = [&](std::size_t end) -> std::size_t {
            const std::size_t rings = end == 0 ? 0 : areas.area_ends[end - 1];
            return rings == 0 ? 0 : areas.ring_ends[rings - 1];
        };
        const std::size_t most = corners_to(first) + most_corners;
        std::size_t end = first + 1;
        while (end < areas.count() && end - first < most_areas && corners_to(end + 1) <= most)
            ++end;
        return end;
    }

    struct FillData {
        std::string rings;
        std::string seams;
    };

    std::vector<FillData> fill_data(std::span<const FilledPath> fills) const {
        std::vector<FillData> data(fills.size());
        parallel_ranges(fills.size(), 64, [&](std::size_t first, std::size_t last) {
            for (std::size_t i = first; i < last; ++i)
                data[i] = {path_data(fills[i].rings), path_data(fills[i].seams)};
        });
        return data;
    }

    void begin_group(const DrawingGroup& group) {
        text_ += fmt::format("<g id=\"{}\"", ids_.take(group.id));
        const auto add = [&](const char* attribute, const std::string& value) {
            if (!value.empty())
                text_ += fmt::format(" {}=\"{}\"", attribute, xml_text(value));
        };
        if (group.material) {
            add("class", group.material->css_class);
            add("data-material", group.material->name);
        }
        add("data-name", group.given);
        add("inkscape:label", group.name);
        text_ += ">\n";
        write_element("title", group.name);
    }

    void write_fill(const FilledPath& fill, const FillData& data) {
        const FilledOutline& outline = *fill.outline;
        const std::string paint = outline.gradient
            ? fmt::format("url(#{})", id_of(*outline.gradient))
            : css_color(outline.color);
        text_ += "<path";
        if (!outline.id.empty())
            text_ += fmt::format(R"( id="{}")", ids_.take(outline.id));
        text_ += fmt::format(R"( fill="{}" d="{}")", paint, data.rings);
        text_ += outline.name.empty()
            ? "/>\n"
            : fmt::format("><title>{}</title></path>\n", xml_text(outline.name));
        if (!fill.seams.empty())
            text_ +=
                fmt::format("<path class=\"seam\" stroke=\"{}\" d=\"{}\"/>\n", paint, data.seams);
    }

    void write_lines(const LineLayer& layer, const std::string& id) {
        constexpr std::size_t most_text = std::size_t{1} << 20U;
        text_ += fmt::format(
            "<g id=\"{0}\" class=\"line {0}\" inkscape:groupmode=\"layer\" "
            "inkscape:label=\"{1}\">\n",
            id,
            xml_text(layer.name));
        for_each_line(
            drawing_, layer, lattice_, stages_.next(1), cancel_, [&](const SnappedPath& line) {
                text_ += fmt::format("<path d=\"{}\"/>\n", path_data({&line, 1}));
                if (text_.size() > most_text)
                    pass_on();
            });
        text_ += "</g>\n";
    }

    std::string path_data(std::span<const SnappedPath> paths) const {
        return svg_path_data(paths, lattice_.digits());
    }

    const Drawing& drawing_;
    const DrawingSettings& settings_;
    Lattice lattice_;
    Layers layers_;
    StageProgress stages_;
    const CancelFlag* cancel_;
    std::string& text_;
    OutputFile* file_;
    UniqueIds ids_;
    std::string background_id_;
    std::string fills_id_;
    std::vector<std::string> line_ids_; ///< of the layers of lines, which are their classes too
    GradientNumbers gradients_;
    std::unordered_map<std::size_t, std::string> other_gradient_ids_; ///< where the usual was taken
    std::string gradients_text_;                                      ///< of the last ones
    std::vector<std::string> held_gradients_;                         ///< of those before
    bool has_seams_ = false;
    OpenGroups groups_;
    bool is_holding_ = false;
    std::vector<std::string> held_;  ///< text that is not passed on yet, part by part
    std::vector<std::string> ready_; ///< what a pipe gets at the end
};

} // namespace

void write_svg(
    const Drawing& drawing,
    const DrawingSettings& settings,
    std::string& bytes,
    const Progress& progress,
    const CancelFlag* cancel) {
    SvgWriter(drawing, settings, progress, cancel, bytes).write();
}

void detail::write_svg_file(
    const Drawing& drawing,
    const DrawingSettings& settings,
    OutputFile& file,
    const Progress& progress,
    const CancelFlag* cancel) {
    std::string text;
    SvgWriter(drawing, settings, progress, cancel, text, &file).write();
}

} // namespace vera
