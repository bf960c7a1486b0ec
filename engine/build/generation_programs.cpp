// SPDX-License-Identifier: Apache-2.0
// What each rate group does in a tick, and what it takes over from the program before.
#include "engine/build/force_path.hpp"
#include "engine/build/generation_builder.hpp"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>

namespace tactus::build {

void GenerationBuilder::make_steps() {
    std::unordered_map<const Param*, std::size_t> owners;
    for (std::size_t i = 0; i < plan().nodes.size(); ++i)
        for (const auto& [name, param] : made_->nodes[i]->params) owners.emplace(param, i);
    for (const auto& link : made_->links)
        for (const run::LinkWire& wire : link->wires) {
            if (wire.brings_events()) {
                EventFeed& feed = merge_into(wire.target, group_index_.at(link->consumer)).feeds.emplace_back();
                feed.name = wire.name;
                feed.delay = wire.delay;
                feed.link = &wire;
            } else if (wire.mode == patch::WireMode::batch && link->changes_within_calls)
                batches_.emplace(wire.target, &wire);
            else if (wire.param && !wire.glide.empty())
                drives_[owners.at(wire.param)].push_back({wire.param, wire.glide.data(), sizeof(double)});
        }
    for (const auto& [input, merge] : merges_) merge->sort_feeds();
    const std::vector<bool> vary = vary_within_call();
    for (std::size_t g = 0; g < plan().groups.size(); ++g) {
        for (const int index : plan().groups[g].order)
            add_step(*made_->programs[g], static_cast<std::size_t>(index), vary[static_cast<std::size_t>(index)]);
        make_stretches(g);
        record(g);
    }
}

std::vector<bool> GenerationBuilder::vary_within_call() const {
    std::vector<bool> vary(made_->plan.nodes.size());
    for (const compile::ScheduleWire& wire : made_->plan.wires) {
        if (wire.from_node < 0) continue;
        const compile::ScheduleNode& node = made_->plan.nodes[static_cast<std::size_t>(wire.to_node)];
        const int from = made_->plan.nodes[static_cast<std::size_t>(wire.from_node)].group;
        const bool changes = from == node.group || changes_within_calls(from, node.group);
        const InputKind kind =
            wire.to_input < 0 ? InputKind::value : node.inputs[static_cast<std::size_t>(wire.to_input)].port->kind;
        const bool is_one_value = kind == InputKind::value && (changes || wire.mode == patch::WireMode::linear);
        if (is_one_value || (kind == InputKind::batch && changes)) vary[static_cast<std::size_t>(wire.to_node)] = true;
    }
    return vary;
}

void GenerationBuilder::record(std::size_t g) {
    GroupProgram& program = *made_->programs[g];
    if (!context_.take || program.layout.columns.empty()) return;
    program.frames.resize(program.layout.bytes * static_cast<std::size_t>(made_->groups[g]->max_frames));
    program.recorded = context_.take(program.layout, *made_->groups[g]);
}

/// Delayed wires are laid out before the first step that may read them.
void GenerationBuilder::make_stretches(std::size_t g) {
    const compile::ScheduleGroup& group = plan().groups[g];
    GroupProgram& program = *made_->programs[g];
    if (program.delays.empty()) {
        program.stretches.push_back({.first = 0, .count = program.steps.size(), .inner = {}, .before = {}});
        return;
    }
    std::unordered_map<const void*, std::size_t> places;  // of the step that reads an input or a parameter
    for (std::size_t i = 0; i < program.steps.size(); ++i) {
        const compile::ScheduleNode& node = plan().nodes[static_cast<std::size_t>(group.order[i])];
        for (const compile::ScheduleInput& input : node.inputs) places.emplace(input.port, i);
        for (const auto& [name, param] : node.params) places.emplace(param, i);
    }
    std::unordered_map<const Output*, std::size_t> sources;
    for (std::size_t i = 0; i < program.steps.size(); ++i)
        for (const compile::ScheduleOutput& output : plan().nodes[static_cast<std::size_t>(group.order[i])].outputs)
            sources.emplace(output.port, i);
    std::map<std::size_t, Stretch> stretches;  // by the first step
    stretches[0];
    for (const compile::ScheduleCycle& cycle : group.cycles) {
        const auto first = static_cast<std::size_t>(cycle.first);
        stretches[first].longest = cycle.longest;
        stretches.try_emplace(first + static_cast<std::size_t>(cycle.count));
    }
    for (const auto& line : program.delays) {
        const std::size_t at =
            places.at(line->target ? static_cast<const void*>(line->target) : static_cast<const void*>(line->param));
        auto within = std::prev(stretches.upper_bound(at));
        if (within->second.longest > 0) {
            const bool is_inner = sources.at(line->source) >= within->first;
            (is_inner ? within->second.inner : within->second.before).push_back(line.get());
        } else if (group.has_audio) stretches[at].before.push_back(line.get());
        // The source may run later in this activation: the value is from an earlier call.
        else stretches[0].before.push_back(line.get());
    }
    stretches.erase(program.steps.size());
    for (auto at = stretches.begin(); at != stretches.end(); ++at) {
        const auto next = std::next(at);
        at->second.first = at->first;
        at->second.count = (next == stretches.end() ? program.steps.size() : next->first) - at->first;
        program.stretches.push_back(std::move(at->second));
    }
}

void GenerationBuilder::add_step(GroupProgram& program, std::size_t index, bool varies) {
    const compile::ScheduleNode& node = plan().nodes[index];
    LiveNode& running = *made_->nodes[index];
    StepWires& wires = program.wires.emplace_back();
    for (const Drive& drive : drives_[index]) wires.drives.push_back({live(drive.param), drive.values, drive.stride});
    for (std::size_t k = 0; k < node.inputs.size(); ++k) {
        if (const auto merge = merges_.find(running.inputs[k]); merge != merges_.end())
            wires.events.push_back(merge->second);
        else if (const auto batch = batches_.find(running.inputs[k]); batch != batches_.end())
            wires.batches.push_back(batch->second);
        else if (node.inputs[k].port->type) wires.inputs.push_back(running.inputs[k]);
    }
    wires.time = &running.time;
    Step& step = program.steps.emplace_back();
    step.process = node.type->process;
    step.node = running.instance.get();
    step.driven = !wires.drives.empty() || !wires.events.empty();
    step.one_at_a_time = !node.takes_blocks || varies;
    step.first_output = static_cast<std::uint32_t>(program.published.size());
    step.output_count = static_cast<std::uint32_t>(node.outputs.size());
    for (std::size_t k = 0; k < node.outputs.size(); ++k) {
        const ValueType& type = *node.outputs[k].port->type;
        PublishedOutput& output = program.published.emplace_back();
        output.port = running.outputs[k];
        output.is_signal = &type == &value::signal;
        output.name = node.name + "." + node.outputs[k].name;
        if (context_.take) output.offset = program.layout.add(output.name, type);
        if (context_.observer) output.seen = &observed(running, k, output.name);
        if (&type == &value::event) program.event_outputs.push_back(running.outputs[k]);
        if (type.version) program.snapshots.push_back({static_cast<SnapshotOutput*>(running.outputs[k]), {}, {}});
    }
    program.hashes_outputs = context_.hash;
    program.records_outputs = context_.take || context_.observer;
}

observe::ObservedPort& GenerationBuilder::observed(LiveNode& node, std::size_t output, const std::string& name) {
    if (node.seen.size() <= output) {
        const run::GroupRuntime& group = *node.group;
        node.seen.push_back(
            context_.observer->open({name, group.plan->period, group.plan->has_audio ? group.max_frames : 1},
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
        if (link->continued) links_going_on_.insert(link->continued);
        if (!new_links_.contains(link.get())) {
            links_going_on_.insert(link.get());
            continue;
        }
        consumer.new_inputs.push_back(link.get());
        producer.new_outputs.push_back(link.get());
    }
    for (std::size_t g = 0; g < made_->groups.size(); ++g) finish_program(g);
    make_ramps();
    for (std::size_t i = 0; i < plan().nodes.size(); ++i) {
        if (made_->survived[i]) rewire(i);
        assign_devices(i);
    }
    for (const auto& program : made_->programs)
        for (const io::DeviceSlot* slot : program->driven) {
            program->sources.push_back(sources_of(*made_, *slot));
            program->warm_ups.push_back(warm_up_of(*made_, *slot));
        }
    for (const auto& program : made_->programs)
        for (const io::DeviceSlot* slot : program->driven) made_->force_paths[slot] = hash_of_force_path(*made_, *slot);
    for (const auto& program : made_->programs) program->is_new_path.assign(program->driven.size(), !before_);
    if (!before_) return;
    const std::vector<const io::DeviceSlot*> changed = changed_forces(*before_, *made_);
    for (const auto& program : made_->programs)
        for (std::size_t i = 0; i < program->driven.size(); ++i)
            program->is_new_path[i] = std::ranges::find(changed, program->driven[i]) != changed.end();
    for (std::size_t g = 0; g < made_->groups.size(); ++g)
        made_->programs[g]->changes_force = std::ranges::any_of(
            changed, [&](const io::DeviceSlot* slot) { return slot->group == made_->groups[g]->index; });
}

void GenerationBuilder::make_ramps() {
    const std::vector<bool> is_meant = nodes_of_forces(*made_);
    for (std::size_t i = 0; i < made_->nodes.size(); ++i) {
        if (!is_meant[i]) continue;
        for (const auto& [name, param] : made_->nodes[i]->params) {
            if (param->is_structural || param->is_discrete) continue;
            auto& ramp = made_->ramps[param];
            if (before_)
                if (const auto old = before_->ramps.find(param); old != before_->ramps.end()) ramp = old->second;
            if (!ramp) ramp = std::make_shared<run::ParamRamp>(*param);
        }
    }
}

void GenerationBuilder::assign_devices(std::size_t index) {
    const compile::ScheduleNode& node = plan().nodes[index];
    GroupProgram& program = program_of(node.group);
    for (const auto& [slot, use] : made_->nodes[index]->uses.devices) {
        if (std::ranges::find(program.devices, slot) == program.devices.end()) program.devices.push_back(slot);
        if (use != DeviceUse::drive) continue;
        if (std::ranges::find(program.driven, slot) != program.driven.end())
            throw Error(node.where, "another node already drives this device; a hand takes one force");
        program.driven.push_back(slot);
    }
    std::ranges::sort(program.devices, {}, &io::DeviceSlot::id);
    for (io::SoundHeard* heard : made_->nodes[index]->uses.heard) program.heard.push_back(heard);
    std::ranges::sort(program.heard, {}, &io::SoundHeard::id);
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
    find_readers(program);
    const auto found = groups_before_.find(made_->groups[g].get());
    if (found == groups_before_.end()) return;
    const GroupProgram& old = *before_->programs[found->second];
    find_delays_before(program, old);
    find_outputs_before(program, old);
    for (run::Link* link : old.inputs)
        if (!links_going_on_.contains(link)) program.ended.push_back(link);
}

void GenerationBuilder::find_readers(GroupProgram& program) {
    for (PublishedSnapshot& snapshot : program.snapshots) {
        for (const run::Link* link : program.outputs)
            if (link->may_hold(snapshot.port)) snapshot.links.push_back(link);
        for (const auto& delay : program.delays)
            if (delay->source == snapshot.port) snapshot.delays.push_back(delay.get());
    }
}

void GenerationBuilder::find_delays_before(GroupProgram& program, const GroupProgram& old) const {
    // Nothing has two wires but an input of events.
    using End = std::tuple<const void*, const Output*, std::int64_t>;
    const auto end_of = [](const DelayLine& line) {
        return End{line.target ? static_cast<const void*>(line.target) : line.param, line.source, line.count};
    };
    std::map<End, DelayLine*> old_lines;
    for (const auto& line : old.delays) old_lines.emplace(end_of(*line), line.get());
    for (const auto& line : program.delays) {
        const auto found = old_lines.find(end_of(*line));
        if (found == old_lines.end()) continue;
        DelayLine& candidate = *found->second;
        if (candidate.source == line->source && candidate.target == line->target && candidate.param == line->param &&
            candidate.count == line->count)
            line->before = &candidate;
    }
}

void GenerationBuilder::find_outputs_before(GroupProgram& program, const GroupProgram& old) const {
    std::unordered_map<std::string_view, std::size_t> past;
    for (std::size_t k = 0; k < old.published.size(); ++k) past.emplace(old.published[k].name, k);
    for (PublishedOutput& output : program.published) {
        const auto found = past.find(output.name);
        if (found != past.end() && *old.published[found->second].port->type == *output.port->type)
            output.before = static_cast<int>(found->second);
    }
}

void GenerationBuilder::rewire(std::size_t index) {
    const compile::ScheduleNode& node = plan().nodes[index];
    const LiveNode& running = *made_->nodes[index];
    GroupProgram& program = program_of(node.group);
    for (std::size_t k = 0; k < node.inputs.size(); ++k)
        program.wiring.emplace_back(running.inputs[k], node.inputs[k].port);
    const std::size_t old = nodes_before_.at(node.name);
    const compile::ScheduleNode& old_node = before_->plan.nodes[old];
    for (const auto& [name, param] : node.params) {
        Param* const runs = running.params.at(name);
        if (param->max != old_node.params.at(name)->max)
            program.limits.push_back({runs, param->max, made_->ramp_of(runs)});
        if (driven_.contains(param)) continue;
        const double now = made_->patch_values[index].at(name);
        // A value that was set live stays until the patch's text states another one.
        if (now != before_->patch_values[old].at(name) || driven_before_.contains(old_node.params.at(name)))
            program.params.push_back({runs, now, made_->ramp_of(runs)});
    }
}

}  // namespace tactus::build
