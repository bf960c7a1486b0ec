// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/cutting_guide/guide_limits.hpp"

#include "dsp/core/constants.hpp"
#include "tools/analysis/cutting_guide/plan_guide.hpp"

#include <fmt/format.h>

#include <array>

namespace tactus::analysis {

namespace {

constexpr std::string_view placeholder = "a placeholder";
constexpr double percent = 0.01;

constexpr std::array limits{
    GuideLimit{"--min-wall", "min_wall_mm", "thinnest part; what is thinner is left out, and refused where it remains",
               "mm", mm, 0.5, 5.0, placeholder, [](GuideChoice& c) -> double& { return c.settings.min_wall; }},
    GuideLimit{"--max-left-out", "max_thin_share", "of the volume left out as too thin; more is refused", "%", percent,
               0.0, 100.0, placeholder, [](GuideChoice& c) -> double& { return c.limits.max_thin_share; }},
    GuideLimit{
        "--min-slot-wall", "min_wall_share",
        "of a slot's wall that is left; a slot with less of its second wall is a ledge, one with less of the wall "
        "on plan is refused",
        "%", percent, 0.0, 100.0, placeholder, [](GuideChoice& c) -> double& { return c.settings.min_wall_share; }},
    GuideLimit{"--max-lean", "max_lean_deg", "between the approach and the plane of a cut; more is refused", "°",
               degree, 10.0, 85.0, placeholder, [](GuideChoice& c) -> double& { return c.settings.max_lean; }},
    GuideLimit{"--max-lift", "max_lift_mm", "by which slots rise so that the rail clears the bone; more is refused",
               "mm", mm, 0.0, 50.0, placeholder, [](GuideChoice& c) -> double& { return c.settings.max_lift; }},
    GuideLimit{"--free-path", "free_path_mm",
               "along the approach without bone in the way of the guide; less is refused", "mm", mm, 1.0, 300.0,
               placeholder, [](GuideChoice& c) -> double& { return c.limits.free_path; }},
    GuideLimit{"--seat-gap", "seat_gap_mm", "that faces in contact may move, for the play of the guide on the bone",
               "mm", mm, 0.05, 2.0, placeholder, [](GuideChoice& c) -> double& { return c.limits.seat_gap; }},
    GuideLimit{"--max-play", "max_play_mm", "of play of the guide on the bone; more warns", "mm", mm, 0.0, 20.0,
               placeholder, [](GuideChoice& c) -> double& { return c.limits.max_play; }},
    GuideLimit{"--max-turn", "max_turn_deg", "of play of the guide about the bone; more warns", "°", degree, 0.0, 28.0,
               placeholder, [](GuideChoice& c) -> double& { return c.limits.max_turn; }},
    GuideLimit{"--min-contact", "min_contact_share", "of the faces towards the bone that touch it; less warns", "%",
               percent, 0.0, 100.0, placeholder, [](GuideChoice& c) -> double& { return c.limits.min_contact_share; }},
    GuideLimit{"--overhang", "overhang_deg", "that a wall may lean when it is printed without supports", "°", degree,
               10.0, 80.0, "common for printers, remembered",
               [](GuideChoice& c) -> double& { return c.limits.overhang; }},
    GuideLimit{"--max-overhang", "max_overhang_share", "of the surface that hangs over by more; more warns", "%",
               percent, 0.0, 100.0, placeholder, [](GuideChoice& c) -> double& { return c.limits.max_overhang_share; }},
    GuideLimit{"--touch", "touch_mm", "between a vessel or perforator and the guide; less is a touch, which is refused",
               "mm", mm, 0.02, 3.0, "of the order of a printer's trueness, 0.11 to 0.16 mm, Msallem 2020",
               [](GuideChoice& c) -> double& { return c.limits.touch; }},
    GuideLimit{"--vessel", "vessel_mm", "between a vessel and the guide; less warns", "mm", mm, 0.0, 20.0, placeholder,
               [](GuideChoice& c) -> double& { return c.limits.vessel; }},
    GuideLimit{"--perforator", "perforator_mm", "between a perforator and the guide; less warns", "mm", mm, 0.0, 20.0,
               placeholder, [](GuideChoice& c) -> double& { return c.limits.perforator; }},
    GuideLimit{"--perforator-radius", "perforator_radius_mm", "of a perforator", "mm", mm, 0.05, 3.0, "Heitmann 2003",
               [](GuideChoice& c) -> double& { return c.limits.perforator_radius; }},
    GuideLimit{"--hole-to-cut", "hole_to_cut_mm",
               "between a hole and a cut; less warns, a hole that meets one is refused", "mm", mm, 0.0, 20.0,
               placeholder, [](GuideChoice& c) -> double& { return c.limits.hole_to_cut; }},
    GuideLimit{"--max-gap", "max_gap_mm", "between two fragments of a reduction, median; more is refused", "mm", mm,
               0.1, 3.0, placeholder, [](GuideChoice& c) -> double& { return c.limits.max_gap; }},
    GuideLimit{"--max-overlap", "max_overlap_mm3", "of two fragments of a reduction; more is refused", "mm³",
               mm* mm* mm, 0.0, 10000.0, placeholder, [](GuideChoice& c) -> double& { return c.limits.max_overlap; }},
    GuideLimit{"--min-region", "min_region_mm2", "of contact with each fragment of a reduction; less is refused", "mm²",
               mm* mm, 1.0, 10000.0, placeholder, [](GuideChoice& c) -> double& { return c.limits.min_region; }},
    GuideLimit{"--relief", "relief_mm", "round a fracture line, within which the base does not touch the bone", "mm",
               mm, 0.5, 5.0, placeholder, [](GuideChoice& c) -> double& { return c.settings.relief; }},
    GuideLimit{"--end", "end_mm", "of base beyond the outermost cuts or fractures, at least", "mm", mm, 2.0, 60.0,
               placeholder, [](GuideChoice& c) -> double& { return c.settings.end; }},
    GuideLimit{"--beyond", "beyond_mm", "of a slot beyond the bone at either end, at least", "mm", mm, 0.0, 20.0,
               placeholder, [](GuideChoice& c) -> double& { return c.settings.beyond; }},
    GuideLimit{"--jaw-cover", "jaw_cover_share", "of the height of a jaw that the walls of its slots cover", "%",
               percent, 20.0, 100.0, placeholder, [](GuideChoice& c) -> double& { return c.jaw_cover; }},
};

}  // namespace

double GuideLimit::of(const GuideChoice& choice) const {
    GuideChoice copy = choice;
    return in(copy);
}

std::string GuideLimit::text_of(const GuideChoice& choice) const {
    return fmt::format("{:.3g} {}", of(choice) / si, unit);
}

std::span<const GuideLimit> guide_limits() { return limits; }

}  // namespace tactus::analysis
