// SPDX-License-Identifier: Apache-2.0
#include "tools/window/patch/type_search.hpp"

#include "nodes/catalogue.hpp"
#include "tools/window/document/type_ports.hpp"
#include "tools/window/frame/search.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace tactus::window {

const PicturePort* input_for(const NodeType& type, const ValueType* value) {
    const TypePorts* ports = ports_of_type(type.name);
    if (!ports) return nullptr;
    const PicturePort* any = nullptr;
    for (const PicturePort& input : ports->inputs) {
        if (input.type == value) return &input;
        if (!input.type && !any) any = &input;
    }
    return any;
}

std::vector<const NodeType*> types_for(std::string_view words, const ValueType* feeds) {
    std::vector<std::pair<double, const NodeType*>> all;
    for (const NodeType* type : nodes::catalogue()) {
        if (feeds && !input_for(*type, feeds)) continue;
        if (const double suit = suits(words, type->name, type->about); suit > 0.0) all.emplace_back(suit, type);
    }
    std::ranges::stable_sort(all, std::greater{}, &std::pair<double, const NodeType*>::first);
    std::vector<const NodeType*> types;
    for (const auto& [suit, type] : all) types.push_back(type);
    return types;
}

}  // namespace tactus::window
