// SPDX-License-Identifier: Apache-2.0
// A printed strip with the shape of the bone below a plate, on which the plate is bent before the operation.
#pragma once

#include "dsp/core/constants.hpp"
#include "dsp/core/jobs.hpp"
#include "dsp/cutting_guide/guide.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/reconstruction/flap.hpp"

#include <cstddef>
#include <vector>

namespace tactus::cutting_guide {

enum class HoleMarks {
    pins,    ///< stand in the holes of the plate
    dimples  ///< in the bed, below the holes
};

/// m. Placeholders unless noted.
struct TemplateSettings {
    double margin = 2e-3;  ///< of the bed beyond the plate, to either side and at its ends
    double thickness = 8e-3;  ///< below the centreline of the plate
    HoleMarks marks = HoleMarks::pins;
    double mark = 2e-3;  ///< height of a pin above the bed, or depth of a dimple
    double clearance = 0.15e-3;  ///< of a pin, less than the radius of its hole
    double max_slope = 1.5;  ///< of the bed: it spans steeper steps and gaps of the bone as a plate does
    double min_pin = 1.5e-3;  ///< diameter that a printer holds
    double text_height = 4e-3, text_depth = 0.6e-3;  ///< on its lower side
    double voxel = 0.35e-3;
};

struct TemplateDesign {
    geometry::TriangleSurface bone;  ///< as planned, in the frame of the plate; need not be closed
    reconstruction::Plate plate;
    GuideText text;
    TemplateSettings settings;
};

/// The mark of a hole.
struct HoleMark {
    Vec3 at{0.0};  ///< m, on the bed
    Vec3 axis{0.0};  ///< unit, out of the bed
    double diameter = 0.0;  ///< m
};

struct MadeTemplate {
    geometry::TriangleSurface surface;  ///< m, in the frame of the plate
    double length = 0.0, width = 0.0;  ///< m, of the bed
    std::vector<HoleMark> marks;  ///< of each screw of the plate
    /// Of the bed below the plate: share that lies on the bone (to 0.1 mm), and the most by which it spans the bone, m.
    double on_bone_share = 0.0, max_span = 0.0;
    double bone_share = 0.0;  ///< of the bed below the plate, below which there is bone
    double min_radius = 0.0;  ///< m, of the tightest bend of the bed towards the template's inside; at most 1
};

/// The bed follows the outermost bone in lines along the plate's outward directions, from a smooth curve along its
/// points; where the bone falls away more steeply than max_slope, it spans. Below, the strip ends at `thickness` under
/// the curve. Throws Error for a plate without two points, one that bends more tightly than the template is thick, pins
/// that are too thin, and for sizes that cannot be.
MadeTemplate make_template(const TemplateDesign& design, const RunJobs& run);

}  // namespace tactus::cutting_guide
