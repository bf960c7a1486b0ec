// SPDX-License-Identifier: Apache-2.0
#include "graph/compile.hpp"

#include "graph/sub_patch.hpp"

namespace tactus {

std::optional<Plan> compile(const Patch& patch, Catalogue catalogue, Problems& problems) {
    Plan plan;
    plan.patch = patch;
    const std::size_t earlier = problems.list.size();
    flatten(plan.patch, problems);
    if (problems.list.size() > earlier) return std::nullopt;
    resolve_nodes(plan, catalogue, problems);
    form_groups(plan, problems);
    resolve_wires(plan, problems);
    // An order is only worth finding among wires that exist: otherwise one slip is reported twice.
    if (problems.empty()) order_nodes(plan, problems);
    if (!problems.empty()) return std::nullopt;
    return plan;
}

}  // namespace tactus
