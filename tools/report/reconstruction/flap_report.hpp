// SPDX-License-Identifier: Apache-2.0
// A reconstruction of a jaw in the report of its plan.
#pragma once

#include "tools/analysis/plan/flap_study.hpp"
#include "tools/analysis/plan/target_deviation.hpp"
#include "tools/report/result/fields.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::report {

/// One alternative of a plan with what was measured of it.
struct MeasuredAlternative {
    std::string name;
    plan::PlanState state;
    std::unique_ptr<analysis::FlapStudy> study;
    reconstruction::FlapMeasures measures;
};

struct ReportedFlap {
    plan::CasePlan plan;
    std::filesystem::path folder;  ///< of the plan
    std::vector<MeasuredAlternative> alternatives;  ///< the current one first; up to three
    std::vector<reconstruction::Candidate> candidates;  ///< if there are vessels and sites

    const MeasuredAlternative& current() const { return alternatives.front(); }
};

/// None if the plan has no reconstruction. Throws Error when files are missing.
std::optional<ReportedFlap> report_flap(const plan::CasePlan& plan, const std::filesystem::path& folder);

/// Pictures, dimension drawings of each osteotomy, tables, candidates, the order of the operation, alternatives side by
/// side, and thresholds with their sources. Printed only.
const Fields<ReportedFlap>& reported_flap_fields();

}  // namespace tactus::report
