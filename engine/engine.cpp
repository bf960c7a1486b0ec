// SPDX-License-Identifier: Apache-2.0
#include "engine/engine.hpp"

#include "dsp/core/realtime.hpp"
#include "graph/layout.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

namespace tactus {

namespace {

// How late a group may run, live, before values meant for it are dropped.
constexpr Flicks link_slack = flicks_per_second * 64 / 1000;

const std::byte* default_value(const ValueType& type, std::vector<std::vector<std::byte>>& buffers) {
    auto& buffer = buffers.emplace_back(std::max<std::size_t>(type.size, 16));
    if (&type == &value::pose) *reinterpret_cast<Pose*>(buffer.data()) = Pose{};
    return buffer.data();
}

}  // namespace

Engine::Engine(Plan plan, const EngineOptions& options) : options_(options), plan_(std::move(plan)) {
    flush_denormals_to_zero();
    outside_ = std::make_unique<EngineOutside>(plan_.patch, options.folder, options.live);
    for (std::size_t i = 0; i < plan_.groups.size(); ++i) {
        auto& group = *groups_.emplace_back(std::make_unique<GroupRuntime>());
        group.plan = &plan_.groups[i];
        group.index = static_cast<int>(i);
        group.backlog = plan_.groups[i].backlog;
        if (group.plan->has_audio)
            group.max_frames = options.block > 0
                                   ? options.block
                                   : static_cast<int>(std::max<Flicks>(1, plan_.patch.quantum / group.plan->period));
    }
    allocate_outputs();
    prepare_nodes();
    std::vector<std::vector<Drive>> drives(plan_.nodes.size());
    for (const PlanWire& wire : plan_.wires) wire_group(wire, drives);
    for (const auto& link : links_)
        link->prepare(link_slack, groups_[static_cast<std::size_t>(link->producer)]->max_frames,
                      groups_[static_cast<std::size_t>(link->consumer)]->max_frames);
    for (const auto& link : links_) {
        GroupRuntime& consumer = *groups_[static_cast<std::size_t>(link->consumer)];
        GroupRuntime& producer = *groups_[static_cast<std::size_t>(link->producer)];
        consumer.inputs.push_back(link.get());
        consumer.producers.push_back(&producer);
        producer.outputs.push_back(link.get());
    }
    make_steps(drives);
    for (const auto& slot : outside_->devices) {
        GroupRuntime& group = *groups_[static_cast<std::size_t>(slot->group)];
        group.devices.push_back(slot.get());
        // Late ticks are never run back to back against a hand.
        if (!group.plan->backlog_given) group.backlog = 0;
    }
    set_ends();
}

Engine::~Engine() = default;

void Engine::allocate_outputs() {
    std::vector<int> frames;
    std::vector<std::byte*> silence;  // per group, what a signal input without a wire reads
    for (const auto& group : groups_) {
        frames.push_back(group->max_frames);
        silence.push_back(buffers_.emplace_back(static_cast<std::size_t>(group->max_frames) * sizeof(float)).data());
    }
    const ValueLayout layout = lay_out_values(plan_, frames);
    auto& values = buffers_.emplace_back(layout.bytes + value_alignment);
    void* start = values.data();
    std::size_t room = values.size();
    auto* block = static_cast<std::byte*>(std::align(value_alignment, layout.bytes, start, room));
    for (std::size_t n = 0; n < plan_.nodes.size(); ++n) {
        PlanNode& node = plan_.nodes[n];
        const GroupRuntime& group = *groups_[static_cast<std::size_t>(node.group)];
        const bool has_audio = group.plan->has_audio;
        for (std::size_t k = 0; k < node.outputs.size(); ++k) {
            Output& port = *node.outputs[k].port;
            port.data = block + layout.offsets[n][k];
            port.stride = has_audio ? static_cast<std::ptrdiff_t>(port.type->size) : 0;
            if (port.type == &value::pose)
                std::fill_n(reinterpret_cast<Pose*>(port.data), has_audio ? group.max_frames : 1, Pose{});
        }
        for (PlanInput& input : node.inputs) {
            if (!input.port->type) continue;
            const bool is_signal = input.port->type == &value::signal && input.port->kind == InputKind::stream;
            input.port->data =
                is_signal ? silence[static_cast<std::size_t>(node.group)] : default_value(*input.port->type, buffers_);
            if (is_signal) input.port->stride = sizeof(float);
        }
    }
}

void Engine::prepare_nodes() {
    for (PlanNode& node : plan_.nodes) {
        const GroupRuntime& group = *groups_[static_cast<std::size_t>(node.group)];
        outside_->prepare_for(node.group, group.plan->period);
        Hash seed;
        seed.add_word(plan_.patch.seed);
        seed.add_text(node.name);
        Setup setup{node.name, node.where, group.plan->period, group.max_frames, seed.value(), outside_.get()};
        node.type->prepare(node.instance.get(), setup);
    }
}

Link& Engine::link_for(const PlanWire& wire) {
    const int from = plan_.nodes[static_cast<std::size_t>(wire.from_node)].group;
    const int to = plan_.nodes[static_cast<std::size_t>(wire.to_node)].group;
    const PlanGroup &producer = plan_.groups[static_cast<std::size_t>(from)],
                    &consumer = plan_.groups[static_cast<std::size_t>(to)];
    const Flicks latency = wire_latency(producer, wire);
    for (const auto& link : links_)
        if (link->producer == from && link->consumer == to && link->latency == latency) return *link;
    auto& link = *links_.emplace_back(std::make_unique<Link>());
    link.producer = from;
    link.consumer = to;
    link.id = static_cast<int>(links_.size()) - 1;
    link.producer_period = producer.period;
    link.consumer_period = consumer.period;
    link.latency = latency;
    return link;
}

void Engine::load_constant(const PlanWire& wire) {
    Input& input =
        *plan_.nodes[static_cast<std::size_t>(wire.to_node)].inputs[static_cast<std::size_t>(wire.to_input)].port;
    const auto asset = std::ranges::find(plan_.patch.assets, wire.asset, &PatchAsset::name);
    auto& handle = buffers_.emplace_back(input.type->size);
    try {
        owners_.push_back(input.type->load_asset(asset->path.string(), handle.data()));
    } catch (const Error& error) {
        throw Error(asset->where, error.what());
    }
    input.data = handle.data();
}

void Engine::wire_group(const PlanWire& wire, std::vector<std::vector<Drive>>& drives) {
    if (wire.from_node < 0) return load_constant(wire);
    PlanNode& to = plan_.nodes[static_cast<std::size_t>(wire.to_node)];
    const PlanNode& from = plan_.nodes[static_cast<std::size_t>(wire.from_node)];
    const Output& source = *from.outputs[static_cast<std::size_t>(wire.from_output)].port;
    Input* target = wire.to_input < 0 ? nullptr : to.inputs[static_cast<std::size_t>(wire.to_input)].port;
    if (from.group != to.group) {
        LinkWire& moved = link_for(wire).wires.emplace_back();
        moved.type = source.type;
        moved.source = &source;
        moved.target = target;
        moved.param = wire.param;
        moved.mode = wire.mode == WireMode::delay ? WireMode::hold : wire.mode;
        return;
    }
    GroupRuntime& group = *groups_[static_cast<std::size_t>(to.group)];
    if (wire.mode == WireMode::delay) {
        DelayLine& line = group.delays.emplace_back();
        line.type = source.type;
        line.source = &source;
        line.target = target;
        line.param = wire.param;
        line.count = wire.delay;
        const std::size_t size = source.type->size;
        line.history.resize(static_cast<std::size_t>(wire.delay) * size);
        for (int i = 0; i < wire.delay; ++i)
            std::memcpy(line.history.data() + static_cast<std::size_t>(i) * size, source.data, size);
        line.delayed.resize(static_cast<std::size_t>(group.max_frames) * size);
        if (target) {
            target->data = line.delayed.data();
            target->stride = group.plan->has_audio ? static_cast<std::ptrdiff_t>(size) : 0;
        }
        return;
    }
    if (!target) {
        drives[static_cast<std::size_t>(wire.to_node)].push_back({wire.param, &source, nullptr});
        return;
    }
    target->data = source.data;
    target->stride = source.stride;
    if (target->kind == InputKind::batch) {
        // Within one group a batch is the one value of this tick.
        target->count = 1;
        target->times = &group.now;
        target->period = group.plan->period;
    }
}

std::vector<bool> Engine::vary_within_call() const {
    std::vector<bool> vary(plan_.nodes.size());
    for (const PlanWire& wire : plan_.wires) {
        if (wire.from_node < 0) continue;
        const PlanNode& node = plan_.nodes[static_cast<std::size_t>(wire.to_node)];
        const bool same_group = plan_.nodes[static_cast<std::size_t>(wire.from_node)].group == node.group;
        if (!same_group && wire.mode != WireMode::linear) continue;
        const InputKind kind =
            wire.to_input < 0 ? InputKind::value : node.inputs[static_cast<std::size_t>(wire.to_input)].port->kind;
        if (kind == InputKind::value) vary[static_cast<std::size_t>(wire.to_node)] = true;
    }
    return vary;
}

void Engine::make_steps(std::vector<std::vector<Drive>>& drives) {
    for (const auto& link : links_)
        for (const LinkWire& wire : link->wires) {
            if (!wire.param || wire.mode != WireMode::linear) continue;
            for (std::size_t i = 0; i < plan_.nodes.size(); ++i)
                for (const auto& [name, param] : plan_.nodes[i].params)
                    if (param == wire.param) drives[i].push_back({param, nullptr, &wire});
        }
    const std::vector<bool> vary = vary_within_call();
    for (const auto& group : groups_) {
        group->hashes_outputs = options_.hash;
        for (const int node_index : group->plan->order) {
            PlanNode& node = plan_.nodes[static_cast<std::size_t>(node_index)];
            StepWires& wires = group->wires.emplace_back();
            wires.drives = std::move(drives[static_cast<std::size_t>(node_index)]);
            for (const PlanInput& input : node.inputs)
                if (input.port->type) wires.inputs.push_back(input.port);
            Step& step = group->steps.emplace_back();
            step.process = node.type->process;
            step.node = node.instance.get();
            step.driven = !wires.drives.empty();
            step.one_at_a_time = !node.takes_blocks || vary[static_cast<std::size_t>(node_index)];
            step.first_output = static_cast<std::uint32_t>(group->published.size());
            step.output_count = static_cast<std::uint32_t>(node.outputs.size());
            for (const PlanOutput& output : node.outputs) {
                group->published.push_back({output.port, output.port->type == &value::signal, {}, {}});
                if (output.port->type->version) group->snapshots.push_back(output.port);
            }
        }
    }
}

void Engine::set_ends() {
    if (options_.replay && options_.replay->groups.size() != groups_.size())
        throw Error("the timing log belongs to a patch with other groups");
    if (options_.replay && options_.replay->plan_hash != plan_hash())
        throw Error("the timing log was made with another patch or other settings; replay needs the same");
    for (const auto& group : groups_) {
        const double ticks =
            options_.seconds * static_cast<double>(flicks_per_second) / static_cast<double>(group->plan->period);
        // The last activation is the last that starts before the end; the nudge keeps 0.1 s at 1 kHz at 100.
        group->end = static_cast<std::int64_t>(std::ceil(ticks - 1e-6));
        if (!options_.replay) continue;
        group->replayed = &options_.replay->groups[static_cast<std::size_t>(group->index)];
        for (const TimingRecord& record : *group->replayed)
            if (record.kind == TimingKind::end) group->end = record.tick;
    }
}

std::uint64_t Engine::plan_hash() const {
    Hash hash;
    hash.add_text(plan_.patch.text);
    for (const PatchNode& node : plan_.patch.nodes)
        for (const OptionText& setting : node.settings) {
            hash.add_text(node.name);
            hash.add_text(setting.name);
            hash.add_text(setting.text);
        }
    for (const PatchDevice& device : plan_.patch.devices)
        for (const OptionText& setting : device.settings) {
            hash.add_text(setting.name);
            hash.add_text(setting.text);
        }
    for (const PatchAsset& asset : plan_.patch.assets) hash.add_text(asset.path.filename().string());
    hash.add_word(plan_.patch.seed);
    return hash.value();
}

std::vector<std::pair<std::string, std::uint64_t>> Engine::port_hashes() const {
    std::vector<std::pair<std::string, std::uint64_t>> ports;
    for (const auto& group : groups_) {
        std::size_t next = 0;
        for (const int node_index : group->plan->order) {
            const PlanNode& node = plan_.nodes[static_cast<std::size_t>(node_index)];
            for (const PlanOutput& output : node.outputs)
                ports.emplace_back(node.name + "." + output.name, group->hash_of(next++));
        }
    }
    std::ranges::sort(ports);
    return ports;
}

std::uint64_t Engine::output_hash() const {
    Hash hash;
    for (const auto& [name, port] : port_hashes()) {
        hash.add_text(name);
        hash.add_word(port);
    }
    return hash.value();
}

double Engine::progress_seconds() const {
    double least = options_.seconds;
    for (const auto& group : groups_) least = std::min(least, seconds(group->done() * group->plan->period));
    return least;
}

Report Engine::report() const {
    Report report;
    std::vector<const PlanNode*> nodes;
    for (const PlanNode& node : plan_.nodes) nodes.push_back(&node);
    std::ranges::sort(nodes, {}, &PlanNode::name);
    for (const PlanNode* node : nodes) node->type->report(node->instance.get(), report);
    return report;
}

void Engine::drain_streams() {
    for (const auto& stream : outside_->streams) stream->drain();
}

void Engine::finish() {
    for (const auto& stream : outside_->streams) stream->finish();
}

void Engine::fail(std::exception_ptr error) {
    const std::lock_guard lock(failure_lock_);
    if (!failure_) failure_ = std::move(error);
    stop_ = true;
    generation_.fetch_add(1);
    generation_.notify_all();
}

}  // namespace tactus
