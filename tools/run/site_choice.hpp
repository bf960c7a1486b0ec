// SPDX-License-Identifier: Apache-2.0
// --site, --approach and --along: where on a bone a saw works.
#pragma once

#include "dsp/core/types.hpp"
#include "graph/patch/patch.hpp"
#include "tools/run/patch_choice.hpp"

#include <string>
#include <vector>

namespace tactus::run {

struct SiteText {
    std::string site;      ///< "X,Y,Z" in mm; empty: the site is found automatically
    std::string approach;  ///< "X,Y,Z", a direction; empty: along the surface's normal
    std::string along;     ///< "X,Y,Z", a direction of the stroke; empty: over the narrowest width
};

/// A parameter of a node and its value as text.
struct SiteSetting {
    std::string node, param, value;
};
/// What makes a saw of the patch work at a site (mm, LPS): for each workspace with a bone and each carve node. None: the
/// patch has no such node. `approach`: a direction; 0: along the surface's normal. `along`: of the stroke; 0: over the
/// narrowest width.
std::vector<SiteSetting> site_settings(const patch::Patch& patch, const Vec3& site_mm, const Vec3& approach = Vec3(0.0),
                                       const Vec3& along = Vec3(0.0));

/// Adds the site to the choice's settings, for each workspace with a bone and each carve node of the patch. Throws
/// Error for text that is not three numbers, and for a patch without such nodes.
void choose_site(PatchChoice& choice, const SiteText& text);

}  // namespace tactus::run
