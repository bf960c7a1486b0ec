// SPDX-License-Identifier: Apache-2.0
// The target of a plan, and fragments beside it, as a result.
#pragma once

#include "tools/analysis/plan/plan_mirror.hpp"
#include "tools/report/result/fields.hpp"

#include <string>
#include <vector>

namespace tactus::report {

struct ComparedFragment {
    std::string fragment;
    analysis::MirrorComparison found;
};

struct LaidTarget {
    std::string main;  ///< the fragment to which it was registered
    bool is_mirrored;
    std::string doubt;  ///< why it is no target; empty: it is
    const fit::MirrorFit* fit;
    std::vector<ComparedFragment> others;
};

const Fields<LaidTarget>& laid_target_fields();

}  // namespace tactus::report
