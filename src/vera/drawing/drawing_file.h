// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "vera/base/parallel.h"
#include "vera/drawing/drawing.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vera {

class OutputFile;

enum class DrawingFormat { svg, pdf, eps, dxf };

/// The format that a file's extension stands for, in capitals or not: .svg, .pdf, .eps,
/// .dxf.
std::optional<DrawingFormat> drawing_format_from_extension(const std::filesystem::path& path);

/// The format of a name that a user may write: svg, pdf, eps, dxf; in capitals or not.
std::optional<DrawingFormat> drawing_format_from_name(std::string_view name);

/// The names, one a format, as a message lists them.
std::string drawing_format_names();

/// How the lines of one class are drawn. Lengths are in pixels of the picture.
struct LineStyle {
    LineClass line_class = LineClass::silhouette;
    DrawingColor color = {};
    double width = 1;
    std::vector<double> dashes = {}; ///< lengths of dash, gap, dash ...; empty: one unbroken line
};

/// One for each class: silhouettes thick, creases and intersections thinner, shadow boundaries
/// thin, hidden lines thin and dashed.
std::vector<LineStyle> default_line_styles();

struct DrawingSettings {
    /// Coordinates are rounded to the coarsest power of a tenth of a pixel, 1 to 1e-6, that is no
    /// coarser than this.
    double precision = 0.01;
    /// How wide the page is, in millimetres; its height follows. 0: 96 pixels to the inch.
    double page_width_millimeters = 0;
    /// Whether the background is kept from shining through where outlines abut.
    bool cover_seams = true;
    /// How wide the lines are that cover seams, in pixels. 2 suffice where the drawing is shown in
    /// its size or larger; a trace of the background is left where it is shown smaller.
    double seam_width = 2;
    /// For classes that are not among them a LineStyle's own values hold.
    std::vector<LineStyle> line_styles = default_line_styles();
};

// Each writer appends the bytes of a whole file. The same drawing and settings give the same bytes.
// Points that coincide when they are rounded are one; rings of fewer than three points, and lines
// without length, are left out. A number that is not finite is a broken invariant. Each tells how
// far it is, and throws Cancelled soon after the flag is raised.

/// An SVG with a layer for the outlines and one for each class of lines, as Inkscape knows them,
/// and a group with an id for each group of outlines.
void write_svg(
    const Drawing& drawing,
    const DrawingSettings& settings,
    std::string& bytes,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// A PDF 1.7 of one page with the same layers.
void write_pdf(
    const Drawing& drawing,
    const DrawingSettings& settings,
    std::string& bytes,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// An Encapsulated PostScript of level 2, or of level 3 where there are gradients.
void write_eps(
    const Drawing& drawing,
    const DrawingSettings& settings,
    std::string& bytes,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// The lines alone, as an ASCII DXF of AutoCAD 2000 (AC1015) with a layer for each class: y upward
/// from the picture's lower border, in millimetres where the page has a width, else in pixels.
void write_dxf(
    const Drawing& drawing,
    const DrawingSettings& settings,
    std::string& bytes,
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

/// Writes the drawing to a file, whole or not at all; "-" is standard output. Throws
/// std::system_error, which names the path, when it cannot be written.
void write_drawing(
    const Drawing& drawing,
    const std::filesystem::path& path,
    DrawingFormat format,
    const DrawingSettings& settings = {});

/// The same into a file that was opened earlier, so that what makes it impossible shows before the
/// drawing is computed. The caller commits. Throws Cancelled as well.
void write_drawing(
    const Drawing& drawing,
    OutputFile& file,
    DrawingFormat format,
    const DrawingSettings& settings = {},
    const Progress& progress = {},
    const CancelFlag* cancel = nullptr);

} // namespace vera
