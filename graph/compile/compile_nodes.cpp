// SPDX-License-Identifier: Apache-2.0
#include "graph/compile/compile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

namespace tactus::compile {

namespace {

/// Gathers a node's members and, by name, how a text sets each of them.
class Collector : public MemberVisitor {
public:
    explicit Collector(ScheduleNode& node) : node_(node) {}

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
        node_.texts.emplace(name, &t);
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

    const std::vector<std::string>& names() const { return names_; }
    bool knows(std::string_view name) const { return std::ranges::find(names_, name) != names_.end(); }

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

    ScheduleNode& node_;
    std::vector<std::string> names_;
    std::vector<std::function<void(const OptionText&)>> setters_;
};

const NodeType* find_type(const patch::PatchNode& node, Catalogue catalogue, patch::Problems& problems) {
    for (const NodeType* type : catalogue)
        if (type->name == node.type) return type;
    std::vector<std::string> names;
    for (const NodeType* type : catalogue) names.push_back(type->name);
    const std::string near = did_you_mean(node.type, names);
    problems.add(node.type_where,
                 fmt::format("unknown node type '{}'{}", node.type,
                             near.empty() ? "; one from outside of Tactus is given by --nodes FILE" : near));
    return nullptr;
}

void check_assets(const ScheduleNode& node, const std::vector<std::string>& names,
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

/// Gives nodes that name an actuator or a sensor its settings, where they have none of their own.
class Actuators {
public:
    Actuators(const std::vector<patch::PatchActuator>& list, patch::Problems& problems)
        : list_(list), problems_(problems) {}

    void apply(const patch::PatchNode& node, const ScheduleNode& made, const Collector& collector) {
        apply(node, made, collector, {"actuator", "actuators", ""});
        apply(node, made, collector, {"sensor", "sensors", "sensors."});
    }

    /// A setting that no node understands is an error.
    void finish() const {
        for (const patch::PatchActuator& actuator : list_) {
            const auto seen = seen_.find(actuator.name);
            if (seen == seen_.end()) continue;
            const bool is_sensor = actuator.name.starts_with("sensors.");
            for (const OptionText& given : actuator.settings)
                if (!seen->second.known.contains(given.name))
                    problems_.add(given.where, fmt::format("no node that names {} '{}' has a parameter '{}'{}",
                                                           is_sensor ? "sensor" : "actuator",
                                                           actuator.name.substr(is_sensor ? 8 : 0), given.name,
                                                           did_you_mean(given.name, seen->second.names)));
        }
    }

private:
    struct Kind {
        const char *param, *table, *prefix;
    };

    void apply(const patch::PatchNode& node, const ScheduleNode& made, const Collector& collector, const Kind& kind) {
        const auto text = made.texts.find(kind.param);
        if (text == made.texts.end() || text->second->value.empty()) return;
        const std::string wanted = kind.prefix + text->second->value;
        const auto actuator = std::ranges::find(list_, wanted, &patch::PatchActuator::name);
        // A name has no point: "sensors.skin" is no actuator.
        if (actuator == list_.end() || text->second->value.find('.') != std::string::npos) {
            std::vector<std::string> names;
            const std::string prefix = kind.prefix;
            for (const patch::PatchActuator& known : list_)
                if (known.name.starts_with(prefix) && known.name.find('.', prefix.size()) == std::string::npos)
                    names.push_back(known.name.substr(prefix.size()));
            problems_.add(text->second->where, fmt::format("no {} '{}' in [{}]{}", kind.param, text->second->value,
                                                           kind.table, did_you_mean(text->second->value, names)));
            return;
        }
        Seen& seen = seen_[actuator->name];
        for (const OptionText& given : actuator->settings) {
            if (!collector.knows(given.name) || given.name == kind.param) continue;
            seen.known.insert(given.name);
            if (std::ranges::find(node.settings, given.name, &OptionText::name) == node.settings.end())
                collector.apply(given, problems_);
        }
        std::ranges::copy(collector.names(), std::back_inserter(seen.names));
    }

    struct Seen {
        std::unordered_set<std::string> known;
        std::vector<std::string> names;
    };

    const std::vector<patch::PatchActuator>& list_;
    patch::Problems& problems_;
    std::unordered_map<std::string, Seen> seen_;
};

}  // namespace

void resolve_nodes(Schedule& plan, Catalogue catalogue, patch::Problems& problems) {
    plan.nodes.reserve(plan.patch.nodes.size());
    std::vector<std::string> assets;
    for (const patch::PatchAsset& asset : plan.patch.assets) assets.push_back(asset.name);
    const std::unordered_set<std::string_view> known(assets.begin(), assets.end());
    Actuators actuators(plan.patch.actuators, problems);
    for (const patch::PatchNode& patch_node : plan.patch.nodes) {
        ScheduleNode& node = plan.nodes.emplace_back();
        node.name = patch_node.name;
        node.where = patch_node.where;
        node.type = find_type(patch_node, catalogue, problems);
        if (!node.type) continue;
        node.instance = NodeInstance(node.type->create(), node.type->destroy);
        Collector collector(node);
        node.type->visit(node.instance.get(), collector);
        for (const OptionText& given : patch_node.settings) collector.apply(given, problems);
        actuators.apply(patch_node, node, collector);
        check_assets(node, assets, known, problems);
    }
    actuators.finish();
}

}  // namespace tactus::compile
