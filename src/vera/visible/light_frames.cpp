// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/light_frames.h"

#include "vera/exact/screen_point.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

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

/// The frames of one direction, step by step towards finer ones.
class Direction {
public:
    Direction(const Axes& axes, Vec3 position, const Window& window, double farthest)
        : axes_(axes)
        , position_(position)
        , framed_{{window, farthest}}
        , needs_(1) {}

    bool is_done() const { return needs_.empty(); }

    void look_at(const SeenSegment& segment);
    void go_on();

    std::vector<LightFrame> take() { return std::move(frames_); }

private:
    struct Framed {
        Window window;
        double farthest = 0;
    };

    Axes axes_;
    Vec3 position_;
    std::vector<Framed> framed_;
    std::vector<LightFrame> frames_; ///< of the first ones
    std::vector<Need> needs_;        ///< of the others
};

/// Adds what the segment needs to the needs of the windows that have no frame yet. The size of
/// pixels and of steps, as seen from the light, is linear on planes. So where steps are too large
/// ends on the borders of what is seen as well, and these tell all of it.
void Direction::look_at(const SeenSegment& segment) {
    std::array<Vec3, 2> at; // in the axes
    for (std::size_t i = 0; i < 2; ++i) {
        const Vec3 to = segment.ends[i] - position_;
        at[i] = {dot(to, axes_.across), dot(to, axes_.up), dot(to, axes_.forward)};
    }
    for (std::size_t number = 0; number < needs_.size(); ++number) {
        const auto& [window, farthest] = framed_[frames_.size() + number];
        const double step = window.side() / screen_size;
        const double nearest = 0x1p-16 * farthest; // what is nearer is not shown
        std::array<double, 2> excess;
        std::array<double, 2> depth;
        for (std::size_t i = 0; i < 2; ++i) {
            excess[i] = step * at[i].z - most_of_a_pixel * segment.pixels[i];
            depth[i] = at[i].z - nearest;
        }
        std::array<double, 2> part = {0, 1};
        cut(part, excess);
        cut(part, depth);
        if (!(part[0] <= part[1]))
            continue;
        Need& need = needs_[number];
        for (const double t : part) {
            const Vec3 p = at[0] + t * (at[1] - at[0]);
            need.window.include(p.x / p.z, p.y / p.z);
            need.farthest = std::max(need.farthest, p.z);
            need.step = std::max(need.step, step * p.z);
        }
    }
}

/// When all segments were looked at: makes the frames whose needs are known, and the windows of
/// finer ones.
void Direction::go_on() {
    const std::vector<Need> needs = std::exchange(needs_, {});
    for (Need finer : needs) {
        const Framed here = framed_[frames_.size()];
        finer.window = common(finer.window, here.window);
        LightFrame& frame = frames_.emplace_back();
        frame.camera = camera_of(axes_, here.window);
        frame.farthest = here.farthest;
        const double side = here.window.side();
        if (finer.window.empty())
            continue;
        if (framed_.size() + 4 > most_frames || side <= 2 * least_side) {
            frame.coarse_step = finer.step;
        } else if (finer.window.side() <= side / 2) {
            framed_.push_back({square_around(finer.window), finer.farthest});
        } else {
            for (const double x : {0.25, 0.75})
                for (const double y : {0.25, 0.75}) {
                    const Window quarter =
                        square(here.window.left + x * side, here.window.low + y * side, side / 2);
                    if (!common(quarter, finer.window).empty())
                        framed_.push_back({quarter, finer.farthest});
                }
        }
    }
    needs_.resize(framed_.size() - frames_.size());
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

/// In which the light sees all of the box, each as coarsely as that.
std::vector<Direction> directions(Vec3 position, const Box3& box) {
    const Box3 about_light = {box.lower - position, box.upper - position};
    const Vec3 to_middle = center(about_light);
    const double distance = length(to_middle);
    if (distance > 0) {
        const Vec3 forward = to_middle / distance;
        if (const auto half = half_side(about_light, forward))
            return {
                {axes_towards(forward),
                 position,
                 square(0, 0, 2 * *half),
                 reach(about_light, forward)}};
    }
    std::vector<Direction> result;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            Vec3 forward;
            forward[axis] = side;
            const double farthest = reach(about_light, forward);
            if (farthest > 0)
                result.emplace_back(axes_towards(forward), position, square(0, 0, 2), farthest);
        }
    return result;
}

} // namespace

std::vector<std::vector<LightFrame>>
light_frames(std::span<const Vec3> positions, const Box3& box, const SeenSegments& seen) {
    std::vector<std::vector<Direction>> of_lights;
    for (const Vec3 position : positions)
        of_lights.push_back(directions(position, box));
    const auto open_ones = [&] {
        std::vector<Direction*> open;
        for (std::vector<Direction>& of_light : of_lights)
            for (Direction& direction : of_light)
                if (!direction.is_done())
                    open.push_back(&direction);
        return open;
    };
    for (auto open = open_ones(); !open.empty(); open = open_ones()) {
        seen([&](const SeenSegment& segment) {
            for (Direction* direction : open)
                direction->look_at(segment);
        });
        for (Direction* direction : open)
            direction->go_on();
    }
    std::vector<std::vector<LightFrame>> frames(of_lights.size());
    for (std::size_t i = 0; i < frames.size(); ++i)
        for (Direction& direction : of_lights[i])
            for (LightFrame& frame : direction.take())
                frames[i].push_back(frame);
    return frames;
}

} // namespace vera
