// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/compile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string_view>
#include <unordered_set>

namespace tactus::compile {

namespace {

/// Gathers a node's members and, by name, how a text sets each of them.
class Collector : public MemberVisitor {
public:
    explicit Collector(PlanNode& node) : node_(node) {}

    void input(std::string_view name, Input& port) override { node_.inputs.push_back({std::string(name), &port, {}}); }
    void output(std::string_view name, Output& port) override { node_.outputs.push_back({std::string(name), &port}); }
    void param(std::string_view name, Param& p) override {
        node_.params.emplace(name, &p);
        offer(name, [&p](const OptionText& given) { p.set(given.text); });
    }
    void choice(std::string_view name, Choice& c) override {
        offer(name, [&c](const OptionText& given) { c.set(given.text); });
    }
    void text(std::string_view name, Text& t) override {
        offer(name, [&t](const OptionText& given) {
            t.value = given.text;
            t.where = given.where;
        });
    }
    void flag(std::string_view name, Flag& f) override {
        offer(name, [&f](const OptionText& given) { f.set(given.text); });
    }
    void vector(std::string_view name, Vector& v) override {
        offer(name, [&v](const OptionText& given) { v.set(given.text); });
    }
    void asset(std::string_view name, AssetParam& a) override {
        node_.assets.push_back(&a);
        offer(name, [&a](const OptionText& given) {
            a.name = given.text.empty() ? given.text : given.scope + given.text;
            a.where = given.where;
        });
    }

    void apply(const OptionText& given, patch::Problems& problems) const {
        const auto found = std::ranges::find(names_, given.name);
        if (found == names_.end()) {
            problems.add(given.where, fmt::format("no parameter '{}' on node '{}' of type {}{}", given.name, node_.name,
                                                  node_.type->name, did_you_mean(given.name, names_)));
            return;
        }
        try {
            setters_[static_cast<std::size_t>(found - names_.begin())](given);
        } catch (const Error& error) {
            problems.add(given.where,
                         fmt::format("parameter '{}' of node '{}': {}", given.name, node_.name, error.message()));
        }
    }

private:
    void offer(std::string_view name, std::function<void(const OptionText&)> setter) {
        names_.emplace_back(name);
        setters_.push_back(std::move(setter));
    }

    PlanNode& node_;
    std::vector<std::string> names_;
    std::vector<std::function<void(const OptionText&)>> setters_;
};

const NodeType* find_type(const patch::PatchNode& node, Catalogue catalogue, patch::Problems& problems) {
    for (const NodeType* type : catalogue)
        if (type->name == node.type) return type;
    std::vector<std::string> names;
    for (const NodeType* type : catalogue) names.push_back(type->name);
    problems.add(node.type_where, fmt::format("unknown node type '{}'{}", node.type, did_you_mean(node.type, names)));
    return nullptr;
}

void check_assets(const PlanNode& node, const std::vector<std::string>& names,
                  const std::unordered_set<std::string_view>& known, patch::Problems& problems) {
    for (const AssetParam* asset : node.assets) {
        if (asset->name.empty()) {
            if (!asset->is_optional)
                problems.add(node.where, fmt::format("node '{}' needs {} from [assets] ({})", node.name,
                                                     asset->type_name, asset->about));
        } else if (!known.contains(asset->name)) {
            problems.add(asset->where, fmt::format("no asset '{}' in [assets]{}", asset->name,
                                                   problems.wants_hint() ? did_you_mean(asset->name, names) : ""));
        }
    }
}

}  // namespace

void resolve_nodes(Plan& plan, Catalogue catalogue, patch::Problems& problems) {
    plan.nodes.reserve(plan.patch.nodes.size());
    std::vector<std::string> assets;
    for (const patch::PatchAsset& asset : plan.patch.assets) assets.push_back(asset.name);
    const std::unordered_set<std::string_view> known(assets.begin(), assets.end());
    for (const patch::PatchNode& patch_node : plan.patch.nodes) {
        PlanNode& node = plan.nodes.emplace_back();
        node.name = patch_node.name;
        node.where = patch_node.where;
        node.type = find_type(patch_node, catalogue, problems);
        if (!node.type) continue;
        node.instance = NodeInstance(node.type->create(), node.type->destroy);
        Collector collector(node);
        node.type->visit(node.instance.get(), collector);
        for (const OptionText& given : patch_node.settings) collector.apply(given, problems);
        check_assets(node, assets, known, problems);
    }
}

}  // namespace tactus::compile
