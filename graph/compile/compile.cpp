// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/compile.hpp"

#include "graph/compile/decide_types.hpp"
#include "graph/compile/force_path.hpp"
#include "graph/compile/sounds.hpp"
#include "graph/compile/units.hpp"
#include "graph/patch/sub_patch.hpp"

#include <utility>

namespace tactus::compile {

std::optional<Schedule> compile(patch::Patch patch, Catalogue catalogue, patch::Problems& problems) {
    Schedule plan;
    plan.patch = std::move(patch);
    const std::size_t earlier = problems.list.size();
    patch::flatten(plan.patch, problems);
    if (problems.list.size() > earlier) return std::nullopt;
    resolve_nodes(plan, catalogue, problems);
    decide_types(plan);
    form_groups(plan, problems);
    resolve_wires(plan, problems);
    join_heard_cards(plan);
    if (problems.empty()) check_sounds(plan, problems);
    if (problems.empty()) check_units(plan, problems);
    // An order is only worth finding among wires that exist: otherwise one slip is reported twice.
    if (problems.empty()) order_nodes(plan, problems);
    if (!problems.empty()) return std::nullopt;
    order_feedback(plan);
    rank_groups(plan);
    return plan;
}

}  // namespace tactus::compile
