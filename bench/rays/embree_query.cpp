// SPDX-License-Identifier: Apache-2.0
#include "embree_query.h"

#include "vera/base/check.h"

#include <array>
#include <limits>

#include "turns.h"
#include <fmt/format.h>
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

namespace vera {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

/// Embree is fastest where numbers too small for the usual form count as 0, as its manual asks;
/// our indexes are not asked about rays while this lives.
class TinyNumbersAreZero {
public:
#ifdef __SSE2__
    TinyNumbersAreZero()
        : before_(_mm_getcsr()) {
        constexpr unsigned results_and_arguments = 0x8040;
        _mm_setcsr(before_ | results_and_arguments);
    }

    ~TinyNumbersAreZero() {
        _mm_setcsr(before_);
    }
#else
    TinyNumbersAreZero() {}

    ~TinyNumbersAreZero() {}
#endif

    TinyNumbersAreZero(const TinyNumbersAreZero&) = delete;
    TinyNumbersAreZero& operator=(const TinyNumbersAreZero&) = delete;

private:
#ifdef __SSE2__
    unsigned before_;
#endif
};

// One ray, eight and sixteen, with their hits or without, by the same names.

template <typename Packet>
constexpr std::size_t width_of = 1;
template <>
constexpr std::size_t width_of<RTCRay8> = 8;
template <>
constexpr std::size_t width_of<RTCRayHit8> = 8;
template <>
constexpr std::size_t width_of<RTCRay16> = 16;
template <>
constexpr std::size_t width_of<RTCRayHit16> = 16;

template <typename Packet>
auto& ray_part(Packet& packet) {
    if constexpr (requires { packet.ray; })
        return packet.ray;
    else
        return packet;
}

float& lane(float& value, std::size_t) {
    return value;
}

unsigned& lane(unsigned& value, std::size_t) {
    return value;
}

template <typename Number, std::size_t Width>
Number& lane(Number (&values)[Width], std::size_t i) {
    return values[i];
}

template <typename Packet>
void fill(Packet& packet, std::size_t i, const FloatRay& from) {
    auto& ray = ray_part(packet);
    lane(ray.org_x, i) = from.origin[0];
    lane(ray.org_y, i) = from.origin[1];
    lane(ray.org_z, i) = from.origin[2];
    lane(ray.tnear, i) = 0;
    lane(ray.dir_x, i) = from.direction[0];
    lane(ray.dir_y, i) = from.direction[1];
    lane(ray.dir_z, i) = from.direction[2];
    lane(ray.time, i) = 0;
    lane(ray.tfar, i) = from.t_max;
    lane(ray.mask, i) = ~0U;
    lane(ray.id, i) = 0;
    lane(ray.flags, i) = 0;
    if constexpr (requires { packet.hit; }) {
        lane(packet.hit.geomID, i) = RTC_INVALID_GEOMETRY_ID;
        lane(packet.hit.instID[0], i) = RTC_INVALID_GEOMETRY_ID;
    }
}

template <typename Packet>
float distance(Packet& packet, std::size_t i) {
    const float t = lane(ray_part(packet).tfar, i);
    if constexpr (requires { packet.hit; })
        return lane(packet.hit.geomID, i) == RTC_INVALID_GEOMETRY_ID ? infinity : t;
    else
        return t < 0 ? 0 : infinity; // what is hidden gets -infinity
}

void ask(RTCScene scene, RTCIntersectContext& context, const int*, RTCRayHit& ray) {
    rtcIntersect1(scene, &context, &ray);
}

void ask(RTCScene scene, RTCIntersectContext& context, const int*, RTCRay& ray) {
    rtcOccluded1(scene, &context, &ray);
}

void ask(RTCScene scene, RTCIntersectContext& context, const int* valid, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &context, &rays);
}

void ask(RTCScene scene, RTCIntersectContext& context, const int* valid, RTCRay8& rays) {
    rtcOccluded8(valid, scene, &context, &rays);
}

void ask(RTCScene scene, RTCIntersectContext& context, const int* valid, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &context, &rays);
}

void ask(RTCScene scene, RTCIntersectContext& context, const int* valid, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &context, &rays);
}

void ask_stream(RTCScene scene, RTCIntersectContext& context, RTCRayHit* first, std::size_t count) {
    rtcIntersect1M(scene, &context, first, static_cast<unsigned>(count), sizeof(RTCRayHit));
}

void ask_stream(RTCScene scene, RTCIntersectContext& context, RTCRay* first, std::size_t count) {
    rtcOccluded1M(scene, &context, first, static_cast<unsigned>(count), sizeof(RTCRay));
}

/// Asks about rays number first to first + count; first is a multiple of the packets' width.
template <typename Packet>
void ask_packets(
    RTCScene scene,
    RTCIntersectContext& context,
    std::vector<Packet>& packets,
    std::size_t first,
    std::size_t count) {
    constexpr std::size_t width = width_of<Packet>;
    alignas(64) std::array<int, width> valid;
    valid.fill(-1);
    std::size_t i = first;
    for (; i + width <= first + count; i += width)
        ask(scene, context, valid.data(), packets[i / width]);
    if (i == first + count)
        return;
    for (std::size_t j = 0; j < width; ++j)
        valid[j] = i + j < first + count ? -1 : 0;
    ask(scene, context, valid.data(), packets[i / width]);
}

RTCIntersectContext context_of(const EmbreeCall& call) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = call.promise == Coherence::coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT
                                                        : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
    return context;
}

} // namespace

std::string name_of(const EmbreeCall& call, Question question) {
    const char* const verb = question == Question::nearest ? "intersect" : "occluded";
    const auto width = [&]() -> std::string {
        switch (call.width) {
        case EmbreeWidth::one:
            return "1";
        case EmbreeWidth::eight:
            return "8";
        case EmbreeWidth::sixteen:
            return "16";
        case EmbreeWidth::stream:
            break;
        }
        return call.generation == whole_generation ? "1M all" : "1M";
    };
    return fmt::format(
        "{}{}{}", verb, width(), call.promise == Coherence::coherent ? " coherent" : "");
}

std::vector<EmbreeCall> embree_calls(Coherence coherence) {
    constexpr std::size_t usual = 1024;
    std::vector<EmbreeCall> calls = {
        {EmbreeWidth::one, Coherence::incoherent, usual},
        {EmbreeWidth::eight, Coherence::incoherent, usual},
        {EmbreeWidth::sixteen, Coherence::incoherent, usual},
        {EmbreeWidth::stream, Coherence::incoherent, usual},
        {EmbreeWidth::stream, Coherence::incoherent, whole_generation}};
    if (coherence == Coherence::coherent) {
        calls.push_back({EmbreeWidth::eight, Coherence::coherent, usual});
        calls.push_back({EmbreeWidth::sixteen, Coherence::coherent, usual});
        calls.push_back({EmbreeWidth::stream, Coherence::coherent, usual});
    }
    return calls;
}

EmbreeQuery::EmbreeQuery(const RaySet& rays, std::size_t threads)
    : rays_(rays)
    , threads_(threads)
    , distances_(rays.floats.size()) {}

template <typename Packet>
double
EmbreeQuery::run_packets(RTCScene scene, const EmbreeCall& call, std::vector<Packet>& packets) {
    constexpr std::size_t width = width_of<Packet>;
    const std::size_t count = rays_.floats.size();
    packets.resize((count + width - 1) / width);
    for (std::size_t i = 0; i < count; ++i)
        fill(packets[i / width], i % width, rays_.floats[i]);

    const Stopwatch watch(threads_);
    for_each_generation(count, call.generation, threads_, [&](std::size_t first, std::size_t size) {
        const TinyNumbersAreZero mode;
        RTCIntersectContext context = context_of(call);
        if constexpr (width == 1) {
            if (call.width == EmbreeWidth::stream) {
                ask_stream(scene, context, &packets[first], size);
                return;
            }
        }
        ask_packets(scene, context, packets, first, size);
    });
    const double seconds = watch.seconds();

    for (std::size_t i = 0; i < count; ++i)
        distances_[i] = distance(packets[i / width], i % width);
    return seconds;
}

double EmbreeQuery::run(const EmbreeScene& scene, const EmbreeCall& call) {
    const bool nearest = rays_.question == Question::nearest;
    switch (call.width) {
    case EmbreeWidth::one:
    case EmbreeWidth::stream:
        return nearest ? run_packets(scene.handle(), call, hits_)
                       : run_packets(scene.handle(), call, rays_1_);
    case EmbreeWidth::eight:
        return nearest ? run_packets(scene.handle(), call, hits_8_)
                       : run_packets(scene.handle(), call, rays_8_);
    case EmbreeWidth::sixteen:
        return nearest ? run_packets(scene.handle(), call, hits_16_)
                       : run_packets(scene.handle(), call, rays_16_);
    }
    VERA_CHECK(false);
    return 0;
}

Distances EmbreeQuery::distances() const {
    return distances_;
}

} // namespace vera
