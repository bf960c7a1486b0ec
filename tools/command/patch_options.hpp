// SPDX-License-Identifier: Apache-2.0
// What every verb that compiles a patch is given.
#pragma once

#include "tools/verbs.hpp"

namespace CLI {
class App;
}

namespace tactus {

/// The patch, its changed parameters and assets, and the seed.
void add_patch_options(CLI::App& verb, PatchChoice& choice);

}  // namespace tactus
