// SPDX-License-Identifier: Apache-2.0
#include "reference/reference_renderer.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "reference/faces.h"

namespace vera::reference {
namespace {

/// Surfaces nearer than this part of the coordinates' size coincide.
constexpr Real coincidence = 1e-12L;

/// A colour in two parts: what grows with the light sources and AMBIENT, and what does not.
struct Value {
    Vector lit;
    Vector fixed;
};

Value operator+(const Value& a, const Value& b) {
    return {a.lit + b.lit, a.fixed + b.fixed};
}

Value filtered(Vector filter, const Value& value) {
    return {filtered(filter, value.lit), filtered(filter, value.fixed)};
}

class Tracer {
public:
    Tracer(const Scene& scene, PictureSettings settings)
        : scene_(scene)
        , settings_(std::move(settings))
        , faces_(faces_of(scene)) {}

    /// "Pixel (i, j) of a W x H raster, j counted from the top, sees through
    /// LL + (i+1/2)/W (LR-LL) + (1 - (j+1/2)/H) (UL-LL)."
    Value pixel(
        std::uint32_t i,
        std::uint32_t j,
        std::uint32_t width,
        std::uint32_t height,
        bool* hit_something = nullptr) const {
        const Camera& camera = *scene_.camera;
        const Real across = (static_cast<Real>(i) + 0.5L) / width;
        const Real up = 1 - (static_cast<Real>(j) + 0.5L) / height;
        const Vector corner = vector_of(camera.lower_left);
        const Vector point = corner + across * (vector_of(camera.lower_right) - corner)
            + up * (vector_of(camera.upper_left) - corner);

        // "The ray starts at the view point ... PARALLEL: the ray passes through that point in the
        // given direction and sees everything along it."
        if (camera.projection == Camera::Projection::parallel)
            return traced(
                {point, unit(vector_of(camera.direction))}, everything, nullptr, 1, hit_something);
        const Vector eye = vector_of(camera.viewpoint);
        return traced({eye, unit(point - eye)}, 0, nullptr, 1, hit_something);
    }

private:
    static constexpr Real everything = -std::numeric_limits<Real>::infinity();

    /// The colour that the line brings to its start; `level` of the ray tree counts from 1.
    Value traced(
        const Line& line,
        Real from,
        const Face* start,
        std::uint32_t level,
        bool* hit_something = nullptr) const {
        const auto hit = nearest(line, from, start);
        if (hit_something)
            *hit_something = hit.has_value();
        return hit ? lighted(line, *hit, level) : Value{{}, firmament(line.direction)};
    }

    std::optional<Crossing> nearest(const Line& line, Real from, const Face* start) const {
        // "rays that start there do not meet the other" of two surfaces that coincide.
        const Real least = start ? coincidence * size(line.origin) : from;
        std::vector<Crossing> found = crossings(faces_, line, start);
        std::erase_if(found, [&](const Crossing& crossing) {
            return crossing.face == start ? crossing.t <= 0 : crossing.t <= least;
        });
        if (found.empty())
            return std::nullopt;

        // "Where two surfaces coincide, the one that stands earlier in the text is in front".
        const Crossing first =
            *std::min_element(found.begin(), found.end(), [](const Crossing& a, const Crossing& b) {
                return a.t < b.t;
            });
        const Real last = first.t + coincidence * (size(line.origin) + std::fabs(first.t));
        Crossing best = first;
        for (const Crossing& crossing : found)
            if (crossing.t <= last && crossing.face->order < best.face->order)
                best = crossing;
        return best;
    }

    /// Amb + Dif + Spk + Slm + Rfl + Rfr.
    Value lighted(const Line& line, const Crossing& hit, std::uint32_t level) const {
        const Material material = hit.face->material == inherited_material
            ? Material::fallback()
            : scene_.materials[static_cast<std::size_t>(hit.face->material)];
        const Vector drf = vector_of(material.drf);
        const Vector arf = vector_of(material.arf);
        const Vector point = line.origin + hit.t * line.direction;
        const Surface surface = hit.face->surface(point, hit);

        // "R: unit vector from the hit point to the ray's origin. N: unit normal ..., turned so
        // that R.N >= 0. S: mirror direction of R about N."
        const Vector R = -1 * line.direction;
        const Vector N = inner(R, surface.normal) < 0 ? -1 * surface.normal : surface.normal;
        const Vector S = 2 * inner(R, N) * N - R;

        Value value;
        value.lit = filtered(inner(R, N) * drf + arf, vector_of(settings_.ambient));
        value.fixed = inner(R, N) * vector_of(material.san) + vector_of(material.sdi);

        for (const PointLight& light : scene_.lights) {
            const Vector to_light = vector_of(light.position) - point;
            const Real distance = norm(to_light);
            const Vector L = unit(to_light);
            // "A light with L.N <= 0 gives nothing; nor does one on the other side of the geometric
            // surface than R".
            if (inner(L, N) <= 0 || inner(L, surface.outside) * inner(R, surface.outside) <= 0)
                continue;
            const Real falloff = light.falloff == Falloff::none ? 1 : 1 / (distance * distance);
            const Vector intens = filtered(
                light.intensity * falloff * vector_of(light.color),
                visibility({point, L}, distance, hit.face));
            const Real highlight = f(inner(L, S), material.spc);
            value.lit = value.lit + filtered(inner(L, N) * drf, intens)
                + filtered(std::fmax(0.0L, inner(L, R)) * arf, intens)
                + highlight * highlight * intens;
        }

        // "RTDEPTH D: the ray tree has D levels ... Deeper rays contribute nothing."
        if (level >= settings_.depth)
            return value;
        const Vector rab = vector_of(material.rab);
        const Vector tab = vector_of(material.tab);
        if (!is_black(rab))
            value = value + filtered(rab, traced({point, S}, 0, hit.face, level + 1));
        if (!is_black(tab)) {
            const bool enters = inner(R, surface.outside) > 0;
            const Vector through = refracted(R, N, enters, material.ref).value_or(S);
            value = value + filtered(tab, traced({point, through}, 0, hit.face, level + 1));
        }
        return value;
    }

    /// "f(x) = (x-SPC)(x+SPC-2)/(1-SPC)^2 for SPC < 1 and x >= SPC, else 0"
    static Real f(Real x, Real spc) {
        return spc < 1 && x >= spc ? (x - spc) * (x + spc - 2) / ((1 - spc) * (1 - spc)) : 0;
    }

    /// "the product over the surfaces between the point and the light of their TAB ... every
    /// crossing counts ... the surface at the point itself does not"
    Vector visibility(const Line& line, Real distance, const Face* start) const {
        Vector passed = {1, 1, 1};
        if (!settings_.shadows)
            return passed;
        const Real least = coincidence * size(line.origin);
        for (const Crossing& crossing : crossings(faces_, line, start)) {
            if (crossing.t <= (crossing.face == start ? 0 : least) || crossing.t >= distance)
                continue;
            const MaterialId id = crossing.face->material;
            passed = id == inherited_material
                ? Vector{}
                : filtered(passed, vector_of(scene_.materials[static_cast<std::size_t>(id)].tab));
        }
        return passed;
    }

    /// "Refraction bends by Snell's law, index 1 outside, REF inside". Nothing on total reflection.
    /// The part of the direction along the surface shrinks by the ratio of the indices.
    static std::optional<Vector> refracted(Vector R, Vector N, bool enters, Real ref) {
        const Vector along = inner(R, N) * N - R;
        const Vector along_after = (enters ? 1 / ref : ref) * along;
        const Real sine_squared = inner(along_after, along_after);
        if (sine_squared > 1)
            return std::nullopt;
        return unit(along_after - std::sqrt(1 - sine_squared) * N);
    }

    /// "y is up; with u the y-part of its unit direction, HORIZON + (SKY-HORIZON) u for u >= 0,
    /// EARTH below. Without SKY the whole firmament is black".
    Vector firmament(Vector direction) const {
        if (!settings_.firmament)
            return {};
        const Vector sky = vector_of(settings_.firmament->sky);
        const Vector horizon = vector_of(settings_.firmament->horizon);
        const Real u = direction.y;
        if (is_earth(direction))
            return vector_of(settings_.firmament->earth);
        return horizon + std::max(u, Real{0}) * (sky - horizon);
    }

    /// "PROFILE: ... the line from one point to the next is part of a great circle".
    bool is_earth(Vector direction) const {
        const auto& profile = settings_.firmament->profile;
        if (!profile)
            return direction.y < 0;
        const Real degree = std::acos(Real{-1}) / 180;
        const auto points = profile->points();
        const Real turned = std::atan2(direction.x, -direction.z) / degree;
        const Real azimuth = turned < points.front().azimuth_degrees ? turned + 360 : turned;
        std::size_t i = points.size() - 1;
        while (i > 0 && points[i].azimuth_degrees > azimuth)
            --i;
        const ProfilePoint& a = points[i];
        const ProfilePoint& b = points[i + 1 < points.size() ? i + 1 : 0];
        const auto slope = [&](const ProfilePoint& point) {
            return std::tan(point.elevation_degrees * degree);
        };
        const Real from_a = (azimuth - a.azimuth_degrees) * degree;
        const Real gap = (b.azimuth_degrees - a.azimuth_degrees) * degree;
        const Real height =
            (slope(a) * std::sin(gap - from_a) + slope(b) * std::sin(from_a)) / std::sin(gap);
        return direction.y < height * std::hypot(direction.x, direction.z);
    }

    const Scene& scene_;
    PictureSettings settings_;
    Group faces_;
};

/// "EXPMES e with 0 < e <= 1 scales the light sources and AMBIENT by one factor s: over the centres
/// of a 64 x 64 raster (one ray each ..., unclamped) that hit something, the value of a ray is its
/// largest colour s a + b ...; s makes the nearest-rank 95 % quantile equal e; where no s > 0 does,
/// ... s = 1."
Real light_factor(const Tracer& tracer, Real wanted) {
    std::vector<Value> values;
    for (std::uint32_t j = 0; j < 64; ++j)
        for (std::uint32_t i = 0; i < 64; ++i) {
            bool hit = false;
            const Value value = tracer.pixel(i, j, 64, 64, &hit);
            if (hit)
                values.push_back(value);
        }
    if (values.empty())
        return 1;

    const auto quantile = [&](Real s) {
        std::vector<Real> largest;
        for (const auto& [a, b] : values)
            largest.push_back(std::fmax(s * a.x + b.x, std::fmax(s * a.y + b.y, s * a.z + b.z)));
        std::sort(largest.begin(), largest.end());
        const std::size_t rank = (95 * largest.size() + 99) / 100; // rounded up
        return largest[rank - 1];
    };
    // The quantile never falls as s grows: so halve, on a scale of powers of two.
    Real low = std::ldexp(1.0L, -200);
    Real high = std::ldexp(1.0L, 200);
    if (quantile(low) > wanted || quantile(high) < wanted)
        return 1;
    for (int round = 0; round < 400; ++round) {
        const Real middle = std::sqrt(low) * std::sqrt(high);
        (quantile(middle) < wanted ? low : high) = middle;
    }
    return high;
}

/// "a byte is round(255 min(1, max(0, value)))"
std::uint8_t byte(Real value) {
    return static_cast<std::uint8_t>(std::lround(255 * std::fmin(1.0L, std::fmax(0.0L, value))));
}

} // namespace

ReferencePicture reference_picture(const Scene& scene, const PictureSettings& settings) {
    const Tracer tracer(scene, settings);
    const Real s = settings.exposure.value_or(0) > 0 ? light_factor(tracer, *settings.exposure) : 1;

    ReferencePicture picture;
    picture.light_factor = static_cast<double>(s);
    for (std::uint32_t j = 0; j < settings.height; ++j)
        for (std::uint32_t i = 0; i < settings.width; ++i) {
            const auto [lit, fixed] = tracer.pixel(i, j, settings.width, settings.height);
            const Vector color = s * lit + fixed;
            for (const Real value : {color.x, color.y, color.z})
                picture.bytes.push_back(byte(value));
        }
    return picture;
}

} // namespace vera::reference
