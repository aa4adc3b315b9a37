// SPDX-License-Identifier: Apache-2.0
#include "vera/scene/outline_table.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vera {

namespace {

constexpr std::uint32_t few_corners = 8;

/// Sides are listed in this many strips each, on the average, at most.
constexpr std::size_t most_listings = 6;

bool has_outline(const Polygon& polygon) {
    return polygon.shape != Polygon::Shape::split_quadrangle && polygon.corner_count > few_corners;
}

/// Sums and products of such numbers, and of their products, neither overflow nor underflow.
bool is_ordinary(double number) {
    const double size = std::abs(number);
    return size == 0 || (size >= 0x1p-200 && size <= 0x1p200);
}

bool is_ordinary(const Vec3& point) {
    return is_ordinary(point.x) && is_ordinary(point.y) && is_ordinary(point.z);
}

/// A shear is at most 1.
bool is_ordinary_shear(double shear) {
    return shear == 0 || std::abs(shear) >= 0x1p-100;
}

/// What lies beyond the polygon counts to its first or last strip. Never falls where v rises, since
/// no rounding does: a side touches the strips from that of one end to that of the other.
std::uint32_t strip_at(const OutlineStrips& outline, double v) {
    const double place = (v - outline.bounds.lower.*outline.v_axis) * outline.strips_per_unit;
    return static_cast<std::uint32_t>(
        std::clamp(place, 0.0, static_cast<double>(outline.strip_count - 1)));
}

/// Calls sink(side, first strip, last strip).
template <typename Sink>
void for_each_side(const OutlineStrips& outline, std::span<const Vec3> corners, const Sink& sink) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const double from = corners[i].*outline.v_axis;
        const double to = corners[i + 1 == corners.size() ? 0 : i + 1].*outline.v_axis;
        sink(
            static_cast<std::uint32_t>(i),
            strip_at(outline, std::min(from, to)),
            strip_at(outline, std::max(from, to)));
    }
}

/// As many strips as corners, or fewer where too many sides would be listed.
void choose_strips(OutlineStrips& outline, std::span<const Vec3> corners) {
    const double height =
        outline.bounds.upper.*outline.v_axis - outline.bounds.lower.*outline.v_axis;
    outline.strip_count = static_cast<std::uint32_t>(corners.size());
    while (true) {
        outline.strips_per_unit = outline.strip_count / height;
        if (!(outline.strips_per_unit < 0x1p300))
            outline.strip_count = 1;
        if (outline.strip_count == 1) {
            outline.strips_per_unit = 0;
            return;
        }
        std::size_t listings = 0;
        for_each_side(
            outline, corners, [&](std::uint32_t, std::uint32_t first, std::uint32_t last) {
                listings += last - first + std::size_t{1};
            });
        if (listings <= most_listings * corners.size())
            return;
        outline.strip_count = std::max(outline.strip_count / 2, std::uint32_t{1});
    }
}

void append_strips(OutlineTable& table, OutlineStrips& outline, std::span<const Vec3> corners) {
    // One more than there are, so that what is counted for a strip comes behind its start.
    outline.first_strip = table.starts.size();
    table.starts.resize(table.starts.size() + outline.strip_count + 1);
    std::uint32_t* starts = table.starts.data() + outline.first_strip;
    for_each_side(outline, corners, [&](std::uint32_t, std::uint32_t first, std::uint32_t last) {
        for (std::uint32_t strip = first; strip <= last; ++strip)
            ++starts[strip + 1];
    });
    starts[0] = static_cast<std::uint32_t>(table.sides.size());
    for (std::uint32_t strip = 0; strip < outline.strip_count; ++strip)
        starts[strip + 1] += starts[strip];
    table.sides.resize(starts[outline.strip_count]);
    std::vector<std::uint32_t> next(starts, starts + outline.strip_count);
    for_each_side(
        outline, corners, [&](std::uint32_t side, std::uint32_t first, std::uint32_t last) {
            for (std::uint32_t strip = first; strip <= last; ++strip)
                table.sides[next[strip]++] = side;
        });
}

/// The same as strip_at(), along the strips.
std::uint32_t cell_at(const OutlineStrips& outline, double u) {
    const double place = (u - outline.bounds.lower.*outline.u_axis) * outline.cells_per_unit;
    return static_cast<std::uint32_t>(std::clamp(place, 0.0, double{StripCells::count - 1}));
}

/// The cells from the first to the last.
std::uint64_t cells_between(std::uint32_t first, std::uint32_t last) {
    return (~std::uint64_t{0} >> (StripCells::count - 1 - last)) & (~std::uint64_t{0} << first);
}

/// The cells that the side from a to b may touch between two places across the strips.
std::uint64_t
touched_cells(const OutlineStrips& outline, const Vec3& a, const Vec3& b, double from, double to) {
    const double a_u = a.*outline.u_axis;
    const double a_v = a.*outline.v_axis;
    const double along = b.*outline.u_axis - a_u;
    const double rise = b.*outline.v_axis - a_v;
    double ends[2] = {a_u, a_u + along};
    double off = 1; // what is rounded moves ends by less than 2^-48 of the size, times this
    if (rise != 0) {
        const double parts[2] = {
            std::clamp((from - a_v) / rise, 0.0, 1.0), std::clamp((to - a_v) / rise, 0.0, 1.0)};
        for (std::size_t i = 0; i < 2; ++i)
            ends[i] = a_u + parts[i] * along;
        off += std::abs(along / rise);
    }
    const double margin = 0x1p-48 * outline.size * off;
    return cells_between(
        cell_at(outline, std::min(ends[0], ends[1]) - margin),
        cell_at(outline, std::max(ends[0], ends[1]) + margin));
}

/// How often the outline turns about a place that no side of the strip comes near.
int turns_about(
    const OutlineStrips& outline,
    std::span<const Vec3> corners,
    std::span<const std::uint32_t> sides,
    double u,
    double v) {
    int turns = 0;
    for (const std::uint32_t side : sides) {
        const Vec3& a = corners[side];
        const Vec3& b = corners[side + 1 == corners.size() ? 0 : side + 1];
        const bool starts_below = a.*outline.v_axis <= v;
        if (starts_below == (b.*outline.v_axis <= v))
            continue;
        const double part = (v - a.*outline.v_axis) / (b.*outline.v_axis - a.*outline.v_axis);
        if (a.*outline.u_axis + part * (b.*outline.u_axis - a.*outline.u_axis) > u)
            turns += starts_below ? 1 : -1;
    }
    return turns;
}

/// Finds out which cells the sides leave untouched, and which of those are inside.
void set_cells(OutlineTable& table, OutlineStrips& outline, std::span<const Vec3> corners) {
    table.cells.resize(table.starts.size());
    const double lower_u = outline.bounds.lower.*outline.u_axis;
    const double lower_v = outline.bounds.lower.*outline.v_axis;
    const double width = outline.bounds.upper.*outline.u_axis - lower_u;
    const double height = outline.bounds.upper.*outline.v_axis - lower_v;
    // Cells that are not far larger than what is rounded are no use; and a strip that is not far
    // higher than that is never asked about: margins are larger.
    constexpr double least_part = 0x1p-20;
    if (outline.strip_count == 1 || !(std::min(width, height) > least_part * outline.size))
        return;
    outline.cells_per_unit = StripCells::count / width;
    const double strip_height = height / outline.strip_count;
    const std::uint32_t* const starts = table.starts.data() + outline.first_strip;
    for (std::uint32_t strip = 0; strip < outline.strip_count; ++strip) {
        const std::span<const std::uint32_t> sides = {
            table.sides.data() + starts[strip], table.sides.data() + starts[strip + 1]};
        const double middle = lower_v + (strip + 0.5) * strip_height;
        std::uint64_t touched = 0;
        for (const std::uint32_t side : sides)
            touched |= touched_cells(
                outline,
                corners[side],
                corners[side + 1 == corners.size() ? 0 : side + 1],
                middle - 0.51 * strip_height,
                middle + 0.51 * strip_height);
        StripCells& cells = table.cells[outline.first_strip + strip];
        cells.known = ~touched;
        // Between two that are touched all are alike.
        for (std::uint64_t rest = cells.known; rest != 0;) {
            const auto first = static_cast<std::uint32_t>(std::countr_zero(rest));
            const auto length = static_cast<std::uint32_t>(std::countr_one(rest >> first));
            const std::uint64_t run = cells_between(first, first + length - 1);
            const double u = lower_u + (first + 0.5) / outline.cells_per_unit;
            if (turns_about(outline, corners, sides, u, middle) != 0)
                cells.inside |= run;
            rest &= ~run;
        }
    }
}

void add_outline(OutlineTable& table, std::size_t polygon, std::span<const Vec3> corners, Vec3 n) {
    const Vec3 normal_size = abs(n);
    const bool usable = std::all_of(
        corners.begin(), corners.end(), [](const Vec3& corner) { return is_ordinary(corner); });
    // Of a unit vector both hold.
    if (!usable || !(normal_size.x + normal_size.y + normal_size.z <= 2)
        || !(max_component(normal_size) >= 0.5)
        || table.sides.size() + most_listings * corners.size() > 0xffffffffU)
        return;
    OutlineStrips outline;
    constexpr double Vec3::*axes[] = {&Vec3::x, &Vec3::y, &Vec3::z};
    const std::size_t across = longest_axis(n);
    outline.u_axis = axes[(across + 1) % 3];
    outline.v_axis = axes[(across + 2) % 3];
    for (const Vec3& corner : corners) {
        // Of zeros the first, as in range_of_corners().
        for (std::size_t axis = 0; axis < 3; ++axis) {
            double& lower = outline.bounds.lower[axis];
            double& upper = outline.bounds.upper[axis];
            lower = std::min(lower, corner[axis]);
            upper = std::max(upper, corner[axis]);
        }
        outline.size = std::max(outline.size, max_component(abs(corner)));
        outline.deviation = std::max(outline.deviation, std::abs(dot(n, corner - corners[0])));
    }
    choose_strips(outline, corners);
    append_strips(table, outline, corners);
    set_cells(table, outline, corners);
    table.outlines.push_back(outline);
    table.numbers[polygon] = static_cast<std::uint32_t>(table.outlines.size());
}

/// The point where the ray meets the plane, and how far from it, along either axis, the outline
/// must pass for it not to matter how it was rounded.
struct Place {
    double u = 0;
    double v = 0;
    double u_margin = 0;
    double v_margin = 0;
};

enum class Side : std::uint8_t { lower, upper, near };

/// On which side of the place, along u, the side of the polygon from a to b passes.
Side side_of_place(const OutlineStrips& outline, const Place& place, const Vec3& a, const Vec3& b) {
    const double a_u = a.*outline.u_axis - place.u;
    const double b_u = b.*outline.u_axis - place.u;
    if (a_u < -place.u_margin && b_u < -place.u_margin)
        return Side::lower;
    if (a_u > place.u_margin && b_u > place.u_margin)
        return Side::upper;
    // By the differences as they are, so that the rounding shrinks with the side.
    const double along = b.*outline.u_axis - a.*outline.u_axis;
    const double rise = b.*outline.v_axis - a.*outline.v_axis;
    const double determinant = a_u * rise - (a.*outline.v_axis - place.v) * along;
    const double margin = place.v_margin * std::abs(along) + place.u_margin * std::abs(rise);
    if (!(std::abs(determinant) > margin))
        return Side::near;
    return (determinant > 0) == (rise > 0) ? Side::upper : Side::lower;
}

} // namespace

OutlineTable outline_table(const Geometry& geometry) {
    OutlineTable table;
    for (std::size_t i = 0; i < geometry.polygons.size(); ++i) {
        const Polygon& polygon = geometry.polygons[i];
        if (!has_outline(polygon))
            continue;
        table.numbers.resize(geometry.polygons.size());
        add_outline(
            table,
            i,
            {geometry.corners.data() + polygon.first_corner, polygon.corner_count},
            polygon.normal);
    }
    return table;
}

std::size_t memory(const OutlineTable& table) {
    return table.outlines.size() * sizeof(OutlineStrips)
        + (table.numbers.size() + table.starts.size() + table.sides.size()) * sizeof(std::uint32_t)
        + table.cells.size() * sizeof(StripCells);
}

std::size_t most_memory_of_outline_table(const Geometry& geometry) {
    // As many strips as corners, and one start more.
    constexpr std::size_t by_corner =
        (1 + most_listings) * sizeof(std::uint32_t) + sizeof(StripCells);
    std::size_t bytes = 0;
    for (const Polygon& polygon : geometry.polygons)
        if (has_outline(polygon))
            bytes += sizeof(OutlineStrips) + by_corner * (polygon.corner_count + std::size_t{1});
    return bytes == 0 ? 0 : bytes + geometry.polygons.size() * sizeof(std::uint32_t);
}

// meets_outline() is exact for the sheared corners, but that it takes an edge for one through the
// ray when the two products of the edge function are rounded to the same. Let s be the sum of the
// largest coordinates of corners and origin, and e = 2^-53.
//
// A sheared coordinate is off by 6 e s at most. The products are the same only where moving the
// ends of the edge by 8 e s leads it through the ray: for an edge that crosses the first axis, they
// have different signs unless its ends lie on different sides of the second one as well, and then
// it passes the ray within 2 e times the distance of the nearer end. (That holds as long as no
// product underflows: hence the ordinary numbers. Coordinates that are multiples of 2^-252, and a
// shear that is one of 2^-152, make sheared coordinates that are multiples of 2^-404.) So the
// answer is that for a polygon whose corners, as the ray sees them, were moved by no more than
// 16 e s.
//
// Carried along the ray into the plane, where its points are an affine image of what the ray sees,
// a corner moves along u by 16 e s and by (deviation + 32 e s) |direction.u / speed| at most; the
// place by a bit less, as it is rounded by itself, when s includes its distance from the origin. No
// side then passes over the place while it moves, and the outline turns about it as often as
// before, as long as it does not come nearer than these together. The margins are larger than
// that by half, for their own rounding and that of determinants.
//
// Where the place with its margins lies in a cell that no side touches, none comes as near.
InclusionStatus inclusion_status(
    const OutlineTable& table,
    const OutlineStrips& outline,
    std::span<const Vec3> corners,
    const PreparedRay& prepared,
    double t,
    double speed) {
    const Ray& ray = prepared.ray;
    const double direction_size = std::abs(prepared.direction_z);
    const double speed_size = std::abs(speed);
    const double size = outline.size + prepared.origin_size + std::abs(t) * direction_size;
    if (!is_ordinary(ray.origin) || !is_ordinary(direction_size) || !(size <= 0x1p202)
        || !(speed_size >= 0x1p-30 * direction_size) || !is_ordinary_shear(prepared.shear_x)
        || !is_ordinary_shear(prepared.shear_y))
        return InclusionStatus::uncertain;

    const double noise = 0x1p-46 * size;
    const double slant = (outline.deviation + noise) / speed_size;
    const double direction_u = ray.direction.*outline.u_axis;
    const double direction_v = ray.direction.*outline.v_axis;
    const Place place = {
        ray.origin.*outline.u_axis + t * direction_u,
        ray.origin.*outline.v_axis + t * direction_v,
        noise + slant * std::abs(direction_u),
        noise + slant * std::abs(direction_v)};
    if (place.u + place.u_margin < outline.bounds.lower.*outline.u_axis
        || place.u - place.u_margin > outline.bounds.upper.*outline.u_axis
        || place.v + place.v_margin < outline.bounds.lower.*outline.v_axis
        || place.v - place.v_margin > outline.bounds.upper.*outline.v_axis)
        return InclusionStatus::outside;
    const std::uint32_t strip = strip_at(outline, place.v - place.v_margin);
    if (strip_at(outline, place.v + place.v_margin) != strip)
        return InclusionStatus::uncertain;
    const std::uint32_t cell = cell_at(outline, place.u - place.u_margin);
    const StripCells& cells = table.cells[outline.first_strip + strip];
    if ((cells.known >> cell & 1U) != 0 && cell_at(outline, place.u + place.u_margin) == cell)
        return (cells.inside >> cell & 1U) != 0 ? InclusionStatus::inside
                                                : InclusionStatus::outside;

    const std::uint32_t* starts = table.starts.data() + outline.first_strip + strip;
    int turns = 0; // of the outline about the place
    for (std::uint32_t i = starts[0]; i < starts[1]; ++i) {
        const std::size_t number = table.sides[i];
        const Vec3& from = corners[number];
        const Vec3& to = corners[number + 1 == corners.size() ? 0 : number + 1];
        const double from_v = from.*outline.v_axis - place.v;
        const double to_v = to.*outline.v_axis - place.v;
        if ((from_v < -place.v_margin && to_v < -place.v_margin)
            || (from_v > place.v_margin && to_v > place.v_margin))
            continue;
        const Side side = side_of_place(outline, place, from, to);
        if (side == Side::near)
            return InclusionStatus::uncertain;
        if (side == Side::upper && (from_v <= 0) != (to_v <= 0))
            turns += from_v <= 0 ? 1 : -1;
    }
    return turns != 0 ? InclusionStatus::inside : InclusionStatus::outside;
}

} // namespace vera
