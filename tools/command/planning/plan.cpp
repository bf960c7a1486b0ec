// SPDX-License-Identifier: Apache-2.0
// The verbs that keep the plan of a case.
#include "tools/command/catalogue.hpp"

namespace tactus::command {

Verb plan_verb() {
    return {"plan", "keep the plan of a case: fragments, their places, and every step", nullptr, plan_verbs};
}

}  // namespace tactus::command
