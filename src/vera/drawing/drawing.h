// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/line_class.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vera {

/// In pixels of the picture: x from its left, y from its top. Must be finite.
struct DrawingPoint {
    double x = 0;
    double y = 0;

    friend bool operator==(const DrawingPoint&, const DrawingPoint&) = default;
};

/// Red, green and blue as a screen shows them (sRGB).
struct DrawingColor {
    std::uint8_t r = 0;
    std::uint8_t g = 0;
    std::uint8_t b = 0;

    friend bool operator==(const DrawingColor&, const DrawingColor&) = default;
};

/// A colour on the way of a gradient.
struct GradientStop {
    double offset = 0; ///< from 0 to 1, never less than that of the stop before it
    DrawingColor color = {};

    friend bool operator==(const GradientStop&, const GradientStop&) = default;
};

/// Colours that go over into each other from stop to stop, in proportion to the offset and to the
/// bytes of sRGB, as SVG and PDF define it; before the first stop its colour holds, behind the last
/// one that of the last.
struct Gradient {
    enum class Shape : std::uint8_t {
        linear, ///< the offset of a point is its way along the axis, by the axis' length
        radial  ///< the offset is 0 in the start and 1 on the ellipse of the axes' ends
    };

    Shape shape = Shape::linear;
    DrawingPoint start = {};
    DrawingPoint axis = {1, 0};   ///< from the start; not of length 0
    DrawingPoint other_axis = {}; ///< of radial ones: the ellipse's other half axis, not along axis
    std::vector<GradientStop> stops = {}; ///< one or more

    friend bool operator==(const Gradient&, const Gradient&) = default;
};

/// The points center + cos(a) major + sin(a) minor.
struct DrawingEllipse {
    DrawingPoint center = {};
    DrawingPoint major = {}; ///< from the center to the farthest point
    DrawingPoint minor = {}; ///< a quarter turn from major, from x towards y, and no longer

    friend bool operator==(const DrawingEllipse&, const DrawingEllipse&) = default;
};

/// A part of an ellipse, from one angle to the other; backward where the end is the smaller one.
struct DrawingArc {
    std::size_t segment = 0; ///< of a line or ring: from the point of that number to the next
    DrawingEllipse ellipse = {};
    double begin_degrees = 0;
    double end_degrees = 0; ///< at most a whole turn from the beginning

    friend bool operator==(const DrawingArc&, const DrawingArc&) = default;
};

/// What areas are of.
struct DrawingMaterial {
    std::string name = {};      ///< for people
    std::string css_class = {}; ///< that a style sheet names it by

    friend bool operator==(const DrawingMaterial&, const DrawingMaterial&) = default;
};

/// What areas are part of. In an SVG an element, in a PDF optional content, in an EPS comments.
struct DrawingGroup {
    std::string id = {};
    std::string name = {};                                ///< for people; may be empty
    std::string given = {};                               ///< name in a file, for scripts
    std::shared_ptr<const DrawingMaterial> material = {}; ///< of all in it; or none
    std::shared_ptr<const DrawingGroup> parent = {};      ///< that it is part of; or none
};

/// Whether they are equal, with all that they are part of, or none both.
inline bool is_same_group(const DrawingGroup* a, const DrawingGroup* b) {
    const auto have_one_material = [&] {
        return a->material == b->material
            || (a->material && b->material && *a->material == *b->material);
    };
    for (; a != b && a != nullptr && b != nullptr; a = a->parent.get(), b = b->parent.get())
        if (a->id != b->id || a->name != b->name || a->given != b->given || !have_one_material())
            return false;
    return a == b;
}

/// An area of one colour or gradient, of any number of parts and holes. Its rings are closed (the
/// first point need not be repeated), and holes run against the rings around them, so that the
/// nonzero and the even-odd rule see the same area.
struct FilledOutline {
    std::string id = {};   ///< of the path in an SVG; may be empty
    std::string name = {}; ///< for people: the path's title in an SVG; may be empty
    /// What the area is part of. Consecutive outlines of equal groups are written as one, and so
    /// are groups of equal parents; outlines without a group stand by themselves.
    std::shared_ptr<const DrawingGroup> group = {};
    DrawingColor color = {};
    std::optional<Gradient> gradient = {}; ///< in place of the colour
    std::vector<std::vector<DrawingPoint>> rings = {};
    /// Of each ring the arcs among its segments, as those of a closed Stroke; rings beyond the end
    /// of this list have none.
    std::vector<std::vector<DrawingArc>> arcs = {};
    /// The parts of the border beyond which an outline lies that is painted later. Points of the
    /// border, in its order; a part that goes on where the one before it ended is one with it.
    std::vector<std::vector<DrawingPoint>> seams = {};
};

/// A line. Its class says why it is drawn and decides how. Its segments, from each point to the
/// next and, where it is closed, from the last to the first, are straight but for the arcs, whose
/// ends are at the points. A whole ellipse is closed and has one point and one arc.
struct Stroke {
    LineClass line_class = LineClass::silhouette;
    std::vector<DrawingPoint> points = {};
    bool closed = false;
    std::vector<DrawingArc> arcs = {}; ///< by segment, each segment at most once
};

/// Areas that have their corners in common, as the regions of a map do: each of one colour, its
/// rings as those of a FilledOutline, and without all else that one has. A tenth of the memory.
struct SharedAreas {
    std::vector<DrawingPoint> places;
    std::vector<std::uint32_t> corners;   ///< places, one ring's behind the other's
    std::vector<std::uint32_t> ring_ends; ///< of each ring, behind its last one of corners
    std::vector<std::uint32_t> area_ends; ///< of each area, behind its last one of ring_ends
    std::vector<DrawingColor> colors;     ///< of each area

    std::size_t count() const { return colors.size(); }
};

/// One of the areas by itself.
FilledOutline outline_of(const SharedAreas& areas, std::size_t number);

/// Outlines that are made when a writer asks for them, some at a time: all of them would take ten
/// times as much memory as what they are made from. Asked again, a block is the same again.
struct LaterFills {
    /// The outlines of the block of that number, in their order. Throws Cancelled.
    using Block =
        std::function<std::vector<FilledOutline>(std::size_t number, const CancelFlag* cancel)>;

    std::size_t blocks = 0;     ///< 0: there are none
    bool have_gradients = true; ///< whether some may have one
    Block block = {};
    /// Those of the block that have seams, which must all be known before any of them is written.
    Block with_seams = {};
};

/// A vector picture: the background, on it the outlines in their order, on them those that are made
/// later, on them the areas, on them the lines, one class after the other. Texts are UTF-8; what is
/// not is replaced.
struct Drawing {
    double width = 1; ///< in pixels, positive
    double height = 1;
    std::string title = {};
    std::string description = {};
    std::optional<DrawingColor> background = {};
    std::vector<FilledOutline> fills = {};
    LaterFills later_fills = {};
    SharedAreas areas = {};
    std::vector<Stroke> strokes = {};
};

} // namespace vera
