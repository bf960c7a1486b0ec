// SPDX-License-Identifier: Apache-2.0
// Finds a position on any bone where a saw blade can start a cut and complete it.
#pragma once

#include "dsp/volume/grid.hpp"

#include <optional>

namespace tactus::volume {

/// The blade and the free space it needs; m.
struct SiteRequest {
    double blade_length = 40e-3;   ///< of the tooth line
    double blade_height = 10e-3;   ///< behind the teeth
    double travel = 10e-3;  ///< of the hand to either side, along the blade
    double min_gap = 0.8e-3;  ///< between the blade's middle plane and other bone
    double best_depth = 12e-3;  ///< preferred thickness of the bone: long enough to perceive, short enough to finish
};

/// A site for a cut: the middle of the tooth line starts at `point` and moves along `feed`, while the blade strokes
/// along `stroke`. Frame of the grid, m; both directions are unit vectors, orthogonal to each other.
struct SawSite {
    Vec3 point;              ///< on the surface
    Vec3 feed;  ///< into the bone, normal to the surface
    Vec3 stroke;             ///< along the blade
    double thickness = 0.0;  ///< of the bone along `feed`, up to 40 mm
    double width = 0.0;  ///< of the bone along `stroke` at half that depth, up to blade length + 2 travel
};

/// Evaluates surface points about 3 mm apart (more on a large bone, which bounds the time to a fraction of a second)
/// and eight blade directions at each. A site must be reachable in a straight line from outside of the grid, the blade
/// must touch no other bone on its way, and the site must not be on a face where the grid cuts the bone. Among these
/// the best has about the preferred depth, is narrow along the blade and in the middle of that width, has bone on both
/// sides, lies under an even surface, and near the middle of the bone. `density` (kg/m³, same samples) distinguishes bone from filled hollows. Empty when there is no site.
/// A site near the border of the grid counts less, as does one that is reached from the side of the bone's own middle,
/// such as the inside of a rib cage. When every face lies at the border, as on a block with a tight grid, they count as
/// any other. Deterministic.
std::optional<SawSite> find_saw_site(const Grid& distance, const Grid& density, const SiteRequest& request = {});

/// The site where a line through `point` along `approach` first meets the bone; without an approach (zero), or where the
/// line misses, the surface nearest to `point`. The blade lies in the direction, of eight, in which the bone is
/// narrowest and the blade is free of other bone, if there is one; or along `along`, as far as that is orthogonal to the
/// feed, unless `along` is zero. Empty when there is no surface, or, without an approach, none within 30 mm of `point`.
/// Throws Error when `along` is within 10° of the feed.
std::optional<SawSite> saw_site_at(const Grid& distance, const Grid& density, const Vec3& point, const Vec3& approach,
                                   const Vec3& along = Vec3(0.0), const SiteRequest& request = {});

/// How far in front of a site the middle of the tooth line rests so that all of the blade, and its travel to either
/// side, is clear of bone: `clearance` m, or more where bone stands in the way, as beside a site that lies in a hollow; at
/// most 60 mm more.
double resting_clearance(const Grid& distance, const SawSite& site, double clearance, const SiteRequest& request = {});

/// Both grids around a site with samples `spacing` m apart, over the reach of a blade there; up to the surface the
/// density is that of the bone (extend_density). Throws Error for more than 40 million samples.
struct SiteVolume {
    Grid distance, density;
};
SiteVolume refine_at(const SawSite& site, const Grid& distance, const Grid& density, double spacing,
                     const SiteRequest& request = {});

}  // namespace tactus::volume
