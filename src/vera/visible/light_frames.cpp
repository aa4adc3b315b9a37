// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/light_frames.h"

#include "vera/exact/screen_point.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>

namespace vera {

namespace {

/// A step may be as large a part of a pixel.
constexpr double most_of_a_pixel = 1.0 / 64;

/// So narrow a window that its corners are not yet one for rounding.
constexpr double least_side = 2e-9;

/// In one direction. What needs more is told.
constexpr std::size_t most_frames = 32;

/// Unit vectors.
struct Axes {
    Vec3 forward;
    Vec3 across;
    Vec3 up;
};

Axes axes_towards(Vec3 forward) {
    const Vec3 away = std::abs(forward.z) < 0.75 ? Vec3{0, 0, 1} : Vec3{0, 1, 0};
    const Vec3 across = normalized(cross(forward, away));
    return {forward, across, normalized(cross(across, forward))};
}

/// A rectangle at distance 1 before the light.
struct Window {
    double left = std::numeric_limits<double>::infinity();
    double right = -std::numeric_limits<double>::infinity();
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    double side() const { return std::max(right - left, high - low); }

    bool empty() const { return !(left <= right && low <= high); }

    void include(double x, double y) {
        left = std::min(left, x);
        right = std::max(right, x);
        low = std::min(low, y);
        high = std::max(high, y);
    }
};

Window common(const Window& a, const Window& b) {
    return {
        std::max(a.left, b.left),
        std::min(a.right, b.right),
        std::max(a.low, b.low),
        std::min(a.high, b.high)};
}

Window square(double x, double y, double side) {
    return {x - side / 2, x + side / 2, y - side / 2, y + side / 2};
}

/// A square, a bit larger.
Window square_around(const Window& window) {
    return square(
        0.5 * (window.left + window.right),
        0.5 * (window.low + window.high),
        std::max(1.001 * window.side(), least_side));
}

Camera camera_of(const Axes& axes, const Window& window) {
    const auto at = [&](double x, double y) {
        return axes.forward + x * axes.across + y * axes.up;
    };
    Camera camera;
    camera.lower_left = at(window.left, window.low);
    camera.lower_right = at(window.right, window.low);
    camera.upper_left = at(window.left, window.high);
    return camera;
}

/// What of the seen needs a finer grid than a window has.
struct Need {
    Window window;
    double farthest = 0;
    double step = 0; ///< the largest of the grid there, in the scene's units
};

/// The part of the way from one end of a segment to the other, at which they have these values, on
/// which what is linear between is positive.
void cut(std::array<double, 2>& part, const std::array<double, 2>& values) {
    const auto [first, last] = values;
    if (!(first > 0 || last > 0))
        part = {1, 0};
    else if (first <= 0)
        part[0] = std::max(part[0], first / (first - last));
    else if (last <= 0)
        part[1] = std::min(part[1], first / (first - last));
}

/// The frames of one direction.
class Frames {
public:
    Frames(const Axes& axes, Vec3 position, std::span<const SeenSegment> seen)
        : axes_(axes)
        , position_(position)
        , seen_(seen) {}

    std::vector<LightFrame> of(const Window& window, double farthest) const;

private:
    Need need(const Window& window, double farthest) const;

    Axes axes_;
    Vec3 position_;
    std::span<const SeenSegment> seen_;
};

/// The size of pixels and of steps, as seen from the light, is linear on planes. So where steps are
/// too large ends on the borders of what is seen as well, and these tell all of it.
Need Frames::need(const Window& window, double farthest) const {
    const double step = window.side() / screen_size;
    const double nearest = 0x1p-16 * farthest; // what is nearer is not shown
    Need need;
    for (const SeenSegment& segment : seen_) {
        std::array<Vec3, 2> at; // in the axes
        std::array<double, 2> excess;
        std::array<double, 2> depth;
        for (std::size_t i = 0; i < 2; ++i) {
            const Vec3 to = segment.ends[i] - position_;
            at[i] = {dot(to, axes_.across), dot(to, axes_.up), dot(to, axes_.forward)};
            excess[i] = step * at[i].z - most_of_a_pixel * segment.pixels[i];
            depth[i] = at[i].z - nearest;
        }
        std::array<double, 2> part = {0, 1};
        cut(part, excess);
        cut(part, depth);
        if (!(part[0] <= part[1]))
            continue;
        for (const double t : part) {
            const Vec3 p = at[0] + t * (at[1] - at[0]);
            need.window.include(p.x / p.z, p.y / p.z);
            need.farthest = std::max(need.farthest, p.z);
            need.step = std::max(need.step, step * p.z);
        }
    }
    need.window = common(need.window, window);
    return need;
}

std::vector<LightFrame> Frames::of(const Window& window, double farthest) const {
    struct Framed {
        Window window;
        double farthest;
    };

    std::vector<Framed> all = {{window, farthest}};
    std::vector<LightFrame> frames;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const Framed here = all[i];
        LightFrame& frame = frames.emplace_back();
        frame.camera = camera_of(axes_, here.window);
        frame.farthest = here.farthest;
        const Need finer = need(here.window, here.farthest);
        const double side = here.window.side();
        if (finer.window.empty())
            continue;
        if (all.size() + 4 > most_frames || side <= 2 * least_side) {
            frame.coarse_step = finer.step;
        } else if (finer.window.side() <= side / 2) {
            all.push_back({square_around(finer.window), finer.farthest});
        } else {
            for (const double x : {0.25, 0.75})
                for (const double y : {0.25, 0.75}) {
                    const Window quarter =
                        square(here.window.left + x * side, here.window.low + y * side, side / 2);
                    if (!common(quarter, finer.window).empty())
                        all.push_back({quarter, finer.farthest});
                }
        }
    }
    return frames;
}

/// How far the box reaches in that direction.
double reach(const Box3& box, Vec3 direction) {
    double farthest = 0;
    for (unsigned i = 0; i < 8; ++i)
        farthest = std::max(farthest, dot(corner(box, i), direction));
    return farthest;
}

/// Half the side of a window in that direction that shows all of the box, if it is not much wider
/// than a cube's.
std::optional<double> half_side(const Box3& box, Vec3 forward) {
    double tangent = 0; // of the widest angle
    for (unsigned i = 0; i < 8; ++i) {
        const Vec3 to = corner(box, i);
        const double along = dot(to, forward);
        if (!(along > 0))
            return std::nullopt;
        tangent = std::max(tangent, length(cross(to, forward)) / along);
    }
    if (tangent < 1.2)
        return std::max(1.001 * tangent, least_side / 2);
    return std::nullopt;
}

} // namespace

std::vector<LightFrame>
light_frames(Vec3 position, const Box3& box, std::span<const SeenSegment> seen) {
    const Box3 about_light = {box.lower - position, box.upper - position};
    const Vec3 to_middle = center(about_light);
    const double distance = length(to_middle);
    if (distance > 0) {
        const Vec3 forward = to_middle / distance;
        if (const auto half = half_side(about_light, forward))
            return Frames(axes_towards(forward), position, seen)
                .of(square(0, 0, 2 * *half), reach(about_light, forward));
    }
    std::vector<LightFrame> frames;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vec3 forward;
            forward[axis] = side;
            const double farthest = reach(about_light, forward);
            if (!(farthest > 0))
                continue;
            const auto of_side =
                Frames(axes_towards(forward), position, seen).of(square(0, 0, 2), farthest);
            frames.insert(frames.end(), of_side.begin(), of_side.end());
        }
    return frames;
}

} // namespace vera
