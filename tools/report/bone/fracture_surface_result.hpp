// SPDX-License-Identifier: Apache-2.0
// The proposed fracture surface of a fragment as a result.
#pragma once

#include "assets/plan/paint_file.hpp"
#include "tools/analysis/bone/fracture_surface.hpp"
#include "tools/report/result/fields.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus::report {

struct ProposedSurface {
    const analysis::FractureSurfaceSettings* settings;
    const analysis::FractureSurface* found;
    std::vector<plan::PaintedFace> faces;
    std::filesystem::path file;  ///< with the paint; empty: it was not written

    /// The unbroken bone does not lie on the fragment.
    bool is_doubtful() const;
};

const Fields<ProposedSurface>& proposed_surface_fields();

}  // namespace tactus::report
