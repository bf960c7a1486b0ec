// SPDX-License-Identifier: Apache-2.0
// The change between two texts of a patch: live parameter changes where possible, otherwise an edit.
#pragma once

#include "graph/compile/schedule.hpp"

#include <string>
#include <vector>

namespace tactus::window {

struct PatchChange {
    struct Setting {
        std::string node, param, value;
        bool operator==(const Setting&) const = default;
    };
    std::vector<Setting> settings;  ///< changed live quantities of nodes in both texts
    bool needs_edit = false;        ///< true when anything else differs
};

PatchChange change_between(const compile::Schedule& before, const compile::Schedule& after);

}  // namespace tactus::window
