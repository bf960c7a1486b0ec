// SPDX-License-Identifier: Apache-2.0
// Drafts: new nodes that become an edit when their inputs are wired.
#include "tools/view/workbench.hpp"

#include "nodes/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::view {

namespace {

struct PortLister : MemberVisitor {
    explicit PortLister(Draft& draft_) : draft(draft_) {}
    void input(std::string_view name, Input& port) override {
        draft.inputs.push_back({std::string(name),
                                std::string(port.about),
                                std::string(port.unit),
                                port.type,
                                port.is_optional,
                                false,
                                false,
                                {}});
    }
    void output(std::string_view name, Output& port) override {
        draft.outputs.push_back(
            {std::string(name), std::string(port.about), std::string(port.unit), port.type, true, false, false, {}});
    }
    Draft& draft;
};

}  // namespace

bool Draft::is_complete() const {
    return std::ranges::all_of(inputs, [](const PicturePort& p) { return p.is_optional || p.is_connected; });
}

std::string Workbench::free_name(const std::string& type) const {
    std::string name = type;
    for (int i = 2; picture_.find(name) >= 0; ++i) name = fmt::format("{}_{}", type, i);
    return name;
}

void Workbench::begin_draft(const std::string& type, int group) {
    const auto found = std::ranges::find(nodes::catalogue(), type, [](const NodeType* t) { return t->name; });
    if (found == nodes::catalogue().end() || !plan_) return tell(fmt::format("no node type '{}'", type), true);
    Draft draft;
    draft.node.name = free_name(type);
    draft.node.type = type;
    const compile::PlanGroup& lane = plan_->groups[static_cast<std::size_t>(group)];
    const auto named = std::ranges::find(plan_->patch.groups, lane.name, &patch::PatchGroup::name);
    if (named != plan_->patch.groups.end()) draft.node.group = lane.name;
    else draft.node.rate = lane.name;
    const compile::NodeInstance fresh((*found)->create(), (*found)->destroy);
    PortLister lister(draft);
    (*found)->visit(fresh.get(), lister);
    draft_ = std::move(draft);
    if (!draft_->is_complete()) return tell(fmt::format("{} needs wires to its inputs first", draft_->node.name));
    const edit::NewNode node = draft_->node;
    draft_.reset();
    add(node);
}

void Workbench::connect_draft(const std::string& from, const std::string& input) {
    if (!draft_) return;
    const auto port = std::ranges::find(draft_->inputs, input, &PicturePort::name);
    if (port == draft_->inputs.end()) return;
    std::erase_if(draft_->node.wires, [&](const edit::WireText& w) { return w.to.ends_with("." + input); });
    draft_->node.wires.push_back({from, draft_->node.name + "." + input, {}});
    port->is_connected = true;
    if (!draft_->is_complete()) return;
    const edit::NewNode node = draft_->node;
    if (add(node)) draft_.reset();
    else {
        draft_->node.wires.pop_back();
        std::ranges::find(draft_->inputs, input, &PicturePort::name)->is_connected = false;
    }
}

}  // namespace tactus::view
