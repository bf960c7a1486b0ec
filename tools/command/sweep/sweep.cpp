// SPDX-License-Identifier: Apache-2.0
// tactus sweep: the group of verbs for sweeps.
#include "tools/command/catalogue.hpp"

namespace tactus::command {

Verb sweep_verb() {
    return {"sweep", "run verbs or programs over a grid or a design, on this machine or on a cluster", nullptr,
            sweep_verbs};
}

}  // namespace tactus::command
