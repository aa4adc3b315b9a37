// SPDX-License-Identifier: Apache-2.0
#include "picture_metadata.h"

#include "vera/base/version.h"
#include "vera/formats/source_text.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <string>
#include <string_view>

#include <fmt/format.h>

namespace vera {

namespace {

/// FNV-1a, of words of eight bytes instead of single ones, since each waits for the one before; the
/// upper half is carried into the lower one, where a product alone would never take it.
class Hash {
public:
    void add(std::string_view text) {
        for (; text.size() >= sizeof(std::uint64_t); text.remove_prefix(sizeof(std::uint64_t)))
            add_word(text.data(), sizeof(std::uint64_t));
        add_word(text.data(), text.size());
        add(text.size());
    }

    std::uint64_t value() const { return value_; }

private:
    void add(std::uint64_t word) {
        value_ = (value_ ^ word) * 0x100000001b3;
        value_ ^= value_ >> 32U;
    }

    /// The first byte is the least significant one, on every machine.
    void add_word(const char* bytes, std::size_t count) {
        std::uint64_t word = 0;
        std::memcpy(&word, bytes, count);
        if constexpr (std::endian::native == std::endian::big)
            word = __builtin_bswap64(word);
        add(word);
    }

    std::uint64_t value_ = 0xcbf29ce484222325;
};

/// Of all files that the scene was read from: tells two versions of a scene apart.
std::string scene_hash(const Scene& scene) {
    Hash hash;
    for (const std::string& path : scene.files)
        if (path != "-" && std::filesystem::is_regular_file(path))
            hash.add(SourceText(path).text());
    return fmt::format("{:016x}", hash.value());
}

} // namespace

PictureMetadata picture_metadata(const PreparedScene& prepared) {
    const auto point = [](Vec3 p) { return fmt::format("{} {} {}", p.x, p.y, p.z); };
    const Camera& camera = prepared.camera;
    const bool parallel = camera.projection == Camera::Projection::parallel;
    return {
        {"Software", fmt::format("vera {}", version)},
        {"Scene hash", scene_hash(prepared.scene)},
        {"Settings", control_text(prepared.settings)},
        {"Camera",
         fmt::format(
             "{} {} {} {} {}",
             parallel ? "PARALLEL" : "PROJECTION",
             point(parallel ? camera.direction : camera.viewpoint),
             point(camera.lower_left),
             point(camera.lower_right),
             point(camera.upper_left))}};
}

} // namespace vera
