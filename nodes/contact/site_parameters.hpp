// SPDX-License-Identifier: Apache-2.0
// The site at which a saw works on a bone: found automatically, or given by a point and a direction.
#pragma once

#include "assets/bone/bone.hpp"
#include "dsp/core/error.hpp"
#include "dsp/volume/site.hpp"
#include "graph/node/node.hpp"

#include <optional>

namespace tactus::nodes {

/// Flag find, Vector site, Vector approach, Vector along of a node.
inline std::optional<volume::SawSite> site_of(const bone::Bone& bone, bool find, const Vec3& site, const Vec3& approach,
                                              const Vec3& along, const Setup& setup) {
    if (find) return volume::find_saw_site(bone.distance, bone.density);
    try {
        return volume::saw_site_at(bone.distance, bone.density, site, approach, along);
    } catch (const Error& error) {
        setup.fail(error.message());
    }
}

inline constexpr auto find_site_about = "find a site for a saw cut; false: it is given by 'site' and 'approach'";
inline constexpr auto site_about =
    "point in the bone's frame: the cut starts where a line through it along 'approach' meets the bone";
inline constexpr auto approach_about =
    "direction of that line, into the bone; 0, 0, 0: along the surface's normal at 'site'";
inline constexpr auto along_about =
    "direction of the stroke at 'site', as far as it is across the approach; 0, 0, 0: over the narrowest width";

}  // namespace tactus::nodes
