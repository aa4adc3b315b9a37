// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/curve_plot.h"

#include "vera/math/elementary.h"
#include "vera/theory/diagram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace vera {

namespace {

constexpr double panel_width = 560;
constexpr double plot_height = 330;
constexpr double left_margin = 74;
constexpr double right_margin = 24;
constexpr double top_margin = 62;
constexpr double below_plot = 58;
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

/// The power of ten that is not above the value, or not below it.
struct Decades {
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

    Decades found() const {
        constexpr double rounding = 1e-9;
        const int first = static_cast<int>(std::floor(lowest_.value_or(0) + rounding));
        const int last = static_cast<int>(std::ceil(highest_.value_or(1) - rounding));
        return {first, std::max(last, first + 1)};
    }

private:
    std::optional<double> lowest_;
    std::optional<double> highest_;
};

/// The curves of one name, and where they are drawn.
class Panel {
public:
    Panel(Diagram& diagram, std::span<const Curve> curves, DrawingPoint corner)
        : diagram_(diagram)
        , curves_(curves)
        , left_(corner.x + left_margin)
        , right_(corner.x + panel_width - right_margin)
        , top_(corner.y + top_margin)
        , bottom_(corner.y + top_margin + plot_height) {
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
    }

    void draw() {
        add_heading();
        add_axes();
        for (const Curve& curve : with_bounds())
            add_bound(curve);
        for (std::size_t i = 0; i < curves_.size(); ++i)
            add_curve(curves_[i], color_of(i));
        add_legend();
    }

    static double height(std::span<const Curve> curves) {
        return top_margin + plot_height + below_plot
            + legend_line * static_cast<double>(curves.size() + 2);
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
            const double x = place(std::pow(10.0, power), 1).x;
            diagram_.line({x, top_}, {x, bottom_}, pen);
            diagram_.text(
                {x, bottom_ + 18}, power_text(power), {11, diagram_colors::faint, "middle"});
        }
        diagram_.line({left_, bottom_}, {right_, bottom_}, {diagram_colors::faint});
        diagram_.text(
            {(left_ + right_) / 2, bottom_ + 36},
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

    void add_legend() {
        double y = bottom_ + below_plot;
        for (std::size_t i = 0; i < curves_.size(); ++i, y += legend_line) {
            const Curve& curve = curves_[i];
            diagram_.circle({left_ + 4, y - 4}, 4, color_of(i));
            diagram_.text({left_ + 16, y}, curve.experiment->family);
            diagram_.text({left_ + 130, y}, "n^" + exponent_text(curve.growth));
            diagram_.text({left_ + 240, y}, verdict_on_bound(curve));
        }
        const DiagramText style = {11, diagram_colors::faint};
        diagram_.text(
            {left_, y + 4},
            "Solid: the power fitted to the full points. Dashed: the bound, from the first on.",
            style);
        diagram_.text({left_, y + 4 + legend_line}, "Bound: " + sources(), style);
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
    Decades sizes_;
    Decades counts_;
};

/// Those of each name, which stand in a row.
std::vector<std::span<const Curve>> by_name(std::span<const Curve> curves) {
    std::vector<std::span<const Curve>> groups;
    std::size_t first = 0;
    for (std::size_t i = 1; i <= curves.size(); ++i)
        if (i == curves.size() || curves[i].experiment->name != curves[first].experiment->name) {
            groups.push_back(curves.subspan(first, i - first));
            first = i;
        }
    return groups;
}

} // namespace

std::string exponent_text(const Growth& growth) {
    return fmt::format("{:.2f} ± {:.2f}", growth.exponent, growth.half_interval);
}

std::string curve_plot(std::span<const Curve> curves) {
    const auto groups = by_name(curves);
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
