// SPDX-License-Identifier: Apache-2.0
#include "tools/report/bone/pose_fields.hpp"

#include "dsp/core/constants.hpp"
#include "tools/analysis/bone/fragment_file.hpp"

#include <fmt/format.h>

namespace tactus::report {

const Fields<Pose>& pose_fields() {
    static const Fields<Pose> all =
        Fields<Pose>("pose: p_after = R p_before + t")
            .vector("position_mm", "t", fixed(3, "mm"),
                    [](const Pose& pose) { return analysis::numbers_of(pose).position_mm; })
            .vector("quaternion_wxyz", "R as a unit quaternion w x y z", fixed(6),
                    [](const Pose& pose) { return analysis::numbers_of(pose).quaternion_wxyz; });
    return all;
}

const Fields<analysis::Motion>& motion_fields() {
    using analysis::Motion;
    static const Fields<Motion> all = Fields<Motion>("motion of the centre, and rotation")
                                          .number("distance_mm", "moved", from_si(2, "mm"), &Motion::distance)
                                          .number("angle_deg", "rotated", fixed(2, "°"), &Motion::angle_deg);
    return all;
}

const Fields<fit::PoseBound>& bound_fields() {
    using fit::PoseBound;
    static const Fields<PoseBound> all = Fields<PoseBound>("bound of a pose at 95 %")
                                             .number("turn_deg", "rotation", from_si(2, "°"), &PoseBound::turn)
                                             .number("face_mm", "at the face", from_si(2, "mm"), &PoseBound::face)
                                             .number("far_mm", "at the far end", from_si(2, "mm"), &PoseBound::far)
                                             .flag("rival", "another pose is within it", &PoseBound::has_rival);
    return all;
}

std::string left_out_words(const std::string& name, double area) {
    return fmt::format(
        "{}: {:.0f} mm² touch another fragment in the scan; they are left out of fits, as they show where it was "
        "scanned",
        name, area * 1e6);
}

std::string bound_words(fit::FitVerdict verdict, const fit::PoseBound& bound) {
    if (verdict != fit::FitVerdict::fit && verdict != fit::FitVerdict::uncertain) return {};
    return fmt::format(
        "{}: its place is known to ±{:.2f}°, ±{:.2f} mm at the face and ±{:.2f} mm at the far end (95 %){}",
        fit::answer_of(verdict), bound.turn / degree, bound.face / mm, bound.far / mm,
        bound.has_rival ? "; another pose that fits less well is within that" : "");
}

}  // namespace tactus::report
