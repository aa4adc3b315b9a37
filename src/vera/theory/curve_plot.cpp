// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/curve_plot.h"

#include "vera/math/elementary.h"
#include "vera/theory/curve_structure.h"
#include "vera/theory/diagram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

namespace vera {

namespace {

constexpr double panel_width = 560;
constexpr double plot_height = 330;
constexpr double left_margin = 74;
constexpr double right_margin = 24;
constexpr double top_margin = 62;
constexpr double strip_gap = 22; ///< between the plot and that of local exponents
constexpr double strip_height = 84;
constexpr double below_strip = 58;
constexpr double legend_line = 17;

/// Beyond this number of curves in a panel only the highest one's bound is drawn.
constexpr std::size_t most_bounds = 3;

constexpr std::array<const char*, 9> curve_colors = {
    diagram_colors::blue,
    diagram_colors::orange,
    diagram_colors::green,
    diagram_colors::purple,
    diagram_colors::gold,
    diagram_colors::sky,
    "#000000",
    "#8c564b",
    "#7f7f7f"};

const char* color_of(std::size_t number) {
    return curve_colors.at(number % curve_colors.size());
}

/// Ends belong to it.
struct WholeRange {
    int first = 0;
    int last = 0;
};

double log10_of(double value) {
    return log2_of(value) / log2_of(10);
}

/// That hold all values; at least one. What rounding does to whole powers does not make a further
/// one.
class DecadesOf {
public:
    void add(double value) {
        const double at = log10_of(value);
        lowest_ = lowest_ ? std::min(*lowest_, at) : at;
        highest_ = highest_ ? std::max(*highest_, at) : at;
    }

    WholeRange found() const {
        constexpr double rounding = 1e-9;
        const int first = static_cast<int>(std::floor(lowest_.value_or(0) + rounding));
        const int last = static_cast<int>(std::ceil(highest_.value_or(1) - rounding));
        return {first, std::max(last, first + 1)};
    }

private:
    std::optional<double> lowest_;
    std::optional<double> highest_;
};

/// Whole numbers that hold all values, and at least one apart.
WholeRange whole_range(std::span<const double> values) {
    const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
    const int first = static_cast<int>(std::floor(*lowest));
    return {first, std::max(static_cast<int>(std::ceil(*highest)), first + 1)};
}

/// What is said below the legend: what a star means, where there is one; and what each family has
/// of the terms of a bound of several.
std::vector<std::string> notes_of(std::span<const Curve> curves) {
    std::vector<std::string> lines;
    if (std::any_of(curves.begin(), curves.end(), std::mem_fn(&Curve::is_contradicted)))
        lines.emplace_back("* A bootstrap comes to another verdict.");
    for (const CurveStructure& found : structures(curves)) {
        const std::vector<BoundTerm>& terms = found.experiment->terms;
        for (std::size_t i = 0; i < found.families.size(); ++i) {
            std::string sum;
            for (std::size_t term = 0; term < terms.size(); ++term)
                if (const auto& coefficient = found.fits[i].coefficients[term])
                    sum += fmt::format(
                        "{}{:.3g} {}",
                        sum.empty() ? "" : " + ",
                        coefficient->value,
                        terms[term].formula);
            lines.push_back(fmt::format(
                "{}: {}, off by {:.1f} %", found.families[i], sum, 100 * found.fits[i].error));
        }
    }
    return lines;
}

/// The curves of one name, and where they are drawn.
class Panel {
public:
    Panel(Diagram& diagram, std::span<const Curve> curves, DrawingPoint corner)
        : diagram_(diagram)
        , curves_(curves)
        , left_(corner.x + left_margin)
        , right_(corner.x + panel_width - right_margin)
        , top_(corner.y + top_margin)
        , bottom_(corner.y + top_margin + plot_height)
        , strip_top_(bottom_ + strip_gap)
        , strip_bottom_(strip_top_ + strip_height)
        , notes_(notes_of(curves)) {
        DecadesOf across;
        DecadesOf upward;
        for (const Curve& curve : curves)
            for (const CountedSize& point : curve.points) {
                across.add(point.size);
                upward.add(point.count);
            }
        for (const Curve& curve : with_bounds())
            for (const CountedSize& point : curve.fitted())
                upward.add(bound_beside(curve, point));
        sizes_ = across.found();
        counts_ = upward.found();
        std::vector<double> locals;
        for (const Curve& curve : curves) {
            const std::vector<double> some = curve.local_exponents();
            locals.insert(locals.end(), some.begin(), some.end());
        }
        exponents_ = whole_range(locals);
    }

    void draw() {
        add_heading();
        add_axes();
        for (const Curve& curve : with_bounds())
            add_bound(curve);
        for (std::size_t i = 0; i < curves_.size(); ++i)
            add_curve(curves_[i], color_of(i));
        for (std::size_t i = 0; i < curves_.size(); ++i)
            add_local_exponents(curves_[i], color_of(i));
        add_legend();
    }

    static double height(std::span<const Curve> curves) {
        return top_margin + plot_height + strip_gap + strip_height + below_strip
            + legend_line * static_cast<double>(curves.size() + 3 + notes_of(curves).size());
    }

private:
    /// Those whose bound is drawn.
    std::span<const Curve> with_bounds() const {
        if (curves_.size() <= most_bounds)
            return curves_;
        const auto highest =
            std::max_element(curves_.begin(), curves_.end(), [](const Curve& a, const Curve& b) {
                return a.fitted().front().count < b.fitted().front().count;
            });
        return curves_.subspan(static_cast<std::size_t>(highest - curves_.begin()), 1);
    }

    /// The bound is drawn so that it begins where the fitted counts do.
    static double bound_beside(const Curve& curve, const CountedSize& point) {
        const CountedSize& first = curve.fitted().front();
        return first.count * (point.bound / first.bound);
    }

    DrawingPoint place(double size, double count) const {
        return {
            left_
                + (log10_of(size) - sizes_.first) / (sizes_.last - sizes_.first) * (right_ - left_),
            bottom_
                - (log10_of(count) - counts_.first) / (counts_.last - counts_.first)
                    * (bottom_ - top_)};
    }

    double place_x(double size) const { return place(size, 1).x; }

    double strip_y(double exponent) const {
        return strip_bottom_
            - (exponent - exponents_.first) / (exponents_.last - exponents_.first) * strip_height;
    }

    void add_heading() {
        const Experiment& experiment = *curves_.front().experiment;
        diagram_.text(
            {left_, top_ - 38}, experiment.name, {15, diagram_colors::ink, "start", true});
        diagram_.text({left_, top_ - 18}, experiment.counted, {12, diagram_colors::faint});
    }

    void add_axes() {
        const DiagramPen pen = {diagram_colors::grid};
        const DiagramText label = {11, diagram_colors::faint, "end"};
        for (int power = counts_.first; power <= counts_.last; ++power) {
            const double y = place(1, std::pow(10.0, power)).y;
            diagram_.line({left_, y}, {right_, y}, pen);
            diagram_.text({left_ - 7, y + 4}, power_text(power), label);
        }
        for (int power = sizes_.first; power <= sizes_.last; ++power) {
            const double x = place_x(std::pow(10.0, power));
            diagram_.line({x, top_}, {x, bottom_}, pen);
            diagram_.line({x, strip_top_}, {x, strip_bottom_}, pen);
            diagram_.text(
                {x, strip_bottom_ + 18}, power_text(power), {11, diagram_colors::faint, "middle"});
        }
        // Not so close that the numbers would touch.
        const int step = (exponents_.last - exponents_.first + 3) / 4;
        for (int exponent = exponents_.first; exponent <= exponents_.last; exponent += step) {
            const double y = strip_y(exponent);
            diagram_.line({left_, y}, {right_, y}, pen);
            diagram_.text({left_ - 7, y + 4}, std::to_string(exponent), label);
        }
        diagram_.line({left_, bottom_}, {right_, bottom_}, {diagram_colors::faint});
        diagram_.line({left_, strip_bottom_}, {right_, strip_bottom_}, {diagram_colors::faint});
        diagram_.text(
            {left_, strip_top_ - 7}, "exponent from size to size", {11, diagram_colors::faint});
        diagram_.text(
            {(left_ + right_) / 2, strip_bottom_ + 36},
            curves_.front().experiment->unit,
            {11, diagram_colors::faint, "middle"});
    }

    static std::string power_text(int power) {
        if (power >= 0 && power <= 4)
            return fmt::format("{:.0f}", std::pow(10.0, power));
        return "10^" + std::to_string(power);
    }

    void add_bound(const Curve& curve) {
        std::vector<DrawingPoint> points;
        for (const CountedSize& point : curve.fitted())
            points.push_back(place(point.size, bound_beside(curve, point)));
        const auto number = static_cast<std::size_t>(&curve - curves_.data());
        diagram_.polyline(points, {color_of(number), 1.2, "5 4"});
    }

    void add_curve(const Curve& curve, const char* color) {
        const auto fitted = [&](const CountedSize& point) {
            return place(
                point.size, curve.growth.factor * power(point.size, curve.growth.exponent));
        };
        diagram_.line(fitted(curve.fitted().front()), fitted(curve.fitted().back()), {color, 1.6});
        for (std::size_t i = 0; i < curve.points.size(); ++i) {
            const CountedSize& point = curve.points[i];
            const bool is_fitted = i >= curve.first_fitted;
            diagram_.circle(
                place(point.size, point.count), 2.6, is_fitted ? color : "#ffffff", {color, 1.2});
        }
    }

    /// Each in the middle of its two sizes. A drift tells that the counts are no power.
    void add_local_exponents(const Curve& curve, const char* color) {
        const std::vector<double> exponents = curve.local_exponents();
        std::vector<DrawingPoint> points;
        for (std::size_t i = 0; i < exponents.size(); ++i)
            points.push_back(
                {(place_x(curve.points[i].size) + place_x(curve.points[i + 1].size)) / 2,
                 strip_y(exponents[i])});
        diagram_.polyline(points, {color, 1});
        for (std::size_t i = 0; i < points.size(); ++i)
            diagram_.circle(
                points[i], 1.8, i >= curve.first_fitted ? color : "#ffffff", {color, 0.8});
    }

    void add_legend() {
        double y = strip_bottom_ + below_strip;
        for (std::size_t i = 0; i < curves_.size(); ++i, y += legend_line) {
            const Curve& curve = curves_[i];
            diagram_.circle({left_ + 4, y - 4}, 4, color_of(i));
            diagram_.text({left_ + 16, y}, curve.experiment->family);
            diagram_.text({left_ + 130, y}, "n^" + exponent_text(curve.growth));
            diagram_.text(
                {left_ + 240, y}, verdict_on_bound(curve) + (curve.is_contradicted() ? " *" : ""));
        }
        const DiagramText style = {11, diagram_colors::faint};
        diagram_.text(
            {left_, y + 4},
            "Solid: the power fitted to the full points. Dashed: the bound, from the first on.",
            style);
        y += 4 + legend_line;
        diagram_.text({left_, y}, "Bound: " + sources(), style);
        for (const std::string& line : notes_)
            diagram_.text({left_, y += legend_line}, line, style);
    }

    static std::string verdict_on_bound(const Curve& curve) {
        const std::string& bound = curve.experiment->bound;
        switch (curve.verdict) {
        case Verdict::below:
            return "below the bound " + bound;
        case Verdict::along:
            return "along the bound " + bound;
        case Verdict::above:
            break;
        }
        return "above the bound " + bound + ", for certain";
    }

    /// Who says so, each once.
    std::string sources() const {
        std::string text;
        for (const Curve& curve : curves_)
            if (const std::string& source = curve.experiment->source;
                text.find(source) == std::string::npos)
                text += (text.empty() ? "" : "; ") + source;
        return text;
    }

    Diagram& diagram_;
    std::span<const Curve> curves_;
    double left_;
    double right_;
    double top_;
    double bottom_;
    double strip_top_;
    double strip_bottom_;
    std::vector<std::string> notes_;
    WholeRange sizes_;
    WholeRange counts_;
    WholeRange exponents_; ///< whole numbers
};

} // namespace

std::string exponent_text(const Growth& growth) {
    return fmt::format("{:.2f} ± {:.2f}", growth.exponent, growth.half_interval);
}

std::string interval_text(const Interval& interval) {
    return fmt::format("{:.2f} to {:.2f}", interval.lower, interval.upper);
}

std::string followed_text(const Curve& curve) {
    const std::string& bound = curve.experiment->bound;
    const ModelFit& best = best_model(curve.models);
    std::string text = model_text(best, bound);
    for (const ModelFit& model : curve.models)
        if (&model != &best && model.information <= told_apart_from)
            text += ", or " + model_text(model, bound);
    return text;
}

std::string curve_plot(std::span<const Curve> curves) {
    const auto groups = curves_by_name(curves);
    const std::size_t columns = groups.size() > 1 ? 2 : 1;
    std::vector<double> tops = {0};
    for (std::size_t i = 0; i < groups.size(); i += columns) {
        double highest = Panel::height(groups[i]);
        if (columns > 1 && i + 1 < groups.size())
            highest = std::max(highest, Panel::height(groups[i + 1]));
        tops.push_back(tops.back() + highest);
    }
    Diagram diagram(
        panel_width * static_cast<double>(columns), tops.back() + 8, "Counts, and their bounds");
    for (std::size_t i = 0; i < groups.size(); ++i)
        Panel(
            diagram, groups[i], {panel_width * static_cast<double>(i % columns), tops[i / columns]})
            .draw();
    return diagram.svg();
}

} // namespace vera
