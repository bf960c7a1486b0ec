// SPDX-License-Identifier: Apache-2.0
// tactus experiment: the group of verbs for experiments with subjects.
#include "tools/command/catalogue.hpp"

namespace tactus::command {

Verb experiment_verb() {
    return {"experiment", "run an experiment with subjects, real or simulated, and analyse it", nullptr,
            experiment_verbs};
}

}  // namespace tactus::command
