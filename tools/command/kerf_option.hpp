// SPDX-License-Identifier: Apache-2.0
// --kerf, for the verbs that fit fragments.
#pragma once

#include "tools/command/options.hpp"

#include <optional>

namespace tactus::command {

/// `kerf`: mm of bone lost along the faces.
inline void add_kerf(VerbOptions& verb, std::optional<double>& kerf) {
    verb.add("--kerf", kerf,
             "mm of bone lost along the whole faces, to a blade or by crushing; the fit leaves this gap open. 0: no "
             "bone is lost, and the kerf is not checked (default: unknown; a fit is refused if the cortex beyond the "
             "faces indicates a loss)")
        .range(0.0, 4.0);
}

}  // namespace tactus::command
