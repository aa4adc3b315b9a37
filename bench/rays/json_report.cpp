// SPDX-License-Identifier: Apache-2.0
#include "report.h"
#include <embree3/rtcore.h>
#include <nlohmann/json.hpp>

namespace vera {

namespace {

using Json = nlohmann::ordered_json;

const char* name_of(EmbreeQuality quality) {
    return quality == EmbreeQuality::medium ? "medium" : "high";
}

const char* name_of(OurCall call) {
    switch (call) {
    case OurCall::generation:
        return "generation";
    case OurCall::all:
        return "all";
    case OurCall::one:
        break;
    }
    return "one";
}

void add(Json& json, const EmbreeSettings& build) {
    json["quality"] = name_of(build.quality);
    json["robust"] = build.edges == EmbreeEdges::robust;
}

void add(Json& json, const Rate& rate) {
    json["rate"] = rate.median;
    json["slowest"] = rate.slowest;
    json["fastest"] = rate.fastest;
}

Json as_json(const BuildMeasurement& build) {
    Json json = {{"index", build.embree ? "embree" : build.name}};
    if (build.embree)
        add(json, *build.embree);
    json["seconds"] = build.seconds;
    json["bytes"] = build.bytes;
    if (build.nodes > 0)
        json["nodes"] = build.nodes;
    return json;
}

Json as_json(const RaysMeasurement& rays) {
    Json json = {
        {"kind", rays.rays},
        {"rays", rays.count},
        {"disagreement", rays.disagreement},
        {"ours", Json::array()},
        {"embree", Json::array()},
        {"steps", Json::array()}};
    for (const OurRate& ours : rays.ours) {
        Json one = {{"index", ours.index}, {"call", name_of(ours.call)}};
        add(one, ours.rate);
        json["ours"].push_back(one);
    }
    for (const EmbreeRate& embree : rays.embree) {
        Json one = {{"call", embree.call}, {"one_ray", embree.one_ray}};
        add(one, embree.build);
        add(one, embree.rate);
        json["embree"].push_back(one);
    }
    for (const StepsPerRay& steps : rays.steps)
        json["steps"].push_back(
            {{"index", steps.index}, {"nodes", steps.nodes}, {"tests", steps.tests}});
    return json;
}

} // namespace

nlohmann::ordered_json as_json(const MeasurementSettings& settings) {
    return {
        {"embree", RTC_VERSION_STRING},
        {"embree_device", settings.embree_device},
        {"threads", settings.threads},
        {"runs", settings.runs},
        {"raster", settings.raster},
        {"generation", settings.generation},
        {"unit", "million rays a second"}};
}

nlohmann::ordered_json as_json(const SceneMeasurement& scene) {
    Json json = {
        {"name", scene.name},
        {"kind", name_of(scene.kind)},
        {"primitives", scene.primitives},
        {"triangles_for_embree", scene.triangles_for_embree},
        {"builds", Json::array()},
        {"rays", Json::array()}};
    for (const BuildMeasurement& build : scene.builds)
        json["builds"].push_back(as_json(build));
    for (const RaysMeasurement& rays : scene.rays)
        json["rays"].push_back(as_json(rays));
    return json;
}

} // namespace vera
