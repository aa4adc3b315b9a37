// SPDX-License-Identifier: Apache-2.0
#include "draw_report.h"

#include <fmt/format.h>

namespace vera {

void print_notes(const DrawnScene& drawn, const Console& console) {
    if (drawn.cut_nearness > 0)
        print_note(
            fmt::format(
                "what is nearer to the view point than {:.3g} of the image plane's distance is not "
                "drawn: the rest would be too coarse",
                drawn.cut_nearness),
            console);
    if (drawn.shadows.cut_nearness > 0)
        print_note(
            fmt::format(
                "what is nearer to a light than {:.3g} throws no shadow: the others would be too "
                "coarse",
                drawn.shadows.cut_nearness),
            console);
    if (drawn.shadows.light_step > 0)
        print_note(
            fmt::format(
                "what is smaller than {:.3g} may throw no shadow, or one with holes: what is seen "
                "of the scene reaches too far",
                drawn.shadows.light_step),
            console);
    if (drawn.lights_without_shadows > 0)
        print_note(
            fmt::format(
                "shadows are drawn of the first {} lights; the last {} shine through everything",
                most_lights_of_a_set,
                drawn.lights_without_shadows),
            console);
    if (drawn.penetrating > 0)
        print_note(
            fmt::format(
                "{} pairs of facets still pass through each other after {} rounds of cutting: "
                "outlines there may be wrong",
                drawn.penetrating,
                drawn.cut_rounds),
            console);
    // As far as --verify lets a border be off.
    constexpr double most_join = 1.0 / 64;
    if (drawn.longest_join > most_join)
        print_note(
            fmt::format(
                "borders that do not close are joined by straight ways of up to {:.3g} pixels: "
                "faces there may be wrong, as --verify tells",
                drawn.longest_join),
            console);
}

void print_check(const MapCheck& check, const Console& console) {
    if (check.near == 0)
        return print_note(
            fmt::format(
                "verified: at all {} points the drawing shows what a ray sees", check.points),
            console);
    print_note(
        fmt::format(
            "verified: at {} of {} points the drawing shows what a ray sees; the other {} are "
            "within 1/64 pixel, or the deviation, of it",
            check.points - check.near,
            check.points,
            check.near),
        console);
}

nlohmann::ordered_json as_json(const DrawReport& report, const DrawnScene& drawn) {
    nlohmann::ordered_json json = {
        {"version", 1},
        {"facets", drawn.facets},
        {"visible_faces", drawn.visible_faces},
        {"cut_rounds", drawn.cut_rounds},
        {"penetrating", drawn.penetrating},
        {"partly_lit", drawn.shadows.partly_lit},
        {"shadows", drawn.shadows.shadows},
        {"bytes", report.bytes},
        {"seconds",
         {{"read", report.read_seconds},
          {"draw", report.draw_seconds},
          {"verify", report.verify_seconds},
          {"write", report.write_seconds}}}};
    if (report.check.points > 0)
        json["verified"] = {{"points", report.check.points}, {"near", report.check.near}};
    return json;
}

} // namespace vera
