// SPDX-License-Identifier: Apache-2.0
// What `check` found in a patch as a result.
#pragma once

#include "tools/analysis/patch/patch_check.hpp"
#include "tools/report/result/fields.hpp"

namespace tactus::report {

const Fields<analysis::PatchCheck>& check_fields();

}  // namespace tactus::report
