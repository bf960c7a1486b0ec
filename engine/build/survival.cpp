// SPDX-License-Identifier: Apache-2.0
#include "engine/build/survival.hpp"

#include <fmt/format.h>

namespace tactus::build {

namespace {

class Describer : public MemberVisitor {
public:
    explicit Describer(std::string& description) : description_(description) {}

    void param(std::string_view name, Param& p) override {
        if (p.is_structural) add(name, fmt::format("{:a}", p.value));
    }
    void choice(std::string_view name, Choice& c) override { add(name, std::to_string(c.index)); }
    void text(std::string_view name, Text& t) override { add(name, t.value); }
    void flag(std::string_view name, Flag& f) override { add(name, f.value ? "true" : "false"); }
    void vector(std::string_view name, Vector& v) override {
        add(name, fmt::format("{:a} {:a} {:a}", v.value.x, v.value.y, v.value.z));
    }
    // The file itself counts: two names of one file are the same asset.
    void asset(std::string_view name, AssetParam& a) override { add(name, fmt::format("{}", a.loaded.get())); }

private:
    void add(std::string_view name, const std::string& value) { description_ += fmt::format("{}={}\n", name, value); }

    std::string& description_;
};

/// What the wire into an input means for its node.
void describe_wire(const compile::Schedule& plan, const compile::ScheduleWire& wire, std::string& text) {
    const compile::ScheduleInput& input =
        plan.nodes[static_cast<std::size_t>(wire.to_node)].inputs[static_cast<std::size_t>(wire.to_input)];
    // A batch input was prepared for the rate of its source.
    if (input.port->kind == InputKind::batch) text += fmt::format("{} every {}\n", input.name, input.port->period);
    if (input.port->kind != InputKind::any) return;
    // What a probe reports and a recorder writes is that of one source.
    if (!plan.nodes[static_cast<std::size_t>(wire.to_node)].outputs.empty()) return;
    std::string source = wire.asset;
    if (wire.from_node >= 0) {
        const compile::ScheduleNode& from = plan.nodes[static_cast<std::size_t>(wire.from_node)];
        source = from.name + "." + from.outputs[static_cast<std::size_t>(wire.from_output)].name;
    }
    text += fmt::format("{} from {}\n", input.name, source);
}

}  // namespace

std::vector<std::string> structures_of(const compile::Schedule& plan) {
    std::vector<std::string> texts;
    texts.reserve(plan.nodes.size());
    for (const compile::ScheduleNode& node : plan.nodes) {
        std::string& text = texts.emplace_back(fmt::format("{} seed {}\n", node.type->name, plan.patch.seed));
        Describer describer(text);
        node.type->visit(node.instance.get(), describer);
        for (const compile::ScheduleInput& input : node.inputs)
            if (input.port->kind == InputKind::any && input.port->type)
                text += fmt::format("{} takes {}\n", input.name, input.port->type->name);
    }
    for (const compile::ScheduleWire& wire : plan.wires)
        if (wire.to_input >= 0) describe_wire(plan, wire, texts[static_cast<std::size_t>(wire.to_node)]);
    return texts;
}

}  // namespace tactus::build
