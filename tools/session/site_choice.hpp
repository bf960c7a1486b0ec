// SPDX-License-Identifier: Apache-2.0
// --site and --approach: where on a bone a saw works.
#pragma once

#include "tools/session/patch_choice.hpp"

#include <string>

namespace tactus::session {

struct SiteText {
    std::string site;      ///< "X,Y,Z" in mm, empty: the program finds a site
    std::string approach;  ///< "X,Y,Z", a direction; empty: along the surface's normal
};

/// Adds the site to the choice's settings, for each workspace with a bone and each carve node of the patch. Throws Error
/// for text that is no three numbers, and for a patch without such nodes.
void choose_site(PatchChoice& choice, const SiteText& text);

}  // namespace tactus::session
