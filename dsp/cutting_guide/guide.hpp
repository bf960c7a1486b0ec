// SPDX-License-Identifier: Apache-2.0
// A printed guide that sits on a bone and holds the blade of a saw in the planes of a plan, or the fragments of a bone in
// their planned places.
#pragma once

#include "dsp/core/constants.hpp"
#include "dsp/core/jobs.hpp"
#include "dsp/core/types.hpp"
#include "dsp/geometry/dual_contour.hpp"
#include "dsp/geometry/iso_surface.hpp"
#include "dsp/reconstruction/section.hpp"

#include <glm/vec2.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::cutting_guide {

/// Which walls a slot has.
enum class Sides {
    one = 1,  ///< a ledge: the wall on the kept side
    two = 2,  ///< a wall on either side; the rail joins them above the end of the slot
    three = 3  ///< the end at the rail is closed as well
};

/// Sizes in m. BoneReconstructionPlanner's values unless noted.
struct GuideSettings {
    double thickness = 4e-3;  ///< of the base
    double wrap = 120.0 * degree;  ///< rad: the base reaches half of it to either side of the direction of removal
    double offset = 0.3e-3;  ///< between base and bone; 0.5e-3 over periosteum
    double blade = 0.4e-3;  ///< thickness that the blade cuts; a placeholder
    double clearance = 0.25e-3;  ///< per side of the blade: 0.25e-3 for SLA, 0.4e-3 for FDM
    Sides sides = Sides::three;
    double depth = 15e-3;  ///< of a slot above the highest bone in it
    double wall = 3e-3;  ///< of a slot
    double beyond = 2e-3;  ///< of a slot, beyond the bone at either end; a placeholder
    double cover = 1.0;  ///< share of the bone across a slot that its walls cover, from the rail on; 1: and `beyond`
    double end = 14e-3;  ///< length of base beyond the outermost cuts; a placeholder
    double screw_radius = 1.5e-3;
    double rail = 4e-3;  ///< thickness of the bar that joins the slots and bears the text; a placeholder
    double rail_clearance = 1e-3;  ///< between the rail and the bone (BoneReconstructionPlanner's security margin)
    double text_height = 4e-3;  ///< of capitals; remembered, not from a seen source
    double text_depth = 1e-3;
    double voxel = 0.35e-3;  ///< of the grid from which the mesh is made; edges are sharp at any
    double min_wall = 2e-3;  ///< what is thinner is left out; remembered
    double min_wall_share = 0.5;  ///< of the second wall of a slot; with less the slot is a ledge: a placeholder
    double max_lean = 70.0 * degree;  ///< rad, between the approach and a cut: a placeholder
    double max_lift = 15e-3;  ///< by which slots may rise so that the rail clears the bone: a placeholder
    double relief =
        1.5e-3;  ///< round a fracture line nothing touches the bone, and nothing fills the gap: a placeholder

    double slot_width() const { return blade + 2.0 * clearance; }
    /// m: no part of the guide may be thinner.
    double min_thickness() const { return std::min({thickness, wall, rail - text_depth, min_wall}); }
};

struct GuideCut {
    reconstruction::Plane plane;  ///< normal out of what is kept; the wall of the slot lies on it
    std::string name;  ///< "segment-1 at plane 2"
    char letter = 'A';
};

/// A part of a line round which the base wraps the bone.
struct BaseSpan {
    Vec3 point{0.0}, axis{1.0, 0.0, 0.0};  ///< unit
    double from = 0.0, to = 0.0;  ///< m along the axis
    /// The base lies on the negative side of it; none: also beyond the cuts.
    std::optional<reconstruction::Plane> until{};
    /// The base lies on one of the design's fragments only, on the part of it nearest to a point, m.
    struct OnFragment {
        std::size_t fragment = 0;
        Vec3 at{0.0};
    };
    std::optional<OnFragment> on{};
};

struct GuideHole {
    Vec3 at{0.0}, axis{0.0, 0.0, 1.0};  ///< unit
    double radius = 1.5e-3;
    std::string name;
    bool is_predictive = false;  ///< of a plate or implant; else the guide is fixed by it
    Vec3 slide{0.0};  ///< m: by up to so much it may move until the guide surrounds it
};

struct MadeHole : GuideHole {
    Vec3 middle{0.0};  ///< m: on its axis, in the middle of the base
    double wall = 0.0;  ///< m: the thinnest around it at half the thickness of the base, from the mesh (see hole_wall)
};

/// All points within `radius` of a line of points, such as a vessel; of a single point a ball.
struct Tube {
    std::vector<Vec3> points;  ///< m, at least one
    double radius = 0.0;  ///< m
};

/// A tube and a guide where they are nearest.
struct TubeDistance {
    double distance = 0.0;  ///< m, between their surfaces, at most max_tube_distance; negative: they overlap
    Vec3 at{0.0};  ///< m, on the middle line of the tube
};

/// Tubes farther from a guide are not measured, m. Nearer ones are exact to `tube_tolerance`, at any voxel.
inline constexpr double max_tube_distance = 20e-3, tube_tolerance = 0.01e-3;

/// A closed polygon of a glyph, m; filled by the non-zero rule.
using Outline = std::vector<glm::dvec2>;

/// Engraved on the rail. x along the rail, y along the direction of removal.
struct GuideText {
    std::vector<Outline> outlines;
    double width = 0.0;  ///< m
};

struct GuideDesign {
    geometry::TriangleSurface bone;
    std::vector<geometry::TriangleSurface>
        fragments;  ///< parts of the bone that the guide holds together; usually none
    Vec3 removal{0.0, 0.0, 1.0};  ///< unit: the guide is taken off along it and put on against it
    Vec3 along{1.0, 0.0, 0.0};  ///< unit: from slot to slot, or along the bridge
    std::vector<GuideCut> cuts;  ///< at least one, or none with fragments
    std::vector<BaseSpan> base;  ///< at least one
    std::vector<GuideHole> holes;
    std::vector<Tube> tubes;  ///< to keep clear of, in the frame of the bone
    std::array<GuideText, 2> text;  ///< above and below the letters
    std::vector<GuideText> letters;  ///< one per cut, without cuts one per base; empty: none
    GuideSettings settings;
};

struct MadeSlot {
    GuideCut cut;  ///< in the frame of the bone
    double width = 0.0, depth = 0.0;  ///< m; depth of its walls above the highest bone in it
    double length = 0.0;  ///< m, across the direction of removal
    std::optional<double> play;  ///< rad: atan((width - blade) / depth); none: a ledge holds the blade on one side only
    Sides sides = Sides::three;
    Vec3 middle{0.0};  ///< on the plane, at half of its depth
    Vec3 deep{0.0}, wide{0.0};  ///< unit, in the plane: out of the bone, along the slot
    double area() const { return depth * length; }  ///< m², of a wall
};

/// A text on the rail's face, which looks along -y of the guide's frame.
struct MadeText {
    Vec3 at{0.0};  ///< m, in the guide's frame: where the outlines have their origin
    GuideText text;
};

/// A wall at one of its triangles.
struct ThinWall {
    double thickness = 0.0;  ///< m
    Vec3 at{0.0};  ///< the middle of the wall
};

/// The end of a wall whose faces are not parallel, thinner than GuideSettings::min_thickness.
struct Taper {
    double thickness = 0.0;  ///< m, of the chord that meets both faces at equal angles; 0: a sharp edge
    double angle = 0.0;  ///< rad, between the faces
    Vec3 at{0.0};  ///< the middle of the chord
};
inline constexpr double taper_step = 30.0 * degree;
/// The thinnest of those whose faces are at most 30° apart, and of those between 30° and 60°; none: no such end.
using Tapers = std::array<std::optional<Taper>, 2>;

struct MadeGuide {
    geometry::TriangleSurface surface;  ///< m, in the frame of the bone
    Pose frame;  ///< of x along the slots and z along the removal
    std::vector<MadeSlot> slots;
    std::vector<MadeHole> holes;  ///< those that the guide surrounds by a wall that is not too thin
    std::vector<MadeText> texts;
    std::vector<TubeDistance> tubes;  ///< of each tube of the design
    std::optional<ThinWall> wall;  ///< the thinnest, except of text; none: no wall is below max_measured_wall
    Tapers tapers;  ///< except of text
    double thin_volume = 0.0;  ///< m³ left out as thinner than GuideSettings::min_thickness, and of the loose parts
    double thin_share = 0.0;  ///< of the volume of the guide before that
    std::size_t loose_parts = 0;  ///< separate parts that were dropped; their volume is part of thin_volume
    std::vector<std::string> notes;  ///< what was left out or changed
    std::size_t flipped = 0, smoothed = 0;  ///< see geometry::Contour
};

/// The base follows the bone at `offset`, `thickness` thick, where the approach reaches, over each span; it ends with
/// round edges, since planes through its shell would leave feather edges on a flat bone. Each cut has a
/// block with a slot whose wall on the kept side lies on the plane: a blade that is held against it cuts on plan, one at
/// the other wall leaves bone. A rail beside the bone joins the blocks, and bears the text. All is united and
/// subtracted as distances, with slots and holes as analytic bodies, and meshed by dual contouring. What is thinner
/// than min_thickness is left out, and stated in `thin_share`: strips between two slots, which have notes of their own,
/// do not count there.
///
/// Without cuts, the bases lie on fragments in their planned places: the rail stands on them in the middle and bridges
/// the fractures. Within `relief` of two fragments nothing is left of the guide: edges of fractures are uncertain, and
/// in a gap a fin would be left. Throws Error for planes through which no blade can come along the removal (more than max_lean
/// between them), for bone that stands in the way of the rail, for guides that need more than 150 million samples and
/// numbers that cannot be.
MadeGuide make_guide(const GuideDesign& design, const RunJobs& run);

/// Measured walls may be thinner than they should be by this much, m.
inline constexpr double wall_slack = 0.1e-3;

/// The index of the slot whose wall on the kept side is nearest to `p` (frame of the bone); there must be one.
/// Distances to the walls, not to their planes: the planes of two cuts cross, so that beyond the crossing the nearer
/// plane is that of the farther slot.
std::size_t nearest_slot(std::span<const MadeSlot> slots, const Vec3& p);

/// Base lines of the rows of text on the rail, m from its top: the first text, letters, the second text.
std::array<double, 3> text_rows(const GuideSettings& settings);
double rail_height(const GuideSettings& settings);

}  // namespace tactus::cutting_guide
