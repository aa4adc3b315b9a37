// SPDX-License-Identifier: Apache-2.0
// Checks what is seen of a scene, and what drawings of it in style ids show, at random points by
// asking every triangle. bench/drawings/faces runs it and tells what its numbers mean.
#include "vera/base/random.h"
#include "vera/exact/front_order.h"
#include "vera/formats/control_file.h"
#include "vera/formats/read_scene.h"
#include "vera/scene/framing.h"
#include "vera/visible/brute_force.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/map_locator.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/projection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace vera {

namespace {

struct Request {
    std::string scene;
    std::string control; ///< or empty
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::size_t points = 0;
    VisibilityEngine engine = VisibilityEngine::cells;
    std::vector<std::string> files; ///< the areas of drawings
};

/// The scene on the grid as `vera draw --style ids` sees it: sources are primitives.
struct GridScene {
    ScreenScene screen;
    std::uint32_t sources = 0;
    std::vector<std::uint64_t> primitives; ///< of each source
};

Camera camera_of(const Scene& scene, const PictureSettings& settings) {
    const FrameSettings frame = {
        .width = settings.width,
        .height = settings.height,
        .margin = settings.frame_margin.value_or(FrameSettings().margin),
        .pixel_aspect = settings.pixel_aspect};
    if (!scene.camera)
        return framed_camera(scene, frame);
    return settings.frame_margin ? reframed_camera(scene, *scene.camera, frame) : *scene.camera;
}

GridScene grid_scene(const Request& request) {
    SceneFile file = read_scene(request.scene, {});
    PictureSettings settings = file.scene.defaults;
    if (!request.control.empty())
        settings = read_control_file(request.control, file.scene.defaults, file.warnings);
    settings.width = request.width;
    settings.height = request.height;
    const Camera camera = camera_of(file.scene, settings);
    const CameraMap map(camera);
    constexpr double deviation = 0.1; // pixels, as of vera draw
    const Facets all = facets(file.scene, [&](Vec3 point) {
        return deviation * map.size_of_pixel(settings.width, settings.height, point);
    });
    const DrawnFaces faces = drawn_faces(file.scene, all, FaceUnit::primitive, camera);
    GridScene grid;
    grid.screen = screen_scene(all, map, faces.of_facet);
    sort_by_place(grid.screen);
    grid.sources = static_cast<std::uint32_t>(faces.first_facet.size());
    for (const std::uint32_t facet : faces.first_facet)
        grid.primitives.push_back(all.triangles[facet].primitive);
    return grid;
}

/// Two triangles over the whole picture behind everything, of the last source: a hole would show
/// nothing, and all areas together are the picture's.
void add_wall(GridScene& grid) {
    ScreenScene& screen = grid.screen;
    const auto first = static_cast<std::uint32_t>(screen.vertices.size());
    for (const ScreenPoint point :
         {ScreenPoint{0, 0},
          ScreenPoint{screen_size, 0},
          ScreenPoint{screen_size, screen_size},
          ScreenPoint{0, screen_size}})
        screen.vertices.push_back({point, 0});
    add_triangle(screen, {first, first + 1, first + 2}, grid.sources);
    add_triangle(screen, {first, first + 2, first + 3}, grid.sources);
}

/// A point in half steps, odd ones: never a corner.
struct Point {
    std::int64_t x = 0;
    std::int64_t y = 0;

    double step_x() const { return 0.5 * static_cast<double>(x); }

    double step_y() const { return 0.5 * static_cast<double>(y); }
};

/// Random points, found by place.
class Points {
public:
    explicit Points(std::size_t count)
        : side_(static_cast<std::int64_t>(std::sqrt(static_cast<double>(count))) + 1) {
        const auto part = [](std::size_t i, std::uint64_t axis) {
            constexpr std::uint64_t halves = 2 * std::uint64_t{screen_size};
            return static_cast<std::int64_t>(random(1988, i, axis) % halves | 1U);
        };
        std::vector<Point> all(count);
        for (std::size_t i = 0; i < count; ++i)
            all[i] = {part(i, 0), part(i, 1)};
        std::sort(all.begin(), all.end(), [&](const Point& a, const Point& b) {
            return cell_of(a) < cell_of(b);
        });
        starts_.assign(static_cast<std::size_t>(side_ * side_) + 1, 0);
        for (const Point& point : all)
            ++starts_[cell_of(point) + 1];
        for (std::size_t i = 1; i < starts_.size(); ++i)
            starts_[i] += starts_[i - 1];
        points_ = std::move(all);
    }

    std::size_t size() const { return points_.size(); }

    const Point& operator[](std::size_t i) const { return points_[i]; }

    /// Calls visit(number) for those near the triangle, and some beside them.
    template <typename Visit>
    void for_each_near(const std::array<ScreenVertex, 3>& corners, const Visit& visit) const {
        const auto [left, right] =
            std::minmax({corners[0].point.x, corners[1].point.x, corners[2].point.x});
        const auto [top, bottom] =
            std::minmax({corners[0].point.y, corners[1].point.y, corners[2].point.y});
        for (std::int64_t row = index(2 * std::int64_t{top});
             row <= index(2 * std::int64_t{bottom});
             ++row) {
            const auto first =
                static_cast<std::size_t>(row * side_ + index(2 * std::int64_t{left}));
            const auto last =
                static_cast<std::size_t>(row * side_ + index(2 * std::int64_t{right}));
            for (std::size_t i = starts_[first]; i < starts_[last + 1]; ++i)
                visit(i);
        }
    }

private:
    std::int64_t index(std::int64_t halves) const {
        return std::min(halves * side_ / (2 * std::int64_t{screen_size}), side_ - 1);
    }

    std::size_t cell_of(const Point& point) const {
        return static_cast<std::size_t>(index(point.y) * side_ + index(point.x));
    }

    std::int64_t side_;
    std::vector<Point> points_;
    std::vector<std::size_t> starts_;
};

/// What asking every triangle tells of a point.
struct Truth {
    std::uint32_t source = no_source; ///< of the nearest; of as near ones the first
    DoubledNearness nearness = {0, 1};
    double margin = 0; ///< by which the grid may have moved it
    bool is_on_side = false;
};

/// What it tells of the points, and in `claimed` of the triangles of the source that is claimed to
/// be seen at each.
std::vector<Truth> asked_of_all(
    const ScreenScene& scene,
    const Points& points,
    std::span<const std::uint32_t> claims,
    std::vector<Truth>& claimed) {
    std::vector<Truth> nearest(points.size());
    claimed.assign(points.size(), {});
    for (const ScreenTriangle& triangle : scene.triangles) {
        const auto corners = corners_of(scene, triangle);
        const DepthPlane plane = plane_of(scene, triangle);
        const double margin = sure_margin(nearness_slope(plane));
        points.for_each_near(corners, [&](std::size_t i) {
            const Point& at = points[i];
            const int included = inclusion(corners, at.x, at.y);
            if (included < 0)
                return;
            nearest[i].is_on_side = nearest[i].is_on_side || included == 0;
            const Truth here = {
                triangle.source,
                doubled_nearness(plane, at.x, at.y),
                margin,
                nearest[i].is_on_side};
            const auto improve = [&](Truth& best) {
                const int ahead =
                    best.source == no_source ? 1 : order(here.nearness, best.nearness);
                if (ahead > 0 || (ahead == 0 && here.source < best.source))
                    best = here;
            };
            improve(nearest[i]);
            if (triangle.source == claims[i])
                improve(claimed[i]);
        });
    }
    return nearest;
}

double half(const DoubledNearness& nearness) {
    return 0.5 * static_cast<double>(nearness.numerator)
        / static_cast<double>(nearness.denominator);
}

/// How claims compare with the truth.
struct Comparison {
    std::size_t on_side = 0;    ///< points on the side of a triangle: either is right there
    std::size_t coincident = 0; ///< what is claimed is as near, but for what the grid may have
                                ///< done, and comes earlier in the text
    std::size_t close = 0;      ///< the same, and it comes later
    std::size_t near_side = 0;  ///< what was cut at new corners on the grid ends within some steps
    std::size_t wrong = 0;
    nlohmann::ordered_json first_wrong;
};

Comparison compared(
    const ScreenScene& scene,
    const Points& points,
    std::span<const std::uint32_t> claims,
    const MapLocator& locator,
    double reach) {
    std::vector<Truth> claimed;
    const std::vector<Truth> truth = asked_of_all(scene, points, claims, claimed);
    Comparison result;
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (truth[i].is_on_side)
            ++result.on_side;
        else if (claims[i] == truth[i].source)
            continue;
        else if (
            claimed[i].source != no_source && truth[i].source != no_source
            && half(truth[i].nearness) - half(claimed[i].nearness)
                <= truth[i].margin + claimed[i].margin)
            ++(claims[i] < truth[i].source ? result.coincident : result.close);
        else if (
            reach > 0
            && locator.has_side_near(points[i].step_x(), points[i].step_y(), reach, reach))
            ++result.near_side;
        else if (++result.wrong == 1)
            result.first_wrong = {
                {"x", points[i].step_x()},
                {"y", points[i].step_y()},
                {"shown", claims[i]},
                {"is", truth[i].source}};
    }
    return result;
}

nlohmann::ordered_json as_json(const Comparison& found) {
    nlohmann::ordered_json json = {
        {"on_side", found.on_side},
        {"coincident", found.coincident},
        {"close", found.close},
        {"near_side", found.near_side},
        {"wrong", found.wrong}};
    if (found.wrong > 0)
        json["first_wrong"] = found.first_wrong;
    return json;
}

/// A drawing's areas as a map: a line an area, the number of its primitive from 1 on and its rings,
/// each the number of its points and their x and y in pixels.
VisibleMap map_of_file(const Request& request, const std::string& path, const GridScene& grid) {
    std::ifstream file(path);
    if (!file)
        throw std::runtime_error("cannot read " + path);
    VisibleMap map;
    std::uint64_t number = 0;
    std::size_t rings = 0;
    const auto on_grid = [&](double pixels, std::uint32_t size) {
        // Coordinates have some digits behind the point: as fractions of a step they are exact to
        // a billionth of a step.
        constexpr std::int64_t parts = 1'000'000'000;
        const double steps = pixels * screen_size / size;
        if (!(steps >= 0 && steps <= screen_size))
            throw std::runtime_error(path + " shows something beyond the picture");
        const double whole = std::floor(steps);
        return std::pair(
            static_cast<std::int32_t>(whole),
            static_cast<std::int64_t>((steps - whole) * static_cast<double>(parts)));
    };
    while (file >> number >> rings) {
        const auto place =
            std::lower_bound(grid.primitives.begin(), grid.primitives.end(), number - 1);
        if (number == 0 || place == grid.primitives.end() || *place != number - 1)
            throw std::runtime_error(path + " shows a primitive that the scene does not have");
        for (; rings > 0; --rings) {
            VisibleMap::Ring ring;
            ring.source = static_cast<std::uint32_t>(place - grid.primitives.begin());
            ring.first = map.ring_vertices.size();
            file >> ring.count;
            for (std::size_t i = 0; i < ring.count; ++i) {
                double x = 0;
                double y = 0;
                file >> x >> y;
                const auto [column, x_part] = on_grid(x, request.width);
                const auto [row, y_part] = on_grid(y, request.height);
                map.ring_vertices.push_back(static_cast<std::uint32_t>(map.vertices.size()));
                map.vertices.push_back(RationalPoint{{column, row}, x_part, y_part, 1'000'000'000});
            }
            map.rings.push_back(ring);
        }
    }
    return map;
}

/// How far the point is from the nearest side of the map, in pixels; infinite beyond most.
double
distance_to_side(const Request& request, const MapLocator& map, const Point& point, double most) {
    const auto is_near = [&](double pixels) {
        return map.has_side_near(
            point.step_x(),
            point.step_y(),
            pixels * screen_size / request.width,
            pixels * screen_size / request.height);
    };
    if (!is_near(most))
        return std::numeric_limits<double>::infinity();
    double far = most;
    for (double near = 0; far - near > 1e-5;) {
        const double middle = (near + far) / 2;
        (is_near(middle) ? far : near) = middle;
    }
    return far;
}

/// At the points a drawing shows what is claimed, or a side of the map is near.
nlohmann::ordered_json file_compared(
    const Request& request,
    const VisibleMap& drawn,
    const Points& points,
    std::span<const std::uint32_t> claims,
    const MapLocator& map) {
    constexpr double most = 0.01; // pixels
    const MapLocator file(drawn);
    std::size_t differing = 0;
    std::size_t far = 0;
    double farthest = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const MapPlace shown = file.at(points[i].step_x(), points[i].step_y());
        if (shown.is_sound && shown.source == claims[i])
            continue;
        ++differing;
        const double distance = distance_to_side(request, map, points[i], most);
        if (std::isfinite(distance))
            farthest = std::max(farthest, distance);
        else
            ++far;
    }
    return {{"differing", differing}, {"far", far}, {"farthest", farthest}};
}

double area_of(const VisibleMap& map) {
    double area = 0;
    for (const VisibleMap::Ring& ring : map.rings)
        area += 0.5 * doubled_area(map, ring);
    return area;
}

void check(const Request& request) {
    GridScene grid = grid_scene(request);
    GridScene walled = grid;
    add_wall(walled);
    ScreenScene cut = grid.screen;
    const WholePieces whole = whole_pieces(cut, {}, nullptr, request.engine);
    const VisibleMap map = visible_map(cut, whole.pieces);
    const MapLocator locator(map);
    const Points points(request.points);
    std::vector<std::uint32_t> claims(points.size());
    std::size_t unsound = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const MapPlace place = locator.at(points[i].step_x(), points[i].step_y());
        claims[i] = place.source;
        unsound += place.is_sound ? 0 : 1;
    }

    ScreenScene walled_cut = walled.screen;
    const WholePieces walled_whole = whole_pieces(walled_cut, {}, nullptr, request.engine);
    const VisibleMap walled_map = visible_map(walled_cut, walled_whole.pieces);
    const MapLocator walled_locator(walled_map);
    std::size_t holes = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const MapPlace place = walled_locator.at(points[i].step_x(), points[i].step_y());
        const std::uint32_t expected = claims[i] == no_source ? grid.sources : claims[i];
        holes += !place.is_sound || place.source != expected ? 1 : 0;
    }
    const double frame = static_cast<double>(screen_size) * screen_size;

    constexpr double steps = 4; // cut at new corners, each of which is off by one at most
    nlohmann::ordered_json json = {
        {"triangles", grid.screen.triangles.size()},
        {"cut_triangles", cut.triangles.size()},
        {"rounds", whole.rounds},
        {"penetrating", whole.left},
        {"points", points.size()},
        {"unsound", unsound},
        {"map", as_json(compared(cut, points, claims, locator, 0))},
        {"uncut", as_json(compared(grid.screen, points, claims, locator, steps))},
        {"joined", map.joined + walled_map.joined},
        {"holes", holes},
        {"area_error", std::abs(area_of(walled_map) / frame - 1)}};
    for (const std::string& path : request.files)
        json["files"].push_back(
            file_compared(request, map_of_file(request, path, grid), points, claims, locator));
    std::printf("%s\n", json.dump().c_str());
}

} // namespace

} // namespace vera

int main(int count, char** words) {
    const std::string engine = count > 6 ? words[6] : "";
    if (count < 7 || (engine != "cells" && engine != "sweep")) {
        std::fprintf(
            stderr,
            "usage: faces_check SCENE CONTROL|- WIDTH HEIGHT POINTS cells|sweep AREAS...\n");
        return 2;
    }
    vera::Request request;
    request.scene = words[1];
    request.control = words[2] == std::string("-") ? "" : words[2];
    request.width = static_cast<std::uint32_t>(std::atoi(words[3]));
    request.height = static_cast<std::uint32_t>(std::atoi(words[4]));
    request.points = static_cast<std::size_t>(std::atoll(words[5]));
    request.engine =
        engine == "sweep" ? vera::VisibilityEngine::sweep : vera::VisibilityEngine::cells;
    request.files.assign(words + 7, words + count);
    try {
        vera::check(request);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "faces_check: %s\n", error.what());
        return 3;
    }
    return 0;
}
