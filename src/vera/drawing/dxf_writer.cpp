// SPDX-License-Identifier: Apache-2.0
#include "vera/base/progress_part.h"
#include "vera/drawing/document_text.h"
#include "vera/drawing/elliptic_arc.h"
#include "vera/drawing/layers.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace vera {

namespace {

using namespace detail;

constexpr double degrees_per_radian = 57.295779513082320877;

/// As DXF has numbers: with a digit before the point.
std::string real(double value, int digits) {
    std::string text = decimal(value, digits);
    if (const std::size_t point = text.find_first_not_of('-'); text[point] == '.')
        text.insert(point, 1, '0');
    return text;
}

/// The number of the nearest of the nine colors that every program shows alike. Number 7 is black
/// on a bright ground and white on a dark one.
int color_number(DrawingColor color) {
    constexpr DrawingColor known[] = {
        {255, 0, 0},
        {255, 255, 0},
        {0, 255, 0},
        {0, 255, 255},
        {0, 0, 255},
        {255, 0, 255},
        {0, 0, 0},
        {128, 128, 128},
        {192, 192, 192}};
    const auto off = [&](DrawingColor other) {
        const int r = color.r - other.r;
        const int g = color.g - other.g;
        const int b = color.b - other.b;
        return r * r + g * g + b * b;
    };
    const auto* const nearest =
        std::min_element(std::begin(known), std::end(known), [&](DrawingColor a, DrawingColor b) {
            return off(a) < off(b);
        });
    return static_cast<int>(nearest - std::begin(known)) + 1;
}

/// The nearest of the widths that DXF has, in hundredths of a millimetre.
int line_weight(double millimeters) {
    constexpr int known[] = {0,  5,  9,  13, 15, 18,  20,  25,  30,  35,  40,  50,
                             53, 60, 70, 80, 90, 100, 106, 120, 140, 158, 200, 211};
    return *std::min_element(std::begin(known), std::end(known), [&](int a, int b) {
        return std::abs(a - 100 * millimeters) < std::abs(b - 100 * millimeters);
    });
}

/// Writes group after group: a code on a line, and a value on the next. Every object gets a number
/// of its own, its handle.
class DxfWriter {
public:
    DxfWriter(
        const Drawing& drawing,
        const DrawingSettings& settings,
        const Progress& progress,
        const CancelFlag* cancel)
        : drawing_(drawing)
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
        , in_millimeters_(settings.page_width_millimeters > 0)
        , per_pixel_(in_millimeters_ ? settings.page_width_millimeters / drawing.width : 1)
        , millimeters_per_pixel_(in_millimeters_ ? per_pixel_ : 25.4 / 96) {
        const double per_unit = per_pixel_ / lattice_.units_per_pixel();
        for (double last = 1; last > per_unit * (1 + 1e-9) && digits_ < 9; last /= 10)
            ++digits_;
    }

    std::string written() {
        // The header must name a handle that is greater than all others.
        write_tables();
        write_blocks();
        write_entities();
        write_objects();
        std::string rest = std::move(text_);
        text_.clear();
        write_header();
        return std::move(text_) + rest + "0\nEOF\n";
    }

private:
    enum : std::uint64_t { root = 1, groups, model_space, paper_space, first_free };

    void group(int code, std::string_view value) { text_ += fmt::format("{}\n{}\n", code, value); }

    void group(int code, std::int64_t value) { text_ += fmt::format("{}\n{}\n", code, value); }

    void handle(int code, std::uint64_t value) { text_ += fmt::format("{}\n{:X}\n", code, value); }

    void length(int code, double value) { group(code, real(value, digits_)); }

    void begin_section(std::string_view name) {
        group(0, "SECTION");
        group(2, name);
    }

    void end_section() { group(0, "ENDSEC"); }

    void write_header() {
        if (!drawing_.title.empty())
            group(999, plain_line(drawing_.title));
        if (!drawing_.description.empty())
            group(999, plain_line(drawing_.description));
        begin_section("HEADER");
        group(9, "$ACADVER");
        group(1, "AC1015");
        group(9, "$DWGCODEPAGE");
        group(3, "ANSI_1252");
        group(9, "$INSUNITS");
        group(70, in_millimeters_ ? 4 : 0);
        group(9, "$MEASUREMENT");
        group(70, 1);
        group(9, "$HANDSEED");
        handle(5, next_handle_);
        group(9, "$EXTMIN");
        write_point(0, {0, 0, true});
        group(9, "$EXTMAX");
        write_point(0, {drawing_.width * per_pixel_, drawing_.height * per_pixel_, true});
        end_section();
        begin_section("CLASSES");
        end_section();
    }

    /// Writes entries between a table's head and end.
    template <typename Entries>
    void write_table(const char* name, std::size_t count, const Entries& entries) {
        table_ = next_handle_++;
        group(0, "TABLE");
        group(2, name);
        handle(5, table_);
        group(330, "0");
        group(100, "AcDbSymbolTable");
        group(70, static_cast<std::int64_t>(count));
        entries();
        group(0, "ENDTAB");
    }

    void begin_entry(
        const char* kind,
        const char* subclass,
        std::string_view name,
        std::uint64_t number,
        int code_of_number = 5) {
        group(0, kind);
        handle(code_of_number, number);
        handle(330, table_);
        group(100, "AcDbSymbolTableRecord");
        group(100, subclass);
        group(2, name);
    }

    void write_tables() {
        begin_section("TABLES");
        write_table("VPORT", 0, [] {});
        write_line_types();
        write_table("LAYER", layers_.lines.size() + 1, [&] {
            write_layer("0", "Continuous", {});
            for (std::size_t i = 0; i < layers_.lines.size(); ++i)
                write_layer(
                    name_of(layers_.lines[i].style.line_class),
                    type_of_layer_[i],
                    layers_.lines[i].style);
        });
        write_table("STYLE", 1, [&] {
            begin_entry("STYLE", "AcDbTextStyleTableRecord", "Standard", next_handle_++);
            group(70, 0);
            group(40, 0);
            group(41, 1);
            group(50, 0);
            group(71, 0);
            group(42, 1);
            group(3, "txt");
            group(4, "");
        });
        write_table("VIEW", 0, [] {});
        write_table("UCS", 0, [] {});
        write_table("APPID", 1, [&] {
            begin_entry("APPID", "AcDbRegAppTableRecord", "ACAD", next_handle_++);
            group(70, 0);
        });
        write_table("DIMSTYLE", 1, [&] {
            group(100, "AcDbDimStyleTable");
            group(71, 0);
            begin_entry("DIMSTYLE", "AcDbDimStyleTableRecord", "Standard", next_handle_++, 105);
            group(70, 0);
        });
        write_table("BLOCK_RECORD", 2, [&] {
            begin_entry("BLOCK_RECORD", "AcDbBlockTableRecord", "*Model_Space", model_space);
            begin_entry("BLOCK_RECORD", "AcDbBlockTableRecord", "*Paper_Space", paper_space);
        });
        end_section();
    }

    /// Continuous and, for layers with dashes, DASHED, DASHED2 and so on.
    void write_line_types() {
        std::size_t dashed = 0;
        for (const LineLayer& layer : layers_.lines) {
            type_of_layer_.emplace_back("Continuous");
            if (!layer.style.dashes.empty())
                type_of_layer_.back() =
                    ++dashed == 1 ? "DASHED" : "DASHED" + std::to_string(dashed);
        }
        write_table("LTYPE", 3 + dashed, [&] {
            for (const char* name : {"ByBlock", "ByLayer", "Continuous"})
                write_line_type(name, {});
            for (std::size_t i = 0; i < layers_.lines.size(); ++i)
                if (!layers_.lines[i].style.dashes.empty())
                    write_line_type(type_of_layer_[i], layers_.lines[i].style.dashes);
        });
    }

    void write_line_type(std::string_view name, std::vector<double> dashes) {
        if (dashes.size() % 2 == 1) // what was a gap is a dash the next time
            dashes.insert(dashes.end(), dashes.begin(), dashes.end());
        double total = 0;
        for (const double dash : dashes)
            total += dash * per_pixel_;
        begin_entry("LTYPE", "AcDbLinetypeTableRecord", name, next_handle_++);
        group(70, 0);
        group(3, dashes.empty() ? "" : "_ _ _ _");
        group(72, 65);
        group(73, static_cast<std::int64_t>(dashes.size()));
        length(40, total);
        for (std::size_t i = 0; i < dashes.size(); ++i) {
            length(49, (i % 2 == 0 ? 1 : -1) * dashes[i] * per_pixel_);
            group(74, 0);
        }
    }

    void write_layer(std::string_view name, std::string_view type, const LineStyle& style) {
        begin_entry("LAYER", "AcDbLayerTableRecord", name, next_handle_++);
        group(70, 0);
        group(62, color_number(style.color));
        group(6, type);
        group(370, line_weight(style.width * millimeters_per_pixel_));
    }

    void write_blocks() {
        begin_section("BLOCKS");
        for (const auto& [name, record] :
             {std::pair{"*Model_Space", model_space}, {"*Paper_Space", paper_space}}) {
            begin_entity("BLOCK", record, "0", "AcDbBlockBegin");
            group(2, name);
            group(70, 0);
            write_point(0, {0, 0, true});
            group(3, name);
            group(1, "");
            begin_entity("ENDBLK", record, "0", "AcDbBlockEnd");
        }
        end_section();
    }

    void begin_entity(
        const char* kind, std::uint64_t owner, std::string_view layer, const char* subclass) {
        group(0, kind);
        handle(5, next_handle_++);
        handle(330, owner);
        group(100, "AcDbEntity");
        group(8, layer);
        group(100, subclass);
    }

    struct Point {
        double x = 0; ///< in units of the file, y upward
        double y = 0;
        bool is_in_space = false; ///< then it has a z, of 0
    };

    /// Point number i of an entity.
    void write_point(int i, Point point) {
        length(10 + i, point.x);
        length(20 + i, point.y);
        if (point.is_in_space)
            group(30 + i, "0");
    }

    Point in_file(DrawingPoint in_units, bool is_in_space) const {
        const double per_unit = per_pixel_ / lattice_.units_per_pixel();
        return {
            in_units.x * per_unit,
            drawing_.height * per_pixel_ - in_units.y * per_unit,
            is_in_space};
    }

    static DrawingPoint as_numbers(SnappedPoint point) {
        return {static_cast<double>(point.x), static_cast<double>(point.y)};
    }

    void write_entities() {
        begin_section("ENTITIES");
        for (const LineLayer& layer : layers_.lines) {
            const std::string_view name = name_of(layer.style.line_class);
            for_each_line(
                drawing_, layer, lattice_, stages_.next(1), cancel_, [&](const SnappedPath& line) {
                    write_path(line, name);
                });
        }
        end_section();
    }

    /// What is straight as lines with corners, and the arcs between as themselves.
    void write_path(const SnappedPath& path, std::string_view layer) {
        if (path.arcs.empty())
            return write_corners(path.points, path.closed, layer);
        std::vector<SnappedPoint> corners = {path.points.front()};
        const auto end_corners = [&](SnappedPoint next) {
            if (corners.size() > 1)
                write_corners(corners, false, layer);
            corners = {next};
        };
        for_each_segment(
            path,
            [&](SnappedPoint to) { corners.push_back(to); },
            [&](const DrawingArc& arc, SnappedPoint to) {
                end_corners(to);
                write_arc(arc, layer);
            });
        if (path.closed && path.arcs.back().segment + 1 < path.points.size())
            corners.push_back(path.points.front());
        end_corners({});
    }

    void
    write_corners(const std::vector<SnappedPoint>& corners, bool closed, std::string_view layer) {
        if (corners.size() == 2) {
            begin_entity("LINE", model_space, layer, "AcDbLine");
            write_point(0, in_file(as_numbers(corners[0]), true));
            write_point(1, in_file(as_numbers(corners[1]), true));
            return;
        }
        begin_entity("LWPOLYLINE", model_space, layer, "AcDbPolyline");
        group(90, static_cast<std::int64_t>(corners.size()));
        group(70, closed ? 1 : 0);
        for (const SnappedPoint corner : corners)
            write_point(0, in_file(as_numbers(corner), false));
    }

    /// As CIRCLE or ARC, or as ELLIPSE, which is one or a part of one.
    void write_arc(const DrawingArc& arc, std::string_view layer) {
        constexpr int angle_digits = 7;
        const DrawingPoint& major = arc.ellipse.major;
        const double radius = distance(major, {});
        const double ratio = distance(arc.ellipse.minor, {}) / radius;
        const double sweep = std::abs(arc.end_degrees - arc.begin_degrees);
        // With y upward angles count the other way, and all arcs run against the clock.
        const double first = -std::max(arc.begin_degrees, arc.end_degrees);
        const Point center = in_file(arc.ellipse.center, true);
        const double per_unit = per_pixel_ / lattice_.units_per_pixel();
        const auto from_0_to = [](double turn, double angle) {
            return angle - turn * std::floor(angle / turn);
        };
        // Where the axes differ by less than is written.
        if (radius * (1 - ratio) < 0.5) {
            const bool is_whole = sweep >= 360;
            begin_entity(is_whole ? "CIRCLE" : "ARC", model_space, layer, "AcDbCircle");
            write_point(0, center);
            length(40, radius * per_unit);
            if (is_whole)
                return;
            const double begin = first - direction_degrees(major);
            group(100, "AcDbArc");
            group(50, real(from_0_to(360, begin), angle_digits));
            group(51, real(from_0_to(360, begin + sweep), angle_digits));
            return;
        }
        begin_entity("ELLIPSE", model_space, layer, "AcDbEllipse");
        write_point(0, center);
        write_point(1, {major.x * per_unit, -major.y * per_unit, true});
        constexpr double least_ratio = 1e-6;
        group(40, real(std::max(ratio, least_ratio), 9));
        const double begin = sweep >= 360 ? 0 : from_0_to(360, first);
        group(41, real(begin / degrees_per_radian, 9));
        group(42, real((begin + sweep) / degrees_per_radian, 9));
    }

    void write_objects() {
        begin_section("OBJECTS");
        group(0, "DICTIONARY");
        handle(5, root);
        group(330, "0");
        group(100, "AcDbDictionary");
        group(281, 1);
        group(3, "ACAD_GROUP");
        handle(350, groups);
        group(0, "DICTIONARY");
        handle(5, groups);
        handle(330, root);
        group(100, "AcDbDictionary");
        group(281, 1);
        end_section();
    }

    const Drawing& drawing_;
    Lattice lattice_;
    Layers layers_;
    StageProgress stages_;
    const CancelFlag* cancel_;
    bool in_millimeters_;
    double per_pixel_; ///< units of the file
    double millimeters_per_pixel_;
    int digits_ = 0;
    std::string text_;
    std::uint64_t next_handle_ = first_free;
    std::uint64_t table_ = 0;
    std::vector<std::string> type_of_layer_;
};

} // namespace

void write_dxf(
    const Drawing& drawing,
    const DrawingSettings& settings,
    std::string& bytes,
    const Progress& progress,
    const CancelFlag* cancel) {
    bytes += DxfWriter(drawing, settings, progress, cancel).written();
}

} // namespace vera
