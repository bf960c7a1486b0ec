// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/constants.hpp"
#include "dsp/reconstruction/plan_measures.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <numbers>
#include <string>
#include <utility>

namespace tactus::reconstruction {

namespace {

constexpr double greatest_off_bisector = 1.0 * degree;

}  // namespace

const char* name_of(PlanWarning warning) {
    switch (warning) {
        case PlanWarning::short_segment: return "short-segment";
        case PlanWarning::very_short_segment: return "very-short-segment";
        case PlanWarning::close_osteotomies: return "close-osteotomies";
        case PlanWarning::wide_kerf: return "wide-kerf";
        case PlanWarning::distal_margin: return "distal-margin";
        case PlanWarning::proximal_margin: return "proximal-margin";
        case PlanWarning::section_mismatch: return "section-mismatch";
        case PlanWarning::line_downwards: return "line-downwards";
    }
    return "";
}

void warn_of(FibulaPlan& plan, const FibulaInputs& inputs, const DonorBone& donor) {
    const auto add = [&](PlanWarning code, int segment, std::string text) {
        plan.warnings.push_back({code, std::move(text), segment});
    };
    if (donor.axis().z < 0.0)
        add(PlanWarning::line_downwards, -1,
            "the line runs downwards (LPS): it must run from the ankle to the knee, else the margins and the medial "
            "side are exchanged");
    for (std::size_t n = 0; n < plan.segments.size(); ++n) {
        const double length = plan.segments[n].length_shortest.value_or(plan.segments[n].length_centre);
        const char* how = plan.segments[n].length_shortest ? "at its shortest" : "at its centre";
        if (length < inputs.very_short_segment)
            add(PlanWarning::very_short_segment, static_cast<int>(n),
                fmt::format("segment {} is {:.1f} mm long {}, less than {:.0f} mm: it may have no blood supply", n + 1,
                            length / mm, how, inputs.very_short_segment / mm));
        else if (length < inputs.short_segment)
            add(PlanWarning::short_segment, static_cast<int>(n),
                fmt::format("segment {} is {:.1f} mm long {}, less than {:.0f} mm: its blood supply is in doubt", n + 1,
                            length / mm, how, inputs.short_segment / mm));
    }
    for (std::size_t n = 0; n + 1 < plan.segments.size(); ++n) {
        if (plan.clearances[n] && *plan.clearances[n] < 0.0)
            add(PlanWarning::close_osteotomies, static_cast<int>(n),
                fmt::format("segments {} and {} overlap by {:.2f} mm along the line", n + 1, n + 2,
                            -*plan.clearances[n] / mm));
        else if (plan.clearances[n] && *plan.clearances[n] < inputs.between - 1e-6)
            add(PlanWarning::close_osteotomies, static_cast<int>(n),
                fmt::format(
                    "between segments {} and {} there are {:.2f} mm of bone along the line, less than {:.2f} mm", n + 1,
                    n + 2, *plan.clearances[n] / mm, inputs.between / mm));
        // The blade runs beside each segment, in the bone between them.
        if (plan.clearances[n] && *plan.clearances[n] >= 0.0 && *plan.clearances[n] < 2.0 * inputs.kerf - 1e-6)
            add(PlanWarning::wide_kerf, static_cast<int>(n),
                fmt::format(
                    "between segments {} and {} there are {:.2f} mm of bone along the line, and two cuts of {:.2f} "
                    "mm take {:.2f} mm: a cut would run into a segment",
                    n + 1, n + 2, *plan.clearances[n] / mm, inputs.kerf / mm, 2.0 * inputs.kerf / mm));
        if (plan.off_bisector[n] > greatest_off_bisector)
            add(PlanWarning::section_mismatch, static_cast<int>(n),
                fmt::format("plane {} is {:.1f}° from bisecting the angle between segments {} and {}: their two "
                            "sections differ",
                            n + 2, plan.off_bisector[n] / degree, n + 1, n + 2));
    }
    const int last = static_cast<int>(plan.segments.size()) - 1;
    if (plan.left_distal && *plan.left_distal < inputs.distal_margin - 1e-6)
        add(PlanWarning::distal_margin, inputs.reversed ? last : 0,
            fmt::format("{:.1f} mm of donor are left at the ankle, less than {:.0f} mm", *plan.left_distal / mm,
                        inputs.distal_margin / mm));
    if (plan.left_proximal && *plan.left_proximal < inputs.proximal_margin - 1e-6)
        add(PlanWarning::proximal_margin, inputs.reversed ? 0 : last,
            fmt::format("{:.1f} mm of donor are left at the knee, less than {:.0f} mm (a placeholder without a source)",
                        *plan.left_proximal / mm, inputs.proximal_margin / mm));
}

}  // namespace tactus::reconstruction
