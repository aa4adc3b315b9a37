// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/vera_statements.h"

#include "vera/formats/contour_reader.h"
#include "vera/formats/faces.h"
#include "vera/formats/vera_keywords.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace vera {

std::optional<Sphere> read_sphere(WordReader& words) {
    const auto center = words.take_point("the sphere's center");
    if (!center)
        return std::nullopt;
    const WordPlace place = words.place();
    const auto radius = words.take_number("the sphere's radius");
    if (!radius)
        return std::nullopt;
    if (*radius <= 0) {
        words.complaints().error(
            place,
            fmt::format("the sphere's radius is {}, but must be positive", *radius),
            *radius < 0 ? "write it without its sign: the surface is the same" : "");
        return std::nullopt;
    }
    return Sphere{*center, *radius};
}

namespace {

constexpr std::array<const char*, 4> corner_names = {
    "the first corner", "the second corner", "the third corner", "the fourth corner"};
constexpr std::array<const char*, 3> normal_names = {
    "the first corner's normal", "the second corner's normal", "the third corner's normal"};

template <std::size_t Count>
bool take_points(WordReader& words, const char* const* names, std::array<Vec3, Count>& points) {
    for (std::size_t i = 0; i < Count; ++i) {
        const auto point = words.take_point(names[i]);
        if (!point)
            return false;
        points[i] = *point;
    }
    return true;
}

} // namespace

std::optional<Triangle> read_triangle(WordReader& words) {
    Triangle triangle;
    if (!take_points(words, corner_names.data(), triangle.corners))
        return std::nullopt;
    return triangle;
}

std::optional<std::array<Vec3, 4>> read_quadrangle(WordReader& words) {
    std::array<Vec3, 4> corners;
    if (!take_points(words, corner_names.data(), corners))
        return std::nullopt;
    return corners;
}

std::optional<std::vector<Vec3>> read_polygon(WordReader& words) {
    constexpr std::uint64_t most_corners = 0xffffffff;
    const auto count = words.take_whole_number("the number of corners", 3, most_corners);
    if (!count)
        return std::nullopt;
    std::vector<Vec3> corners;
    // The number may be wrong: no more room than the text can fill, six bytes a corner.
    corners.reserve(std::min<std::size_t>(*count, words.rest().size() / 6 + 1));
    for (std::uint64_t i = 0; i < *count; ++i) {
        const auto point = words.take_point("a corner of the polygon");
        if (!point)
            return std::nullopt;
        corners.push_back(*point);
    }
    return corners;
}

std::optional<Patch> read_patch(WordReader& words) {
    Patch patch;
    if (!take_points(words, corner_names.data(), patch.corners)
        || !take_points(words, normal_names.data(), patch.normals))
        return std::nullopt;
    return patch;
}

namespace {

/// P tip | V direction, as a unit vector
std::optional<Vec3> read_axis(WordReader& words, Vec3 base) {
    const std::string_view keyword = words.peek();
    const WordPlace place = words.place();
    if (keyword != "P" && keyword != "V") {
        words.expected("P and the tip of the axis, or V and its direction");
        return std::nullopt;
    }
    words.take();
    if (keyword == "P") {
        const auto tip = words.take_point("the tip of the axis");
        if (!tip)
            return std::nullopt;
        // Halves, whose difference never overflows.
        const Vec3 along = 0.5 * *tip - 0.5 * base;
        if (length(along) > 0)
            return normalized(along);
        words.complaints().error(
            place,
            "the tip of the axis is its base, so that it has no direction",
            "the tip only gives the direction: any other point of the axis will do");
        return std::nullopt;
    }
    const auto direction = words.take_point("the direction of the axis");
    if (!direction)
        return std::nullopt;
    if (length(*direction) > 0)
        return normalized(*direction);
    words.complaints().error(place, "the direction of the axis is 0 0 0");
    return std::nullopt;
}

} // namespace

std::optional<std::vector<RotationalShape>> read_rotational_shapes(WordReader& words) {
    const auto base = words.take_point("the base of the axis");
    if (!base)
        return std::nullopt;
    const auto axis = read_axis(words, *base);
    if (!axis)
        return std::nullopt;
    auto contours = read_contour(words);
    if (!contours)
        return std::nullopt;
    std::vector<RotationalShape> shapes;
    shapes.reserve(contours->size());
    for (Contour& contour : *contours)
        shapes.push_back({*base, *axis, contour.start, std::move(contour.pieces)});
    return shapes;
}

namespace {

/// The three corners of the picture; false, and a complaint, when they are on one line.
bool read_picture_corners(WordReader& words, const WordPlace& keyword, Camera& camera) {
    const auto lower_left = words.take_point("the picture's lower left corner");
    if (!lower_left)
        return false;
    const auto lower_right = words.take_point("the picture's lower right corner");
    if (!lower_right)
        return false;
    const auto upper_left = words.take_point("the picture's upper left corner");
    if (!upper_left)
        return false;
    camera.lower_left = *lower_left;
    camera.lower_right = *lower_right;
    camera.upper_left = *upper_left;
    const std::array<Vec3, 3> corners = {*lower_left, *lower_right, *upper_left};
    if (triangle_normal(corners))
        return true;
    words.complaints().error(
        keyword,
        "the corners of the picture are on one line",
        "the picture is what lies between the lower left, lower right and upper left corners");
    return false;
}

/// Whether a line in this direction is parallel to the picture, as far as rounding can tell.
bool is_parallel_to_picture(const Camera& camera, Vec3 direction) {
    const Vec3 unit = normalized(direction);
    const std::array<Vec3, 3> corners = {camera.lower_left, camera.lower_right, camera.upper_left};
    const auto normal = triangle_normal(corners);
    constexpr double smallest_sine = 1e-12;
    return !normal || !(std::abs(dot(*normal, unit)) > smallest_sine);
}

} // namespace

std::optional<Camera> read_projection(WordReader& words) {
    const WordPlace keyword = words.last_place();
    Camera camera;
    const auto viewpoint = words.take_point("the view point");
    if (!viewpoint)
        return std::nullopt;
    camera.viewpoint = *viewpoint;
    if (!read_picture_corners(words, keyword, camera))
        return std::nullopt;
    if (is_parallel_to_picture(camera, 0.5 * camera.lower_left - 0.5 * *viewpoint)) {
        words.complaints().error(
            keyword,
            "the view point lies in the plane of the picture",
            "move it to the front, away from the picture");
        return std::nullopt;
    }
    return camera;
}

std::optional<Camera> read_parallel(WordReader& words) {
    const WordPlace keyword = words.last_place();
    Camera camera;
    camera.projection = Camera::Projection::parallel;
    const auto direction = words.take_point("the direction of the view rays");
    if (!direction)
        return std::nullopt;
    camera.direction = *direction;
    if (!read_picture_corners(words, keyword, camera))
        return std::nullopt;
    if (is_parallel_to_picture(camera, *direction)) {
        words.complaints().error(
            keyword,
            length(*direction) > 0 ? "the view rays run in the plane of the picture"
                                   : "the direction of the view rays is 0 0 0",
            "the direction leads from the viewer through the picture");
        return std::nullopt;
    }
    return camera;
}

std::optional<PointLight> read_light(WordReader& words) {
    const auto position = words.take_point("the light's position");
    if (!position)
        return std::nullopt;
    const WordPlace place = words.place();
    const auto intensity = words.take_number("the light's intensity");
    if (!intensity)
        return std::nullopt;
    if (*intensity < 0)
        words.complaints().warn(
            "lights below 0",
            place,
            fmt::format("the light's intensity is {}, below 0", *intensity),
            "such a light darkens what others make bright");
    const auto color = words.take_color("the light");
    if (!color)
        return std::nullopt;
    return PointLight{*position, *intensity, *color, Falloff::inverse_square};
}

namespace {

bool take_color(WordReader& words, const char* what, Color& color) {
    const auto taken = words.take_color(what);
    if (taken)
        color = *taken;
    return taken.has_value();
}

bool take_cosine(WordReader& words, Material& material) {
    const WordPlace place = words.place();
    const auto cosine = words.take_number("SPC, the cosine at which the highlight ends");
    if (!cosine)
        return false;
    if (!(*cosine >= -1 && *cosine <= 1)) {
        words.complaints().error(
            place,
            fmt::format("SPC is {}, but is a cosine, from -1 to 1", *cosine),
            "near 1 the highlight is small and sharp");
        return false;
    }
    material.spc = *cosine;
    return true;
}

bool take_refraction(WordReader& words, Material& material) {
    const WordPlace place = words.place();
    const auto index = words.take_number("REF, the index of refraction");
    if (!index)
        return false;
    if (!(*index > 0)) {
        words.complaints().error(
            place,
            fmt::format("REF is {}, but an index of refraction is positive", *index),
            "glass has about 1.5, water 1.33");
        return false;
    }
    material.ref = *index;
    return true;
}

bool read_property(WordReader& words, std::size_t property, Material& material) {
    switch (property) {
    case 0:
        return take_color(words, "DRF", material.drf);
    case 1:
        return take_color(words, "ARF", material.arf);
    case 2:
        return take_color(words, "SDI", material.sdi);
    case 3:
        return take_color(words, "SAN", material.san);
    case 4:
        return take_color(words, "RAB", material.rab);
    case 5:
        return take_color(words, "TAB", material.tab);
    case 6:
        return take_cosine(words, material);
    default:
        return take_refraction(words, material);
    }
}

} // namespace

bool read_properties(WordReader& words, Material& material) {
    std::array<std::uint64_t, property_words.size()> lines = {};
    while (true) {
        const std::string_view word = words.peek();
        const auto found = std::find(property_words.begin(), property_words.end(), word);
        if (found == property_words.end())
            return true;
        const auto property = static_cast<std::size_t>(found - property_words.begin());
        words.take();
        const WordPlace place = words.last_place();
        if (lines[property] != 0)
            words.complaints().error(
                place,
                fmt::format("{} is given twice for material '{}'", word, material.name),
                fmt::format("the first stands in line {}", lines[property]));
        lines[property] = place.line;
        if (!read_property(words, property, material))
            return false;
    }
}

namespace {

/// MX m11..m34: row by row, the fourth column the translation
std::optional<Affine3> read_matrix(WordReader& words) {
    Affine3 map;
    for (std::size_t row = 0; row < 3; ++row)
        for (std::size_t column = 0; column < 4; ++column) {
            const auto element = words.take_number("an element of the matrix, of 3 rows of 4");
            if (!element)
                return std::nullopt;
            if (column < 3)
                map.linear.rows[row][column] = *element;
            else
                map.translation[row] = *element;
        }
    return map;
}

std::optional<Affine3> read_transformation(WordReader& words, std::string_view keyword) {
    words.take();
    if (keyword == "MX")
        return read_matrix(words);
    if (keyword == "RT") {
        const auto angles = words.take_point("the angles of rotation");
        return angles ? std::optional(rotation(*angles)) : std::nullopt;
    }
    if (keyword == "TR") {
        const auto offset = words.take_point("the translation");
        return offset ? std::optional(translation(*offset)) : std::nullopt;
    }
    const auto factor = words.take_number("the factor of scaling");
    return factor ? std::optional(scaling(*factor)) : std::nullopt;
}

} // namespace

std::optional<Placement> read_transformations(WordReader& words) {
    const WordPlace statement = words.last_place();
    Placement placement;
    const auto singular = [&](const WordPlace& place) {
        words.complaints().error(
            place,
            "singular transformation: it flattens everything",
            "no factor of scaling and no row or column of a matrix may vanish");
        return std::nullopt;
    };
    const auto is_transformation = [](std::string_view word) {
        return std::find(transformation_words.begin(), transformation_words.end(), word)
            != transformation_words.end();
    };
    for (std::string_view word = words.peek(); is_transformation(word); word = words.peek()) {
        const WordPlace place = words.place();
        const auto map = read_transformation(words, word);
        if (!map)
            return std::nullopt;
        if (!inverse(*map))
            return singular(place);
        placement.to_parent = placement.moves ? composed(*map, placement.to_parent) : *map;
        placement.moves = true;
    }
    const auto back = inverse(placement.to_parent);
    if (!back)
        return singular(statement);
    placement.from_parent = *back;
    return placement;
}

} // namespace vera
