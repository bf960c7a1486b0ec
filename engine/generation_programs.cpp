// SPDX-License-Identifier: Apache-2.0
// What each rate group does in a tick, and what it takes over from the program before.
#include "engine/force_path.hpp"
#include "engine/generation_builder.hpp"

#include <algorithm>
#include <cstdint>

namespace tactus {

void GenerationBuilder::make_steps() {
    for (const auto& link : made_->links)
        for (const LinkWire& wire : link->wires) {
            if (!wire.param || wire.mode != WireMode::linear) continue;
            for (std::size_t i = 0; i < plan().nodes.size(); ++i)
                for (const auto& [name, param] : made_->nodes[i]->params)
                    if (param == wire.param) drives_[i].push_back({param, nullptr, &wire});
        }
    const std::vector<bool> vary = vary_within_call();
    for (std::size_t g = 0; g < plan().groups.size(); ++g)
        for (const int index : plan().groups[g].order)
            add_step(*made_->programs[g], static_cast<std::size_t>(index), vary[static_cast<std::size_t>(index)]);
}

std::vector<bool> GenerationBuilder::vary_within_call() const {
    std::vector<bool> vary(made_->plan.nodes.size());
    for (const PlanWire& wire : made_->plan.wires) {
        if (wire.from_node < 0) continue;
        const PlanNode& node = made_->plan.nodes[static_cast<std::size_t>(wire.to_node)];
        const bool same_group = made_->plan.nodes[static_cast<std::size_t>(wire.from_node)].group == node.group;
        if (!same_group && wire.mode != WireMode::linear) continue;
        const InputKind kind =
            wire.to_input < 0 ? InputKind::value : node.inputs[static_cast<std::size_t>(wire.to_input)].port->kind;
        if (kind == InputKind::value) vary[static_cast<std::size_t>(wire.to_node)] = true;
    }
    return vary;
}

void GenerationBuilder::add_step(GroupProgram& program, std::size_t index, bool varies) {
    const PlanNode& node = plan().nodes[index];
    LiveNode& running = *made_->nodes[index];
    StepWires& wires = program.wires.emplace_back();
    for (const Drive& drive : drives_[index])
        wires.drives.push_back({live(drive.param), drive.source ? live(drive.source) : nullptr, drive.glide});
    for (std::size_t k = 0; k < node.inputs.size(); ++k)
        if (node.inputs[k].port->type) wires.inputs.push_back(running.inputs[k]);
    wires.time = &running.time;
    Step& step = program.steps.emplace_back();
    step.process = node.type->process;
    step.node = running.instance.get();
    step.driven = !wires.drives.empty();
    step.one_at_a_time = !node.takes_blocks || varies;
    step.first_output = static_cast<std::uint32_t>(program.published.size());
    step.output_count = static_cast<std::uint32_t>(node.outputs.size());
    for (std::size_t k = 0; k < node.outputs.size(); ++k) {
        const ValueType& type = *node.outputs[k].port->type;
        PublishedOutput& output = program.published.emplace_back();
        output.port = running.outputs[k];
        output.is_signal = &type == &value::signal;
        output.name = node.name + "." + node.outputs[k].name;
        if (workshop_.take) output.take = workshop_.take(output.name, type, *running.group);
        if (workshop_.observer) output.seen = &observed(running, k, output.name);
        if (type.version) program.snapshots.push_back(static_cast<SnapshotOutput*>(running.outputs[k]));
    }
    program.hashes_outputs = workshop_.hash;
    program.records_outputs = workshop_.take || workshop_.observer;
}

ObservedPort& GenerationBuilder::observed(LiveNode& node, std::size_t output, const std::string& name) {
    if (node.seen.size() <= output) {
        const GroupRuntime& group = *node.group;
        node.seen.push_back(
            workshop_.observer->open({name, group.plan->period, group.plan->has_audio ? group.max_frames : 1},
                                     *node.outputs[output]->type, node.outputs[output]->data));
    }
    return *node.seen[output];
}

void GenerationBuilder::make_programs() {
    for (const auto& link : made_->links) {
        GroupProgram &consumer = program_of(link->consumer), &producer = program_of(link->producer);
        consumer.inputs.push_back(link.get());
        consumer.producers.push_back(link->producer);
        producer.outputs.push_back(link.get());
        if (std::ranges::find(new_links_, link.get()) == new_links_.end()) continue;
        consumer.new_inputs.push_back(link.get());
        producer.new_outputs.push_back(link.get());
    }
    for (std::size_t g = 0; g < made_->groups.size(); ++g) finish_program(g);
    for (std::size_t i = 0; i < plan().nodes.size(); ++i) {
        if (made_->survived[i]) rewire(i);
        assign_devices(i);
    }
    if (!before_ || !changes_force_path(*before_, *made_)) return;
    for (const auto& program : made_->programs) program->changes_force = !program->driven.empty();
}

void GenerationBuilder::assign_devices(std::size_t index) {
    const PlanNode& node = plan().nodes[index];
    GroupProgram& program = program_of(node.group);
    for (const auto& [slot, use] : made_->nodes[index]->uses.devices) {
        if (std::ranges::find(program.devices, slot) == program.devices.end()) program.devices.push_back(slot);
        if (use != DeviceUse::drive) continue;
        if (std::ranges::find(program.driven, slot) != program.driven.end())
            throw Error(node.where, "another node already drives this device; a hand takes one force");
        program.driven.push_back(slot);
    }
    std::ranges::sort(program.devices, {}, &DeviceSlot::id);
    // Late ticks are never run back to back against a hand.
    if (!program.devices.empty() && !plan().groups[static_cast<std::size_t>(node.group)].backlog_given)
        program.backlog = 0;
}

void GenerationBuilder::finish_program(std::size_t g) {
    GroupProgram& program = *made_->programs[g];
    for (const auto& line : program.delays) {
        line->source = live(line->source);
        line->target = live(line->target);
        line->param = live(line->param);
    }
    if (!before_) return;
    for (std::size_t old = 0; old < before_->groups.size(); ++old) {
        if (before_->groups[old] != made_->groups[g]) continue;
        for (const auto& line : program.delays)
            for (const auto& candidate : before_->programs[old]->delays)
                if (candidate->source == line->source && candidate->target == line->target &&
                    candidate->param == line->param && candidate->count == line->count)
                    line->before = candidate.get();
        for (PublishedOutput& output : program.published) {
            const auto& past = before_->programs[old]->published;
            const auto at = std::ranges::find(past, output.name, &PublishedOutput::name);
            if (at != past.end() && at->port->type == output.port->type)
                output.before = static_cast<int>(at - past.begin());
        }
        for (Link* link : before_->programs[old]->inputs) {
            const bool goes_on = std::ranges::any_of(
                made_->links, [link](const auto& now) { return now.get() == link || now->continued == link; });
            if (!goes_on) program.ended.push_back(link);
        }
    }
}

bool GenerationBuilder::is_driven(const Generation& generation, int node, const Param* param) const {
    return std::ranges::any_of(generation.plan.wires, [&](const PlanWire& wire) {
        return wire.to_node == node && wire.to_input < 0 && wire.from_node >= 0 && wire.param == param;
    });
}

void GenerationBuilder::rewire(std::size_t index) {
    const PlanNode& node = plan().nodes[index];
    const LiveNode& running = *made_->nodes[index];
    GroupProgram& program = program_of(node.group);
    for (std::size_t k = 0; k < node.inputs.size(); ++k)
        program.wiring.emplace_back(running.inputs[k], node.inputs[k].port);
    const int old = before_->find(node.name);
    const PlanNode& old_node = before_->plan.nodes[static_cast<std::size_t>(old)];
    for (const auto& [name, param] : node.params) {
        if (is_driven(*made_, static_cast<int>(index), param)) continue;
        const double now = made_->patch_values[index].at(name);
        // A value set from outside stays until the patch's text says another.
        if (now != before_->patch_values[static_cast<std::size_t>(old)].at(name) ||
            is_driven(*before_, old, old_node.params.at(name)))
            program.params.emplace_back(running.params.at(name), now);
    }
}

}  // namespace tactus
