// SPDX-License-Identifier: Apache-2.0
// The cuts of a fibula as a result.
#pragma once

#include "dsp/reconstruction/fibula_plan.hpp"
#include "tools/analysis/plan/plan_cuts.hpp"
#include "tools/report/result/fields.hpp"

namespace tactus::report {

inline constexpr const char* research_note = "for research, not a medical device";

struct FibulaCuts {
    const reconstruction::FibulaInputs* inputs;
    const reconstruction::FibulaPlan* plan;
};
const Fields<FibulaCuts>& fibula_fields();
/// Sizes and joints of segments, and their cuts: printed tables.
const Fields<FibulaCuts>& fibula_tables();

/// The cuts that fit the pieces where they were placed.
struct DerivedCuts {
    std::string plan, alternative;
    const analysis::CutsOfPieces* found;
};
const Fields<DerivedCuts>& derived_cuts_fields();

/// origin_mm, normal
const Fields<reconstruction::Plane>& plane_fields();

/// code, text
const Fields<reconstruction::FibulaWarning>& fibula_warning_fields();
std::vector<std::string> texts_of(const std::vector<reconstruction::FibulaWarning>& warnings);

}  // namespace tactus::report
