// SPDX-License-Identifier: Apache-2.0
#include "graph/node/visual.hpp"

#include "dsp/core/error.hpp"

#include <map>

namespace tactus {

namespace {

/// Filled before main and while plug-ins are loaded, which is before a plan is compiled; read only afterwards.
std::map<const NodeType*, VisualsDeclaration::Gives>& declared() {
    static std::map<const NodeType*, VisualsDeclaration::Gives> all;
    return all;
}

}  // namespace

VisualsDeclaration::VisualsDeclaration(const NodeType& type, Gives gives) { declared().emplace(&type, gives); }

std::vector<Visual> visuals_of(const NodeType& type, const void* node) {
    const auto found = declared().find(&type);
    if (found == declared().end()) return {};
    try {
        return found->second(node);
    } catch (const Error&) {
        return {};  // `prepare` says what is wrong
    }
}

}  // namespace tactus
