// SPDX-License-Identifier: Apache-2.0
#include "vera/solids/solid_findings.h"

#include "vera/base/long_loop.h"
#include "vera/base/progress_part.h"
#include "vera/base/random.h"
#include "vera/scene/bounds.h"
#include "vera/solids/box_pairs.h"
#include "vera/solids/shells.h"
#include "vera/solids/solid_faces.h"
#include "vera/solids/sphere_crossing.h"
#include "vera/solids/triangle_relation.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

#include <fmt/format.h>

namespace vera {

namespace {

using Kind = SolidFinding::Kind;

std::string shown(Vec3 point) {
    return fmt::format("({} {} {})", point.x, point.y, point.z);
}

/// Faces that have something in common.
struct FirstOfMany {
    std::uint32_t first = ~std::uint32_t{0};
    std::size_t count = 0;

    void add(std::uint32_t face) {
        first = std::min(first, face);
        ++count;
    }
};

/// The findings of one geometry.
class GeometryCheck {
public:
    GeometryCheck(const Scene& scene, std::size_t subscene, std::vector<SolidFinding>& findings)
        : scene_(scene)
        , subscene_(subscene)
        , geometry_(subscene == 0 ? scene.geometry : scene.subscenes[subscene - 1])
        , faces_(solid_faces(geometry_))
        , findings_(findings) {}

    void check(const Progress& progress, const CancelFlag* cancel) {
        stop_if_raised(cancel);
        find_duplicates();
        find_curved_duplicates();
        stop_if_raised(cancel);
        for (const Shell& shell : shells(faces_))
            check_shell(shell);
        find_pairs(progress, cancel);
    }

private:
    using Loop = std::vector<std::uint32_t>;

    void find_duplicates();
    void find_curved_duplicates();
    void check_shell(const Shell& shell);
    void check_sides(const Shell& shell);
    void add_wrong_inner_point(std::uint32_t face);
    void add_turned(const std::vector<std::uint32_t>& turned, std::size_t by_normal);
    void check_openness(const Shell& shell);
    void find_pairs(const Progress& progress, const CancelFlag* cancel);

    /// What may pass through something else: a triangle, or a whole sphere.
    struct Part {
        static constexpr std::uint32_t no_triangle = 0xffffffff;

        std::uint32_t item = 0;
        std::uint32_t triangle = no_triangle; ///< of faces_

        bool is_sphere() const { return triangle == no_triangle; }
    };

    TriangleRelation relation_of(const Part& a, const Part& b) const;

    /// What the later and the earlier item do, and how many pairs of their triangles do so.
    using ItemPair = std::tuple<Kind, std::uint32_t, std::uint32_t>;
    using ItemPairs = std::map<ItemPair, FirstOfMany>;

    void add_parts(std::vector<Part>& parts, std::vector<Box3>& boxes) const;
    void add_pairs(const ItemPairs& pairs);
    void add_pair(const ItemPair& pair, const FirstOfMany& faces, const std::string& more);

    bool is_sphere(std::uint32_t item) const {
        return geometry_.items[item].kind == ItemKind::sphere;
    }

    const Item& item_of(std::uint32_t face) const {
        return geometry_.items[faces_.faces[face].item];
    }

    /// Whether its outside is told by normals of the vertices.
    bool has_normals(std::uint32_t face) const {
        const Item& item = item_of(face);
        return item.kind == ItemKind::mesh && !geometry_.meshes[item.index].normals.empty();
    }

    bool is_mesh(std::uint32_t face) const { return item_of(face).kind == ItemKind::mesh; }

    /// Corners that begin with the least and go on with the lesser of its neighbours: the same for
    /// faces that are the same, however they are written.
    Loop loop_of(std::uint32_t face) const {
        const auto corners = faces_.corners_of(faces_.faces[face]);
        Loop loop(corners.begin(), corners.end());
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
        if (loop.size() > 2 && loop.back() < loop[1])
            std::reverse(loop.begin() + 1, loop.end());
        return loop;
    }

    /// Whether what is outside of the face lies where its loop runs clockwise.
    bool is_outside_behind_loop(std::uint32_t face) const {
        const auto corners = faces_.corners_of(faces_.faces[face]);
        const Loop loop = loop_of(face);
        const auto first =
            static_cast<std::size_t>(std::ranges::find(corners, loop.front()) - corners.begin());
        const bool is_reversed = corners[(first + 1) % corners.size()] != loop[1];
        return is_reversed != (item_of(face).outside == Outside::against_normal);
    }

    /// "line 12", with its file where it is another than the item's.
    std::string place_of(std::uint32_t item, std::uint16_t file) const {
        const Item& other = geometry_.items[item];
        return other.file == file || other.file >= scene_.files.size()
            ? fmt::format("line {}", other.line)
            : fmt::format("{}:{}", scene_.files[other.file], other.line);
    }

    /// Of what takes the material of the call, whether there is such a material at all.
    bool is_transparent(const Item& item) const {
        const auto lets_light_through = [](const Material& material) {
            return !is_black(material.tab);
        };
        const auto number = static_cast<std::size_t>(item.material);
        return number < scene_.materials.size()
            ? lets_light_through(scene_.materials[number])
            : std::ranges::any_of(scene_.materials, lets_light_through);
    }

    SolidFinding& add(Kind kind, Severity severity, std::uint32_t item) {
        SolidFinding& finding = findings_.emplace_back();
        finding.kind = kind;
        finding.severity = severity;
        finding.subscene = subscene_;
        finding.item = item;
        return finding;
    }

    /// About a face, and others perhaps.
    SolidFinding& add_of_face(Kind kind, Severity severity, std::uint32_t face) {
        const std::uint32_t item = faces_.faces[face].item;
        SolidFinding& finding = add(kind, severity, item);
        if (is_mesh(face)) {
            const auto first = std::ranges::lower_bound(
                faces_.faces, item, std::ranges::less(), &SolidFaces::Face::item);
            finding.triangle = face - static_cast<std::uint32_t>(first - faces_.faces.begin());
        }
        return finding;
    }

    void
    add_duplicate(std::uint32_t item, std::uint32_t first, const char* what, Severity severity) {
        SolidFinding& finding = add(Kind::duplicate, severity, item);
        finding.other = first;
        finding.problem = fmt::format(
            "the same {} stands in {} already", what, place_of(first, geometry_.items[item].file));
        finding.remedy = severity == Severity::note
            ? "they have their outer sides towards each other: two solids touch there"
            : "remove one of them: where surfaces coincide, the earlier one is seen";
    }

    template <typename Primitives, typename Key>
    void find_same(ItemKind kind, const Primitives& primitives, const Key& key, const char* what);

    const Scene& scene_;
    std::size_t subscene_;
    const Geometry& geometry_;
    SolidFaces faces_;
    std::vector<SolidFinding>& findings_;
};

void GeometryCheck::find_duplicates() {
    // Few faces stand twice: they are compared where their hashes are the same.
    std::vector<std::pair<std::uint64_t, std::uint32_t>> by_hash;
    by_hash.reserve(faces_.faces.size());
    for (std::uint32_t i = 0; i < faces_.faces.size(); ++i) {
        std::uint64_t hash = 0;
        for (const std::uint32_t point : loop_of(i))
            hash = scrambled_bits(hash + point + 1);
        by_hash.emplace_back(hash, i);
    }
    std::sort(by_hash.begin(), by_hash.end());
    std::vector<std::pair<std::uint32_t, std::uint32_t>> same; // the later one first
    for (std::size_t i = 1; i < by_hash.size(); ++i) {
        const Loop loop = loop_of(by_hash[i].second);
        std::size_t first = i;
        for (std::size_t k = i; k-- > 0 && by_hash[k].first == by_hash[i].first;)
            if (loop_of(by_hash[k].second) == loop)
                first = k;
        if (first < i)
            same.emplace_back(by_hash[i].second, by_hash[first].second);
    }
    std::sort(same.begin(), same.end());
    std::map<std::uint32_t, FirstOfMany> twice_in_mesh; // by item
    for (const auto& [face, first] : same) {
        const std::uint32_t item = faces_.faces[face].item;
        if (is_mesh(face))
            twice_in_mesh[item].add(face);
        else
            add_duplicate(
                item,
                faces_.faces[first].item,
                "face",
                is_outside_behind_loop(face) == is_outside_behind_loop(first) ? Severity::warning
                                                                              : Severity::note);
    }
    for (const auto& [item, faces] : twice_in_mesh) {
        const std::size_t count = faces.count;
        SolidFinding& finding = add_of_face(Kind::duplicate, Severity::note, faces.first);
        finding.problem = fmt::format(
            "{} triangle{} of this mesh stand{} in the same place as another face",
            count,
            count == 1 ? "" : "s",
            count == 1 ? "s" : "");
    }
}

template <typename Primitives, typename Key>
void GeometryCheck::find_same(
    ItemKind kind, const Primitives& primitives, const Key& key, const char* what) {
    std::map<decltype(key(primitives[0])), std::uint32_t> first_with;
    for (std::uint32_t i = 0; i < geometry_.items.size(); ++i) {
        const Item& item = geometry_.items[i];
        if (item.kind != kind)
            continue;
        const auto [at, is_new] = first_with.emplace(key(primitives[item.index]), i);
        if (!is_new)
            add_duplicate(i, at->second, what, Severity::warning);
    }
}

void GeometryCheck::find_curved_duplicates() {
    if (!geometry_.spheres.empty())
        find_same(
            ItemKind::sphere,
            geometry_.spheres,
            [](const Sphere& sphere) {
                const Vec3 center = sphere.center;
                return std::tuple(center.x, center.y, center.z, sphere.radius);
            },
            "sphere");
    if (!geometry_.rotational_shapes.empty())
        find_same(
            ItemKind::rotational_shape,
            geometry_.rotational_shapes,
            [](const RotationalShape& shape) {
                std::vector<double> numbers = {
                    shape.base.x,
                    shape.base.y,
                    shape.base.z,
                    shape.axis.x,
                    shape.axis.y,
                    shape.axis.z,
                    shape.start.r,
                    shape.start.h};
                for (const ContourPiece& piece : shape.contour) {
                    numbers.push_back(static_cast<double>(piece.kind));
                    for (const auto& control : piece.control)
                        numbers.insert(numbers.end(), {control.r, control.h});
                    numbers.insert(numbers.end(), {piece.weight, piece.end.r, piece.end.h});
                }
                return numbers;
            },
            "rotational shape");
}

void GeometryCheck::check_shell(const Shell& shell) {
    if (shell.has_inside)
        check_sides(shell);
    if (!shell.is_closed)
        check_openness(shell);
}

/// Of a solid: whether what the text says is outside is so.
void GeometryCheck::check_sides(const Shell& shell) {
    std::vector<std::uint32_t> turned;
    std::size_t by_normal = 0;
    for (std::size_t i = 0; i < shell.faces.size(); ++i) {
        const std::uint32_t face = shell.faces[i];
        const Outside outside = item_of(face).outside;
        if (outside != Outside::by_normal) {
            if ((outside == Outside::against_normal) != shell.is_turned[i])
                add_wrong_inner_point(face);
            continue;
        }
        ++by_normal;
        if (shell.is_closed && shell.is_turned[i] && !has_normals(face))
            turned.push_back(face);
    }
    if (!turned.empty())
        add_turned(turned, by_normal);
}

void GeometryCheck::add_wrong_inner_point(std::uint32_t face) {
    SolidFinding& finding = add_of_face(Kind::wrong_inner_point, Severity::warning, face);
    finding.problem = "the inner point is on the outer side of this face of its solid";
    finding.remedy =
        "move IP to the inside of all faces that it is for; a solid that no point sees "
        "wholly from inside needs several";
}

/// Of a closed solid, those of the faces without inner point whose normals point inwards.
void GeometryCheck::add_turned(const std::vector<std::uint32_t>& turned, std::size_t by_normal) {
    // All of them inwards may be meant: a room. That, and of meshes, is told once.
    const bool are_all = turned.size() == by_normal;
    const bool is_told_once = are_all || is_mesh(turned.front());
    for (const std::uint32_t face : turned) {
        const bool changes_picture = is_transparent(item_of(face)) && !are_all;
        SolidFinding& finding = add_of_face(
            is_told_once ? Kind::turned_solid : Kind::turned_face,
            changes_picture ? Severity::warning : Severity::note,
            face);
        finding.problem = are_all
            ? fmt::format(
                "the normals of all {} faces of this closed solid point inwards", by_normal)
            : is_told_once ? fmt::format(
                  "the normals of {} of the {} triangles of this closed mesh point inwards",
                  turned.size(),
                  by_normal)
                           : "the normal of this face points to the inside of its closed solid";
        finding.remedy = "turn the order of its corners round, or give an inner point: IP";
        if (is_told_once)
            break;
    }
}

/// Of faces that hang together and do not enclose a solid: whether they were meant to.
void GeometryCheck::check_openness(const Shell& shell) {
    constexpr std::size_t least_faces = 4; // of a solid
    constexpr std::size_t most_named = 3;
    const bool is_meant = std::ranges::any_of(shell.faces, [&](std::uint32_t face) {
        return is_mesh(face) || item_of(face).outside != Outside::by_normal;
    });
    if (!is_meant || shell.open.empty() || shell.faces.size() < least_faces)
        return;
    const std::uint32_t face = shell.open.front().face;
    const Item& item = item_of(face);
    SolidFinding& finding = add_of_face(Kind::open, Severity::note, face);
    finding.problem = fmt::format(
        "this solid is open: {} of its {} edges belong{} to one face alone:",
        shell.open.size(),
        shell.edges,
        shell.open.size() == 1 ? "s" : "");
    for (std::size_t i = 0; i < shell.open.size() && i < most_named; ++i) {
        const OpenEdge& edge = shell.open[i];
        const std::string where = is_mesh(edge.face)
            ? ""
            : fmt::format(" in {}", place_of(faces_.faces[edge.face].item, item.file));
        finding.problem += fmt::format(
            "{}{} from {} to {}",
            i == 0 ? "" : ",",
            where,
            shown(faces_.points[edge.from]),
            shown(faces_.points[edge.to]));
    }
    if (shell.open.size() > most_named)
        finding.problem += fmt::format(" and {} more", shell.open.size() - most_named);
    finding.remedy =
        "where it was meant to be closed, a face is missing, or corners that should be "
        "the same differ";
}

TriangleRelation GeometryCheck::relation_of(const Part& a, const Part& b) const {
    const auto sphere_of = [&](const Part& part) -> const Sphere& {
        return geometry_.spheres[geometry_.items[part.item].index];
    };
    const auto corners_of = [&](const Part& part) {
        return faces_.corners_of(faces_.triangles[part.triangle]);
    };
    const auto crossing_if = [](bool is) {
        return is ? TriangleRelation::crossing : TriangleRelation::apart;
    };
    // What a generator makes of one statement is as it should be.
    const Item& first_item = geometry_.items[a.item];
    const Item& second_item = geometry_.items[b.item];
    const bool is_one_line = first_item.line != 0 && first_item.line == second_item.line
        && first_item.file == second_item.file;
    if ((a.is_sphere() || b.is_sphere()) && is_one_line)
        return TriangleRelation::apart;
    if (a.is_sphere() && b.is_sphere())
        return crossing_if(is_crossing(sphere_of(a), sphere_of(b)));
    if (a.is_sphere() || b.is_sphere())
        return crossing_if(
            is_crossing(sphere_of(a.is_sphere() ? a : b), corners_of(a.is_sphere() ? b : a)));
    const std::uint32_t first = faces_.triangles[a.triangle].face;
    const std::uint32_t second = faces_.triangles[b.triangle].face;
    if (first == second)
        return TriangleRelation::apart;
    const TriangleRelation between = relation(corners_of(a), corners_of(b));
    // What stands twice is told as that.
    return between == TriangleRelation::covering && loop_of(first) == loop_of(second)
        ? TriangleRelation::apart
        : between;
}

void GeometryCheck::find_pairs(const Progress& progress, const CancelFlag* cancel) {
    constexpr std::size_t most_pairs = 1'000'000;
    ItemPairs pairs;
    std::size_t found = 0;
    std::vector<Part> parts;
    std::vector<Box3> boxes;
    add_parts(parts, boxes);
    const auto face_of = [&](const Part& part) { return faces_.triangles[part.triangle].face; };
    const auto look_at = [&](std::uint32_t i, std::uint32_t k) {
        if (found == most_pairs)
            return;
        const TriangleRelation between = relation_of(parts[i], parts[k]);
        if (between == TriangleRelation::apart)
            return;
        ++found;
        const std::uint32_t first = parts[i].item;
        const std::uint32_t second = parts[k].item;
        const bool are_faces = !parts[i].is_sphere() && !parts[k].is_sphere();
        pairs[ItemPair(
                  between == TriangleRelation::crossing ? Kind::crossing : Kind::covering,
                  std::max(first, second),
                  std::min(first, second))]
            .add(are_faces ? std::max(face_of(parts[i]), face_of(parts[k])) : 0);
    };
    for_each_box_pair(boxes, look_at, progress, cancel);
    add_pairs(pairs);
}

void GeometryCheck::add_parts(std::vector<Part>& parts, std::vector<Box3>& boxes) const {
    parts.reserve(faces_.triangles.size() + geometry_.spheres.size());
    boxes.reserve(parts.capacity());
    for (std::uint32_t i = 0; i < faces_.triangles.size(); ++i) {
        const SolidFaces::Triangle& triangle = faces_.triangles[i];
        const auto [a, b, c] = faces_.corners_of(triangle);
        parts.push_back({faces_.faces[triangle.face].item, i});
        boxes.push_back(grown(grown(grown(Box3(), a), b), c));
    }
    for (std::uint32_t i = 0; i < geometry_.items.size(); ++i)
        if (is_sphere(i)) {
            parts.push_back({i});
            boxes.push_back(bounds(geometry_.spheres[geometry_.items[i].index]));
        }
}

void GeometryCheck::add_pairs(const ItemPairs& pairs) {
    // A sphere is told of once: in a heap or a row of them each may meet a hundred.
    std::map<std::uint32_t, std::size_t> pairs_of_sphere;
    for (const auto& [pair, faces] : pairs)
        if (is_sphere(std::get<1>(pair)))
            ++pairs_of_sphere[std::get<1>(pair)];
    for (const auto& [pair, faces] : pairs) {
        const std::uint32_t item = std::get<1>(pair);
        std::string more;
        if (is_sphere(item)) {
            const auto untold = pairs_of_sphere.extract(item);
            if (untold.empty())
                continue;
            if (untold.mapped() > 1)
                more = fmt::format(" and {} more", untold.mapped() - 1);
        }
        add_pair(pair, faces, more);
    }
}

/// What two items do, at so many places, and what else the one does.
void GeometryCheck::add_pair(
    const ItemPair& pair, const FirstOfMany& faces, const std::string& more) {
    const auto [kind, item, other] = pair;
    const auto word_for = [&](std::uint32_t i) { return is_sphere(i) ? "sphere" : "face or mesh"; };
    SolidFinding& finding = is_sphere(item) || is_sphere(other)
        ? add(kind, Severity::note, item)
        : add_of_face(kind, Severity::note, faces.first);
    finding.other = other;
    const std::string with = item == other
        ? fmt::format("itself, at {} pair{} of triangles", faces.count, faces.count == 1 ? "" : "s")
        : fmt::format(
            "{} of {}",
            is_sphere(item) == is_sphere(other) ? "that" : fmt::format("the {}", word_for(other)),
            place_of(other, geometry_.items[item].file));
    finding.problem = kind == Kind::crossing
        ? fmt::format("this {} passes through {}{}", word_for(item), with, more)
        : fmt::format("a part of this face or mesh coincides with {}", with);
    finding.remedy = kind == Kind::crossing
        ? ""
        : "where surfaces coincide, the one that stands earlier is seen";
}

} // namespace

const char* name_of(SolidFinding::Kind kind) {
    switch (kind) {
    case Kind::duplicate:
        return "things that stand in the text twice";
    case Kind::wrong_inner_point:
        return "inner points on the wrong side of a face";
    case Kind::turned_face:
        return "faces whose normals point inwards";
    case Kind::turned_solid:
        return "solids with normals that point inwards";
    case Kind::open:
        return "solids that are open";
    case Kind::crossing:
        return "pairs that pass through each other";
    case Kind::covering:
        break;
    }
    return "pairs that coincide in part";
}

std::vector<SolidFinding>
solid_findings(const Scene& scene, const Progress& progress, const CancelFlag* cancel) {
    std::vector<SolidFinding> findings;
    const std::size_t count = scene.subscenes.size() + 1;
    StageProgress stages(progress, static_cast<double>(count));
    for (std::size_t i = 0; i < count; ++i)
        GeometryCheck(scene, i, findings).check(stages.next(1), cancel);
    return findings;
}

} // namespace vera
