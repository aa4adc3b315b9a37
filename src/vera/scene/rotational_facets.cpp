// SPDX-License-Identifier: Apache-2.0
#include "vera/math/elementary.h"
#include "vera/scene/contour.h"
#include "vera/scene/curved_facets.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

namespace vera {

namespace {

using Point = ContourPiece::Point;

constexpr std::size_t fewest_around = 8;
constexpr std::size_t most_around = std::size_t{1} << 14U;
constexpr int most_halvings = 20; ///< of a piece of a contour

/// A deviation that changes by more than this factor, round a circle from one place to the next or
/// among five along a band, may be still less in between.
constexpr double steep_around = 2;
constexpr double steep_along = 3;

/// The steepness no longer matters where a facet is nearer to the surface than this part of what
/// was asked for.
constexpr double near_part = 1.0 / 256;

constexpr std::size_t no_limit = std::size_t{1} << 48U;

/// Thrown where there would be too many triangles.
struct TooMany {};

/// A circle of corners, or a point on the axis.
struct Circle {
    Point at;
    std::size_t count = 0; ///< of corners; 1 on the axis, 0 where nothing needs it
    std::uint32_t first_corner = 0;
};

/// The part of a piece between two circles.
struct Band {
    std::size_t from = 0;
    std::size_t to = 0;
    std::uint32_t piece = 0;
};

/// Part of a facet's distance from the surface that may come from going round the axis: half of it
/// where the contour is curved too. Both distances together are no less than the whole one.
double part_around(const ContourPiece& piece) {
    return piece.kind == ContourPiece::Kind::line ? 1 : 0.5;
}

/// What a circle on the surface is to be like.
struct Need {
    double v = 0; ///< on the piece
    Point at;
    std::size_t count = 1;
    double least = 0; ///< deviation, of all round
};

class RotationalFacets {
public:
    RotationalFacets(const RotationalShape& shape, const LocalDeviation& deviation)
        : shape_(shape)
        , deviation_(deviation) {
        Vec3 coordinate_axis;
        const Vec3 size = abs(shape.axis);
        const double smallest = std::min({size.x, size.y, size.z});
        coordinate_axis[smallest == size.x ? 0 : smallest == size.y ? 1 : 2] = 1;
        across_ = normalized(cross(shape.axis, coordinate_axis));
        other_across_ = cross(shape.axis, across_);
    }

    /// Chooses the circles so that no facet lies farther off than the deviation or `floor`,
    /// whichever is more. Throws TooMany.
    void plan(double floor, std::size_t most) {
        floor_ = floor;
        most_ = most;
        planned_ = 0;
        samples_left_ = 8 * most;
        bands_.clear();
        circles_.assign(1, circle_at(shape_.start));
        Point start = shape_.start;
        for (std::uint32_t i = 0; i < shape_.contour.size(); ++i) {
            plan_piece(shape_.contour[i], start, i);
            start = shape_.contour[i].end;
        }
        close();
        std::size_t count = 0;
        for (const Band& band : bands_)
            count += circles_[band.from].count + circles_[band.to].count;
        if (count > most)
            throw TooMany();
    }

    CurvedFacets result() {
        CurvedFacets facets;
        for (Circle& circle : circles_) {
            circle.first_corner = static_cast<std::uint32_t>(facets.corners.size());
            for (std::size_t i = 0; i < circle.count; ++i)
                facets.corners.push_back(place(circle.at, i, circle.count));
        }
        for (const Band& band : bands_)
            add_band(facets, circles_[band.from], circles_[band.to], band.piece);
        return facets;
    }

private:
    static Circle circle_at(Point at) {
        Circle circle;
        circle.at = at;
        return circle;
    }

    Vec3 place(Point at, std::size_t i, std::size_t count) const {
        const Vec3 middle = shape_.base + at.h * shape_.axis;
        if (at.r == 0)
            return middle;
        const double angle = 360 * static_cast<double>(i) / static_cast<double>(count);
        return middle + at.r * (cos_degrees(angle) * across_ + sin_degrees(angle) * other_across_);
    }

    double asked(Point at, std::size_t i, std::size_t count) {
        if (samples_left_ == 0)
            throw TooMany();
        --samples_left_;
        return std::max(floor_, deviation_(place(at, i, count)));
    }

    /// How many corners the circle must have that no chord of it lies farther from it than `part`
    /// of the deviation.
    Need need(double v, Point at, double part) {
        Need result = {v, at, 1, 0};
        if (at.r == 0) {
            result.least = asked(at, 0, 1);
            return result;
        }
        std::vector<double> all;
        for (result.count = fewest_around;; result.count *= 2) {
            const std::size_t n = result.count;
            all.resize(n);
            for (std::size_t i = 0; i < n; ++i)
                all[i] = asked(at, i, n);
            const auto least = std::min_element(all.begin(), all.end());
            result.least = *least;
            const auto i = static_cast<std::size_t>(least - all.begin());
            const auto is_steep = [&](double beside) {
                return std::isfinite(beside) && beside > steep_around * result.least;
            };
            const bool steep = is_steep(all[(i + 1) % n]) || is_steep(all[(i + n - 1) % n]);
            const double off = at.r * (1 - cos_degrees(180 / static_cast<double>(n)));
            if (n == most_around
                || (off <= part * result.least && !(steep && off > near_part * result.least)))
                return result;
        }
    }

    void plan_piece(const ContourPiece& piece, Point start, std::uint32_t number) {
        const bool is_line = piece.kind == ContourPiece::Kind::line;
        if (is_line && piece.end == start)
            return;
        if (is_line && start.r == 0 && piece.end.r == 0) {
            circles_.push_back(circle_at(piece.end));
            return;
        }
        piece_ = &piece;
        start_ = start;
        number_ = number;
        part_ = part_around(piece);
        const Need first = need_at(0);
        const Need last = need_at(1);
        if (is_line && start.h == piece.end.h) {
            // A plane ring: all that is not exact is its rims.
            add_band(first, last, 1);
            return;
        }
        if (is_line) {
            divide(first, last, most_halvings);
            return;
        }
        // Between these places the curve is monotone and bends to one side.
        directions_ = hodograph(piece, start);
        std::vector<double> places = {1};
        for (const QuadraticRoots& roots :
             {extremes(directions_, {1, 0}),
              extremes(directions_, {0, 1}),
              inflections(directions_)})
            places.insert(places.end(), roots.v.begin(), roots.v.begin() + roots.count);
        std::sort(places.begin(), places.end());
        Need from = first;
        for (const double v : places) {
            if (v == from.v)
                continue;
            const Need to = v == 1 ? last : need_at(v);
            const Need middle = need_at(0.5 * (from.v + v));
            divide(from, middle, most_halvings);
            divide(middle, to, most_halvings);
            from = to;
        }
    }

    Need need_at(double v) { return need(v, point_at(*piece_, start_, v), part_); }

    /// How far the curve goes from its chord between the places, where it bends to one side.
    double distance_from_chord(const Need& from, const Need& to) const {
        const Point along = {to.at.r - from.at.r, to.at.h - from.at.h};
        const double size = std::sqrt(along.r * along.r + along.h * along.h);
        if (!(size > 0))
            return 0;
        const Point out = {along.h / size, -along.r / size};
        double distance = 0;
        const QuadraticRoots farthest = extremes(directions_, out);
        for (std::size_t i = 0; i < farthest.count; ++i) {
            if (farthest.v[i] <= from.v || farthest.v[i] >= to.v)
                continue;
            const Point at = point_at(*piece_, start_, farthest.v[i]);
            distance = std::max(
                distance, std::abs((at.r - from.at.r) * out.r + (at.h - from.at.h) * out.h));
        }
        return distance;
    }

    /// Makes bands of the piece between the places.
    void divide(const Need& from, const Need& to, int halvings) {
        const Need middle = need_at(0.5 * (from.v + to.v));
        const std::array<Need, 5> needs = {
            from, need_at(0.5 * (from.v + middle.v)), middle, need_at(0.5 * (middle.v + to.v)), to};
        double least = from.least;
        double most = 0;
        std::size_t count = 1;
        for (const Need& here : needs) {
            least = std::min(least, here.least);
            most = std::isfinite(here.least) ? std::max(most, here.least) : most;
            count = std::max(count, here.count);
        }
        const bool coarse = piece_->kind != ContourPiece::Kind::line
            && !(distance_from_chord(from, to) <= (1 - part_) * least);
        if (halvings > 0 && (coarse || most > steep_along * least)) {
            divide(from, middle, halvings - 1);
            divide(middle, to, halvings - 1);
        } else {
            add_band(from, to, count);
        }
    }

    /// The band from the last circle to a new one, with at least `count` corners in each.
    void add_band(const Need& from, const Need& to, std::size_t count) {
        const auto grow = [&](Circle& circle, const Need& own) {
            circle.at = own.at;
            circle.count = own.at.r == 0 ? 1 : std::max({circle.count, own.count, count});
        };
        grow(circles_.back(), from);
        circles_.push_back(circle_at(to.at));
        grow(circles_.back(), to);
        bands_.push_back({circles_.size() - 2, circles_.size() - 1, number_});
        planned_ += circles_[circles_.size() - 2].count + circles_.back().count;
        if (planned_ > most_)
            throw TooMany();
    }

    /// Makes one circle of the first and the last one where they are the same.
    void close() {
        if (bands_.empty() || circles_.back().at != circles_.front().at)
            return;
        circles_.front().count = std::max(circles_.front().count, circles_.back().count);
        for (Band& band : bands_)
            if (band.to == circles_.size() - 1)
                band.to = 0;
        circles_.pop_back();
    }

    /// One circle has as many corners as the other times a power of two, or is a point. Every
    /// triangle stays between two neighbouring radii of the circle with fewer corners: so none of
    /// it is farther from the surface than a chord of that circle.
    static void
    add_band(CurvedFacets& facets, const Circle& from, const Circle& to, std::uint32_t piece) {
        const auto corner = [](const Circle& circle, std::size_t i) {
            return circle.first_corner + static_cast<std::uint32_t>(i % circle.count);
        };
        const auto along_from = [&](std::size_t i, std::size_t opposite) {
            facets.triangles.push_back(
                {{corner(from, i), corner(from, i + 1), corner(to, opposite)}, piece});
        };
        const auto along_to = [&](std::size_t i, std::size_t opposite) {
            facets.triangles.push_back(
                {{corner(from, opposite), corner(to, i + 1), corner(to, i)}, piece});
        };
        if (from.count == 1 || to.count == 1) {
            for (std::size_t i = 0; to.count == 1 && from.count > 1 && i < from.count; ++i)
                along_from(i, 0);
            for (std::size_t i = 0; from.count == 1 && to.count > 1 && i < to.count; ++i)
                along_to(i, 0);
            return;
        }
        const std::size_t fewer = std::min(from.count, to.count);
        const std::size_t ratio = std::max(from.count, to.count) / fewer;
        const auto fine = [&](std::size_t i, std::size_t opposite) {
            from.count > to.count ? along_from(i, opposite) : along_to(i, opposite);
        };
        for (std::size_t i = 0; i < fewer; ++i) {
            const std::size_t middle = i * ratio + ratio / 2;
            for (std::size_t j = i * ratio; j < middle; ++j)
                fine(j, i);
            from.count > to.count ? along_to(i, middle) : along_from(i, middle);
            for (std::size_t j = middle; j < (i + 1) * ratio; ++j)
                fine(j, i + 1);
        }
    }

    const RotationalShape& shape_;
    const LocalDeviation& deviation_;
    Vec3 across_; ///< with other_across_ and the axis a right-handed system
    Vec3 other_across_;
    std::vector<Circle> circles_; ///< in the order of the contour
    std::vector<Band> bands_;

    double floor_ = 0;
    std::size_t most_ = 0;
    std::size_t planned_ = 0; ///< triangles
    std::size_t samples_left_ = 0;

    // The piece that is being planned.
    const ContourPiece* piece_ = nullptr;
    Point start_;
    std::uint32_t number_ = 0;
    double part_ = 1;
    Hodograph directions_ = {};
};

/// How far the contour reaches from the base, about.
double reach_of(const RotationalShape& shape) {
    double reach = std::max(shape.start.r, std::abs(shape.start.h));
    for (const ContourPiece& piece : shape.contour) {
        reach = std::max({reach, piece.end.r, std::abs(piece.end.h)});
        for (const Point& control : piece.control)
            reach = std::max({reach, std::abs(control.r), std::abs(control.h)});
    }
    return reach;
}

} // namespace

CurvedFacets
curved_facets(const RotationalShape& shape, const LocalDeviation& deviation, std::size_t most) {
    RotationalFacets facets(shape, deviation);
    // A million triangles come as near as about 2^-17 of the size to a whole shape, to a part of it
    // nearer.
    const double reach = reach_of(shape);
    for (int exponent = -32;; exponent += 4) {
        try {
            // A contour of very many pieces has more triangles even when they are few round each.
            const bool last = exponent == 0;
            facets.plan(std::ldexp(reach, exponent), last ? no_limit : most);
            return facets.result();
        } catch (const TooMany&) {
        }
    }
}

} // namespace vera
