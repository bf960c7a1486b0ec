// SPDX-License-Identifier: Apache-2.0
#include "tools/command/patch_options.hpp"

#include <CLI/CLI.hpp>

namespace tactus {

void add_patch_options(CLI::App& verb, PatchChoice& choice) {
    verb.add_option("patch", choice.patch, "patch file, or a name in the library such as saw-training")->required();
    verb.add_option("--set", choice.overrides.settings, "change a parameter: NODE.PARAM=VALUE")
        ->allow_extra_args(false);
    verb.add_option("--asset", choice.overrides.assets, "use another file: NAME=PATH")->allow_extra_args(false);
    verb.add_option("--seed", choice.seed, "seed of the random numbers");
}

}  // namespace tactus
