// SPDX-License-Identifier: Apache-2.0
// Templates on which the plates of a plan are bent: made, checked, and refused.
#pragma once

#include "assets/mesh/mesh.hpp"
#include "dsp/cutting_guide/plate_template.hpp"
#include "tools/analysis/cutting_guide/plan_guide.hpp"
#include "tools/analysis/plan/flap_study.hpp"

#include <string>
#include <vector>

namespace tactus::analysis {

struct TemplateChoice {
    std::string plate;  ///< empty: the plan's only one
    std::string label;  ///< engraved; empty: the plan's title
    cutting_guide::TemplateSettings settings;
    double min_bone_share = 0.9;  ///< of the bed below the plate that has bone below it; less is refused: a placeholder
    double min_on_bone_share = 0.8;  ///< of it that lies on the bone; less warns: a placeholder
};

struct PlannedTemplate {
    std::string plate;
    TemplateChoice choice;
    cutting_guide::TemplateDesign design;
    cutting_guide::MadeTemplate made;
    mesh::MeshTopology topology;
    std::size_t intersections = 0;  ///< pairs of triangles of the mesh, at most 100
    double volume = 0.0;  ///< m³
    std::vector<GuideWarning> warnings;
};

/// The bone as the reconstruction plans it: what is kept of the jaw, and the segments at their planned places. Open where
/// it is cut. m, frame of the jaw.
geometry::TriangleSurface planned_bone(const FlapStudy& study);

/// Throws Error for a plan without that plate, a plate with too little bone below it, and a mesh that is not closed, one
/// part and free of self-intersections.
PlannedTemplate plan_template(const FlapStudy& study, const std::string& title, const TemplateChoice& choice);

}  // namespace tactus::analysis
