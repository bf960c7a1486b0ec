// SPDX-License-Identifier: Apache-2.0
// Where on a bone, whatever bone it is, a saw blade can be set on and pushed through.
#pragma once

#include "dsp/volume/grid.hpp"

#include <optional>

namespace tactus::volume {

/// The blade and the room that it needs; m.
struct SiteRequest {
    double blade_length = 40e-3;   ///< of the tooth line
    double blade_height = 10e-3;   ///< behind the teeth
    double travel = 10e-3;         ///< of the hand to either side, along the blade
    double least_gap = 0.8e-3;     ///< between the blade's middle plane and bone that is not to be cut
    double best_depth = 12e-3;  ///< bone of this thickness is preferred: long enough to feel, not too long to finish
};

/// A place for a cut: the middle of the tooth line starts at `point` and goes along `feed` while the blade moves along
/// `stroke`. Frame of the grid, m; both directions of unit length and square to each other.
struct SawSite {
    Vec3 point;              ///< on the surface
    Vec3 feed;               ///< into the bone, square to the surface
    Vec3 stroke;             ///< along the blade
    double thickness = 0.0;  ///< of the bone along `feed`, at most 40 mm are looked at
    double width = 0.0;      ///< of the bone along `stroke` at half that depth, at most blade length + 2 travel
};

/// Looks at surface points about 3 mm apart (more on a large bone, so that the time stays within a fraction of a
/// second) and at eight blade directions in each. A site must be reachable from outside of the grid in a straight line,
/// its blade must touch no other bone on the way in, and it must not lie on a face where the grid cuts the bone. Of
/// these the one wins that has bone of about the wanted depth, as narrow as can be along the blade, going on to both
/// sides of it, under an even surface. `density` (kg/m³, same samples) tells bone from filled hollows. Nothing when
/// there is no such place. The same grid gives the same site.
std::optional<SawSite> find_saw_site(const Grid& distance, const Grid& density, const SiteRequest& request = {});

}  // namespace tactus::volume
