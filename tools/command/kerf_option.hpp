// SPDX-License-Identifier: Apache-2.0
// --kerf, for the verbs that fit fragments.
#pragma once

#include "tools/command/options.hpp"

#include <optional>

namespace tactus::command {

/// `kerf`: mm of bone lost along the faces.
inline void add_kerf(VerbOptions& verb, std::optional<double>& kerf) {
    verb.add("--kerf", kerf,
             "mm of bone that a blade or a break took away all along the faces; the fit leaves it open. 0: nothing is "
             "lost, and no kerf is looked for (default: a fit that the cortex shows open is refused)")
        .range(0.0, 4.0);
}

}  // namespace tactus::command
