// SPDX-License-Identifier: Apache-2.0
#include "explanation.h"
#include "scene_objects.h"
#include <nlohmann/json.hpp>

namespace vera {

namespace {

using Json = nlohmann::ordered_json;

Json as_json(Vec3 a) {
    return {a.x, a.y, a.z};
}

Json as_json(Color a) {
    return {a.r, a.g, a.b};
}

Json as_json(const LayerSample& a) {
    return {a[0], a[1], a[2]};
}

void put_place(Json& json, const SourcePlace& place) {
    json["file"] = place.file;
    json["line"] = place.line;
    json["column"] = place.column;
}

Json as_json(const SceneObject::Call& call) {
    Json json = {{"name", call.subscene}};
    put_place(json, call.place);
    return json;
}

Json as_json(const SceneObject& object) {
    Json json = {{"kind", object.kind}, {"number", object.number}};
    if (object.triangle > 0)
        json["triangle"] = object.triangle;
    put_place(json, object.place);
    if (!object.parts.empty())
        json["parts"] = object.parts;
    json["subscenes"] = Json::array();
    for (const SceneObject::Call& call : object.calls)
        json["subscenes"].push_back(as_json(call));
    return json;
}

Json as_json(
    const WalkedPlace& place,
    const WalkedObject& object,
    double direction_length,
    SceneObjects& objects) {
    Json json = {{"outcome", name_of(object.outcome)}};
    if (object.outcome == WalkedObject::Outcome::met)
        json["distance"] = object.t * direction_length;
    if (object.outcome == WalkedObject::Outcome::searched)
        json["tests"] = object.tests;
    if (object.is_call)
        json["call"] = as_json(call_of(place, object, objects));
    else
        json["object"] = as_json(objects.object({object.primitive, 0}));
    return json;
}

/// The calls that lead to a place, from outside inwards.
Json calls_json(const WalkedPlace& place, SceneObjects& objects) {
    Json calls = Json::array();
    if (place.depth == 0)
        return calls;
    const SceneObject first = objects.object({place.first_primitive, 0});
    for (std::size_t i = 0; i < place.depth; ++i)
        calls.push_back(as_json(first.calls[i]));
    return calls;
}

/// Of a ray whose direction is so long.
Json as_json(const RayWalk& walk, double direction_length, SceneObjects& objects) {
    Json visits = Json::array();
    for (const WalkStep& step : walk.steps) {
        const WalkedPlace& place = walk.places[step.place];
        Json json = {{"level", step.level}, {"subscenes", calls_json(place, objects)}};
        switch (step.kind) {
        case WalkStep::Kind::cell:
            json["grid"] = step.number;
            json["cell"] = step.cell;
            json["own_grid"] = step.is_grid ? Json(step.own_grid) : Json();
            break;
        case WalkStep::Kind::node:
            json["node"] = step.number;
            break;
        case WalkStep::Kind::leaf:
            json["leaf_of"] = step.number;
            break;
        }
        if (step.kind != WalkStep::Kind::node) {
            json["listed"] = step.listed;
            json["objects"] = Json::array();
            for (const WalkedObject& object : step.objects)
                json["objects"].push_back(as_json(place, object, direction_length, objects));
        }
        visits.push_back(std::move(json));
    }
    return visits;
}

Json as_json(const LightAtPlace& light, std::size_t number, SceneObjects& objects) {
    Json json = {
        {"light", number + 1},
        {"distance", light.distance},
        {"to_light", as_json(light.to_light)},
        {"cos_normal", light.cos_normal},
        {"cos_viewer", light.cos_viewer},
        {"cos_mirrored", light.cos_mirrored},
        {"behind", light.behind},
        {"intensity", as_json(light.intensity)},
        {"visibility", as_json(light.visibility)},
        {"highlight_factor", light.highlight},
        {"diffuse_drf", as_json(light.diffuse_drf)},
        {"diffuse_arf", as_json(light.diffuse_arf)},
        {"diffuse", as_json(light.terms.diffuse)},
        {"highlight", as_json(light.terms.highlight)},
        {"shadow_ray", light.shadow_ray.has_value()},
        {"cells", light.counts.cells},
        {"tests", light.counts.tests}};
    if (!light.crossings_known)
        return json;
    json["between"] = Json::array();
    for (const ShadowCrossing& crossing : light.crossings)
        json["between"].push_back(
            {{"distance", crossing.t * light.distance},
             {"tab", as_json(crossing.tab)},
             {"object", as_json(objects.object(crossing.face))}});
    return json;
}

/// The terms in the order in which they are added, each with the sum so far.
Json terms_json(const RayNode& node) {
    Json terms = Json::array();
    Color sum;
    const auto add = [&](const char* name, Color value) {
        // Nothing is there to be added to first.
        sum = terms.empty() ? value : sum + value;
        terms.push_back({{"name", name}, {"value", as_json(value)}, {"sum", as_json(sum)}});
    };
    if (!node.hit.found()) {
        add("firmament", node.color);
        return terms;
    }
    add("Amb", node.local.ambient);
    add("Dif", node.local.diffuse);
    add("Spk", node.local.highlight);
    add("Slm", node.local.luminosity);
    add("Rfl", node.mirrored);
    add("Rfr", node.refracted);
    return terms;
}

void put_hit(
    Json& json,
    const Explanation& of,
    const RayNode& node,
    const RayVisits* visits,
    SceneObjects& objects) {
    if (!node.hit.found()) {
        json["hit"] = nullptr;
        return;
    }
    json["hit"] = {
        {"object", as_json(objects.object(node.hit.face))},
        {"material", material_name(of.prepared.scene, node.surface.material)},
        {"distance", node.hit.t},
        {"point", as_json(node.surface.point)},
        {"normal", as_json(node.incidence.normal)},
        {"from_outside", node.incidence.from_outside},
        {"cos_viewer", node.incidence.cos_viewer},
        {"luminosity_san", as_json(node.luminosity_san)},
        {"luminosity_sdi", as_json(node.material->sdi)}};
    json["lights"] = Json::array();
    for (std::size_t i = 0; i < node.lights.size(); ++i) {
        json["lights"].push_back(as_json(node.lights[i], i, objects));
        if (visits != nullptr && visits->shadow_walks[i])
            json["lights"].back()["visits"] =
                as_json(*visits->shadow_walks[i], node.lights[i].distance, objects);
    }
    json["mirrored_ray"] = node.mirrored_ray ? Json(*node.mirrored_ray + 1) : Json();
    json["refracted_ray"] = node.refracted_ray ? Json(*node.refracted_ray + 1) : Json();
}

Json ray_json(const Explanation& of, std::size_t number, SceneObjects& objects) {
    const RayNode& node = of.tree.nodes[number];
    Json json = {
        {"number", number + 1},
        {"kind", name_of(node.kind)},
        {"parent", number == 0 ? Json() : Json(node.parent + 1)},
        {"level", node.level},
        {"weight", as_json(node.weight)},
        {"origin", as_json(node.ray.ray.origin)},
        {"direction", as_json(node.ray.ray.direction)},
        {"cells", node.counts.cells},
        {"tests", node.counts.tests}};
    const RayVisits* const visits = of.visits.empty() ? nullptr : &of.visits[number];
    if (visits != nullptr)
        json["visits"] = as_json(visits->walk, 1, objects);
    put_hit(json, of, node, visits, objects);
    json["terms"] = terms_json(node);
    json["color"] = as_json(node.color);
    return json;
}

Json layers_json(const Explanation& of) {
    Json layers = Json::array();
    LayerSample sum = {};
    for (std::size_t i = 0; i < of.samples.size(); ++i) {
        sum = layer_sum(std::array{sum, of.samples[i]});
        layers.push_back(
            {{"name", i < of.layers.size() ? of.layers[i].name : PictureLayer::rounding},
             {"value", as_json(of.samples[i])},
             {"sum", as_json(sum)}});
    }
    return layers;
}

} // namespace

nlohmann::ordered_json explanation_json(const Explanation& explanation) {
    SceneObjects objects(explanation.prepared.scene);
    const PictureSettings& settings = explanation.prepared.settings;
    Json json = {
        {"version", 1},
        {"x", explanation.x},
        {"y", explanation.y},
        {"width", settings.width},
        {"height", settings.height},
        {"index", explanation.index},
        {"color", as_json(explanation.tree.nodes.front().color)},
        {"bytes", picture_bytes(explanation)}};
    if (explanation.exposure)
        json["exposure_factor"] = explanation.exposure->factor;
    json["rays"] = Json::array();
    for (std::size_t i = 0; i < explanation.tree.nodes.size(); ++i)
        json["rays"].push_back(ray_json(explanation, i, objects));
    json["layers"] = layers_json(explanation);
    return json;
}

} // namespace vera
