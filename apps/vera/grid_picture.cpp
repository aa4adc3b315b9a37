// SPDX-License-Identifier: Apache-2.0
#include "grid_picture.h"

#include "vera/accel/wide_bvh.h"
#include "vera/base/output_file.h"
#include "vera/base/progress_part.h"
#include "vera/drawing/drawing_file.h"
#include "vera/image/image_file.h"
#include "vera/render/render_scene.h"
#include "vera/scene/framing.h"
#include "vera/visible/draw_scene.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "interrupt.h"
#include "messages.h"
#include "option_values.h"
#include "progress_display.h"
#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace vera {

namespace {

constexpr std::uint32_t most_levels = 64;
constexpr std::size_t most_cells = 30'000;
/// Of a block, by its cell: what is left free tells neighbours apart.
constexpr double block_part = 0.84;
/// On the walls of the frame, more lines than this are not shown: they would be a grey, and cutting
/// bars where they cross takes long.
constexpr int most_lines = 32;
constexpr double legend_line = 22; ///< in pixels
constexpr double legend_margin = 14;

constexpr std::array<Color, 6> level_colors = {
    Color{0.20, 0.42, 0.66},
    Color{0.86, 0.46, 0.12},
    Color{0.24, 0.56, 0.30},
    Color{0.60, 0.32, 0.58},
    Color{0.78, 0.24, 0.26},
    Color{0.20, 0.58, 0.58}};

/// Of the objects in a cell: up to so many have this tone.
struct Tone {
    std::uint32_t objects;
    double strength;
};

constexpr std::array<Tone, 3> tones = {{{1, 0.45}, {4, 0.72}, {0xffffffff, 1}}};
constexpr std::uint32_t frame_material = 0;

Color tinted(Color color, double strength) {
    return strength * color + (1 - strength) * Color{1, 1, 1};
}

MaterialId material_of(const FullCell& cell) {
    const std::size_t level = (cell.level - 1) % level_colors.size();
    // A grid that is not looked into holds many.
    const std::uint32_t objects = cell.objects == 0 ? tones.back().objects : cell.objects;
    std::size_t tone = 0;
    while (objects > tones[tone].objects)
        ++tone;
    return MaterialId{static_cast<std::uint32_t>(1 + level * tones.size() + tone)};
}

std::vector<Material> materials() {
    std::vector<Material> result(1);
    result[frame_material].drf = {0.35, 0.36, 0.38};
    for (const Color color : level_colors)
        for (const Tone& tone : tones) {
            Material material;
            material.drf = tinted(color, tone.strength);
            result.push_back(material);
        }
    return result;
}

void add_face(Scene& scene, MaterialId material, const std::array<Vec3, 4>& corners) {
    Geometry& geometry = scene.geometry;
    Polygon polygon;
    polygon.first_corner = static_cast<std::uint32_t>(geometry.corners.size());
    polygon.corner_count = 4;
    polygon.normal = normalized(cross(corners[1] - corners[0], corners[3] - corners[0]));
    geometry.corners.insert(geometry.corners.end(), corners.begin(), corners.end());
    Item item;
    item.kind = ItemKind::polygon;
    item.index = static_cast<std::uint32_t>(geometry.polygons.size());
    item.material = material;
    geometry.polygons.push_back(polygon);
    geometry.items.push_back(item);
}

/// The part of the unit cube from lower to upper, as the map carries it.
void add_block(Scene& scene, MaterialId material, const Affine3& to_scene, Vec3 lower, Vec3 upper) {
    std::array<Vec3, 8> corners;
    for (std::size_t i = 0; i < corners.size(); ++i)
        corners[i] = transformed_point(
            to_scene,
            {(i & 1U) != 0 ? upper.x : lower.x,
             (i & 2U) != 0 ? upper.y : lower.y,
             (i & 4U) != 0 ? upper.z : lower.z});
    constexpr std::array<std::array<std::size_t, 4>, 6> faces = {
        {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
    for (const auto& face : faces)
        add_face(
            scene,
            material,
            {corners[face[0]], corners[face[1]], corners[face[2]], corners[face[3]]});
}

/// The box's edges as bars, and the borders of the cells on the walls at the lower ends of the
/// axes, which are those behind and below as the scene is seen.
void add_frame(Scene& scene, const GridCells& cells) {
    const Vec3 size = extent(cells.box);
    const double longest = std::max({size.x, size.y, size.z});
    const Affine3 map = {{{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}}, cells.box.lower};
    const auto bar = [&](std::size_t along, Vec3 from, double width) {
        Vec3 lower = from;
        Vec3 upper = from;
        upper[along] += size[along];
        const Vec3 half = 0.5 * width * longest * Vec3{1, 1, 1};
        add_block(scene, MaterialId{frame_material}, map, lower - half, upper + half);
    };
    for (std::size_t along = 0; along < 3; ++along) {
        const std::size_t second = (along + 1) % 3;
        const std::size_t third = (along + 2) % 3;
        for (const double u : {0.0, 1.0})
            for (const double v : {0.0, 1.0}) {
                Vec3 from;
                from[second] = u * size[second];
                from[third] = v * size[third];
                bar(along, from, 0.0035);
            }
        for (const auto& [across, wall] : {std::pair(second, third), std::pair(third, second)}) {
            const int lines = cells.counts[across];
            for (int i = 1; i < lines && lines <= most_lines; ++i) {
                Vec3 from;
                from[across] = size[across] * i / lines;
                bar(along, from, 0.0012);
            }
        }
    }
}

void add_camera_and_light(Scene& scene, const PictureSettings& settings) {
    const FrameSettings frame = {.width = settings.width, .height = settings.height};
    scene.camera = framed_camera(scene, frame);
    scene.lights = default_lights(scene, *scene.camera);
    // And a weaker one from the viewer's right, so that blocks have three tones and none is black.
    const Camera& camera = *scene.camera;
    PointLight fill = scene.lights.front();
    fill.position = camera.viewpoint + 20 * (camera.lower_right - camera.lower_left);
    fill.intensity *= 0.5;
    scene.lights.push_back(fill);
}

std::string grouped(std::size_t number) {
    std::string digits = std::to_string(number);
    for (std::size_t place = digits.size(); place > 3;) {
        place -= 3;
        digits.insert(place, " ");
    }
    return digits;
}

std::string counted(std::size_t number, const char* what) {
    return fmt::format("{} {}{}", grouped(number), what, number == 1 ? "" : "s");
}

std::string level_text(const GridCells& cells, std::size_t number) {
    const GridLevel& level = cells.levels[number];
    const std::string first = number > 0
        ? counted(level.grids, "grid") + ", " + counted(level.cells, "cell")
        : fmt::format(
            "1 grid of {} x {} x {} cells", cells.counts[0], cells.counts[1], cells.counts[2]);
    return fmt::format(
        "level {}: {}, {} full; {} at most in a list",
        number + 1,
        first,
        grouped(level.full_cells),
        counted(level.longest_list, "object"));
}

std::string hex(Color color) {
    const auto byte = [](double value) { return std::lround(255 * value); };
    return fmt::format("#{:02x}{:02x}{:02x}", byte(color.r), byte(color.g), byte(color.b));
}

/// What the colours mean, below a drawing of that size.
std::string legend(const GridCells& cells, double width, double top) {
    std::size_t longest = 1;
    for (std::size_t i = 0; i < cells.levels.size(); ++i)
        longest = std::max(longest, level_text(cells, i).size());
    // Letters of these fonts are half as wide as high, a little more in some.
    const double font_size = std::clamp(
        std::floor((width - legend_margin - 58) / (0.56 * static_cast<double>(longest))),
        6.0,
        13.0);
    std::string svg = fmt::format(
        "<g id=\"legend\" font-family=\"Helvetica, Arial, 'Liberation Sans', "
        "sans-serif\" font-size=\"{}\" fill=\"#333\">\n",
        font_size);
    double y = top + legend_margin;
    for (std::size_t i = 0; i < cells.levels.size(); ++i, y += legend_line) {
        for (std::size_t tone = 0; tone < tones.size(); ++tone)
            svg += fmt::format(
                "<rect x=\"{}\" y=\"{}\" width=\"14\" height=\"14\" fill=\"{}\"/>\n",
                legend_margin + 16 * static_cast<double>(tone),
                y,
                hex(tinted(level_colors[i % level_colors.size()], tones[tone].strength)));
        svg += fmt::format(
            "<text x=\"{}\" y=\"{}\">{}</text>\n",
            legend_margin + 58,
            y + 12,
            level_text(cells, i));
    }
    svg += fmt::format(
        "<text x=\"{}\" y=\"{}\">A block is a cell that is not empty: with 1 object, up to {}, or "
        "more{}.</text>\n</g>\n",
        legend_margin,
        y + 12,
        tones[1].objects,
        cells.whole ? "" : "; what is deeper is not shown");
    return svg;
}

void draw_grid(
    const Scene& picture,
    const GridCells& cells,
    const PictureSettings& settings,
    OutputFile& file,
    const Console& console,
    const Progress& progress) {
    DrawSettings draw;
    draw.style = DrawingStyle::flat;
    Drawing drawing =
        draw_scene(picture, *picture.camera, settings, draw, progress, &console.cancel).drawing;
    drawing.title = "Tree of grids";
    const double width = drawing.width;
    const double top = drawing.height;
    drawing.height +=
        2 * legend_margin + legend_line * static_cast<double>(cells.levels.size() + 1);
    std::string bytes;
    write_svg(drawing, {.precision = 0.1}, bytes, {}, &console.cancel);
    bytes.insert(bytes.rfind("</svg>"), legend(cells, width, top));
    file.write(bytes);
}

bool is_drawing(const std::string& path) {
    return drawing_format_from_extension(path) == DrawingFormat::svg;
}

} // namespace

void add_grid_picture_options(CLI::App& command, GridPictureRequest& request) {
    const char* const group = "Picture of the tree of grids";
    CLI::Option* const picture =
        command
            .add_option(
                "--draw-grid",
                request.path,
                "draw the cells of the tree that hold something, each level in its colour, to an "
                "SVG with a legend, or a PNG")
            ->type_name("PICTURE")
            ->group(group);
    command
        .add_option(
            "--grid-from",
            request.from,
            "the first level that is shown; those above it may hide what is in them")
        ->type_name("N")
        ->capture_default_str()
        ->needs(picture)
        ->group(group);
    command
        .add_option(
            "--grid-levels",
            request.levels,
            "how deep it is looked into; less where that were more than 30000 cells")
        ->type_name("N")
        ->capture_default_str()
        ->needs(picture)
        ->group(group);
    command
        .add_option(
            "--grid-cut",
            request.cut,
            "part of the depth that is cut away in front, to look inside: from 0 to 0.95")
        ->type_name("X")
        ->capture_default_str()
        ->needs(picture)
        ->group(group);
}

void check_grid_picture(const GridPictureRequest& request) {
    whole_of("--grid-from", request.from, 1, most_levels);
    whole_of("--grid-levels", request.levels, 1, most_levels);
    number_of("--grid-cut", request.cut, 0, 0.95);
    if (request.path.empty())
        return;
    if (!is_drawing(request.path) && format_from_extension(request.path) != ImageFileFormat::png8)
        throw CommandLineError(fmt::format(
            "--draw-grid writes SVG and PNG; found '{}'; name it as in grid.svg", request.path));
}

Scene grid_scene(
    const GridCells& cells, const GridPictureRequest& request, const PictureSettings& settings) {
    Scene scene;
    scene.materials = materials();
    if (request.from <= 1)
        add_frame(scene, cells);
    const double front = cells.box.upper.z - request.cut * extent(cells.box).z;
    const Vec3 lower = 0.5 * (1 - block_part) * Vec3{1, 1, 1};
    const Vec3 upper = Vec3{1, 1, 1} - lower;
    for (const FullCell& cell : cells.cells)
        if (cell.level >= request.from
            && transformed_point(cell.to_scene, {0.5, 0.5, 0.5}).z <= front)
            add_block(scene, material_of(cell), cell.to_scene, lower, upper);
    if (scene.geometry.items.empty())
        throw CommandLineError(fmt::format(
            "no cell of level {} or deeper is left to draw, of {}; take a smaller --grid-from or "
            "--grid-cut",
            request.from,
            counted(cells.levels.size(), "level")));
    number_primitives(scene);
    add_camera_and_light(scene, settings);
    return scene;
}

void write_grid_picture(
    const Scene& scene,
    const PictureSettings& settings,
    const GridPictureRequest& request,
    const Console& console) {
    OutputFile file(request.path);
    const CancellableWork work;
    ProgressDisplay display(console, "picture");
    StageProgress stages(display.callback(), 4);
    const GridCells cells = grid_cells(
        scene,
        {},
        static_cast<std::size_t>(request.levels),
        most_cells,
        stages.next(1),
        &console.cancel);
    if (cells.box.empty())
        throw std::runtime_error("the scene is empty: it has no grid to draw");

    PictureSettings look;
    look.width = settings.width;
    look.height = settings.height;
    look.depth = 1;
    look.shadows = false;
    look.ambient = {0.42, 0.42, 0.42};
    look.firmament = Firmament{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}};
    const Scene picture = grid_scene(cells, request, look);
    if (is_drawing(request.path)) {
        draw_grid(picture, cells, look, file, console, stages.next(3));
    } else {
        const auto index = make_wide_bvh(picture, stages.next(1), &console.cancel);
        const RenderResult rendered = render_scene(
            picture,
            *picture.camera,
            *index,
            look,
            SampleType::integer8,
            stages.next(2),
            &console.cancel);
        write_image(rendered.image, file, ImageFileFormat::png8);
    }
    file.commit();
    for (std::size_t i = 0; i < cells.levels.size(); ++i)
        print_note(request.path + ": " + level_text(cells, i), console);
    if (!cells.whole)
        print_note(request.path + ": deeper grids are not shown", console);
}

} // namespace vera
