// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/gradient_fit.h"

#include "vera/base/check.h"
#include "vera/drawing/gradient.h"
#include "vera/visible/drawn_color.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

namespace vera {

namespace {

double largest_difference(Color a, Color b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

/// How far off the paint is where the sample is, beyond what it may be.
double error_of(const ColorSample& sample, Color painted) {
    return std::max(0.0, largest_difference(painted, sample.color) - sample.slack);
}

/// By least squares the errors are compared with what they may be.
double weight_of(const ColorSample& sample, double tolerance) {
    const double relative = tolerance / (tolerance + sample.slack);
    return relative * relative;
}

/// How the colours of samples go along one parameter from 0 to 1, as a polygonal line: the values
/// at the knots of least squares. The samples are sorted by the parameter, so that those between
/// two knots follow each other.
class Profile {
public:
    Profile(const Gradient& gradient, std::span<const ColorSample> samples, double tolerance) {
        along_.reserve(samples.size());
        for (const ColorSample& sample : samples)
            along_.push_back(
                {gradient_offset(gradient, sample.point),
                 0,
                 weight_of(sample, tolerance),
                 sample.slack,
                 sample.color});
        std::ranges::stable_sort(along_, {}, &Along::offset);
        knots_ = {{along_.front().offset, 0, 0}, {along_.back().offset, 0, along_.size() - 1}};
        if (has_extent())
            place_samples_after(0);
    }

    /// Whether there are two knots.
    bool has_extent() const { return knots_.back().offset > knots_.front().offset; }

    /// The stops for the knots that there are.
    std::vector<GradientStop> stops() const {
        std::vector<GradientStop> stops(knots_.size());
        const std::vector<Color> values = values_at_knots();
        for (std::size_t i = 0; i < stops.size(); ++i)
            stops[i] = {knots_[i].offset, drawn_color(values[i])};
        return stops;
    }

    /// How far off these stops at the knots are, at most.
    double largest_error(std::span<const GradientStop> stops) const {
        double largest = 0;
        for (std::size_t knot = 0; knot + 1 < knots_.size(); ++knot) {
            const Color from = as_color(stops[knot].color);
            const Color way = as_color(stops[knot + 1].color) - from;
            for (const Along& sample : samples_after(knot))
                largest = std::max(largest, sample.error(from + sample.part * way));
        }
        return largest;
    }

    /// A knot more: at the sample that is farthest off the lines between the samples at the knots
    /// that there are, which finds the bends of a profile (Ramer 1972, Douglas and Peucker 1973).
    /// False where there is no room.
    bool add_knot() {
        constexpr double nearest = 1.0 / 64; // of knots
        double most = 0;
        const Along* where = nullptr;
        std::size_t after = 0;
        for (std::size_t knot = 0; knot + 1 < knots_.size(); ++knot) {
            const double width = knots_[knot + 1].offset - knots_[knot].offset;
            const Color from = along_[knots_[knot].sample].color;
            const Color way = along_[knots_[knot + 1].sample].color - from;
            for (const Along& sample : samples_after(knot)) {
                if (std::min(sample.part, 1 - sample.part) * width < nearest)
                    continue;
                const double off = sample.error(from + sample.part * way);
                if (off > most) {
                    most = off;
                    where = &sample;
                    after = knot;
                }
            }
        }
        if (where == nullptr)
            return false;
        const auto sample = static_cast<std::size_t>(where - along_.data());
        std::size_t first = sample;
        while (along_[first - 1].offset == where->offset)
            --first;
        knots_.insert(
            knots_.begin() + static_cast<std::ptrdiff_t>(after) + 1,
            {where->offset, first, sample});
        place_samples_after(after);
        place_samples_after(after + 1);
        return true;
    }

private:
    struct Along {
        double offset = 0;
        double part = 0; ///< of the way from the knot before it to the next one
        double weight = 1;
        double slack = 0;
        Color color;

        double error(Color painted) const { return largest_difference(painted, color) - slack; }
    };

    struct Knot {
        double offset = 0;
        std::size_t first = 0;  ///< sample that is there or after it
        std::size_t sample = 0; ///< one that is there
    };

    static Color as_color(DrawingColor color) {
        return {color.r / 255.0, color.g / 255.0, color.b / 255.0};
    }

    std::span<const Along> samples_after(std::size_t knot) const {
        const std::size_t end = knot + 2 == knots_.size() ? along_.size() : knots_[knot + 1].first;
        return std::span(along_).subspan(knots_[knot].first, end - knots_[knot].first);
    }

    void place_samples_after(std::size_t knot) {
        const double from = knots_[knot].offset;
        const double width = knots_[knot + 1].offset - from;
        const std::size_t count = samples_after(knot).size();
        for (Along& sample : std::span(along_).subspan(knots_[knot].first, count))
            sample.part = (sample.offset - from) / width;
    }

    /// The equations of least squares have three diagonals. None is singular, as each knot has a
    /// sample of its own.
    std::vector<Color> values_at_knots() const {
        const std::size_t count = knots_.size();
        std::vector<double> diagonal(count, 0);
        std::vector<double> beside(count, 0); // of each and the next
        std::vector<Color> sums(count);
        for (std::size_t knot = 0; knot + 1 < count; ++knot)
            for (const Along& sample : samples_after(knot)) {
                const double to_next = sample.weight * sample.part;
                const double to_this = sample.weight - to_next;
                diagonal[knot] += to_this * (1 - sample.part);
                diagonal[knot + 1] += to_next * sample.part;
                beside[knot] += to_this * sample.part;
                sums[knot] += to_this * sample.color;
                sums[knot + 1] += to_next * sample.color;
            }
        for (std::size_t i = 1; i < count; ++i) {
            const double factor = beside[i - 1] / diagonal[i - 1];
            diagonal[i] -= factor * beside[i - 1];
            sums[i] = sums[i] - factor * sums[i - 1];
        }
        for (std::size_t i = count; i-- > 0;) {
            if (i + 1 < count)
                sums[i] = sums[i] - beside[i] * sums[i + 1];
            sums[i] = 1 / diagonal[i] * sums[i];
        }
        return sums;
    }

    std::vector<Along> along_; ///< the samples, by offset
    std::vector<Knot> knots_;
};

/// The gradient of that shape with the stops that fit best: more and more of them,
/// until the error is within the tolerance or more do not help.
FittedPaint with_stops(Gradient gradient, std::span<const ColorSample> samples, double tolerance) {
    constexpr std::size_t most_stops = 16;
    constexpr int patience = 4;

    Profile profile(gradient, samples, tolerance);
    FittedPaint best;
    best.error = 2; // more than any
    if (!profile.has_extent())
        return best;
    for (int in_vain = 0; in_vain < patience; ++in_vain) {
        std::vector<GradientStop> stops = profile.stops();
        const double error = profile.largest_error(stops);
        const bool is_full = stops.size() >= most_stops;
        if (error < 0.9 * best.error)
            in_vain = 0;
        if (error < best.error) {
            gradient.stops = std::move(stops);
            best.error = error;
        }
        if (error <= tolerance || is_full || !profile.add_knot())
            break;
    }
    if (!gradient.stops.empty())
        best.gradient = std::move(gradient);
    return best;
}

/// Weighted means: of the points, and of the squares and products of their ways from there.
struct Moments {
    DrawingPoint middle;
    double xx = 0;
    double xy = 0;
    double yy = 0;
};

Moments moments_of(std::span<const ColorSample> samples, double tolerance) {
    Moments moments;
    double sum = 0;
    for (const ColorSample& sample : samples)
        sum += weight_of(sample, tolerance);
    for (const ColorSample& sample : samples) {
        const double part = weight_of(sample, tolerance) / sum;
        moments.middle.x += part * sample.point.x;
        moments.middle.y += part * sample.point.y;
    }
    for (const ColorSample& sample : samples) {
        const double part = weight_of(sample, tolerance) / sum;
        const double x = sample.point.x - moments.middle.x;
        const double y = sample.point.y - moments.middle.y;
        moments.xx += part * x * x;
        moments.xy += part * x * y;
        moments.yy += part * y * y;
    }
    return moments;
}

/// The unit eigenvector of the larger eigenvalue of a symmetric matrix.
DrawingPoint main_direction(double xx, double xy, double yy) {
    const double half = 0.5 * (xx - yy);
    const double root = std::sqrt(half * half + xy * xy);
    // Of the two forms the one that does not cancel.
    const DrawingPoint along =
        half >= 0 ? DrawingPoint{half + root, xy} : DrawingPoint{xy, root - half};
    const double length = std::sqrt(along.x * along.x + along.y * along.y);
    return length > 0 ? DrawingPoint{along.x / length, along.y / length} : DrawingPoint{1, 0};
}

double dot(Color a, Color b) {
    return a.r * b.r + a.g * b.g + a.b * b.b;
}

/// The direction along which the slopes of the samples lie, by least squares: exact where the
/// colour is a function of the way along it.
DrawingPoint direction_of_slopes(std::span<const ColorSample> samples, double tolerance) {
    double xx = 0;
    double xy = 0;
    double yy = 0;
    for (const ColorSample& sample : samples) {
        const double weight = weight_of(sample, tolerance);
        xx += weight * dot(sample.slope_x, sample.slope_x);
        xy += weight * dot(sample.slope_x, sample.slope_y);
        yy += weight * dot(sample.slope_y, sample.slope_y);
    }
    return main_direction(xx, xy, yy);
}

/// The direction in which the planes through the colours, by least squares, change most: it sees
/// what changes between the samples as well.
DrawingPoint direction_of_planes(std::span<const ColorSample> samples, double tolerance) {
    const Moments moments = moments_of(samples, tolerance);
    Color along_x;
    Color along_y;
    for (const ColorSample& sample : samples) {
        const Color weighted = weight_of(sample, tolerance) * sample.color;
        along_x += (sample.point.x - moments.middle.x) * weighted;
        along_y += (sample.point.y - moments.middle.y) * weighted;
    }
    // Across a thin strip next to nothing is known, and nothing is to change.
    const double slight = 1e-4 * (moments.xx + moments.yy);
    const double xx = moments.xx + slight;
    const double yy = moments.yy + slight;
    const Color slope_x = yy * along_x - moments.xy * along_y;
    const Color slope_y = xx * along_y - moments.xy * along_x;
    return main_direction(dot(slope_x, slope_x), dot(slope_x, slope_y), dot(slope_y, slope_y));
}

using Matrix5 = std::array<std::array<double, 5>, 5>;

/// Turns row and column p and q of the symmetric matrix so that their common element vanishes, and
/// the columns of the vectors with them (Jacobi's rotation: Golub and Van Loan, section 8.5).
void rotate(Matrix5& matrix, Matrix5& vectors, std::size_t p, std::size_t q) {
    if (matrix[p][q] == 0)
        return;
    const double theta = (matrix[q][q] - matrix[p][p]) / (2 * matrix[p][q]);
    const double t = (theta >= 0 ? 1 : -1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
    const double cosine = 1 / std::sqrt(t * t + 1);
    const double sine = t * cosine;
    const auto turn = [&](double& a, double& b) {
        const double old = a;
        a = cosine * old - sine * b;
        b = sine * old + cosine * b;
    };
    for (std::size_t k = 0; k < 5; ++k)
        turn(matrix[k][p], matrix[k][q]);
    for (std::size_t k = 0; k < 5; ++k) {
        turn(matrix[p][k], matrix[q][k]);
        turn(vectors[k][p], vectors[k][q]);
    }
}

/// The eigenvector of the smallest eigenvalue of a symmetric matrix.
std::array<double, 5> smallest_eigenvector(Matrix5 matrix) {
    Matrix5 vectors = {};
    for (std::size_t i = 0; i < 5; ++i)
        vectors[i][i] = 1;
    constexpr int sweeps = 10; // they converge quadratically
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (std::size_t p = 0; p < 5; ++p)
            for (std::size_t q = p + 1; q < 5; ++q)
                rotate(matrix, vectors, p, q);
    std::size_t smallest = 0;
    for (std::size_t i = 1; i < 5; ++i)
        if (matrix[i][i] < matrix[smallest][smallest])
            smallest = i;
    std::array<double, 5> vector = {};
    for (std::size_t i = 0; i < 5; ++i)
        vector[i] = vectors[i][smallest];
    return vector;
}

/// Concentric ellipses, as the form of second degree whose levels they are: of a point p it has the
/// value (p - center) Q (p - center).
struct Ellipses {
    DrawingPoint center;
    double xx = 0;
    double xy = 0;
    double yy = 0;
};

/// The ellipses along which the samples change least: where it is steepest in the direction s, the
/// form's slope Q p - q is to have the same direction. That is a linear equation in Q and q, which
/// holds whatever colours the levels have.
std::optional<Ellipses> level_ellipses(std::span<const ColorSample> samples, double tolerance) {
    const Moments moments = moments_of(samples, tolerance);
    const double unit = std::sqrt(moments.xx + moments.yy);
    Matrix5 squares = {};
    for (const ColorSample& sample : samples) {
        const double weight = weight_of(sample, tolerance);
        const double x = (sample.point.x - moments.middle.x) / unit;
        const double y = (sample.point.y - moments.middle.y) / unit;
        const Color sx = sample.slope_x;
        const Color sy = sample.slope_y;
        const std::array<Color, 5> equations = {
            -x * sy, x * sx - y * sy, y * sx, sy, -1.0 * sx}; // one for each of red, green and blue
        for (std::size_t i = 0; i < 5; ++i)
            for (std::size_t j = 0; j < 5; ++j)
                squares[i][j] += weight * dot(equations[i], equations[j]);
    }
    const auto [xx, xy, yy, qx, qy] = smallest_eigenvector(squares);
    const double determinant = xx * yy - xy * xy;
    const double trace = xx + yy;
    constexpr double longest = 1e-4; // of the smaller eigenvalue by the larger one, about
    constexpr double farthest = 100; // of the centre, in units of the samples' size
    if (!(determinant > longest * trace * trace))
        return std::nullopt;
    const double x = (yy * qx - xy * qy) / determinant;
    const double y = (xx * qy - xy * qx) / determinant;
    if (!(x * x + y * y < farthest * farthest))
        return std::nullopt;
    const double sign = trace > 0 ? 1 : -1;
    return Ellipses{
        {moments.middle.x + unit * x, moments.middle.y + unit * y},
        sign * xx,
        sign * xy,
        sign * yy};
}

} // namespace

ColorSample color_sample(DrawingPoint point, const ColorField& field, double within) {
    return color_sample({point, field(point)}, field, within);
}

ColorSample color_sample(const PointColor& at, const ColorField& field, double within) {
    const auto [point, color] = at;
    // Of three directions, two are never along a level, and one leads in from any border.
    const double side = std::sqrt(0.75);
    const DrawingPoint ways[] = {{1, 0}, {-0.5, side}, {-0.5, -side}};
    ColorSample sample = {point, color};
    for (const DrawingPoint way : ways) {
        const Color there = field({point.x + within * way.x, point.y + within * way.y});
        const Color change = there - sample.color;
        sample.slack = std::max(sample.slack, largest_difference(there, sample.color));
        const double part = 2 / (3 * within);
        sample.slope_x += part * way.x * change;
        sample.slope_y += part * way.y * change;
    }
    return sample;
}

std::vector<ColorSample>
color_samples(std::span<const DrawingPoint> points, const ColorField& field, double within) {
    std::vector<ColorSample> samples;
    samples.reserve(points.size());
    for (const DrawingPoint point : points)
        samples.push_back(color_sample(point, field, within));
    return samples;
}

Color color_at(const FittedPaint& paint, DrawingPoint point) {
    if (paint.gradient)
        return color_at(*paint.gradient, point);
    return {paint.color.r / 255.0, paint.color.g / 255.0, paint.color.b / 255.0};
}

double error_of(const FittedPaint& paint, const ColorSample& sample) {
    return error_of(sample, color_at(paint, sample.point));
}

FittedPaint flat_fit(std::span<const ColorSample> samples) {
    VERA_CHECK(!samples.empty());
    Color least = samples.front().color;
    Color most = least;
    for (const ColorSample& sample : samples) {
        least = min(least, sample.color);
        most = max(most, sample.color);
    }
    FittedPaint paint;
    paint.color = drawn_color(0.5 * (least + most));
    for (const ColorSample& sample : samples)
        paint.error = std::max(paint.error, error_of(paint, sample));
    return paint;
}

namespace {

/// The axis' direction, turned so that by least squares it fits the samples better: for a small
/// turn, what a gradient shows changes by its slope times the way across the axis.
DrawingPoint
turned(const Gradient& gradient, std::span<const ColorSample> samples, double tolerance) {
    const double length =
        std::sqrt(gradient.axis.x * gradient.axis.x + gradient.axis.y * gradient.axis.y);
    const DrawingPoint along = {gradient.axis.x / length, gradient.axis.y / length};
    const DrawingPoint middle = moments_of(samples, tolerance).middle;
    double products = 0;
    double squares = 1e-30;
    for (const ColorSample& sample : samples) {
        const auto [x, y] = sample.point;
        const double step = 0.01 * length;
        const Color slope = 1 / (2 * step)
            * (color_at(gradient, {x + step * along.x, y + step * along.y})
               - color_at(gradient, {x - step * along.x, y - step * along.y}));
        const Color change = (along.x * (y - middle.y) - along.y * (x - middle.x)) * slope;
        const double weight = weight_of(sample, tolerance);
        products += weight * dot(change, sample.color - color_at(gradient, sample.point));
        squares += weight * dot(change, change);
    }
    const double turn = products / squares;
    const double size = std::sqrt(1 + turn * turn);
    return {(along.x - turn * along.y) / size, (along.y + turn * along.x) / size};
}

FittedPaint
linear_fit_along(DrawingPoint along, std::span<const ColorSample> samples, double tolerance) {
    const auto way = [&](DrawingPoint point) { return point.x * along.x + point.y * along.y; };
    const auto [first, last] = std::ranges::minmax(
        samples, {}, [&](const ColorSample& sample) { return way(sample.point); });
    const double length = way(last.point) - way(first.point);
    if (!(length > 0))
        return flat_fit(samples);
    Gradient gradient;
    gradient.start = first.point;
    gradient.axis = {length * along.x, length * along.y};
    return with_stops(gradient, samples, tolerance);
}

} // namespace

FittedPaint linear_fit(std::span<const ColorSample> samples, double tolerance) {
    FittedPaint best =
        linear_fit_along(direction_of_planes(samples, tolerance), samples, tolerance);
    const auto try_along = [&](DrawingPoint along) {
        if (best.error <= tolerance)
            return;
        if (FittedPaint other = linear_fit_along(along, samples, tolerance);
            other.error < best.error)
            best = std::move(other);
    };
    if (best.error > tolerance && best.gradient)
        try_along(turned(*best.gradient, samples, tolerance));
    if (best.error > tolerance)
        try_along(direction_of_slopes(samples, tolerance));
    return best;
}

std::optional<FittedPaint> radial_fit(std::span<const ColorSample> samples, double tolerance) {
    const std::optional<Ellipses> ellipses = level_ellipses(samples, tolerance);
    if (!ellipses)
        return std::nullopt;
    const DrawingPoint along = main_direction(ellipses->xx, ellipses->xy, ellipses->yy);
    const DrawingPoint across = {-along.y, along.x};
    const auto value = [&](double x, double y) {
        return ellipses->xx * x * x + 2 * ellipses->xy * x * y + ellipses->yy * y * y;
    };
    double largest = 0;
    for (const ColorSample& sample : samples)
        largest = std::max(
            largest,
            value(sample.point.x - ellipses->center.x, sample.point.y - ellipses->center.y));
    const double half = std::sqrt(largest / value(along.x, along.y));
    const double other_half = std::sqrt(largest / value(across.x, across.y));
    Gradient gradient;
    gradient.shape = Gradient::Shape::radial;
    gradient.start = ellipses->center;
    gradient.axis = {half * along.x, half * along.y};
    gradient.other_axis = {other_half * across.x, other_half * across.y};
    if (!(half > 0 && std::isfinite(other_half)))
        return std::nullopt;
    return with_stops(gradient, samples, tolerance);
}

FittedPaint best_fit(std::span<const ColorSample> samples, double tolerance) {
    FittedPaint best = flat_fit(samples);
    if (best.error <= tolerance)
        return best;
    if (FittedPaint linear = linear_fit(samples, tolerance); linear.error < best.error)
        best = std::move(linear);
    if (best.error <= tolerance)
        return best;
    if (auto radial = radial_fit(samples, tolerance); radial && radial->error < best.error)
        best = std::move(*radial);
    return best;
}

} // namespace vera
