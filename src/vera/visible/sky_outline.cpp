// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/sky_outline.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <utility>

namespace vera {

namespace {

/// A direction, in parts of the picture: it is seen x / w of the width from the left and y / w of
/// the height from below. Where w is negative it lies behind the viewer.
struct PictureDirection {
    double x = 0;
    double y = 0;
    double w = 0;
};

class PictureDirections {
public:
    explicit PictureDirections(const ViewRays& rays)
        : x_(cross(rays.up, rays.corner))
        , y_(cross(rays.corner, rays.across))
        , w_(cross(rays.across, rays.up))
        , scale_(1 / dot(rays.corner, w_)) {}

    PictureDirection of(Vec3 direction) const {
        return {
            scale_ * dot(x_, direction), scale_ * dot(y_, direction), scale_ * dot(w_, direction)};
    }

private:
    Vec3 x_;
    Vec3 y_;
    Vec3 w_;
    double scale_;
};

using Corners = std::vector<PictureDirection>;

enum class PictureSide : std::uint8_t { left, right, lower, upper };

/// Positive within the side.
double within(PictureSide side, const PictureDirection& at) {
    switch (side) {
    case PictureSide::left:
        return at.x;
    case PictureSide::right:
        return at.w - at.x;
    case PictureSide::lower:
        return at.y;
    case PictureSide::upper:
        break;
    }
    return at.w - at.y;
}

/// Where the way from one to the other, on different sides, crosses the picture's: exactly on it,
/// and the same whichever of two triangles asks.
PictureDirection
crossing(PictureSide side, const PictureDirection& inside, const PictureDirection& outside) {
    const double in = within(side, inside);
    const double part = in / (in - within(side, outside));
    const auto between = [&](double a, double b) { return a + part * (b - a); };
    PictureDirection at = {
        between(inside.x, outside.x), between(inside.y, outside.y), between(inside.w, outside.w)};
    if (side == PictureSide::left || side == PictureSide::right)
        at.x = side == PictureSide::left ? 0 : at.w;
    else
        at.y = side == PictureSide::lower ? 0 : at.w;
    return at;
}

/// The part of a convex cone within the side (Sutherland and Hodgman 1974).
Corners cut(PictureSide side, const Corners& corners) {
    Corners left;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const PictureDirection& a = corners[i];
        const PictureDirection& b = corners[i + 1 < corners.size() ? i + 1 : 0];
        const bool a_inside = within(side, a) >= 0;
        const bool b_inside = within(side, b) >= 0;
        if (a_inside)
            left.push_back(a);
        if (a_inside != b_inside)
            left.push_back(a_inside ? crossing(side, a, b) : crossing(side, b, a));
    }
    return left;
}

struct PointOrder {
    bool operator()(DrawingPoint a, DrawingPoint b) const {
        return a.x != b.x ? a.x < b.x : a.y < b.y;
    }
};

/// Sides of areas that abut. What two areas have in common cancels, and the rest is the way round
/// all of them.
class AreaSides {
public:
    void add(DrawingPoint from, DrawingPoint to) {
        if (from == to)
            return;
        std::vector<DrawingPoint>& back = to_[to];
        const auto opposite = std::find(back.begin(), back.end(), from);
        if (opposite != back.end())
            back.erase(opposite);
        else
            to_[from].push_back(to);
    }

    std::vector<BorderRing> rings() {
        std::vector<BorderRing> rings;
        for (auto& [start, ends] : to_)
            while (!ends.empty()) {
                BorderRing& ring = rings.emplace_back();
                DrawingPoint at = start;
                do {
                    ring.push_back(at);
                    std::vector<DrawingPoint>& next = to_[at];
                    at = next.back();
                    next.pop_back();
                } while (at != start);
            }
        return rings;
    }

private:
    std::map<DrawingPoint, std::vector<DrawingPoint>, PointOrder> to_;
};

/// The ring without points in the middle of the picture's sides.
BorderRing without_needless_points(const BorderRing& ring, double width, double height) {
    BorderRing kept;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const DrawingPoint a = ring[(i + ring.size() - 1) % ring.size()];
        const DrawingPoint b = ring[i];
        const DrawingPoint c = ring[(i + 1) % ring.size()];
        const bool along_x = a.y == b.y && b.y == c.y && (b.y == 0 || b.y == height);
        const bool along_y = a.x == b.x && b.x == c.x && (b.x == 0 || b.x == width);
        if (!along_x && !along_y)
            kept.push_back(b);
    }
    return kept;
}

double doubled_area(const BorderRing& ring) {
    double area = 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
        const DrawingPoint a = ring[i];
        const DrawingPoint b = ring[(i + 1) % ring.size()];
        area += a.x * b.y - a.y * b.x;
    }
    return area;
}

} // namespace

std::vector<BorderRing>
sky_outline(const Camera& camera, const HorizonProfile& profile, double width, double height) {
    const ViewRays rays(camera);
    const BorderRing frame = {{0, 0}, {width, 0}, {width, height}, {0, height}};
    if (rays.projection == Camera::Projection::parallel)
        return profile.hides(rays.origin_or_direction) ? std::vector<BorderRing>()
                                                       : std::vector<BorderRing>{frame};
    const PictureDirections in_picture(rays);
    const PictureDirection zenith = in_picture.of({0, 1, 0});
    Corners points;
    for (const Vec3 direction : profile.directions())
        points.push_back(in_picture.of(direction));

    // The sky above each side of the profile is the triangle between that and the zenith.
    AreaSides sides;
    for (std::size_t i = 0; i < points.size(); ++i) {
        Corners sky = {zenith, points[i + 1 < points.size() ? i + 1 : 0], points[i]};
        for (const PictureSide side :
             {PictureSide::left, PictureSide::right, PictureSide::lower, PictureSide::upper})
            sky = cut(side, sky);
        BorderRing ring;
        for (const PictureDirection& corner : sky)
            ring.push_back({corner.x / corner.w * width, (1 - corner.y / corner.w) * height});
        for (std::size_t k = 0; k < ring.size(); ++k)
            sides.add(ring[k], ring[(k + 1) % ring.size()]);
    }
    std::vector<BorderRing> rings;
    double area = 0;
    for (const BorderRing& ring : sides.rings()) {
        BorderRing kept = without_needless_points(ring, width, height);
        if (kept.size() < 3)
            continue;
        area += doubled_area(kept);
        rings.push_back(std::move(kept));
    }
    if (area < 0)
        for (BorderRing& ring : rings)
            std::reverse(ring.begin(), ring.end());
    return rings;
}

} // namespace vera
