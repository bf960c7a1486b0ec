// SPDX-License-Identifier: Apache-2.0
#include "engine/survival.hpp"

#include <fmt/format.h>

namespace tactus {

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

}  // namespace

std::string structure_of(const Plan& plan, int index) {
    const PlanNode& node = plan.nodes[static_cast<std::size_t>(index)];
    std::string text = fmt::format("{} seed {}\n", node.type->name, plan.patch.seed);
    Describer describer(text);
    node.type->visit(node.instance.get(), describer);
    for (const PlanWire& wire : plan.wires) {
        if (wire.to_node != index || wire.to_input < 0) continue;
        const PlanInput& input = node.inputs[static_cast<std::size_t>(wire.to_input)];
        // What comes in batches was prepared for at its rate.
        if (input.port->kind == InputKind::batch) text += fmt::format("{} every {}\n", input.name, input.port->period);
        if (input.port->kind != InputKind::any) continue;
        const std::string source = wire.from_node < 0
                                       ? wire.asset
                                       : plan.nodes[static_cast<std::size_t>(wire.from_node)].name + "." +
                                             plan.nodes[static_cast<std::size_t>(wire.from_node)]
                                                 .outputs[static_cast<std::size_t>(wire.from_output)]
                                                 .name;
        text += fmt::format("{} from {}\n", input.name, source);
    }
    return text;
}

}  // namespace tactus
