// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/mtl_file.h"

#include "vera/formats/statement_line.h"
#include "vera/formats/text_cursor.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace vera {

namespace {

/// What is said of one material, each with what holds where it is not.
struct Said {
    std::string name;
    Color diffuse = {0.7, 0.7, 0.7}; ///< as of the material that stands for a missing one
    Color specular;
    Color emission;
    Color filter = {1, 1, 1};
    double exponent = 1;
    double opacity = 1;
    double index = 1;
    int model = 2; ///< of illumination, from 0 to 10
};

Material material_of(Said said) {
    Material material;
    material.name = std::move(said.name);
    material.sdi = said.emission;
    (said.model == 0 ? material.sdi : material.drf) += said.opacity * said.diffuse;
    if (said.model >= 2 && !is_black(said.specular))
        material.spc = highlight_end(said.exponent);
    if (said.model >= 3 && said.model <= 7)
        material.rab = said.specular;
    material.tab = (1 - said.opacity) * (said.filter * (Color{1, 1, 1} - material.rab));
    if (said.model == 6 || said.model == 7)
        material.ref = said.index;
    return material;
}

class MtlReader {
public:
    explicit MtlReader(const SourceText& source)
        : report_(source)
        , cursor_(report_, TextCursor::Lines::continue_behind_backslash) {}

    std::vector<Material> read(std::vector<Diagnostic>& warnings) {
        while (!cursor_.at_end() && !report_.full())
            read_statement_line(cursor_, [&] { read_statement(); });
        end_material();
        warn();
        report_.finish(warnings);
        return std::move(materials_);
    }

private:
    void end_material() {
        if (any_)
            materials_.push_back(material_of(std::exchange(said_, {})));
    }

    void read_statement() {
        const std::size_t start = cursor_.offset();
        const std::string_view keyword = cursor_.word();
        cursor_.pass(keyword);
        if (keyword.empty())
            return;
        if (keyword == "newmtl")
            return begin_material(start);
        if (!is_known(keyword))
            return unknown_.add(start);
        if (keyword.starts_with("map_") || keyword == "bump" || keyword == "disp"
            || keyword == "decal" || keyword == "refl" || keyword == "norm")
            return pictures_.add(start);
        if (!any_)
            return report_.error(
                start,
                keyword.size(),
                fmt::format("'{}' before the first 'newmtl'", keyword),
                "begin each material with 'newmtl NAME'");
        read_value(keyword);
    }

    static bool is_known(std::string_view keyword) {
        constexpr std::array<std::string_view, 17> known = {
            "Ka",
            "Kd",
            "Ks",
            "Ke",
            "Tf",
            "Ns",
            "Ni",
            "d",
            "Tr",
            "illum",
            "sharpness",
            "bump",
            "disp",
            "decal",
            "refl",
            "norm",
            "aniso"};
        // Of physically based shading, what has no place in the formula.
        constexpr std::array<std::string_view, 6> rough = {"Pr", "Pm", "Ps", "Pc", "Pcr", "anisor"};
        return keyword.starts_with("map_") || std::ranges::find(known, keyword) != known.end()
            || std::ranges::find(rough, keyword) != rough.end();
    }

    void begin_material(std::size_t start) {
        end_material();
        any_ = true;
        const std::string_view name = cursor_.name_of_line();
        if (name.empty())
            report_.error(start, 6, "the material has no name", "write 'newmtl NAME'");
        said_.name = name;
    }

    void read_value(std::string_view keyword) {
        if (keyword == "Ka")
            take_color(ambient_, keyword);
        else if (keyword == "Kd")
            take_color(said_.diffuse, keyword);
        else if (keyword == "Ks")
            take_color(said_.specular, keyword);
        else if (keyword == "Ke")
            take_color(said_.emission, keyword);
        else if (keyword == "Tf")
            take_color(said_.filter, keyword);
        else if (keyword == "Ns")
            take_number(said_.exponent, 0, 1e9, keyword);
        else if (keyword == "Ni")
            take_number(said_.index, 1e-3, 1e3, keyword);
        else if (keyword == "d")
            take_opacity();
        else if (keyword == "Tr") {
            double transparency = 1 - said_.opacity;
            take_number(transparency, 0, 1, keyword);
            said_.opacity = 1 - transparency;
        } else if (keyword == "illum") {
            double model = said_.model;
            take_number(model, 0, 10, keyword);
            said_.model = static_cast<int>(model);
        }
    }

    /// Three numbers, or one for all. Spectra, and colours as CIE's X Y Z, are left out.
    void take_color(Color& color, std::string_view keyword) {
        cursor_.skip_blanks();
        const std::string_view first = cursor_.word();
        if (first == "spectral" || first == "xyz")
            return spectra_.add(cursor_.offset());
        Color taken;
        if (!take_number(taken.r, 0, 1, keyword))
            return;
        if (cursor_.at_line_end() || cursor_.peek() == '#')
            taken.g = taken.b = taken.r;
        else if (!take_number(taken.g, 0, 1, keyword) || !take_number(taken.b, 0, 1, keyword))
            return;
        color = taken;
    }

    /// -halo, which is less where a surface is seen from its side, is passed over.
    void take_opacity() {
        cursor_.skip_blanks();
        if (const std::string_view word = cursor_.word(); word == "-halo")
            cursor_.pass(word);
        take_number(said_.opacity, 0, 1, "d");
    }

    /// One beyond the range becomes its end.
    bool take_number(double& value, double least, double most, std::string_view keyword) {
        cursor_.skip_blanks();
        const std::size_t start = cursor_.offset();
        double taken = 0;
        if (!cursor_.take_number(taken, "a number of ", fmt::format("'{}'", keyword)))
            return false;
        value = std::clamp(taken, least, most);
        if (value != taken)
            beyond_.add(start);
        return true;
    }

    void warn() {
        if (pictures_.count > 0)
            report_.warning(
                pictures_.first,
                1,
                fmt::format(
                    "pictures on materials are left out ({})",
                    counted(pictures_.count, "statement", "statements")));
        if (spectra_.count > 0)
            report_.warning(
                spectra_.first,
                1,
                fmt::format(
                    "colours as spectra or X Y Z are left out ({})",
                    counted(spectra_.count, "statement", "statements")),
                "write red, green and blue, from 0 to 1");
        if (beyond_.count > 0)
            report_.warning(
                beyond_.first,
                1,
                fmt::format(
                    "{} beyond the range, the first of them here: its end is taken",
                    counted(beyond_.count, "number is", "numbers are")),
                "colours and opacities go from 0 to 1, Ns from 0, illum from 0 to 10");
        if (unknown_.count > 0)
            report_.warning(
                unknown_.first,
                1,
                fmt::format(
                    "{} unknown, the first of them here, and left out",
                    counted(unknown_.count, "statement is", "statements are")));
    }

    SourceReport report_;
    TextCursor cursor_;
    std::vector<Material> materials_;
    bool any_ = false; ///< whether there was a newmtl
    Said said_;
    Color ambient_; ///< for which the formula has no place
    Tally pictures_;
    Tally spectra_;
    Tally beyond_;
    Tally unknown_;
};

/// exp(-x) for 0 <= x < 1, by its series: the same bits with every library of functions.
double inverse_exponential(double x) {
    double sum = 1;
    double term = 1;
    for (double i = 1; i < 24; ++i) {
        term *= -x / i;
        sum += term;
    }
    return sum;
}

} // namespace

double highlight_end(double exponent) {
    // The formula's highlight is (1 - u^2)^2 with u = (1 - cos) / (1 - SPC), which is 1/2 there.
    constexpr double half_way = 0.541196100146197; // sqrt(1 - sqrt(1/2))
    constexpr double log_of_2 = 0.693147180559945;
    const double cosine = inverse_exponential(log_of_2 / std::max(exponent, 1.0));
    return 1 - (1 - cosine) / half_way;
}

std::vector<Material> read_mtl(const SourceText& source, std::vector<Diagnostic>& warnings) {
    return MtlReader(source).read(warnings);
}

} // namespace vera
