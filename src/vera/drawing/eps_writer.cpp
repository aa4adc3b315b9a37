// SPDX-License-Identifier: Apache-2.0
#include "vera/base/progress_part.h"
#include "vera/drawing/document_text.h"
#include "vera/drawing/page_content.h"

#include <cmath>
#include <cstddef>
#include <string>

#include <fmt/format.h>

namespace vera {

using namespace detail;

namespace {

/// The words in lines that are as long as DSC lets them be (Adobe 1992, Document Structuring
/// Conventions 3.0, section 3): blanks become ends of lines.
std::string in_lines(std::string words) {
    constexpr std::size_t longest = 255;
    std::size_t begin = 0; // of the line
    std::size_t last_blank = 0;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (words[i] == ' ')
            last_blank = i;
        if (i - begin == longest && last_blank > begin) {
            words[last_blank] = '\n';
            begin = last_blank + 1;
        }
    }
    return words;
}

} // namespace

void write_eps(
    const Drawing& drawing,
    const DrawingSettings& settings,
    std::string& bytes,
    const Progress& progress,
    const CancelFlag* cancel) {
    StageProgress stages(progress, 2);
    const Lattice lattice(settings.precision);
    const Layers content =
        layers(drawing, settings, lattice, LaterOutlines::at_once, stages.next(1), cancel);
    const Gradients gradients(content.fills);
    const PageSize page = page_size(drawing, settings);
    const std::string width = decimal(page.width, 4);
    const std::string height = decimal(page.height, 4);

    bytes += fmt::format(
        "%!PS-Adobe-3.0 EPSF-3.0\n"
        "%%BoundingBox: 0 0 {} {}\n"
        "%%HiResBoundingBox: 0 0 {} {}\n",
        std::ceil(page.width),
        std::ceil(page.height),
        width,
        height);
    if (!drawing.title.empty())
        bytes += "%%Title: " + plain_line(drawing.title) + "\n";
    bytes += fmt::format(
        "%%LanguageLevel: {}\n"
        "%%EndComments\n"
        "%%BeginProlog\n"
        "32 dict begin\n"
        // The operators of PDF. Both of its colours are the one of PostScript, whose fill and
        // stroke leave no path behind either.
        "/q{{gsave}}def/Q{{grestore}}def/cm{{6 array astore concat}}def\n"
        "/rg{{setrgbcolor}}def/RG{{setrgbcolor}}def\n"
        "/w{{setlinewidth}}def/J{{setlinecap}}def/j{{setlinejoin}}def/d{{setdash}}def\n"
        "/re{{4 2 roll moveto 1 index 0 rlineto 0 exch rlineto neg 0 rlineto closepath}}def\n"
        "/m{{moveto}}def/l{{lineto}}def/c{{curveto}}def/h{{closepath}}def/f{{fill}}def/"
        "S{{stroke}}def\n"
        "{}"
        "%%EndProlog\n"
        // Lines along the picture's border may not paint beyond it.
        "gsave\n0 0 {} {} rectclip\n",
        // Shadings came with level 3.
        gradients.count() > 0 ? 3 : 2,
        gradients.count() > 0 ? "/cs{pop}def/CS{pop}def/scn{load setpattern}def/SCN{scn}def\n" : "",
        width,
        height);
    for (std::size_t i = 0; i < gradients.count(); ++i)
        bytes += in_lines(fmt::format(
                     "/P{} <<{}>>{}makepattern def",
                     i,
                     shading_pattern(gradients[i]),
                     pattern_matrix(gradients[i], page, drawing.width)))
            + "\n";
    const PageMarks marks = {
        [](std::size_t, const std::string& name) { return "% " + plain_line(name) + "\n"; },
        "",
        [](const std::string& name, std::size_t) {
            return "%%BeginObject: " + plain_line(name) + "\n";
        },
        "%%EndObject\n"};
    bytes +=
        page_content(drawing, settings, lattice, content, gradients, marks, stages.next(1), cancel);
    bytes += "grestore\nend\n%%EOF\n";
}

} // namespace vera
