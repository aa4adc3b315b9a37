// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/gradient_shapes.h"

#include "vera/drawing/gradient.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace vera {

namespace {

double dot(Color a, Color b) {
    return a.r * b.r + a.g * b.g + a.b * b.b;
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

} // namespace

DrawingPoint main_direction(double xx, double xy, double yy) {
    const double half = 0.5 * (xx - yy);
    const double root = std::sqrt(half * half + xy * xy);
    // Of the two forms the one that does not cancel.
    const DrawingPoint along =
        half >= 0 ? DrawingPoint{half + root, xy} : DrawingPoint{xy, root - half};
    const double length = std::sqrt(along.x * along.x + along.y * along.y);
    return length > 0 ? DrawingPoint{along.x / length, along.y / length} : DrawingPoint{1, 0};
}

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

} // namespace vera
