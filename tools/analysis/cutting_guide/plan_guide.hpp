// SPDX-License-Identifier: Apache-2.0
// Guides for the cuts of a reconstruction, or for fragments in their planned places: what is made of a plan, what is
// checked, and what is refused.
#pragma once

#include "assets/mesh/mesh.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/cutting_guide/guide.hpp"
#include "dsp/cutting_guide/guide_checks.hpp"
#include "tools/analysis/plan/flap_study.hpp"

#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

/// `reduction`: fragments in their planned places (reduction_guide.hpp).
enum class GuideBone { fibula, jaw, reduction };
const char* name_of(GuideBone bone);  ///< "fibula", "jaw", "reduction"

/// Thresholds of refusals and warnings; guide_limits() lists them with their sources. Most are placeholders. m and rad.
struct GuideLimits {
    double max_thin_share = 0.05;  ///< of the volume, that is left out as too thin
    double free_path = 60e-3;  ///< along the approach
    double seat_gap = 0.3e-3;  ///< for Seat::play
    double max_play = 1e-3, max_turn = 2.0 * degree;  ///< of the guide on the bone
    double min_contact_share = 0.5;
    double overhang = 45.0 * degree;  ///< printers hold walls that lean less
    double max_overhang_share = 0.1;
    double touch = 0.1e-3;  ///< a guide that is nearer to a vessel or perforator is refused
    double vessel = 3e-3, perforator = 3e-3;  ///< nearer ones warn
    double perforator_radius = 0.3e-3;  ///< Heitmann 2003
    double hole_to_cut = 1e-3;
    double max_gap = 2e-3;  ///< between two fragments, median
    double max_overlap = 100e-9;  ///< m³, of two fragments
    double min_region = 50e-6;  ///< m², of contact with a fragment
};

struct GuideChoice {
    GuideBone bone = GuideBone::fibula;
    int cut = 0;  ///< of the jaw: 1 the first, 2 the last; 0: all
    std::vector<std::string> fragments;  ///< of a reduction: those that the guide holds; empty: all that are shown
    cutting_guide::GuideSettings settings;
    std::optional<double> offset;  ///< m; none: 0.5 mm on a fibula, whose periosteum stays, 0.3 mm on a jaw
    double turn =
        0.0;  ///< rad: the approach, about the donor's line from lateral (towards the front), or about the jaw's cuts
    std::string label;  ///< engraved; empty: the plan's title
    double jaw_cover = 0.65;  ///< GuideSettings::cover on a jaw: a placeholder
    GuideLimits limits;
};

struct GuideWarning {
    std::string code;  ///< "seat-play", "perforator", ...
    std::string text;
};

/// A vessel or a perforator of the flap, as near as it comes to the guide.
struct NearVessel {
    std::string name;  ///< "vessel 'artery'"
    double away = 0.0;  ///< m, between its wall and the guide; below 0: they overlap
    Vec3 at{0.0};  ///< m, frame of the donor
    bool is_perforator = false;
    bool is_covered = false;  ///< a perforator that runs into the guide where it leaves the bone
};

/// Two fragments of a reduction that face each other, where the plan has them.
struct FractureGap {
    std::string first, second;
    double gap = 0.0;  ///< m, median over the faces
    double overlap = 0.0;  ///< m³
};

/// A fragment that the guide holds.
struct HeldFragment {
    std::string name;
    char letter = '1';  ///< engraved
    double contact_area = 0.0;  ///< m²
    std::size_t holes = 0;
    /// Of the fragment within its region of the guide, before it is screwed: see Seat.
    double play = 0.0, play_angle = 0.0;  ///< m, rad
};

struct PlannedGuide {
    GuideBone bone = GuideBone::fibula;
    GuideChoice choice;
    cutting_guide::GuideDesign design;
    cutting_guide::MadeGuide made;
    mesh::MeshTopology topology;
    std::size_t intersections = 0;  ///< pairs of triangles of the mesh, at most 100
    double volume = 0.0;  ///< m³
    cutting_guide::Seat seat;
    double overhang = 0.0;  ///< share of the area
    std::vector<cutting_guide::SlotFit> refits;  ///< of each slot, from the mesh
    std::vector<NearVessel> vessels;  ///< of the donor
    double kerf = 0.0;  ///< m, of the plan
    std::vector<FractureGap> gaps;  ///< of a reduction
    std::vector<HeldFragment> held;  ///< of a reduction, in the order of the design's bases
    std::vector<GuideWarning> warnings;
};

/// What a plan's reconstruction asks of a guide. Throws Error when its cuts or its bone are missing.
cutting_guide::GuideDesign design_guide(const FlapStudy& study, const std::string& title, const GuideChoice& choice);

/// Makes and measures it; nothing is refused. Throws Error for designs of which no guide can be made.
PlannedGuide measured_guide(const FlapStudy& study, const std::string& title, const GuideChoice& choice);

/// The same for a design.
PlannedGuide measured_guide(cutting_guide::GuideDesign design, const GuideChoice& choice);

/// Throws Error for a mesh that is not closed, wound or one part, that intersects itself, has a wall thinner than it
/// should or has lost too much that was too thin, a slot off the plan, or cannot be seated, and for one that overlaps a
/// vessel, a perforator or a cut with a hole: such a guide must not be printed; nor one that does not reach or cannot be
/// screwed to one of its fragments. The text names the slot, the value, the
/// limit with its source, and what helps.
void refuse_guide(const PlannedGuide& guide);

/// Adds notes of how it was made, and clinical warnings.
void warn_of(PlannedGuide& guide);

/// All three. Clinical thresholds only warn.
PlannedGuide plan_guide(const FlapStudy& study, const std::string& title, const GuideChoice& choice);

}  // namespace tactus::analysis
