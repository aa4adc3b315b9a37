// SPDX-License-Identifier: Apache-2.0
#include "vera/formats/profile_reader.h"

#include <utility>
#include <vector>

#include <fmt/format.h>

namespace vera {

namespace {

std::optional<double> take_number_within(
    WordReader& words, const char* what, double least, double most, const char* remedy) {
    const WordPlace place = words.place();
    const auto number = words.take_number(what);
    if (!number || (*number >= least && *number <= most))
        return number;
    words.complaints().error(
        place,
        fmt::format("{} is {}, but must be from {} to {}", what, *number, least, most),
        remedy);
    return std::nullopt;
}

std::optional<HorizonProfile> read_mountains(WordReader& words) {
    // Larger ones are not all told apart: a number is read as a double.
    constexpr std::uint64_t largest_seed = (std::uint64_t{1} << 53U) - 1;
    const auto seed = words.take_whole_number("the seed of MOUNTAINS", 0, largest_seed);
    if (!seed)
        return std::nullopt;
    const auto height = take_number_within(
        words,
        "the height of MOUNTAINS",
        0,
        HorizonProfile::steepest,
        "it is the elevation of the highest peak in degrees, for example 12");
    if (!height)
        return std::nullopt;
    const auto roughness = take_number_within(
        words, "the roughness of MOUNTAINS", 0, 1, "0 makes soft hills, 1 jagged rocks");
    if (!roughness)
        return std::nullopt;
    return HorizonProfile(Mountains{*seed, *height, *roughness});
}

/// Whether a point may follow the one before it; complains where not.
bool follows(WordReader& words, const WordPlace& place, double before, double azimuth) {
    const double gap = azimuth - before;
    if (gap >= HorizonProfile::narrowest_gap && gap <= HorizonProfile::widest_gap)
        return true;
    if (gap < HorizonProfile::narrowest_gap)
        words.complaints().error(
            place,
            fmt::format("the azimuth {} does not follow {}", azimuth, before),
            "give the points by growing azimuth: 0 is -z, 90 is x, 180 is z, 270 is -x");
    else
        words.complaints().error(
            place,
            fmt::format(
                "from the azimuth {} to {} there are more than 120 degrees", before, azimuth),
            "give a point between them");
    return false;
}

/// Whether the last point goes on to the first; complains where not.
bool closes(WordReader& words, const WordPlace& place, const std::vector<ProfilePoint>& points) {
    const double first = points.front().azimuth_degrees;
    const double last = points.back().azimuth_degrees;
    const double gap = first + 360 - last;
    if (gap >= HorizonProfile::narrowest_gap && gap <= HorizonProfile::widest_gap)
        return true;
    words.complaints().error(
        place,
        gap < HorizonProfile::narrowest_gap
            ? fmt::format("from {} to {} the profile goes round more than once", first, last)
            : fmt::format(
                "from the last azimuth, {}, round to the first, {}, there are more than 120 "
                "degrees",
                last,
                first),
        gap < HorizonProfile::narrowest_gap
            ? "leave out the last points: the profile closes by itself"
            : "give a point between them: a profile goes all round");
    return false;
}

std::optional<std::vector<ProfilePoint>> read_points(WordReader& words, std::uint64_t count) {
    std::vector<ProfilePoint> points;
    WordPlace last;
    for (std::uint64_t i = 0; i < count; ++i) {
        last = words.place();
        const auto azimuth = take_number_within(
            words,
            "the azimuth of a point of PROFILE",
            -HorizonProfile::largest_azimuth,
            HorizonProfile::largest_azimuth,
            "it is in degrees: 0 is -z, 90 is x, 180 is z, 270 is -x");
        if (!azimuth || (i > 0 && !follows(words, last, points.back().azimuth_degrees, *azimuth)))
            return std::nullopt;
        const auto elevation = take_number_within(
            words,
            "the elevation of a point of PROFILE",
            -HorizonProfile::steepest,
            HorizonProfile::steepest,
            "it is the angle above the level in degrees, for example 5");
        if (!elevation)
            return std::nullopt;
        points.push_back({*azimuth, *elevation});
    }
    if (!closes(words, last, points))
        return std::nullopt;
    return points;
}

} // namespace

std::optional<HorizonProfile> read_profile(WordReader& words) {
    if (words.peek() == "MOUNTAINS") {
        words.take();
        return read_mountains(words);
    }
    const auto count = words.take_whole_number(
        "MOUNTAINS or the number of points of PROFILE", 3, HorizonProfile::most_points);
    if (!count)
        return std::nullopt;
    auto points = read_points(words, *count);
    if (!points)
        return std::nullopt;
    return HorizonProfile(std::move(*points));
}

} // namespace vera
