// SPDX-License-Identifier: Apache-2.0
// A guide as a result: pictures on its bone, dimensions of its slots and holes, warnings.
#pragma once

#include "tools/analysis/cutting_guide/plan_guide.hpp"
#include "tools/report/result/fields.hpp"

#include <string>
#include <vector>

namespace tactus::report {

/// The guide on its bone from the side that it is taken off to, from its rail, and from the bone. Throws Error when
/// pictures cannot be made.
std::vector<render::LabelledPicture> guide_pictures(const analysis::PlannedGuide& guide);

/// Facets keep their own normals: the edges of printed parts are sharp.
display::PictureMesh flat_mesh(const geometry::TriangleSurface& surface, const Vec3& colour);

const Fields<analysis::GuideWarning>& guide_warning_fields();

/// A guide with the files that were written of it; `task`: "" without one.
struct MadeGuideFiles {
    const analysis::PlannedGuide* guide;
    std::string plan, file, task;
};

/// Slots with their letters, holes, checks and where each number is from; pictures on pages.
const Fields<MadeGuideFiles>& guide_fields();

}  // namespace tactus::report
