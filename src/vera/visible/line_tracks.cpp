// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/line_tracks.h"

#include "vera/drawing/elliptic_arc.h"

#include <cmath>

namespace vera {

namespace {

/// The straight line that touches the track where it is nearest to the point.
LineTrack tangent_near(const LineTrack& track, DrawingPoint point) {
    if (track.ellipse == nullptr)
        return track;
    const double at = nearest_degrees(*track.ellipse, point);
    return {nullptr, point_at(*track.ellipse, at), tangent_at(*track.ellipse, at)};
}

} // namespace

DrawingPoint nearest_on(const LineTrack& track, DrawingPoint point) {
    if (track.ellipse != nullptr)
        return point_at(*track.ellipse, nearest_degrees(*track.ellipse, point));
    const auto [x, y] = track.direction;
    const double part =
        ((point.x - track.place.x) * x + (point.y - track.place.y) * y) / (x * x + y * y);
    return {track.place.x + part * x, track.place.y + part * y};
}

DrawingPoint crossing_near(const LineTrack& one, const LineTrack& other, DrawingPoint point) {
    // Newton's method: to where the tangents at the nearest points cross.
    constexpr int steps = 16;
    constexpr double parallel = 1e-9; // radians
    DrawingPoint crossing = nearest_on(one, point);
    for (int i = 0; i < steps; ++i) {
        const LineTrack a = tangent_near(one, crossing);
        const LineTrack b = tangent_near(other, crossing);
        const double sine = a.direction.x * b.direction.y - a.direction.y * b.direction.x;
        const double lengths = distance(a.direction, {}) * distance(b.direction, {});
        if (!(std::abs(sine) > parallel * lengths))
            break;
        const double part =
            ((b.place.x - a.place.x) * b.direction.y - (b.place.y - a.place.y) * b.direction.x)
            / sine;
        crossing =
            nearest_on(one, {a.place.x + part * a.direction.x, a.place.y + part * a.direction.y});
    }
    return crossing;
}

} // namespace vera
