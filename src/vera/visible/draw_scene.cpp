// SPDX-License-Identifier: Apache-2.0
#include "vera/visible/draw_scene.h"

#include "vera/base/diagnostic.h"
#include "vera/base/progress_part.h"
#include "vera/scene/item_names.h"
#include "vera/shade/firmament.h"
#include "vera/shade/lighting.h"
#include "vera/visible/covered_areas.h"
#include "vera/visible/drawn_faces.h"
#include "vera/visible/outline_strokes.h"
#include "vera/visible/penetrations.h"
#include "vera/visible/projection.h"
#include "vera/visible/seam_strips.h"
#include "vera/visible/shaded_outlines.h"
#include "vera/visible/shadows.h"
#include "vera/visible/tones.h"
#include "vera/visible/visible_map.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
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
/// of the ring, without mirrors.
Color light_of_face(const Painted& painted, std::uint32_t face, const VisibleMap::Ring& ring) {
    const LightSet lights = ~painted.map.regions[ring.region].unlit;
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
    for (std::size_t i = 0; i < painted.scene.lights.size(); ++i)
        if (contains(lights, i))
            terms += unshadowed(at, material, painted.scene.lights[i]);
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

/// The rings of one region after the other.
class RegionRings {
public:
    explicit RegionRings(const VisibleMap& map)
        : map_(map) {
        for (std::size_t i = 0; i < map.rings.size(); ++i)
            if (i == 0 || map.rings[i].region != map.rings[i - 1].region)
                starts_.push_back(i);
        starts_.push_back(map.rings.size());
    }

    std::size_t count() const { return starts_.size() - 1; }

    std::span<const VisibleMap::Ring> operator[](std::size_t region) const {
        return std::span(map_.rings)
            .subspan(starts_[region], starts_[region + 1] - starts_[region]);
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

void add_ring(
    const Painted& painted, std::span<const std::uint32_t> vertices, FilledOutline& outline) {
    std::vector<DrawingPoint>& points = outline.rings.emplace_back();
    points.reserve(vertices.size());
    for (const std::uint32_t vertex : vertices)
        points.push_back(drawn_point(painted, vertex));
}

void add_rings(
    const Painted& painted, std::span<const VisibleMap::Ring> rings, FilledOutline& outline) {
    for (const VisibleMap::Ring& ring : rings)
        add_ring(painted, painted.map.vertices_of(ring), outline);
}

/// Of each face, whether others go on below the whole of it: where it is small, or so narrow that a
/// strip below its border would come out beyond it.
std::vector<bool> covering_whole(const Painted& painted, const RegionRings& all) {
    constexpr std::size_t small = 16;
    constexpr double narrow = 4; // pixels, twice the strip's width
    std::vector<bool> result(all.count());
    for (std::size_t number = 0; number < all.count(); ++number) {
        FilledOutline outline;
        add_rings(painted, all[number], outline);
        double doubled_area = 0;
        double length = 0;
        for (const std::vector<DrawingPoint>& ring : outline.rings)
            for (std::size_t i = 0; i < ring.size(); ++i) {
                const DrawingPoint& a = ring[i];
                const DrawingPoint& b = ring[i + 1 == ring.size() ? 0 : i + 1];
                const double x = b.x - a.x;
                const double y = b.y - a.y;
                doubled_area += (a.x - ring[0].x) * y - (a.y - ring[0].y) * x;
                length += std::sqrt(x * x + y * y);
            }
        result[number] = vertex_count(all[number]) <= small || doubled_area < narrow / 2 * length;
    }
    return result;
}

/// Where two regions meet, what smooths edges lets through what lies behind both. So one goes on
/// below those beside it that are painted later: all of them where they are small or narrow, which
/// moves no silhouette; else a strip.
void cover_seams(
    const Painted& painted,
    const RegionRings& all,
    const std::vector<bool>& is_covering_whole,
    std::span<const VisibleMap::Ring> own,
    FilledOutline& outline) {
    std::vector<std::uint32_t> below;
    const std::size_t own_rings = outline.rings.size();
    for (std::size_t i = 0; i < own_rings; ++i) {
        const std::vector<DrawingPoint> points = outline.rings[i];
        for (std::size_t j = 0; j < points.size(); ++j) {
            const std::uint32_t across = painted.map.ring_across[own[i].first + j];
            if (across == no_region || across <= own[i].region)
                continue;
            if (!is_covering_whole[across]) {
                outline.seams.push_back({points[j], points[j + 1 == points.size() ? 0 : j + 1]});
            } else if (std::find(below.begin(), below.end(), across) == below.end()) {
                below.push_back(across);
                add_rings(painted, all[across], outline);
            }
        }
    }
}

/// Where three or more faces meet within a pixel, some of the background would still come through.
/// So what hangs together is painted as a whole before its faces, in the mean of their colours.
void add_underlays(const Painted& painted, const RegionRings& all, Drawing& drawing) {
    struct Sum {
        double r = 0;
        double g = 0;
        double b = 0;
        double area = 0;
        std::size_t faces = 0;
    };

    const CoveredAreas areas = covered_areas(painted.map);
    std::vector<Sum> sums(areas.outlines.size());
    for (std::size_t number = 0; number < all.count(); ++number) {
        Sum& sum = sums[areas.of_source[all[number].front().source]];
        double area = 0;
        for (const VisibleMap::Ring& ring : all[number])
            area += doubled_area(painted.map, ring);
        const DrawingColor color = drawing.fills[number].color;
        sum.r += area * color.r;
        sum.g += area * color.g;
        sum.b += area * color.b;
        sum.area += area;
        ++sum.faces;
    }
    std::vector<FilledOutline> underlays;
    for (std::size_t i = 0; i < sums.size(); ++i) {
        if (sums[i].faces < 2 || sums[i].area <= 0)
            continue;
        const auto mean = [&](double value) {
            return static_cast<std::uint8_t>(
                std::clamp(std::floor(value / sums[i].area + 0.5), 0.0, 255.0));
        };
        FilledOutline& underlay = underlays.emplace_back();
        underlay.id = "underlay";
        underlay.color = {mean(sums[i].r), mean(sums[i].g), mean(sums[i].b)};
        for (const std::vector<std::uint32_t>& ring : areas.outlines[i])
            add_ring(painted, ring, underlay);
    }
    drawing.fills.insert(
        drawing.fills.begin(),
        std::make_move_iterator(underlays.begin()),
        std::make_move_iterator(underlays.end()));
}

/// The same for areas that change their colours from place to place: a face goes on below those
/// beside it only close to their common border, whatever their size.
void cover_seams_closely(
    const Painted& painted,
    const RegionRings& all,
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
            if (across(side) == no_region || across(side) <= own[i].region)
                continue;
            const std::span border = std::span(points).subspan(side, end - side + 1);
            const auto others = all[across(side)];
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
    const Color light = light_of_face(painted, face, *largest);
    return as_drawn(
        painted.settings.style == DrawingStyle::toon
            ? toned(light, material_of(painted.scene, facet.material))
            : light);
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
    const bool is_shaded = painted.settings.style == DrawingStyle::shaded;
    // Numbers are to be compared, not looked at: the colour says all, and the file stays small.
    const bool is_looked_at = painted.settings.style != DrawingStyle::ids;
    const RegionRings all(painted.map);
    const std::vector<bool> is_covering_whole =
        is_looked_at && !is_shaded ? covering_whole(painted, all) : std::vector<bool>();
    std::vector<LitOutline> lit;
    std::uint64_t grouped = 0;
    std::string group;
    for (std::size_t number = 0; number < all.count(); ++number) {
        const auto own = all[number];
        const std::uint32_t face = own.front().source;
        const std::uint32_t facet = painted.faces.first_facet[face];
        const std::uint64_t primitive = painted.facets.triangles[facet].primitive;
        FilledOutline outline;
        if (!is_shaded)
            outline.color = color_of(painted, face, own);
        if (is_looked_at) {
            if (group.empty() || primitive != grouped)
                group = group_name(painted.scene, primitive);
            grouped = primitive;
            outline.id = "face-" + std::to_string(primitive + 1);
            outline.group = group;
        }
        add_rings(painted, own, outline);
        if (is_shaded)
            cover_seams_closely(painted, all, own, outline);
        else if (is_looked_at)
            cover_seams(painted, all, is_covering_whole, own, outline);
        if (is_shaded)
            lit.push_back(
                {std::move(outline), own.size(), facet, ~painted.map.regions[number].unlit});
        else
            drawing.fills.push_back(std::move(outline));
    }
    if (is_shaded)
        add_shaded(painted, std::move(lit), cancel, drawing);
    else if (is_looked_at)
        add_underlays(painted, all, drawing);
}

std::optional<DrawingColor> background(const Painted& painted) {
    switch (painted.settings.style) {
    case DrawingStyle::ids:
        return color_of_number(0);
    case DrawingStyle::flat:
    case DrawingStyle::toon:
        return as_drawn(firmament_color(
            painted.picture.firmament, view_ray(painted.camera, 0.5, 0.5).direction));
    case DrawingStyle::shaded: // painted with its outlines
    case DrawingStyle::lines:
    case DrawingStyle::hidden_lines:
        break;
    }
    return std::nullopt;
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

std::vector<std::uint64_t> primitives_of(const Facets& facets, const DrawnFaces& faces) {
    std::vector<std::uint64_t> primitives;
    for (const std::uint32_t facet : faces.first_facet)
        primitives.push_back(facets.triangles[facet].primitive);
    return primitives;
}

/// Makes the larger faces the sources, and leaves out the pieces that parted one of them.
void join_sources(
    ScreenScene& screen, VisiblePieces& pieces, const DrawnFaces& before, const DrawnFaces& after) {
    for (ScreenTriangle& triangle : screen.triangles)
        triangle.source = after.of_facet[before.first_facet[triangle.source]];
    const auto source = [&](std::uint32_t triangle) {
        return triangle == no_triangle ? no_source : screen.triangles[triangle].source;
    };
    std::erase_if(pieces.pieces, [&](const VisiblePiece& piece) {
        return source(piece.left) == source(piece.right) && piece.left_unlit == piece.right_unlit;
    });
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
    // Shadows fall on plane faces; these become larger ones after.
    DrawnFaces faces = drawn_faces(
        scene,
        all,
        settings.style == DrawingStyle::ids ? FaceUnit::primitive : FaceUnit::plane,
        camera);
    ScreenScene screen = screen_scene(all, camera_map, faces.of_facet);
    sort_by_place(screen);
    DrawnScene drawn;
    drawn.facets = all.triangles.size();
    drawn.cut_nearness = screen.cut_nearness;
    const bool has_shadows = has_fills(settings.style)
        ? picture.shadows && settings.style != DrawingStyle::ids
        : settings.shadow_lines;
    const std::size_t steps = has_shadows ? 3 : 1;
    WholePieces whole =
        whole_pieces(screen, progress_part(progress, 0, steps), cancel, settings.engine);
    drawn.cut_rounds = static_cast<std::size_t>(whole.rounds - 1);
    drawn.penetrating = whole.left;
    if (has_shadows) {
        const std::size_t surfaces = screen.triangles.size();
        drawn.shadows = add_shadows(
            {scene,
             all,
             faces,
             camera,
             camera_map,
             static_cast<double>(picture.width),
             static_cast<double>(picture.height),
             whole.pieces},
            screen,
            progress_part(progress, 1, steps),
            cancel);
        drawn.lights_without_shadows =
            scene.lights.size() - std::min<std::size_t>(scene.lights.size(), most_lights_of_a_set);
        SceneChange change;
        change.triangles.resize(screen.triangles.size() - surfaces);
        std::iota(
            change.triangles.begin(), change.triangles.end(), static_cast<std::uint32_t>(surfaces));
        whole.pieces = cell_raster_after(
            change, std::move(whole.pieces), screen, progress_part(progress, 2, steps), cancel);
    }
    if (settings.style == DrawingStyle::shaded) {
        DrawnFaces smooth = drawn_faces(scene, all, FaceUnit::smooth, camera);
        join_sources(screen, whole.pieces, faces, smooth);
        faces = std::move(smooth);
    }
    const VisibleMap map = has_lines(settings.style) ? visible_map(screen, whole.pieces)
                                                     : visible_map(screen, std::move(whole.pieces));
    if (settings.check)
        settings.check({map, primitives_of(all, faces), screen.cut_nearness});

    const Painted painted = {scene, camera, picture, settings, all, faces, map};
    drawn.drawing.width = picture.width;
    drawn.drawing.height = picture.height;
    drawn.drawing.background = background(painted);
    if (has_fills(settings.style))
        add_fills(painted, cancel, drawn.drawing);
    if (has_lines(settings.style))
        add_strokes(
            {scene,
             camera,
             camera_map,
             picture,
             all,
             faces,
             screen,
             whole.pieces,
             map,
             settings.deviation},
            {.hidden = settings.style == DrawingStyle::hidden_lines,
             .shadows = settings.shadow_lines},
            drawn.drawing);
    for (std::size_t i = 0; i < map.rings.size(); ++i)
        drawn.visible_faces += i == 0 || map.rings[i].source != map.rings[i - 1].source ? 1 : 0;
    return drawn;
}

} // namespace vera
