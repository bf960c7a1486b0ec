// SPDX-License-Identifier: Apache-2.0
// Reach of a flap's vessels to their sites, objects along their paths, and all warnings about a flap.
#pragma once

#include "dsp/reconstruction/clearance.hpp"
#include "dsp/reconstruction/fibula_plan.hpp"
#include "dsp/reconstruction/flap.hpp"
#include "dsp/reconstruction/flap_warning.hpp"
#include "dsp/rope/obstacle.hpp"

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::reconstruction {

enum class Reach {
    slack,      ///< without tension
    in_situ,    ///< with at most the stretch that it has in the leg
    stretched,  ///< with more stretch than in the leg
    too_short   ///< with more than FlapLimits::over_in_situ beyond the stretch in the leg
};
const char* name_of(Reach reach);  ///< "slack", "in-situ", "stretched", "too-short"

/// The path of a vessel's pedicle to a site.
struct SiteReach {
    std::string vessel, site;
    VesselKind kind = VesselKind::artery;
    double in_situ = 0.0;  ///< m: the pedicle's length in the leg
    double free = 0.0;     ///< m: its length when cut free, rope::free_over_in_situ of it
    double path = 0.0;  ///< m: shortest path from the bone to the site with the vessel's radius as distance from bone
    bool is_settled = true;  ///< the path has converged to 0.1 %, outside of bone
    double slack = 0.0;  ///< m: free - path; 0 when the path is longer
    double strain = 0.0;  ///< path / free - 1; 0 when slack
    std::optional<double> tension;  ///< N, for an artery: rope::artery() at this strain; veins have reach only
    double bend_radius = 0.0;  ///< m: smallest over 10 mm of the path and the last 10 mm on the bone; a slack
        ///< vessel can be laid in a wider bend
    std::optional<double>
        twist;  ///< rad: angle from the vein's side of the artery at the site to its side as transported
    ///< from the bone (Bishop frame), for an artery with a vein at hand
    double contact = 0.0;  ///< m of the path in contact with bone
    std::optional<double> to_plate, to_screw;  ///< m, from the path
    Reach reach = Reach::slack;
    std::vector<Vec3> points;  ///< the path, frame of the jaw
};

/// A vessel between two segments.
struct SpanReach {
    std::string vessel;
    std::size_t first = 0, second = 0;  ///< segments, in the vessel's order
    double in_situ = 0.0;  ///< m
    double path = 0.0;  ///< m, straight
    double strain = 0.0;  ///< path / free - 1; 0 when slack
};

struct FlapMeasures {
    std::vector<PlacedVessel> vessels;  ///< with the path to the site with its best reach
    std::vector<Clearance> clearances;
    std::vector<SiteReach> reaches;  ///< of every vessel to every site of its kind
    std::vector<SpanReach> spans;
    std::optional<double> tumour_margin;  ///< m: smallest distance of the tumour from the first or last cut
    std::vector<FlapWarning> warnings;
};

Reach reach_at(double strain, const FlapLimits& limits);

/// Returns the best reach of that vessel in `all`: smallest strain, then largest slack. Null if there is none.
const SiteReach* best_of(std::span<const SiteReach> all, const std::string& vessel);

/// `bone`: obstacle of the paths, frame of the jaw, or null; `tumour`: points of its surface, frame of the jaw.
/// Allocates.
FlapMeasures measure_flap(const FibulaInputs& inputs, const FibulaPlan& plan, const Flap& flap,
                          const rope::Obstacle* bone, std::span<const Vec3> tumour = {});

/// Derives `warnings` from the other measures; measure_flap has already done so.
void add_warnings(FlapMeasures& measures, const FibulaInputs& inputs, const FibulaPlan& plan, const Flap& flap);

}  // namespace tactus::reconstruction
