// SPDX-License-Identifier: Apache-2.0
#include "tools/command/patch_options.hpp"

namespace tactus::command {

void add_patch_options(VerbOptions& verb, session::PatchChoice& choice) {
    verb.add("patch", choice.patch, "patch file, or a name in the library such as saw-training").required();
    add_override_options(verb, choice);
}

void add_override_options(VerbOptions& verb, session::PatchChoice& choice) {
    verb.add("--set", choice.overrides.settings, "change a parameter: NODE.PARAM=VALUE").one_each();
    verb.add("--asset", choice.overrides.assets, "use another file for an asset: NAME=PATH").one_each();
    verb.add("--seed", choice.seed, "seed of the random numbers");
}

void add_device_scale(VerbOptions& verb, std::optional<double>& scale) {
    verb.add("--device-scale", scale,
             "forces and stiffness on the device over those of a saw or a burr, which cut as with 1: 0.2 for a device "
             "that "
             "gives a fifth of the force")
        .range(0.01, 10.0);
}

void add_site_options(VerbOptions& verb, session::SiteText& text) {
    const Option site =
        verb.add("--site", text.site,
                 "X,Y,Z in mm, or with units as in \"12 mm, 3 mm, 4 mm\", in the bone's frame: where the saw "
                 "starts (default: a site is found)");
    verb.add("--approach", text.approach,
             "X,Y,Z: direction of the saw into the bone (default: the surface's normal at --site)")
        .needs(site);
}

}  // namespace tactus::command
