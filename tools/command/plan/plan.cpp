// SPDX-License-Identifier: Apache-2.0
// tactus plan: the group of verbs for plans of a case.
#include "tools/command/catalogue.hpp"

namespace tactus::command {

Verb plan_verb() {
    return {"plan", "edit the plan of a case: fragments, their poses, and every step", nullptr, plan_verbs};
}

}  // namespace tactus::command
