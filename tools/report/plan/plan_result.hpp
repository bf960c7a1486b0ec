// SPDX-License-Identifier: Apache-2.0
// A plan as a result: its content for 'plan show', and with what was measured and drawn of it for 'plan report'.
#pragma once

#include "tools/analysis/plan/case_warnings.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/analysis/plan/target_deviation.hpp"
#include "tools/report/plan/drawn_plan.hpp"
#include "tools/report/reconstruction/flap_report.hpp"
#include "tools/report/result/fields.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::report {

struct ShownPlan {
    plan::CasePlan plan;
    plan::PlanState state;
    analysis::CaseWarnings warnings;
    std::vector<analysis::NamedDeviation> deviation;
    std::optional<DrawnPlan> drawn{};  ///< for a report
    std::optional<ReportedFlap> flap{};

    /// Without measuring anything. Throws Error.
    static ShownPlan of(const plan::CasePlan& plan, const std::filesystem::path& folder);
    /// With all measurements and pictures. `progress`: the fraction done, and the present step. Throws Error.
    static ShownPlan reported(const plan::CasePlan& plan, const std::filesystem::path& folder,
                              const std::function<void(double, std::string_view)>& progress = {});
};
const Fields<ShownPlan>& plan_fields();

/// 'plan check'.
const Fields<ShownPlan>& checked_plan_fields();

/// 'plan gap'.
struct NamedGap {
    std::string first, second;
    const analysis::PlanGap* gap;
};
struct GapsOfPlan {
    std::vector<NamedGap> pairs;
};
const Fields<NamedGap>& gap_fields();
/// `gaps` must live as long as the result.
GapsOfPlan named_gaps(const plan::CasePlan& plan, const std::vector<analysis::PlanGap>& gaps);
const Fields<GapsOfPlan>& gaps_fields();

}  // namespace tactus::report
