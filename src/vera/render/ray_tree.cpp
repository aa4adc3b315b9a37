// SPDX-License-Identifier: Apache-2.0
#include "vera/render/ray_tree.h"

#include "vera/accel/every_crossing.h"
#include "vera/scene/crossings.h"
#include "vera/shade/firmament.h"

#include <algorithm>
#include <span>
#include <tuple>

namespace vera {

namespace {

/// The ray that starts from where the node's ray ends.
QueryRay ray_from(const RayNode& node, Vec3 direction) {
    QueryRay query;
    query.ray.origin = node.surface.point;
    query.ray.direction = direction;
    query.ray.origin_error = node.surface.point_error;
    query.start = node.hit.face;
    return query;
}

std::vector<ShadowCrossing> crossings_along(const Scene& scene, const QueryRay& query) {
    std::vector<ShadowCrossing> crossings;
    std::uint64_t tests = 0;
    detail::for_each_crossing_within(
        scene,
        {&scene.geometry, query.ray, 0, inherited_material},
        query.start,
        tests,
        [&](double t, FaceId face, MaterialId material) {
            crossings.push_back({t, face, detail::transmission(scene, material)});
        },
        [] { return false; });
    const auto place = [](const ShadowCrossing& crossing) {
        return std::tuple(crossing.t, crossing.face);
    };
    std::sort(crossings.begin(), crossings.end(), [&](const auto& a, const auto& b) {
        return place(a) < place(b);
    });
    const auto same = [&](const auto& a, const auto& b) { return place(a) == place(b); };
    crossings.erase(std::unique(crossings.begin(), crossings.end(), same), crossings.end());
    return crossings;
}

class TreeBuilder {
public:
    explicit TreeBuilder(const TracedScene& traced)
        : traced_(traced) {}

    RayTree build(const QueryRay& ray) {
        RayNode root;
        root.ray = ray;
        add(root);
        return std::move(tree_);
    }

private:
    /// Adds the node, of which the ray and what stands above it are known, and all below it.
    std::size_t add(RayNode node) {
        const std::size_t number = tree_.nodes.size();
        if (number == RayTree::most_nodes) {
            tree_.complete = false;
            return number - 1;
        }
        if (traced_.cancel != nullptr)
            traced_.cancel->throw_if_raised();
        traced_.index.nearest_hits({&node.ray, 1}, {&node.hit, 1}, node.counts);
        if (!node.hit.found()) {
            node.color = firmament_color(traced_.firmament, node.ray.ray.direction);
            tree_.nodes.push_back(std::move(node));
            return number;
        }
        light(node);
        node.is_last_level = node.level >= traced_.depth;
        const bool goes_on = !node.is_last_level;
        tree_.nodes.push_back(std::move(node));
        if (goes_on)
            send_on(number);
        return number;
    }

    /// Everything but Rfl and Rfr.
    void light(RayNode& node) const {
        node.surface = surface_at(traced_.scene, node.ray.ray, node.hit);
        node.incidence = incidence(node.surface, node.ray.ray.direction);
        node.material = &material_of(traced_.scene, node.surface.material);
        node.local = unlit(node.incidence, *node.material, traced_.illumination.ambient);
        node.luminosity_san = node.incidence.cos_viewer * node.material->san;
        if (!traced_.luminosity)
            node.luminosity_san = node.local.luminosity = {};
        for (const PointLight& light : traced_.illumination.lights) {
            node.lights.push_back(light_at(node, light));
            node.local += node.lights.back().terms;
        }
        node.color = sum(node.local);
    }

    LightAtPlace light_at(const RayNode& node, const PointLight& light) const {
        const Incidence& at = node.incidence;
        const Vec3 to_light = light.position - at.point;
        LightAtPlace result;
        result.distance = length(to_light);
        result.to_light = normalized(to_light);
        result.cos_normal = dot(result.to_light, at.normal);
        result.cos_viewer = dot(result.to_light, at.to_viewer);
        result.cos_mirrored = dot(result.to_light, at.mirrored);
        result.behind = !is_lit_from(at, to_light);
        const double strength = light.falloff == Falloff::inverse_square
            ? light.intensity / result.distance / result.distance
            : light.intensity;
        result.intensity = strength * light.color;
        if (result.behind)
            return result;

        result.highlight = highlight_factor(result.cos_mirrored, node.material->spc);
        result.diffuse_drf = result.cos_normal * node.material->drf * result.intensity;
        result.diffuse_arf =
            std::max(result.cos_viewer, 0.0) * node.material->arf * result.intensity;
        const LightTerms unshaded = unshadowed(at, *node.material, light);
        if (is_black(unshaded))
            return result;
        if (traced_.shadows)
            ask_for_visibility(node, to_light, result);
        result.terms = result.visibility * unshaded;
        return result;
    }

    void ask_for_visibility(const RayNode& node, Vec3 to_light, LightAtPlace& result) const {
        QueryRay query = ray_from(node, to_light);
        query.ray.t_max = 1 - coincidence_tolerance(query.ray, 1);
        traced_.index.transmittances({&query, 1}, {&result.visibility, 1}, result.counts);
        result.shadow_ray = query;
        result.crossings_known =
            traced_.scene.geometry.primitive_count <= LightAtPlace::most_listed;
        if (result.crossings_known)
            result.crossings = crossings_along(traced_.scene, query);
    }

    /// Follows the rays that a node sends, and adds Rfl and Rfr to its colour.
    void send_on(std::size_t number) {
        const Material& material = *tree_.nodes[number].material;
        const bool refracts = !is_black(material.tab);
        std::optional<Vec3> onwards;
        if (refracts)
            onwards = refracted(tree_.nodes[number].incidence, material.ref);
        const bool is_total = refracts && !onwards;
        if (!is_black(material.rab) || is_total) {
            // One ray is both, so that rays caught in glass do not double at each level.
            const std::size_t child = add(child_of(
                number,
                is_total ? RayNode::Kind::totally_reflected : RayNode::Kind::mirrored,
                tree_.nodes[number].incidence.mirrored,
                is_total ? material.rab + material.tab : material.rab));
            RayNode& node = tree_.nodes[number];
            node.mirrored_ray = child;
            node.mirrored = material.rab * tree_.nodes[child].color;
            node.color += node.mirrored;
            if (is_total) {
                node.refracted_ray = child;
                node.refracted = material.tab * tree_.nodes[child].color;
                node.color += node.refracted;
            }
        }
        if (onwards) {
            const std::size_t child =
                add(child_of(number, RayNode::Kind::refracted, *onwards, material.tab));
            RayNode& node = tree_.nodes[number];
            node.refracted_ray = child;
            node.refracted = material.tab * tree_.nodes[child].color;
            node.color += node.refracted;
        }
    }

    RayNode child_of(std::size_t parent, RayNode::Kind kind, Vec3 direction, Color part) const {
        const RayNode& from = tree_.nodes[parent];
        RayNode node;
        node.kind = kind;
        node.parent = parent;
        node.level = from.level + 1;
        node.weight = from.weight * part;
        node.ray = ray_from(from, direction);
        return node;
    }

    const TracedScene& traced_;
    RayTree tree_;
};

/// The terms of a node that are no Rfl or Rfr.
void put_own_terms(const RayNode& node, const RayTerms& terms, std::span<Color> own) {
    if (!node.hit.found()) {
        own[terms.firmament()] = node.color;
        return;
    }
    own[RayTerms::ambient()] = node.local.ambient;
    own[terms.luminosity()] = node.local.luminosity;
    for (std::size_t i = 0; i < node.lights.size(); ++i) {
        own[terms.diffuse(i)] = node.lights[i].terms.diffuse;
        own[terms.highlight(i)] = node.lights[i].terms.highlight;
    }
}

void add(Color part, std::span<const Color> of, std::span<Color> to) {
    for (std::size_t i = 0; i < of.size(); ++i)
        to[i] += part * of[i];
}

} // namespace

RayTree ray_tree(const TracedScene& traced, const QueryRay& ray) {
    return TreeBuilder(traced).build(ray);
}

std::vector<Color> ray_terms(const RayTree& tree, const RayTerms& terms) {
    const std::size_t count = terms.count();
    std::vector<Color> of_nodes(tree.nodes.size() * count);
    const auto of_node = [&](std::size_t number) {
        return std::span(of_nodes).subspan(number * count, count);
    };
    std::vector<Color> ways(light_way_count * count);
    // Rays come behind those that send them.
    for (std::size_t number = tree.nodes.size(); number-- > 0;) {
        const RayNode& node = tree.nodes[number];
        put_own_terms(node, terms, of_node(number));
        const auto sum_of = [&](LightWay way) {
            return number == 0 ? std::span(ways).subspan(term_number(terms, way, 0), count)
                               : of_node(number);
        };
        if (node.mirrored_ray)
            add(node.material->rab, of_node(*node.mirrored_ray), sum_of(LightWay::mirrored));
        if (node.refracted_ray)
            add(node.material->tab, of_node(*node.refracted_ray), sum_of(LightWay::refracted));
    }
    std::copy_n(of_nodes.begin(), count, ways.begin());
    return ways;
}

} // namespace vera
