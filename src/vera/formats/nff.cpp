// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/nff.h"

#include "vera/formats/mesh_builder.h"
#include "vera/formats/nff_mapping.h"
#include "vera/formats/reserve_room.h"
#include "vera/formats/source_report.h"
#include "vera/formats/text_cursor.h"
#include "vera/scene/polygon_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

namespace vera {

namespace {

class NffReader {
public:
    explicit NffReader(const SourceText& source)
        : report_(source)
        , cursor_(report_, TextCursor::Lines::newlines_and_comments_are_blanks)
        , spent_(source) {
        scene_.files.push_back(source.name());
        scene_.defaults.depth = nff_depth;
    }

    SceneFile read() {
        reserve();
        for (cursor_.skip_blanks(); !cursor_.at_end() && !report_.full(); cursor_.skip_blanks()) {
            start_ = cursor_.offset();
            if (!read_statement())
                skip_to_statement();
            spent_.up_to(start_);
        }
        finish_lights();
        if (scene_.geometry.items.empty() && !report_.any_error())
            report_.error(
                report_.source().text().size(),
                1,
                "the scene holds nothing to be seen",
                "an NFF scene consists of the statements v, b, l, f, c, s, p and pp");
        warn();
        SceneFile file;
        report_.finish(file.warnings);
        number_primitives(scene_);
        file.scene = std::move(scene_);
        return file;
    }

private:
    /// Counts beforehand, by the lines' first letters, so that little has to be copied while the
    /// scene grows.
    void reserve() {
        std::size_t spheres = 0;
        std::size_t cones = 0;
        std::size_t polygons = 0;
        std::size_t triangles = 0;
        std::size_t patches = 0;
        std::size_t corners = 0;
        bool in_polygon = false;
        for (TextCursor counter = cursor_; !counter.at_end(); counter.skip_line()) {
            const std::string_view word = counter.word();
            spheres += word == "s" ? 1 : 0;
            cones += word == "c" ? 1 : 0;
            if (!word.empty() && word.front() >= 'a')
                in_polygon = false;
            corners += in_polygon ? 1 : 0;
            if (word != "p" && word != "pp")
                continue;
            counter.pass(word);
            counter.skip_blanks_of_line();
            const bool three = counter.word() == "3";
            ++(word == "pp" ? patches : three ? triangles : polygons);
            in_polygon = word == "p" && !three;
        }
        Geometry& geometry = scene_.geometry;
        reserve_room(geometry.spheres, spheres);
        reserve_room(geometry.rotational_shapes, cones);
        reserve_room(geometry.polygons, polygons);
        reserve_room(geometry.corners, corners);
        reserve_room(geometry.triangles, triangles);
        reserve_room(geometry.patches, patches);
        reserve_room(geometry.items, spheres + cones + polygons + triangles + patches);
    }

    /// Whether the statement could be read to its end.
    bool read_statement() {
        const std::string_view keyword = cursor_.word();
        if (keyword == "s")
            return pass(keyword) && read_sphere();
        if (keyword == "c")
            return pass(keyword) && read_cone();
        if (keyword == "p")
            return pass(keyword) && read_polygon();
        if (keyword == "pp")
            return pass(keyword) && read_patch();
        if (keyword == "f")
            return pass(keyword) && read_fill();
        if (keyword == "l")
            return pass(keyword) && read_light();
        if (keyword == "b")
            return pass(keyword) && read_background();
        if (keyword == "v")
            return pass(keyword) && read_view();
        cursor_.expected(
            "a statement: v, b, l, f, c, s, p or pp",
            "the Neutral File Format of the Standard Procedural Databases is read here, without "
            "its extensions");
        return false;
    }

    bool pass(std::string_view keyword) {
        cursor_.pass(keyword);
        return true;
    }

    /// After a mistake: to the next line that does not go on with numbers or with the view.
    void skip_to_statement() {
        constexpr std::string_view parts[] = {
            "from", "at", "up", "angle", "hither", "yon", "resolution"};
        bool goes_on = true;
        while (goes_on) {
            cursor_.skip_line();
            cursor_.skip_blanks();
            const std::string_view word = cursor_.word();
            goes_on = !word.empty()
                && (std::string_view("+-.0123456789").find(word.front()) != std::string_view::npos
                    || std::find(std::begin(parts), std::end(parts), word) != std::end(parts));
        }
    }

    bool read_view() {
        NffView view;
        bool has_from = false;
        bool has_at = false;
        bool has_up = false;
        bool has_angle = false;
        while (true) {
            cursor_.skip_blanks();
            const std::string_view word = cursor_.word();
            double unused = 0;
            bool good = true;
            if (word == "from")
                has_from = good = pass(word) && cursor_.take_point(view.from, "the view's 'from'");
            else if (word == "at")
                has_at = good = pass(word) && cursor_.take_point(view.at, "the view's 'at'");
            else if (word == "up")
                has_up = good = pass(word) && cursor_.take_point(view.up, "the view's 'up'");
            else if (word == "angle")
                has_angle = good =
                    pass(word) && cursor_.take_number(view.angle_degrees, "", "the view's angle");
            else if (word == "hither" || word == "yon")
                good = pass(word) && cursor_.take_number(unused, "", "the distance of the plane");
            else if (word == "resolution")
                good = pass(word) && take_resolution(view.width, "the width of the resolution")
                    && take_resolution(view.height, "the height of the resolution");
            else
                break;
            if (!good)
                return false;
        }
        for (const auto& [has, name] :
             {std::pair(has_from, "from"), {has_at, "at"}, {has_up, "up"}, {has_angle, "angle"}})
            if (!has) {
                complain(
                    fmt::format("the view lacks '{}'", name),
                    "a view says: v from x y z at x y z up x y z angle a hither h resolution w h");
                return true;
            }
        use(view);
        return true;
    }

    void use(const NffView& view) {
        if (scene_.camera)
            complain("the view is given twice", "delete one of the statements v");
        scene_.camera = camera_of(view);
        scene_.defaults.width = view.width;
        scene_.defaults.height = view.height;
        if (!scene_.camera)
            complain(
                "the view is degenerate",
                "'from' and 'at' must differ, 'up' must not be parallel to the way from one to the "
                "other, and the angle lie between 0 and 180 degrees");
    }

    bool take_resolution(std::uint32_t& pixels, std::string_view what) {
        cursor_.skip_blanks();
        const std::size_t start = cursor_.offset();
        double number = 0;
        if (!cursor_.take_number(number, "", what))
            return false;
        constexpr double most = 0x1p31;
        if (number >= 1 && number <= most && number == std::floor(number)) {
            pixels = static_cast<std::uint32_t>(number);
            return true;
        }
        report_.error(
            start,
            cursor_.offset() - start,
            fmt::format("{} must be a whole number from 1 to 2147483648", what));
        return false;
    }

    bool take_color(Color& color, std::string_view what) {
        return cursor_.take_number(color.r, "the red of ", what)
            && cursor_.take_number(color.g, "the green of ", what)
            && cursor_.take_number(color.b, "the blue of ", what);
    }

    bool read_background() {
        Color color;
        if (!take_color(color, "the background"))
            return false;
        if (scene_.defaults.firmament)
            complain("the background is given twice", "delete one of the statements b");
        scene_.defaults.firmament = Firmament{.sky = color, .horizon = color, .earth = color};
        return true;
    }

    bool read_light() {
        PointLight light;
        light.falloff = Falloff::none;
        if (!cursor_.take_point(light.position, "the light"))
            return false;
        const bool colored = !cursor_.at_line_end();
        if (colored && !take_color(light.color, "the light"))
            return false;
        scene_.lights.push_back(light);
        if (!colored)
            white_lights_.push_back(scene_.lights.size() - 1);
        return true;
    }

    /// How bright the lights without a colour are, follows from how many lights there are.
    void finish_lights() {
        for (const std::size_t i : white_lights_)
            scene_.lights[i].intensity = 1 / std::sqrt(static_cast<double>(scene_.lights.size()));
    }

    bool read_fill() {
        NffFill fill;
        const bool good = take_color(fill.color, "the surface")
            && cursor_.take_number(fill.kd, "", "the Kd of the surface")
            && cursor_.take_number(fill.ks, "", "the Ks of the surface")
            && cursor_.take_number(fill.shine, "", "the Shine of the surface")
            && cursor_.take_number(fill.transmittance, "", "the T of the surface")
            && cursor_.take_number(fill.index, "", "the index of refraction of the surface");
        if (!good)
            return false;
        const std::array<double, 8> key = {
            fill.color.r,
            fill.color.g,
            fill.color.b,
            fill.kd,
            fill.ks,
            fill.shine,
            fill.transmittance,
            fill.index};
        const auto next = static_cast<std::uint32_t>(scene_.materials.size());
        const auto [known, is_new] = materials_.try_emplace(key, MaterialId{next});
        if (is_new) {
            scene_.materials.push_back(material_of(fill));
            scene_.materials.back().name = fmt::format("f{}", next + 1);
            if (fill.transmittance != 0 && !(fill.index > 0))
                without_index_.add(start_);
        }
        material_ = known->second;
        return true;
    }

    bool read_sphere() {
        Sphere sphere;
        if (!cursor_.take_point(sphere.center, "the sphere's center")
            || !cursor_.take_number(sphere.radius, "", "the sphere's radius"))
            return false;
        sphere.radius = std::abs(sphere.radius);
        if (sphere.radius > 0)
            add(scene_.geometry.spheres, sphere, ItemKind::sphere);
        else
            without_area_.add(start_);
        return true;
    }

    bool read_cone() {
        NffCone cone;
        const bool good = cursor_.take_point(cone.base, "the cone's base")
            && cursor_.take_number(cone.base_radius, "", "the radius of the cone's base")
            && cursor_.take_point(cone.apex, "the cone's apex")
            && cursor_.take_number(cone.apex_radius, "", "the radius of the cone's apex");
        if (!good)
            return false;
        auto shape = shape_of(cone);
        if (shape)
            add(scene_.geometry.rotational_shapes, std::move(*shape), ItemKind::rotational_shape);
        else
            without_area_.add(start_);
        return true;
    }

    bool take_corner_count(std::uint64_t& count) {
        cursor_.skip_blanks();
        const std::size_t start = cursor_.offset();
        double number = 0;
        if (!cursor_.take_number(number, "", "the number of corners"))
            return false;
        if (number >= 0 && number < 0x1p32 && number == std::floor(number)) {
            count = static_cast<std::uint64_t>(number);
            return true;
        }
        report_.error(
            start,
            cursor_.offset() - start,
            "the number of corners must be a whole number, 3 or more");
        return false;
    }

    bool take_corners(std::uint64_t count, bool with_normals) {
        corners_.clear();
        normals_.clear();
        for (std::uint64_t i = 0; i < count; ++i) {
            Vec3 corner;
            Vec3 normal;
            if (!cursor_.take_point(corner, "the corner")
                || (with_normals && !cursor_.take_point(normal, "the normal")))
                return false;
            corners_.push_back(corner);
            normals_.push_back(normal);
        }
        return true;
    }

    bool read_polygon() {
        std::uint64_t count = 0;
        if (!take_corner_count(count) || !take_corners(count, false))
            return false;
        if (count < 3 || doubled_area_vector(corners_) == Vec3{}) {
            without_area_.add(start_);
            return true;
        }
        OutlineKind kind = OutlineKind::convex;
        triangles_.assign({{0, 1, 2}});
        if (count > 3)
            kind = split_polygon(corners_, triangles_);
        if (count > 3 && kind != OutlineKind::tangled && is_plane()) {
            add_polygon(kind);
            return true;
        }
        if (kind == OutlineKind::tangled)
            tangled_.add(start_);
        else if (count > 3)
            bent_.add(start_);
        add_triangles([&](const CornerTriple& t) {
            add(scene_.geometry.triangles,
                Triangle{{corners_[t[0]], corners_[t[1]], corners_[t[2]]}},
                ItemKind::triangle);
        });
        return true;
    }

    /// Whether all corners lie in the plane of the polygon: within a millionth of its extent, as
    /// in the VERA language.
    bool is_plane() const {
        const Vec3 normal = normalized(doubled_area_vector(corners_));
        Box3 box;
        double lowest = 0;
        double highest = 0;
        for (const Vec3& corner : corners_) {
            const double height = dot(corner - corners_[0], normal);
            lowest = std::min(lowest, height);
            highest = std::max(highest, height);
            box = grown(box, corner);
        }
        return highest - lowest <= 1e-6 * max_component(extent(box));
    }

    void add_polygon(OutlineKind kind) {
        Polygon polygon;
        auto& corners = scene_.geometry.corners;
        if (corners.size() + corners_.size() > MeshBuilder::most_triangles) {
            complain("the scene is too large: more than 4294967294 corners", "split it");
            return;
        }
        polygon.first_corner = static_cast<std::uint32_t>(corners.size());
        polygon.corner_count = static_cast<std::uint32_t>(corners_.size());
        polygon.shape =
            kind == OutlineKind::convex ? Polygon::Shape::convex : Polygon::Shape::simple;
        polygon.normal = normalized(doubled_area_vector(corners_));
        corners.insert(corners.end(), corners_.begin(), corners_.end());
        add(scene_.geometry.polygons, polygon, ItemKind::polygon);
    }

    bool read_patch() {
        std::uint64_t count = 0;
        if (!take_corner_count(count) || !take_corners(count, true))
            return false;
        triangles_.clear();
        if (count == 3)
            triangles_.push_back({0, 1, 2});
        else if (count > 3 && split_polygon(corners_, triangles_) == OutlineKind::tangled)
            tangled_.add(start_);
        add_triangles([&](const CornerTriple& t) {
            add(scene_.geometry.patches,
                Patch{
                    {corners_[t[0]], corners_[t[1]], corners_[t[2]]},
                    {normals_[t[0]], normals_[t[1]], normals_[t[2]]}},
                ItemKind::patch);
        });
        return true;
    }

    /// Those of the polygon's triangles that have an area.
    template <typename Add>
    void add_triangles(const Add& add_one) {
        bool any = false;
        for (const CornerTriple& t : triangles_)
            if (!is_without_area(corners_[t[0]], corners_[t[1]], corners_[t[2]])) {
                add_one(t);
                any = true;
            }
        if (!any)
            without_area_.add(start_);
    }

    template <typename Primitive>
    void add(std::vector<Primitive>& primitives, Primitive primitive, ItemKind kind) {
        auto& items = scene_.geometry.items;
        if (items.size() >= MeshBuilder::most_triangles) {
            complain("the scene is too large: more than 4294967294 primitives", "split it");
            return;
        }
        const std::string_view text = report_.source().text();
        line_ += static_cast<std::uint64_t>(std::count(
            text.begin() + static_cast<std::ptrdiff_t>(line_counted_to_),
            text.begin() + static_cast<std::ptrdiff_t>(start_),
            '\n'));
        line_counted_to_ = start_;
        if (material_ == inherited_material)
            without_material_.add(start_);
        items.push_back(
            {.kind = kind,
             .outside = Outside::by_normal,
             .file = 0,
             .index = static_cast<std::uint32_t>(primitives.size()),
             .material = material_,
             .line = static_cast<std::uint32_t>(std::min<std::uint64_t>(line_, 0xffffffffU))});
        primitives.push_back(std::move(primitive));
    }

    /// Of the statement as a whole.
    void complain(std::string problem, const char* remedy) {
        report_.error(start_, 1, std::move(problem), remedy);
    }

    void warn() {
        const auto warn_of = [&](const Tally& tally, std::string_view what, const char* remedy) {
            if (tally.count == 1)
                report_.warning(tally.first, 1, std::string(what), remedy);
            else if (tally.count > 1)
                report_.warning(
                    tally.first,
                    1,
                    fmt::format("{} ({} times, the first of them here)", what, tally.count),
                    remedy);
        };
        warn_of(without_area_, "what has no area is left out", "");
        warn_of(tangled_, "the sides of a polygon cross: it is split as well as may be", "");
        warn_of(
            bent_, "the corners of a polygon are not in a plane: it is split into triangles", "");
        warn_of(
            without_material_,
            "nothing says what the surface is like: DRF 0.7 0.7 0.7 is used",
            "write a statement f above it");
        warn_of(
            without_index_,
            "a transparent surface has no index of refraction: 1 is used",
            "write a positive number at the end of the statement f");
    }

    SourceReport report_;
    TextCursor cursor_;
    SpentText spent_;
    Scene scene_;
    std::size_t start_ = 0; ///< of the statement
    std::size_t line_counted_to_ = 0;
    std::uint64_t line_ = 1; ///< of the byte counted to
    MaterialId material_ = inherited_material;
    std::map<std::array<double, 8>, MaterialId> materials_;
    std::vector<std::size_t> white_lights_;
    std::vector<Vec3> corners_;
    std::vector<Vec3> normals_;
    std::vector<CornerTriple> triangles_;
    Tally without_area_;
    Tally tangled_;
    Tally bent_;
    Tally without_material_;
    Tally without_index_;
};

} // namespace

SceneFile read_nff(const SourceText& source) {
    return NffReader(source).read();
}

} // namespace vera
