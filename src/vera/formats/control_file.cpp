// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/control_file.h"

#include "vera/formats/complaints.h"
#include "vera/formats/control_words.h"
#include "vera/formats/profile_reader.h"
#include "vera/formats/source_text.h"
#include "vera/formats/vera_keywords.h"
#include "vera/formats/word_reader.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

namespace vera {

namespace {

/// In the order of control_words.
enum class Keyword : std::uint8_t {
    raster,
    depth,
    exposure,
    ambient,
    sky,
    horizon,
    earth,
    profile,
    shadows,
    antialias,
    frame,
    aspect,
    samples,
    tolerance,
    lights
};

std::optional<Keyword> keyword_named(std::string_view word) {
    const auto found = std::find(control_words.begin(), control_words.end(), word);
    if (found == control_words.end())
        return std::nullopt;
    return static_cast<Keyword>(found - control_words.begin());
}

/// The parts of the firmament as they are written.
struct FirmamentWords {
    std::optional<Color> sky;
    std::optional<Color> horizon;
    std::optional<Color> earth;
    std::optional<HorizonProfile> profile;
};

/// Reads keyword after keyword.
class ControlReader {
public:
    ControlReader(const SourceText& text, PictureSettings defaults)
        : words_(text, complaints_)
        , settings_(std::move(defaults)) {
        settings_.shadows = false;
        settings_.antialiasing.on = false;
    }

    PictureSettings read(std::vector<Diagnostic>& warnings) {
        for (std::string_view word = words_.peek(); !word.empty() && !complaints_.full();
             word = words_.peek()) {
            const auto keyword = keyword_named(word);
            if (keyword) {
                words_.take();
                read_once(*keyword);
                continue;
            }
            complain_of_word(word);
            skip();
        }
        set_firmament();
        warn_of_idle_words();
        const std::vector<Diagnostic> found = complaints_.finish();
        warnings.insert(warnings.end(), found.begin(), found.end());
        return settings_;
    }

private:
    void skip() {
        words_.take_until([](std::string_view word) { return keyword_named(word).has_value(); });
    }

    void complain_of_word(std::string_view word) {
        std::string similar;
        std::string remedy;
        if (statement_named(word))
            remedy = fmt::format("{} belongs in the scene", word);
        else if (similar = did_you_mean(word, control_words); similar.empty() && !complete_.empty())
            remedy = fmt::format("the {} before it is complete", complete_);
        complaints_.error(
            words_.place(),
            fmt::format("expected a keyword of control files, found {}{}", shown(word), similar),
            std::move(remedy));
        words_.take();
    }

    void read_once(Keyword keyword) {
        const WordPlace place = words_.last_place();
        auto& first = places_[static_cast<std::size_t>(keyword)];
        const std::string_view name = control_words[static_cast<std::size_t>(keyword)];
        if (first)
            complaints_.error(
                place,
                fmt::format("{} is given twice", name),
                fmt::format("the first stands in line {}", first->line));
        else
            first = place;
        const std::size_t errors = complaints_.error_count();
        read_values(keyword);
        complete_ = name;
        if (complaints_.error_count() > errors)
            skip();
    }

    void read_values(Keyword keyword);
    void read_raster();
    void read_exposure();
    void read_frame();
    void read_aspect();
    void read_samples();
    void read_tolerance();
    void read_lights();
    void warn_of_idle_words();
    void set_firmament();

    void take_color(const char* what, std::optional<Color>& color) {
        if (const auto taken = words_.take_color(what))
            color = taken;
    }

    Complaints complaints_;
    WordReader words_;
    PictureSettings settings_;
    FirmamentWords firmament_;
    std::array<std::optional<WordPlace>, control_words.size()> places_;
    std::string_view complete_;
};

void ControlReader::read_values(Keyword keyword) {
    switch (keyword) {
    case Keyword::raster:
        return read_raster();
    case Keyword::depth:
        if (const auto depth = words_.take_whole_number("RTDEPTH", 1, PictureLimits::deepest))
            settings_.depth = static_cast<std::uint32_t>(*depth);
        return;
    case Keyword::exposure:
        return read_exposure();
    case Keyword::ambient:
        if (const auto color = words_.take_color("AMBIENT"))
            settings_.ambient = *color;
        return;
    case Keyword::sky:
        return take_color("SKY", firmament_.sky);
    case Keyword::horizon:
        return take_color("HORIZON", firmament_.horizon);
    case Keyword::earth:
        return take_color("EARTH", firmament_.earth);
    case Keyword::profile:
        firmament_.profile = read_profile(words_);
        return;
    case Keyword::shadows:
        settings_.shadows = true;
        return;
    case Keyword::antialias:
        settings_.antialiasing.on = true;
        return;
    case Keyword::frame:
        return read_frame();
    case Keyword::aspect:
        return read_aspect();
    case Keyword::samples:
        return read_samples();
    case Keyword::tolerance:
        return read_tolerance();
    case Keyword::lights:
        return read_lights();
    }
}

void ControlReader::read_raster() {
    constexpr std::uint64_t largest = PictureLimits::longest_side;
    const auto width = words_.take_whole_number("the picture's width in pixels", 1, largest);
    if (!width)
        return;
    const auto height = words_.take_whole_number("the picture's height in pixels", 1, largest);
    if (!height)
        return;
    settings_.width = static_cast<std::uint32_t>(*width);
    settings_.height = static_cast<std::uint32_t>(*height);
}

void ControlReader::read_exposure() {
    const WordPlace place = words_.place();
    const auto exposure = words_.take_number("EXPMES");
    if (!exposure)
        return;
    if (*exposure >= 0 && *exposure <= 1) {
        settings_.exposure = *exposure;
        return;
    }
    complaints_.error(
        place,
        fmt::format("EXPMES is {}, but must be from 0 to 1", *exposure),
        "0 measures only; more scales the light until bright parts of the picture get this value");
}

void ControlReader::read_frame() {
    const WordPlace place = words_.place();
    const auto margin = words_.take_number("FRAME, the margin");
    if (!margin)
        return;
    if (*margin >= 0 && *margin < PictureLimits::widest_margin) {
        settings_.frame_margin = *margin;
        return;
    }
    complaints_.error(
        place,
        fmt::format("the margin of FRAME is {}, but must be at least 0 and less than 0.5", *margin),
        "it is the part of the picture that stays free on each side, for example 0.05");
}

void ControlReader::read_aspect() {
    const WordPlace place = words_.place();
    const auto aspect = words_.take_number("ASPECT, the width of a pixel by its height");
    if (!aspect)
        return;
    constexpr double largest = PictureLimits::largest_aspect;
    if (*aspect >= 1 / largest && *aspect <= largest) {
        settings_.pixel_aspect = *aspect;
        return;
    }
    complaints_.error(
        place,
        fmt::format("ASPECT is {}, but must be from 0.001 to 1000", *aspect),
        "it is the width of a pixel by its height: 1 for square pixels");
}

void ControlReader::read_samples() {
    const WordPlace place = words_.place();
    const auto samples = words_.take_whole_number("SAMPLES", 2, PictureLimits::most_samples);
    if (!samples)
        return;
    if ((*samples & (*samples - 1)) == 0) {
        settings_.antialiasing.samples = static_cast<std::uint32_t>(*samples);
        return;
    }
    complaints_.error(
        place,
        fmt::format("SAMPLES is {}, but must be a power of two", *samples),
        "2, 4, 8, 16, 32, 64, 128 or 256");
}

void ControlReader::read_tolerance() {
    const WordPlace place = words_.place();
    const auto tolerance = words_.take_number("TOLERANCE");
    if (!tolerance)
        return;
    if (*tolerance >= 0 && *tolerance <= 1) {
        settings_.antialiasing.tolerance = *tolerance;
        return;
    }
    complaints_.error(
        place,
        fmt::format("TOLERANCE is {}, but must be from 0 to 1", *tolerance),
        "it is the difference of neighbouring pixels, in any colour, that refines a pixel");
}

void ControlReader::read_lights() {
    settings_.light_factors_line = static_cast<std::uint32_t>(words_.last_place().line);
    std::vector<double> factors;
    // One at least; what follows is a factor unless it is a keyword.
    do {
        const WordPlace place = words_.place();
        const auto factor = words_.take_number("a factor of LIGHTS");
        if (!factor)
            return;
        if (!(*factor >= 0)) {
            complaints_.error(
                place,
                fmt::format("a factor of LIGHTS is {}, but must be at least 0", *factor),
                "0 turns a light off, 1 leaves it as it is");
            return;
        }
        factors.push_back(*factor);
    } while (!words_.peek().empty() && !keyword_named(words_.peek()));
    settings_.light_factors = std::move(factors);
}

void ControlReader::warn_of_idle_words() {
    if (settings_.antialiasing.on || complaints_.error_count() > 0)
        return;
    for (const Keyword keyword : {Keyword::samples, Keyword::tolerance})
        if (const auto& place = places_[static_cast<std::size_t>(keyword)])
            complaints_.warn(
                "settings of anti-aliasing without ANTI-ALIAS",
                *place,
                fmt::format(
                    "{} does nothing without ANTI-ALIAS",
                    control_words[static_cast<std::size_t>(keyword)]),
                "give ANTI-ALIAS as well, or --antialias on: edges are smoothed then");
}

void ControlReader::set_firmament() {
    if (firmament_.sky) {
        const Color horizon = firmament_.horizon.value_or(*firmament_.sky);
        settings_.firmament = {
            *firmament_.sky,
            horizon,
            firmament_.earth.value_or(horizon),
            std::move(firmament_.profile)};
        return;
    }
    for (const Keyword keyword : {Keyword::horizon, Keyword::earth, Keyword::profile})
        if (const auto& place = places_[static_cast<std::size_t>(keyword)])
            complaints_.warn(
                "parts of a firmament without SKY",
                *place,
                fmt::format(
                    "{} is ignored without SKY", control_words[static_cast<std::size_t>(keyword)]),
                "give SKY as well: without it the whole firmament is black");
}

} // namespace

PictureSettings read_control_file(
    const std::filesystem::path& path,
    const PictureSettings& defaults,
    std::vector<Diagnostic>& warnings) {
    const SourceText text(path);
    return read_control_text(text, defaults, warnings);
}

PictureSettings read_control_text(
    const SourceText& text, const PictureSettings& defaults, std::vector<Diagnostic>& warnings) {
    return ControlReader(text, defaults).read(warnings);
}

void scale_lights(
    Scene& scene, const PictureSettings& settings, const std::filesystem::path& control_file) {
    const std::vector<double>& factors = settings.light_factors;
    if (factors.empty())
        return;
    if (factors.size() != scene.lights.size()) {
        Diagnostic wrong;
        wrong.place = {control_file.string(), settings.light_factors_line, 1};
        wrong.problem = fmt::format(
            "LIGHTS gives {} {}, but the scene has {} {}",
            factors.size(),
            factors.size() == 1 ? "factor" : "factors",
            scene.lights.size(),
            scene.lights.size() == 1 ? "light" : "lights");
        wrong.remedy = "give one factor for each LI, in their order: 1 leaves a light as it is";
        throw InputError({wrong});
    }
    for (std::size_t i = 0; i < factors.size(); ++i)
        scene.lights[i].intensity *= factors[i];
}

} // namespace vera
