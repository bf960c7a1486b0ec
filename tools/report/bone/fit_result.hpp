// SPDX-License-Identifier: Apache-2.0
// 'snap' and 'register' as results.
#pragma once

#include "tools/analysis/bone/registration.hpp"
#include "tools/analysis/bone/snapping.hpp"
#include "tools/report/result/fields.hpp"

#include <string>

namespace tactus::report {

struct SnappedFiles {
    std::string moving, fixed;
    const analysis::Snapped* found;
};
const Fields<SnappedFiles>& snap_fields();

/// Of both surfaces; with `mirror` and `region` JSON has members of its own.
struct RegisteredFiles {
    const analysis::RegisteredSurface* found;
    bool has_region;  ///< it was searched for
};
const Fields<RegisteredFiles>& registration_fields();

}  // namespace tactus::report
