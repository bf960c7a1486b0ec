// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/type_ports.hpp"

#include "graph/compile/schedule.hpp"
#include "nodes/catalogue.hpp"

#include <algorithm>
#include <functional>
#include <map>

namespace tactus::window {

namespace {

struct PortLister : MemberVisitor {
    TypePorts ports;

    /// Null where the wires decide.
    static const ValueType* known(const ValueType* type) { return type == &value::undecided ? nullptr : type; }

    void input(std::string_view name, Input& port) override {
        PicturePort made{std::string(name),
                         std::string(port.about),
                         std::string(port.unit),
                         known(port.type),
                         port.is_optional,
                         false,
                         false,
                         {}};
        made.takes_many = port.kind == InputKind::events;
        ports.inputs.push_back(std::move(made));
    }
    void output(std::string_view name, Output& port) override {
        ports.outputs.push_back({std::string(name),
                                 std::string(port.about),
                                 std::string(port.unit),
                                 known(port.type),
                                 true,
                                 false,
                                 false,
                                 {}});
    }
    void param(std::string_view name, Param& param) override {
        if (!param.is_structural) ports.params.emplace_back(name, param.unit);
    }
    void asset(std::string_view name, AssetParam& asset) override {
        ports.files.push_back({std::string(name), std::string(asset.type_name)});
        if (!asset.is_optional) ports.assets.emplace_back(name);
    }
};

}  // namespace

const TypePorts* ports_of_type(std::string_view name) {
    static std::map<std::string, TypePorts, std::less<>> known;
    if (const auto found = known.find(name); found != known.end()) return &found->second;
    const auto catalogue = nodes::catalogue();
    const auto type = std::ranges::find(catalogue, name, [](const NodeType* t) -> std::string_view { return t->name; });
    if (type == catalogue.end()) return nullptr;
    const compile::NodeInstance fresh((*type)->create(), (*type)->destroy);
    PortLister lister;
    (*type)->visit(fresh.get(), lister);
    return &known.emplace(std::string(name), std::move(lister.ports)).first->second;
}

}  // namespace tactus::window
