// SPDX-License-Identifier: Apache-2.0
#include "reference/contour.h"

namespace vera::reference {
namespace {

/// A place in the half plane of the contour: the distance from the axis and that along it.
struct Place {
    Real r = 0;
    Real h = 0;
};

Place place_of(ContourPiece::Point point) {
    return {point.r, point.h};
}

/// A line as the axis sees it: its height and its part across the axis, both linear in t.
struct AxialLine {
    Real height = 0;
    Real climb = 0;
    Vector across;
    Vector drift;
};

/// What all pieces of a shape have in common.
struct PieceFace : Face {
    Placement placement;
    Vector base;
    Vector axis;

    AxialLine axial(const Line& line) const {
        const Vector o = placed_back(placement, line.origin) - base;
        const Vector d = turned_back(placement, line.direction);
        const Real height = inner(o, axis);
        const Real climb = inner(d, axis);
        return {height, climb, o - height * axis, d - climb * axis};
    }

    // "the outer normal of the piece (r0,h0)->(r1,h1) is (h1-h0, r0-r1) in the (r, h) half plane":
    // for a piece that goes by (dr, dh) there, (dh, -dr).
    Surface surface_going(Vector point, Place going) const {
        const Vector local = placed_back(placement, point) - base;
        const Vector away = local - inner(local, axis) * axis;
        const Vector radial = norm(away) > 0 ? unit(away) : Vector{};
        const Vector normal = unit(carried_normal(placement, going.h * radial - going.r * axis));
        return {normal, normal};
    }

    void set_ball(const std::vector<Place>& hull) {
        Real lowest = hull[0].h;
        Real highest = hull[0].h;
        Real widest = 0;
        for (const Place& place : hull) {
            lowest = std::fmin(lowest, place.h);
            highest = std::fmax(highest, place.h);
            widest = std::fmax(widest, place.r);
        }
        const Real half_height = (highest - lowest) / 2;
        ball_center = placed(placement, base + (lowest + half_height) * axis);
        ball_radius = std::sqrt(half_height * half_height + widest * widest) * stretch(placement);
    }
};

/// GE: "A line at constant h is a plane ring or disc, at constant r a cylinder, else a cone."
struct StraightPiece final : PieceFace {
    Place from;
    Place to;

    void
    cross(const Line& line, bool starts_here, std::vector<Crossing>& crossings) const override {
        const AxialLine seen = axial(line);
        if (from.h == to.h) {
            if (seen.climb == 0 || starts_here)
                return;
            const Real t = (from.h - seen.height) / seen.climb;
            const Real r = norm(seen.across + t * seen.drift);
            if (r >= std::fmin(from.r, to.r) && r <= std::fmax(from.r, to.r))
                crossings.push_back({t, 0, this});
            return;
        }
        // The radius is linear in the height, and so in t: |across + t drift|^2 = (r + t growth)^2.
        const Real slope = (to.r - from.r) / (to.h - from.h);
        const Real r = from.r + slope * (seen.height - from.h);
        const Real growth = slope * seen.climb;
        cross_quadric(
            inner(seen.drift, seen.drift) - growth * growth,
            inner(seen.across, seen.drift) - r * growth,
            inner(seen.across, seen.across) - r * r,
            starts_here,
            [&](Real t) {
                const Real h = seen.height + t * seen.climb;
                if (h >= std::fmin(from.h, to.h) && h <= std::fmax(from.h, to.h))
                    crossings.push_back({t, 0, this});
            });
    }

    Surface surface(Vector point, const Crossing&) const override {
        return surface_going(point, {to.r - from.r, to.h - from.h});
    }
};

/// KR, KE, KU: a rational quadratic or a cubic curve. Its crossings are found by looking closely:
/// many places along the piece, and between those whatever changes its sign or nearly does.
struct CurvedPiece final : PieceFace {
    static constexpr std::size_t steps = 48;

    std::vector<Place> control;
    std::vector<Real> weights;
    std::vector<Place> looked_at; ///< the places at s = 0, 1 / steps, ..., 1

    Place at(Real s) const {
        // Bernstein polynomials, written out.
        const Real u = 1 - s;
        const std::array<Real, 4> parts = control.size() == 3
            ? std::array<Real, 4>{u * u, 2 * u * s, s * s, 0}
            : std::array<Real, 4>{u * u * u, 3 * u * u * s, 3 * u * s * s, s * s * s};
        Place sum;
        Real total = 0;
        for (std::size_t i = 0; i < control.size(); ++i) {
            const Real weight = parts[i] * weights[i];
            sum.r += weight * control[i].r;
            sum.h += weight * control[i].h;
            total += weight;
        }
        return {sum.r / total, sum.h / total};
    }

    /// How the piece goes at s: a difference quotient, so that no derivative can be wrong.
    Place going(Real s) const {
        constexpr Real step = 1e-7L;
        const Real s0 = std::fmax(s - step, 0.0L);
        const Real s1 = std::fmin(s + step, 1.0L);
        const Place p0 = at(s0);
        const Place p1 = at(s1);
        return {p1.r - p0.r, p1.h - p0.h};
    }

    void look(std::vector<Place> points, std::vector<Real> point_weights) {
        control = std::move(points);
        weights = std::move(point_weights);
        for (std::size_t i = 0; i <= steps; ++i)
            looked_at.push_back(at(static_cast<Real>(i) / steps));
        set_ball(control);
    }

    void
    cross(const Line& line, bool starts_here, std::vector<Crossing>& crossings) const override {
        const AxialLine seen = axial(line);
        const Real length = std::sqrt(inner(line.direction, line.direction));
        // Where the line starts on this face, the root that is its start is left out.
        const Real least = starts_here ? 1e-9L * (size(line.origin) + ball_radius) / length : 0;
        const auto found = [&](Real t, Real s) {
            if (!starts_here || std::fabs(t) > least)
                crossings.push_back({t, s, this});
        };

        if (std::fabs(seen.climb) <= 1e-14L * norm(seen.drift)) {
            // The line keeps its height: where the contour has it, so has the shape a circle.
            const auto gap = [&](Place place) { return place.h - seen.height; };
            roots(gap, [&](Real s) {
                const Real r = at(s).r;
                cross_quadric(
                    inner(seen.drift, seen.drift),
                    inner(seen.across, seen.drift),
                    inner(seen.across, seen.across) - r * r,
                    false,
                    [&](Real t) { found(t, s); });
            });
            return;
        }
        // The line reaches the height h at t = (h - height) / climb, and is on the surface there
        // when its distance from the axis is r; both sides times climb^2.
        const auto gap = [&](Place place) {
            const Vector across = seen.climb * seen.across + (place.h - seen.height) * seen.drift;
            const Real r = seen.climb * place.r;
            return inner(across, across) - r * r;
        };
        roots(gap, [&](Real s) { found((at(s).h - seen.height) / seen.climb, s); });
    }

    Surface surface(Vector point, const Crossing& crossing) const override {
        return surface_going(point, going(crossing.s));
    }

private:
    template <typename Gap, typename Found>
    void roots(const Gap& gap, const Found& found) const {
        std::array<Real, steps + 1> gaps;
        for (std::size_t i = 0; i <= steps; ++i)
            gaps[i] = gap(looked_at[i]);

        const auto s_of = [](std::size_t i) { return static_cast<Real>(i) / steps; };
        const auto smaller = [&](std::size_t i, std::size_t j) {
            return std::fabs(gaps[i]) <= std::fabs(gaps[j]);
        };
        for (std::size_t i = 0; i <= steps; ++i) {
            if (i < steps && (gaps[i] < 0) != (gaps[i + 1] < 0))
                found(bisected(gap, s_of(i), s_of(i + 1), gaps[i] < 0));
            // Between neighbours of one sign the gap may dip through zero and come back.
            const std::size_t before = i > 0 ? i - 1 : i;
            const std::size_t after = i < steps ? i + 1 : i;
            if ((gaps[before] < 0) == (gaps[i] < 0) && (gaps[i] < 0) == (gaps[after] < 0)
                && smaller(i, before) && smaller(i, after))
                dip(gap, s_of(before), s_of(after), gaps[i] < 0, found);
        }
    }

    template <typename Gap>
    Real bisected(const Gap& gap, Real low, Real high, bool negative_at_low) const {
        for (int round = 0; round < 64; ++round) {
            const Real middle = (low + high) / 2;
            ((gap(at(middle)) < 0) == negative_at_low ? low : high) = middle;
        }
        return (low + high) / 2;
    }

    /// Looks for the extreme between low and high by thirds, and for the two roots beside it.
    template <typename Gap, typename Found>
    void dip(const Gap& gap, Real low, Real high, bool negative, const Found& found) const {
        const Real first = low;
        const Real last = high;
        for (int round = 0; round < 80; ++round) {
            const Real left = low + (high - low) / 3;
            const Real right = high - (high - low) / 3;
            const Real gap_left = gap(at(left));
            const Real gap_right = gap(at(right));
            for (const auto& [s, value] : {std::pair{left, gap_left}, std::pair{right, gap_right}})
                if ((value < 0) != negative) {
                    found(bisected(gap, first, s, negative));
                    found(bisected(gap, s, last, !negative));
                    return;
                }
            (std::fabs(gap_left) < std::fabs(gap_right) ? high : low) =
                std::fabs(gap_left) < std::fabs(gap_right) ? right : left;
        }
    }
};

} // namespace

std::vector<std::unique_ptr<Face>>
contour_faces(const RotationalShape& shape, const Placement& placement) {
    std::vector<std::unique_ptr<Face>> faces;
    const auto set_up = [&](PieceFace& face) {
        face.placement = placement;
        face.base = vector_of(shape.base);
        face.axis = unit(vector_of(shape.axis));
    };
    Place from = place_of(shape.start);
    for (const ContourPiece& piece : shape.contour) {
        const Place to = place_of(piece.end);
        if (piece.kind == ContourPiece::Kind::line) {
            auto face = std::make_unique<StraightPiece>();
            set_up(*face);
            face->from = from;
            face->to = to;
            face->set_ball({from, to});
            faces.push_back(std::move(face));
        } else {
            auto face = std::make_unique<CurvedPiece>();
            set_up(*face);
            if (piece.kind == ContourPiece::Kind::conic)
                face->look({from, place_of(piece.control[0]), to}, {1, piece.weight, 1});
            else
                face->look(
                    {from, place_of(piece.control[0]), place_of(piece.control[1]), to},
                    {1, 1, 1, 1});
            faces.push_back(std::move(face));
        }
        from = to;
    }
    return faces;
}

} // namespace vera::reference
