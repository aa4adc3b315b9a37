// SPDX-License-Identifier: Apache-2.0
#include "vera/theory/central_queries.h"

#include "vera/base/available_memory.h"
#include "vera/base/progress_part.h"
#include "vera/scene/camera.h"
#include "vera/visible/drawing_memory.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/projection.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace vera {

namespace {

Vec3 unit(std::size_t axis) {
    Vec3 result;
    result[axis] = 1;
    return result;
}

/// Looks from the origin through that face of the cube, of which the sides are 2.
Camera camera_of_face(std::size_t face) {
    const std::size_t axis = face / 2;
    const Vec3 forward = (face % 2 == 0 ? 1.0 : -1.0) * unit(axis);
    const Vec3 across = unit((axis + 1) % 3);
    const Vec3 up = unit((axis + 2) % 3);
    Camera camera;
    camera.lower_left = forward - across - up;
    camera.lower_right = forward + across - up;
    camera.upper_left = forward - across + up;
    return camera;
}

/// A map ends where the next one begins: on the edge itself it shows what lies within.
double inset(double at) {
    constexpr double least = 0x1p-20;
    constexpr double most = screen_size - least;
    return std::clamp(at, least, most);
}

/// A grid where the map is none for the others: hardly ever, and where faces penetrate each other.
std::unique_ptr<RegionLocator>
locator_of(LocatorKind kind, const VisibleMap& map, const CancelFlag* cancel) {
    try {
        return make_locator(kind, map, cancel);
    } catch (const CrossingBorders&) {
        return make_locator(LocatorKind::grid, map, cancel);
    }
}

/// The facets as seen from the center. Not by a camera that stands there: the corners of its
/// picture would be rounded with the coordinates of the scene.
Facets moved_to_origin(const Facets& facets, Vec3 center) {
    Facets moved;
    moved.corners.reserve(facets.corners.size());
    for (std::size_t i = 0; i < facets.corners.size(); ++i)
        moved.corners.push_back(facets.corners[i] - center);
    moved.triangles = facets.triangles;
    return moved;
}

} // namespace

std::optional<CubePlace> cube_place(Vec3 direction) {
    const Vec3 size = abs(direction);
    std::size_t axis = size.y > size.x ? 1 : 0;
    axis = size.z > size[axis] ? 2 : axis;
    const double across = direction[(axis + 1) % 3] / size[axis];
    const double up = direction[(axis + 2) % 3] / size[axis];
    if (!std::isfinite(across) || !std::isfinite(up))
        return std::nullopt;
    constexpr double half = 0.5 * screen_size;
    return CubePlace{
        2 * axis + (direction[axis] < 0 ? 1 : 0), half + half * across, half - half * up};
}

CentralQueries::CentralQueries(
    const Facets& facets,
    Vec3 center,
    LocatorKind kind,
    const Progress& progress,
    const CancelFlag* cancel) {
    const Facets moved = moved_to_origin(facets, center);
    std::vector<std::uint32_t> sources(facets.triangles.size());
    std::iota(sources.begin(), sources.end(), 0U);
    const auto expect = [&](double pieces) {
        require_memory(
            piece_bytes(pieces) + locator_bytes(kind, 2 * pieces),
            "what is seen from one point in one of six directions",
            "a scene with fewer faces has fewer borders, and --strategy rays needs none");
    };
    StageProgress stages(progress, 7 * cube_face_count);
    for (std::size_t face = 0; face < cube_face_count; ++face) {
        ScreenScene screen = screen_scene(
            moved,
            CameraMap(camera_of_face(face)),
            sources,
            std::numeric_limits<double>::infinity(),
            cancel);
        cut_distance_ = std::max(cut_distance_, screen.cut_nearness);
        sort_by_place(screen, cancel);
        WholePieces whole =
            whole_pieces(screen, stages.next(4), cancel, VisibilityEngine::cells, expect);
        penetrating_ += whole.left;
        borders_ += whole.pieces.pieces.size();
        const VisibleMap map = visible_map(
            std::move(screen),
            std::move(whole.pieces),
            RingDetail::with_across,
            stages.next(1),
            cancel);
        stages.next(2);
        faces_[face].locator = locator_of(kind, map, cancel);
        faces_[face].facets.reserve(map.regions.size());
        for (const VisibleMap::Region& region : map.regions)
            faces_[face].facets.push_back(region.source);
    }
}

std::optional<std::uint32_t>
CentralQueries::first_facet(Vec3 direction, LocatorSteps& steps) const {
    const auto place = cube_place(direction);
    if (!place)
        return std::nullopt;
    const Face& face = faces_[place->face];
    const std::uint32_t region =
        face.locator->region_at(map_point(inset(place->x), inset(place->y)), steps);
    if (region == no_region)
        return std::nullopt;
    return face.facets[region];
}

std::size_t CentralQueries::memory() const {
    std::size_t bytes = sizeof(*this);
    for (const Face& face : faces_)
        bytes += face.locator->memory() + face.facets.capacity() * sizeof(std::uint32_t);
    return bytes;
}

} // namespace vera
