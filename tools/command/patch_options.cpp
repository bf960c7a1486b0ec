// SPDX-License-Identifier: Apache-2.0
#include "tools/command/patch_options.hpp"

#include "tools/terminal.hpp"

#include <fmt/format.h>

namespace tactus::command {

void add_patch_options(VerbOptions& verb, run::PatchChoice& choice) {
    verb.add("patch", choice.patch, "patch file, or a name in the library such as saw-training").required();
    add_override_options(verb, choice);
}

void add_override_options(VerbOptions& verb, run::PatchChoice& choice) {
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

void add_saw_options(VerbOptions& verb, run::SawChoice& saw) {
    const Option file =
        verb.add("--saw", saw.file, "sound of a saw, recording set or model: what the saw of the patch plays");
    verb.add(
            "--rate", saw.rate,
            "strokes per second of the sound of --saw, Hz (default: estimated from it); the blade then strokes at this "
            "rate")
        .unit("Hz")
        .range(5.0, 1000.0)
        .needs(file);
}

void use_saw(run::PatchChoice& choice, const run::SawChoice& saw) {
    if (const std::string question = run::choose_saw(choice, saw); !question.empty())
        say(stderr, fmt::format("tactus: {}\n", question));
}

void add_site_options(VerbOptions& verb, run::SiteText& text) {
    const Option site =
        verb.add("--site", text.site,
                 "X,Y,Z in mm, or with units as in \"12 mm, 3 mm, 4 mm\", in the bone's frame: where the saw "
                 "starts (default: a site is found)");
    verb.add("--approach", text.approach,
             "X,Y,Z: direction of the saw into the bone (default: the surface's normal at --site)")
        .needs(site);
    verb.add("--along", text.along,
             "X,Y,Z: direction in which the blade strokes (default: over the narrowest width of the bone at --site)")
        .needs(site);
}

void add_record_options(VerbOptions& verb, std::filesystem::path& folder, bool& values) {
    const Option record = verb.output("--record", folder, OutputFormat::folder(),
                                      "record the run as a take, a folder that 'replay' repeats");
    values = false;
    verb.flag("--values", values,
              "record every value, not only the first 30 MB: the take repeats all of them in each case, and 'replay "
              "--record' writes them")
        .needs(record);
    // Old spelling: values were recorded unless it was given.
    verb.flag("!--no-values", values, "record no more values than the first").hidden();
}

}  // namespace tactus::command
