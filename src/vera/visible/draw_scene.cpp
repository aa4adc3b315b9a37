// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/draw_scene.h"

#include "vera/base/diagnostic.h"
#include "vera/scene/item_names.h"
#include "vera/shade/firmament.h"
#include "vera/shade/lighting.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/outline_strokes.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/projection.h"
#include "vera/visible/seam_strips.h"
#include "vera/visible/shaded_outlines.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace vera {

namespace {

/// What the stages of a drawing have in common.
struct Painted {
    const Scene& scene;
    const Camera& camera;
    const PictureSettings& picture;
    const DrawSettings& settings;
    const Facets& facets;
    const DrawnFaces& faces;
    const VisibleMap& map;
};

DrawingColor as_drawn(Color color) {
    const Color shown = clamped(color);
    const auto byte = [](double value) {
        return static_cast<std::uint8_t>(std::floor(255 * value + 0.5));
    };
    return {byte(shown.r), byte(shown.g), byte(shown.b)};
}

DrawingColor color_of_number(std::uint64_t number) {
    const auto byte = [&](unsigned shift) {
        return static_cast<std::uint8_t>(number >> shift & 0xffU);
    };
    return {byte(16), byte(8), byte(0)};
}

DrawingPoint drawn_point(const Painted& painted, std::uint32_t vertex) {
    const RationalPoint& point = painted.map.vertices[vertex];
    return {
        point.x() * painted.picture.width / screen_size,
        point.y() * painted.picture.height / screen_size};
}

/// What the face gives back towards the viewer at the point of its plane that is seen in the middle
/// of the ring, without shadows and mirrors.
Color light_of_face(const Painted& painted, std::uint32_t face, const VisibleMap::Ring& ring) {
    const Facets::Triangle& facet = painted.facets.triangles[painted.faces.first_facet[face]];
    const Vec3 a = painted.facets.corners[facet.corners[0]];
    const Vec3 normal = normalized(cross(
        painted.facets.corners[facet.corners[1]] - a,
        painted.facets.corners[facet.corners[2]] - a));
    double x = 0;
    double y = 0;
    for (const std::uint32_t vertex : painted.map.vertices_of(ring)) {
        x += painted.map.vertices[vertex].x();
        y += painted.map.vertices[vertex].y();
    }
    const double per_part = 1 / (static_cast<double>(ring.count) * screen_size);
    const Ray ray = view_ray(painted.camera, x * per_part, y * per_part);
    const double speed = dot(normal, ray.direction);
    SurfacePoint surface;
    surface.point = speed == 0 ? a : point_at(ray, dot(normal, a - ray.origin) / speed);
    surface.geometric_normal = surface.shading_normal = normal;
    surface.material = facet.material;
    const Material& material = material_of(painted.scene, facet.material);
    const Incidence at = incidence(surface, ray.direction);
    LocalTerms terms = unlit(at, material, painted.picture.ambient);
    for (const PointLight& light : painted.scene.lights)
        terms += unshadowed(at, material, light);
    return sum(terms);
}

/// Of the item that holds the primitive: what it is, and where it was written.
std::string group_name(const Scene& scene, std::uint64_t primitive) {
    const PrimitivePath path = path_to(scene, primitive);
    const Item& item = path.geometry->items[path.element.item];
    std::string name = name_of(item.kind);
    if (!path.geometry->name.empty())
        name += " of " + path.geometry->name;
    return item.line == 0 ? name : name + ", line " + std::to_string(item.line);
}

/// The rings of one face after the other.
class FaceRings {
public:
    explicit FaceRings(const VisibleMap& map)
        : map_(map) {
        for (std::size_t i = 0; i < map.rings.size(); ++i)
            if (i == 0 || map.rings[i].source != map.rings[i - 1].source)
                starts_.push_back(i);
        starts_.push_back(map.rings.size());
    }

    std::size_t count() const { return starts_.size() - 1; }

    std::span<const VisibleMap::Ring> operator[](std::size_t number) const {
        return std::span(map_.rings)
            .subspan(starts_[number], starts_[number + 1] - starts_[number]);
    }

    /// Of a face that is seen.
    std::span<const VisibleMap::Ring> of_face(std::uint32_t face) const {
        const auto found = std::lower_bound(
            starts_.begin(), starts_.end() - 1, face, [&](std::size_t start, std::uint32_t value) {
                return map_.rings[start].source < value;
            });
        return (*this)[static_cast<std::size_t>(found - starts_.begin())];
    }

private:
    const VisibleMap& map_;
    std::vector<std::size_t> starts_;
};

std::size_t vertex_count(std::span<const VisibleMap::Ring> rings) {
    std::size_t count = 0;
    for (const VisibleMap::Ring& ring : rings)
        count += ring.count;
    return count;
}

void add_rings(
    const Painted& painted, std::span<const VisibleMap::Ring> rings, FilledOutline& outline) {
    for (const VisibleMap::Ring& ring : rings) {
        std::vector<DrawingPoint>& points = outline.rings.emplace_back();
        points.reserve(ring.count);
        for (const std::uint32_t vertex : painted.map.vertices_of(ring))
            points.push_back(drawn_point(painted, vertex));
    }
}

/// Where two faces meet, what smooths edges lets through what lies behind both. So a face goes on
/// below those beside it that are painted later: all of them where they are small, which moves no
/// silhouette; else a strip.
void cover_seams(
    const Painted& painted,
    const FaceRings& all,
    std::span<const VisibleMap::Ring> own,
    FilledOutline& outline) {
    constexpr std::size_t small = 16;
    std::vector<std::uint32_t> below;
    const std::size_t own_rings = outline.rings.size();
    for (std::size_t i = 0; i < own_rings; ++i) {
        const std::vector<DrawingPoint> points = outline.rings[i];
        for (std::size_t j = 0; j < points.size(); ++j) {
            const std::uint32_t across = painted.map.ring_across[own[i].first + j];
            if (across == no_source || across <= own[i].source)
                continue;
            const auto others = all.of_face(across);
            if (vertex_count(others) > small) {
                outline.seams.push_back({points[j], points[j + 1 == points.size() ? 0 : j + 1]});
            } else if (std::find(below.begin(), below.end(), across) == below.end()) {
                below.push_back(across);
                add_rings(painted, others, outline);
            }
        }
    }
}

/// The same for areas that change their colours from place to place: a face goes on below those
/// beside it only close to their common border, whatever their size.
void cover_seams_closely(
    const Painted& painted,
    const FaceRings& all,
    std::span<const VisibleMap::Ring> own,
    FilledOutline& outline) {
    constexpr std::size_t most_corners = 1024; // of a neighbour: else strips take too long
    const std::size_t own_rings = outline.rings.size();
    for (std::size_t i = 0; i < own_rings; ++i) {
        std::vector<DrawingPoint> points = outline.rings[i];
        points.push_back(points.front());
        const auto across = [&](std::size_t side) {
            return painted.map.ring_across[own[i].first + side];
        };
        for (std::size_t side = 0, end = 0; side + 1 < points.size(); side = end) {
            for (end = side + 1; end + 1 < points.size() && across(end) == across(side);)
                ++end;
            if (across(side) == no_source || across(side) <= own[i].source)
                continue;
            const std::span border = std::span(points).subspan(side, end - side + 1);
            const auto others = all.of_face(across(side));
            if (vertex_count(others) > most_corners) {
                outline.seams.emplace_back(border.begin(), border.end());
                continue;
            }
            FilledOutline neighbour;
            add_rings(painted, others, neighbour);
            std::ranges::move(
                seam_strips(border, neighbour.rings), std::back_inserter(outline.rings));
        }
    }
}

DrawingColor
color_of(const Painted& painted, std::uint32_t face, std::span<const VisibleMap::Ring> rings) {
    const Facets::Triangle& facet = painted.facets.triangles[painted.faces.first_facet[face]];
    if (painted.settings.style == DrawingStyle::ids)
        return color_of_number(facet.primitive + 1);
    const auto largest =
        std::max_element(rings.begin(), rings.end(), [&](const auto& a, const auto& b) {
            return doubled_area(painted.map, a) < doubled_area(painted.map, b);
        });
    return as_drawn(light_of_face(painted, face, *largest));
}

/// The firmament and, on it, the outlines as the light shades them.
void add_shaded(
    const Painted& painted,
    std::vector<LitOutline> lit,
    const CancelFlag* cancel,
    Drawing& drawing) {
    const PaintTolerance tolerance = {painted.settings.color_tolerance, painted.settings.deviation};
    DrawnFirmament firmament = drawn_firmament(painted.camera, painted.picture, tolerance);
    drawing.background = firmament.background;
    drawing.fills = std::move(firmament.sky);
    std::ranges::move(
        shaded_outlines(
            std::move(lit),
            {painted.scene, painted.camera, painted.picture, painted.facets, tolerance, cancel}),
        std::back_inserter(drawing.fills));
}

void add_fills(const Painted& painted, const CancelFlag* cancel, Drawing& drawing) {
    const bool shaded = painted.settings.style == DrawingStyle::shaded;
    std::vector<LitOutline> lit;
    const FaceRings all(painted.map);
    std::uint64_t grouped = 0;
    std::string group;
    for (std::size_t number = 0; number < all.count(); ++number) {
        const auto own = all[number];
        const std::uint32_t face = own.front().source;
        const std::uint32_t facet = painted.faces.first_facet[face];
        const std::uint64_t primitive = painted.facets.triangles[facet].primitive;
        if (group.empty() || primitive != grouped)
            group = group_name(painted.scene, primitive);
        grouped = primitive;
        FilledOutline outline;
        outline.id = "face-" + std::to_string(primitive + 1);
        outline.group = group;
        if (!shaded)
            outline.color = color_of(painted, face, own);
        add_rings(painted, own, outline);
        // Numbers are to be compared, not looked at.
        if (shaded)
            cover_seams_closely(painted, all, own, outline);
        else if (painted.settings.style != DrawingStyle::ids)
            cover_seams(painted, all, own, outline);
        if (shaded)
            lit.push_back({std::move(outline), own.size(), facet});
        else
            drawing.fills.push_back(std::move(outline));
    }
    if (shaded)
        add_shaded(painted, std::move(lit), cancel, drawing);
}

std::optional<DrawingColor> background(const Painted& painted) {
    switch (painted.settings.style) {
    case DrawingStyle::ids:
        return color_of_number(0);
    case DrawingStyle::flat:
        return as_drawn(firmament_color(
            painted.picture.firmament, view_ray(painted.camera, 0.5, 0.5).direction));
    case DrawingStyle::shaded: // painted with its outlines
    case DrawingStyle::lines:
        break;
    }
    return std::nullopt;
}

FaceUnit unit_of(DrawingStyle style) {
    if (style == DrawingStyle::ids)
        return FaceUnit::primitive;
    return style == DrawingStyle::shaded ? FaceUnit::smooth : FaceUnit::plane;
}

void check_numbers(const Facets& facets) {
    constexpr std::uint64_t most = (std::uint64_t{1} << 24U) - 1;
    if (facets.triangles.empty() || facets.triangles.back().primitive < most)
        return;
    Diagnostic problem;
    problem.problem = "style ids can tell 16 777 215 primitives apart, and the scene has more";
    problem.remedy = "draw a part of it, or take another style";
    throw InputError({problem});
}

} // namespace

DrawnScene draw_scene(
    const Scene& scene,
    const Camera& camera,
    const PictureSettings& picture,
    const DrawSettings& settings,
    const Progress& progress,
    const CancelFlag* cancel) {
    const CameraMap camera_map(camera);
    const auto deviation = [&](Vec3 point) {
        return settings.deviation * camera_map.size_of_pixel(picture.width, picture.height, point);
    };
    const Facets all = facets(scene, deviation, cancel);
    if (settings.style == DrawingStyle::ids)
        check_numbers(all);
    const DrawnFaces faces = drawn_faces(scene, all, unit_of(settings.style), camera);
    ScreenScene screen = screen_scene(all, camera_map, faces.of_facet);
    sort_by_place(screen);
    const WholePieces whole = whole_pieces(screen, progress, cancel);
    const VisibleMap map = visible_map(screen, whole.pieces);

    const Painted painted = {scene, camera, picture, settings, all, faces, map};
    DrawnScene drawn;
    drawn.facets = all.triangles.size();
    drawn.cut_rounds = static_cast<std::size_t>(whole.rounds - 1);
    drawn.penetrating = whole.left;
    drawn.cut_nearness = screen.cut_nearness;
    drawn.drawing.width = picture.width;
    drawn.drawing.height = picture.height;
    drawn.drawing.background = background(painted);
    if (settings.style == DrawingStyle::lines)
        add_strokes({scene, all, faces, screen, whole.pieces, map}, picture, drawn.drawing);
    else
        add_fills(painted, cancel, drawn.drawing);
    for (std::size_t i = 0; i < map.rings.size(); ++i)
        drawn.visible_faces += i == 0 || map.rings[i].source != map.rings[i - 1].source ? 1 : 0;
    return drawn;
}

} // namespace vera
