// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/flap_words.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace tactus::analysis {

std::string reach_words(const reconstruction::SiteReach& r) {
    constexpr double to_mm = 1e3;
    const std::string vessel = fmt::format("{} '{}' to '{}'", reconstruction::name_of(r.kind), r.vessel, r.site);
    std::string text = fmt::format("{}: {:.1f} mm in the leg, {:.1f} mm free, {:.1f} mm to go", vessel,
                                   r.in_situ * to_mm, r.free * to_mm, r.path * to_mm);
    switch (r.reach) {
        case reconstruction::Reach::slack: text += fmt::format(": {:.1f} mm slack", r.slack * to_mm); break;
        case reconstruction::Reach::in_situ:
        case reconstruction::Reach::stretched:
            text += fmt::format(": strain {:.1f} %{}", 100.0 * r.strain,
                                r.reach == reconstruction::Reach::stretched ? ", more than in the leg" : "");
            if (r.tension) text += fmt::format(", {:.2f} N", *r.tension);
            break;
        case reconstruction::Reach::too_short: text += ": does not reach"; break;
    }
    if (std::isfinite(r.bend_radius)) text += fmt::format("; bends to {:.1f} mm", r.bend_radius * to_mm);
    if (r.twist) text += fmt::format(", twisted by {:.0f}°", *r.twist * 180.0 / std::numbers::pi);
    if (r.contact > 0.0) text += fmt::format(", {:.1f} mm on bone", r.contact * to_mm);
    if (!r.is_settled) text += " (the way did not settle)";
    return text;
}

std::string candidate_words(const reconstruction::Candidate& c) {
    std::string text = fmt::format("{} leg{}, pedicle at the {} plane of the jaw",
                                   c.leg == reconstruction::Leg::left ? "left" : "right",
                                   c.is_mirrored ? " (the given one, mirrored)" : "", c.at_first ? "first" : "last");
    if (c.is_flipped) text += ", turned by 180°";
    if (c.changes == 0) text += " (as given)";
    return text;
}

}  // namespace tactus::analysis
