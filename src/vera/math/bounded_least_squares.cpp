// SPDX-License-Identifier: Apache-2.0
#include "vera/math/bounded_least_squares.h"

#include "vera/base/check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace vera {

namespace {

enum class Place : std::uint8_t { at_least, at_most, free };

/// The z for which |A z - b| is least, A being column by column, by Householder's reflections.
std::vector<double> unbounded_solution(std::vector<std::vector<double>> a, std::vector<double> b) {
    const std::size_t columns = a.size();
    std::vector<double> diagonal(columns);
    const auto dot_from =
        [](std::size_t first, const std::vector<double>& u, const std::vector<double>& v) {
            double sum = 0;
            for (std::size_t i = first; i < u.size(); ++i)
                sum += u[i] * v[i];
            return sum;
        };
    for (std::size_t k = 0; k < columns; ++k) {
        std::vector<double>& mirror = a[k];
        const double size = std::sqrt(dot_from(k, mirror, mirror));
        diagonal[k] = mirror[k] > 0 ? -size : size;
        mirror[k] -= diagonal[k];
        const double square = dot_from(k, mirror, mirror);
        if (square == 0)
            continue;
        const auto reflect = [&](std::vector<double>& v) {
            const double factor = 2 * dot_from(k, mirror, v) / square;
            for (std::size_t i = k; i < v.size(); ++i)
                v[i] -= factor * mirror[i];
        };
        for (std::size_t j = k + 1; j < columns; ++j)
            reflect(a[j]);
        reflect(b);
    }
    std::vector<double> z(columns);
    for (std::size_t k = columns; k-- > 0;) {
        double sum = b[k];
        for (std::size_t j = k + 1; j < columns; ++j)
            sum -= a[j][k] * z[j];
        z[k] = diagonal[k] != 0 ? sum / diagonal[k] : 0;
    }
    return z;
}

class ActiveSet {
public:
    explicit ActiveSet(const BoundedLeastSquares& problem)
        : problem_(problem)
        , places_(problem.columns, Place::at_least)
        , x_(problem.least) {}

    std::vector<double> solve() {
        // Each turn lowers |A x - b|, but for rounding, which the limit is for.
        const std::size_t most_turns = 20 * (problem_.columns + 1);
        std::size_t refused = none;
        for (std::size_t turn = 0; turn < most_turns; ++turn) {
            const std::size_t column = column_to_free(refused);
            if (column == none)
                break;
            const Place before = places_[column];
            places_[column] = Place::free;
            move_to_best();
            // It went straight back to its bound: only rounding had made it seem worth it.
            refused = places_[column] == before ? column : none;
        }
        return x_;
    }

private:
    static constexpr std::size_t none = ~std::size_t{0};

    std::size_t rows() const { return problem_.right.size(); }

    double at(std::size_t row, std::size_t column) const {
        return problem_.matrix[row * problem_.columns + column];
    }

    /// b - A x, leaving out the free columns where they are to be solved for.
    std::vector<double> rest(bool without_free) const {
        std::vector<double> result = problem_.right;
        for (std::size_t row = 0; row < rows(); ++row)
            for (std::size_t i = 0; i < problem_.columns; ++i)
                if (!(without_free && places_[i] == Place::free))
                    result[row] -= at(row, i) * x_[i];
        return result;
    }

    /// The column that stands at a bound and pulls most from it inwards.
    std::size_t column_to_free(std::size_t refused) const {
        const std::vector<double> left = rest(false);
        double left_size = 0;
        for (const double value : left)
            left_size += value * value;
        std::size_t best = none;
        double best_pull = 0;
        for (std::size_t i = 0; i < problem_.columns; ++i) {
            if (places_[i] == Place::free || i == refused || problem_.least[i] == problem_.most[i])
                continue;
            double pull = 0;
            double size = 0;
            for (std::size_t row = 0; row < rows(); ++row) {
                pull += at(row, i) * left[row];
                size += at(row, i) * at(row, i);
            }
            // What rounding alone may make of a pull of 0.
            constexpr double rounding = 1e-14;
            pull = (places_[i] == Place::at_least ? pull : -pull)
                - rounding * std::sqrt(size * left_size);
            if (pull > best_pull) {
                best = i;
                best_pull = pull;
            }
        }
        return best;
    }

    /// Moves the free columns to where |A x - b| is least; those that meet a bound stay there.
    void move_to_best() {
        while (true) {
            std::vector<std::size_t> free;
            std::vector<std::vector<double>> a;
            for (std::size_t i = 0; i < problem_.columns; ++i)
                if (places_[i] == Place::free) {
                    free.push_back(i);
                    a.emplace_back(rows());
                    for (std::size_t row = 0; row < rows(); ++row)
                        a.back()[row] = at(row, i);
                }
            if (free.empty())
                return;
            const std::vector<double> z = unbounded_solution(std::move(a), rest(true));
            if (!stop_at_bounds(free, z))
                return;
        }
    }

    /// Goes from x towards z as far as the bounds allow. False when that is the whole way.
    bool stop_at_bounds(const std::vector<std::size_t>& free, const std::vector<double>& z) {
        double part = 1;
        std::size_t first = none;
        for (std::size_t k = 0; k < free.size(); ++k) {
            const std::size_t i = free[k];
            const double bound = std::clamp(z[k], problem_.least[i], problem_.most[i]);
            if (bound == z[k])
                continue;
            const double to_bound = (bound - x_[i]) / (z[k] - x_[i]);
            if (first == none || to_bound < part) {
                part = std::clamp(to_bound, 0.0, 1.0);
                first = i;
            }
        }
        for (std::size_t k = 0; k < free.size(); ++k) {
            const std::size_t i = free[k];
            const double goal = first == none ? z[k] : x_[i] + part * (z[k] - x_[i]);
            x_[i] = std::clamp(goal, problem_.least[i], problem_.most[i]);
            if (i == first) {
                const bool below = z[k] < problem_.least[i];
                places_[i] = below ? Place::at_least : Place::at_most;
                x_[i] = below ? problem_.least[i] : problem_.most[i];
            }
        }
        return first != none;
    }

    const BoundedLeastSquares& problem_;
    std::vector<Place> places_;
    std::vector<double> x_;
};

} // namespace

std::vector<double> solution(const BoundedLeastSquares& problem) {
    VERA_CHECK(problem.matrix.size() == problem.right.size() * problem.columns);
    VERA_CHECK(problem.right.size() >= problem.columns);
    VERA_CHECK(problem.least.size() == problem.columns && problem.most.size() == problem.columns);
    return ActiveSet(problem).solve();
}

} // namespace vera
