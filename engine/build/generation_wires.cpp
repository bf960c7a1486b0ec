// SPDX-License-Identifier: Apache-2.0
// Where values lie, and what carries them from node to node.
#include "engine/build/generation_builder.hpp"
#include "engine/take/take_writer.hpp"
#include "graph/compile/layout.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <memory>
#include <string_view>
#include <tuple>

namespace tactus::build {

namespace {

// How late a group may run live before values for it are dropped.
constexpr Flicks link_slack = flicks_per_second * 64 / 1000;

}  // namespace

std::byte* GenerationBuilder::memory(std::size_t bytes) {
    return made_->memory.emplace_back(std::make_unique<std::vector<std::byte>>(bytes))->data();
}

void GenerationBuilder::allocate() {
    std::vector<int> frames;
    std::vector<std::byte*> silence;  // per group, what a signal input without a wire reads
    for (const auto& group : made_->groups) {
        frames.push_back(group->max_frames);
        silence.push_back(memory(static_cast<std::size_t>(group->max_frames) * sizeof(float)));
    }
    const compile::ValueLayout layout = compile::lay_out_values(plan(), frames);
    void* start = memory(layout.bytes + compile::value_alignment);
    std::size_t room = layout.bytes + compile::value_alignment;
    auto* block = static_cast<std::byte*>(std::align(compile::value_alignment, layout.bytes, start, room));
    for (std::size_t n = 0; n < plan().nodes.size(); ++n) {
        const compile::ScheduleNode& node = plan().nodes[n];
        const run::GroupRuntime& group = group_of(node);
        for (std::size_t k = 0; k < node.outputs.size(); ++k) {
            Output& port = *node.outputs[k].port;
            const std::size_t size = port.type->size;
            const auto count = static_cast<std::size_t>(group.plan->has_audio ? group.max_frames : 1);
            port.data = block + layout.offsets[n][k];
            port.stride = group.plan->has_audio ? static_cast<std::ptrdiff_t>(size) : 0;
            for (std::size_t f = 0; f < count; ++f) port.type->make_default(port.data + f * size);
            // The memory of a signal is shared with others: its values are valid during one call.
            const bool keeps_value = port.type != &value::signal && port.type != &value::event;
            if (made_->survived[n])
                program_of(node.group)
                    .moved.push_back({made_->nodes[n]->outputs[k], port.data, keeps_value ? count * size : 0});
        }
        for (const compile::ScheduleInput& input : node.inputs) {
            if (!input.port->type) continue;
            const bool is_signal = input.port->type == &value::signal && input.port->kind != InputKind::batch;
            if (is_signal) {
                input.port->data = silence[static_cast<std::size_t>(node.group)];
                input.port->stride = sizeof(float);
                continue;
            }
            std::byte* place = memory(std::max<std::size_t>(input.port->type->size, 16));
            input.port->type->make_default(place);
            input.port->data = place;
        }
    }
}

run::Link& GenerationBuilder::link_for(const compile::ScheduleWire& wire) {
    const compile::ScheduleNode &from = plan().nodes[static_cast<std::size_t>(wire.from_node)],
                                &to = plan().nodes[static_cast<std::size_t>(wire.to_node)];
    const compile::ScheduleGroup& producer = plan().groups[static_cast<std::size_t>(from.group)];
    const Flicks latency = compile::wire_latency(producer, wire);
    auto& known = links_made_[{&group_of(from), &group_of(to), latency}];
    if (known) return *known;
    known = made_->links.emplace_back(std::make_shared<run::Link>());
    run::Link& link = *known;
    link.producer = &group_of(from);
    link.consumer = &group_of(to);
    link.producer_period = producer.period;
    link.consumer_period = group_of(to).plan->period;
    link.latency = latency;
    link.changes_within_calls = changes_within_calls(from.group, to.group);
    return link;
}

bool GenerationBuilder::changes_within_calls(int producer, int consumer) const {
    const run::GroupRuntime& to = *made_->groups[static_cast<std::size_t>(consumer)];
    const Flicks call = to.max_frames * to.plan->period;
    return to.plan->has_audio && 2 * made_->plan.groups[static_cast<std::size_t>(producer)].period <= call;
}

void GenerationBuilder::connect_constant(const compile::ScheduleWire& wire) {
    Input& input =
        *plan().nodes[static_cast<std::size_t>(wire.to_node)].inputs[static_cast<std::size_t>(wire.to_input)].port;
    const patch::PatchAsset* asset = assets_.at(wire.asset);
    BuildContext::Constant& constant = context_.constants[{input.type, asset->path.string()}];
    if (!constant.owner) {
        constant.handle.resize(input.type->size);
        try {
            constant.owner = input.type->load_asset(asset->path.string(), constant.handle.data());
            constant.content = take::hash_of_asset(asset->path);
        } catch (const Error& error) {
            throw Error(asset->where, error.what());
        }
    }
    input.data = constant.handle.data();
    made_->constants[&input] = constant.content;
}

void GenerationBuilder::connect_delay(const compile::ScheduleWire& wire, const Output& source, Input* target,
                                      int group_index) {
    const run::GroupRuntime& group = *made_->groups[static_cast<std::size_t>(group_index)];
    DelayLine& line = *program_of(group_index).delays.emplace_back(std::make_unique<DelayLine>());
    line.type = source.type;
    line.source = &source;
    line.values = source.data;
    line.stride = source.stride;
    line.target = target;
    line.param = wire.param;
    line.count = wire.delay;
    const std::size_t size = source.type->size;
    line.history.resize(static_cast<std::size_t>(wire.delay) * size);
    // The group's thread may be writing the values of a running node.
    const bool is_running = made_->survived[static_cast<std::size_t>(wire.from_node)];
    for (int i = 0; i < wire.delay; ++i) {
        std::byte* place = line.history.data() + static_cast<std::size_t>(i) * size;
        if (is_running) source.type->make_default(place);
        else std::memcpy(place, source.data, size);
    }
    line.delayed.resize(static_cast<std::size_t>(group.max_frames) * size);
    const std::ptrdiff_t stride = group.plan->has_audio ? static_cast<std::ptrdiff_t>(size) : 0;
    if (!target) {
        drives_[static_cast<std::size_t>(wire.to_node)].push_back({wire.param, line.delayed.data(), stride});
        return;
    }
    if (source.type == &value::event) return;
    target->data = line.delayed.data();
    target->stride = stride;
}

void GenerationBuilder::connect_events(const compile::ScheduleWire& wire, const Output& source, Input& target) {
    const compile::ScheduleNode& from = plan().nodes[static_cast<std::size_t>(wire.from_node)];
    EventFeed feed;
    feed.name = from.name + "." + from.outputs[static_cast<std::size_t>(wire.from_output)].name;
    feed.delay = wire.delay;
    feed.values = source.data;
    feed.stride = source.stride;
    if (wire.mode == patch::WireMode::delay) {
        connect_delay(wire, source, &target, from.group);
        const DelayLine& line = *program_of(from.group).delays.back();
        feed.values = line.delayed.data();
        feed.stride = group_of(from).plan->has_audio ? static_cast<std::ptrdiff_t>(sizeof(Events)) : 0;
    }
    merge_into(live(&target), from.group).feeds.push_back(std::move(feed));
}

EventMerge& GenerationBuilder::merge_into(Input* target, int group) {
    EventMerge*& merge = merges_[target];
    if (!merge) merge = program_of(group).merges.emplace_back(std::make_unique<EventMerge>(*target)).get();
    return *merge;
}

void GenerationBuilder::connect(const compile::ScheduleWire& wire) {
    if (wire.from_node < 0) return connect_constant(wire);
    compile::ScheduleNode& to = plan().nodes[static_cast<std::size_t>(wire.to_node)];
    const compile::ScheduleNode& from = plan().nodes[static_cast<std::size_t>(wire.from_node)];
    const Output& source = *from.outputs[static_cast<std::size_t>(wire.from_output)].port;
    Input* target = wire.to_input < 0 ? nullptr : to.inputs[static_cast<std::size_t>(wire.to_input)].port;
    if (from.group != to.group) {
        run::LinkWire& moved = link_for(wire).wires.emplace_back();
        moved.type = source.type;
        moved.source = &source;
        moved.target = target;
        moved.param = wire.param;
        moved.mode = wire.mode == patch::WireMode::delay ? patch::WireMode::hold : wire.mode;
        if (source.type == &value::event) {
            moved.mode = patch::WireMode::batch;
            moved.name = from.name + "." + from.outputs[static_cast<std::size_t>(wire.from_output)].name;
            moved.delay = wire.delay;
        }
        moved.starts_from_output = !made_->survived[static_cast<std::size_t>(wire.from_node)];
        return;
    }
    if (source.type == &value::event) return connect_events(wire, source, *target);
    if (wire.mode == patch::WireMode::delay) return connect_delay(wire, source, target, to.group);
    if (!target) {
        drives_[static_cast<std::size_t>(wire.to_node)].push_back({wire.param, source.data, source.stride});
        return;
    }
    target->data = source.data;
    target->stride = source.stride;
    if (target->kind == InputKind::batch) {
        // Within one group a batch is the one value of this tick.
        run::GroupRuntime& group = group_of(to);
        target->count = 1;
        target->times = &group.now;
        target->period = group.plan->period;
    }
}

bool GenerationBuilder::is_same_wire(const run::LinkWire& old, const run::LinkWire& wire) const {
    // Events in transit stay valid when their node is rebuilt.
    const bool is_same_source =
        wire.source->type == &value::event ? old.source->type == &value::event : old.source == live(wire.source);
    return is_same_source && old.target == live(wire.target) && old.param == live(wire.param) && old.mode == wire.mode;
}

GenerationBuilder::WireMatch GenerationBuilder::match_wires(run::Link& link, run::Link* old) const {
    // Nothing has two wires but an input of events, and that none of one name and delay.
    using End = std::tuple<const void*, std::string_view, int>;
    const auto end_of = [](const auto* target, const auto* param, const run::LinkWire& wire) {
        return End{target ? static_cast<const void*>(target) : param, wire.name, wire.delay};
    };
    std::map<End, run::LinkWire*> old_wires;
    if (old)
        for (run::LinkWire& wire : old->wires) old_wires.emplace(end_of(wire.target, wire.param, wire), &wire);
    WireMatch match;
    for (run::LinkWire& wire : link.wires) {
        const auto found = old_wires.find(end_of(live(wire.target), live(wire.param), wire));
        wire.before = found != old_wires.end() && is_same_wire(*found->second, wire) ? found->second : nullptr;
        if (!wire.before) continue;
        ++match.continued;
        match.same += wire.before->source == live(wire.source);
    }
    return match;
}

/// Activations per call of a live run.
int GenerationBuilder::live_frames(const run::GroupRuntime& group) {
    if (!group.plan->has_audio) return 1;
    return static_cast<int>(std::max<Flicks>(1, plan().patch.quantum / group.plan->period));
}

void GenerationBuilder::finish_links() {
    for (auto& link : made_->links) {
        // The link of the plan before, between the same groups and of the same latency.
        const auto found = links_before_.find(ends_of(*link));
        run::Link* old = found == links_before_.end() ? nullptr : found->second.get();
        const WireMatch match = match_wires(*link, old);
        if (old && match.same == link->wires.size() && match.same == old->wires.size()) {
            // Nothing changed: the old link is kept, and inputs stay pointed at it.
            for (run::LinkWire& wire : link->wires)
                if (wire.target) wire.before->point(*wire.target, old->producer_period);
            link = found->second;
            continue;
        }
        new_links_.insert(link.get());
        link->id = context_.next_link++;
        link->continued = match.continued > 0 ? old : nullptr;
        const run::Link::CallLengths live_calls{live_frames(*link->producer), live_frames(*link->consumer)};
        const run::Link::CallLengths calls{std::max(live_calls.producer, link->producer->max_frames),
                                           std::max(live_calls.consumer, link->consumer->max_frames)};
        link->prepare(link_slack, live_calls, calls, before_ ? run::Link::unknown : 0);
        for (run::LinkWire& wire : link->wires) {
            wire.source = live(wire.source);
            wire.target = live(wire.target);
            wire.param = live(wire.param);
        }
    }
}

}  // namespace tactus::build
