// SPDX-License-Identifier: Apache-2.0
// How a run gets from one text of its patch to another: by single parameters where that is enough.
#pragma once

#include "graph/compile/plan.hpp"

#include <string>
#include <vector>

namespace tactus::view {

struct PatchChange {
    struct Setting {
        std::string node, param, value;
        bool operator==(const Setting&) const = default;
    };
    std::vector<Setting> settings;  ///< live quantities of nodes that both texts have
    bool needs_edit = false;        ///< something else differs, too
};

PatchChange change_between(const compile::Plan& before, const compile::Plan& after);

}  // namespace tactus::view
