// SPDX-License-Identifier: Apache-2.0
#include "engine/generation.hpp"

#include "dsp/core/realtime.hpp"
#include "engine/force_path.hpp"
#include "engine/survival.hpp"
#include "graph/layout.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <unordered_map>

namespace tactus {

namespace {

// How late a group may run, live, before values meant for it are dropped.
constexpr Flicks link_slack = flicks_per_second * 64 / 1000;

/// Builds on the freshly compiled nodes, then points everything at the nodes that live. A compiled node whose older
/// self goes on is never prepared: it only shows how the inputs of that one are to be wired.
class Builder {
public:
    Builder(Plan plan, const Generation* before, Workshop& workshop)
        : before_(before), workshop_(workshop), made_(std::make_unique<Generation>()) {
        made_->plan = std::move(plan);
        made_->number = before ? before->number + 1 : 0;
    }

    std::unique_ptr<Generation> build() {
        note_patch_values();
        form_groups();
        find_survivors();
        allocate();
        prepare();
        drives_.resize(plan().nodes.size());
        for (const PlanWire& wire : plan().wires) connect(wire);
        finish_links();
        make_steps();
        make_programs();
        return std::move(made_);
    }

private:
    Plan& plan() { return made_->plan; }
    GroupRuntime& group_of(const PlanNode& node) { return *made_->groups[static_cast<std::size_t>(node.group)]; }
    GroupProgram& program_of(int group) { return *made_->programs[static_cast<std::size_t>(group)]; }
    GroupProgram& program_of(const GroupRuntime* runtime) {
        const auto at = std::ranges::find(made_->groups, runtime, &std::shared_ptr<GroupRuntime>::get);
        return *made_->programs[static_cast<std::size_t>(at - made_->groups.begin())];
    }

    void note_patch_values() {
        for (const PlanNode& node : plan().nodes) {
            auto& values = made_->patch_values.emplace_back();
            for (const auto& [name, param] : node.params) values[name] = param->value;
        }
    }

    void form_groups() {
        for (const PlanGroup& group : plan().groups) {
            int frames = 1;
            if (group.has_audio)
                frames = workshop_.block > 0
                             ? workshop_.block
                             : static_cast<int>(std::max<Flicks>(1, plan().patch.quantum / group.period));
            std::shared_ptr<GroupRuntime> runtime;
            if (before_)
                for (const auto& old : before_->groups)
                    if (old->plan->name == group.name && old->plan->period == group.period &&
                        old->plan->has_audio == group.has_audio && old->max_frames == frames)
                        runtime = old;
            made_->group_is_new.push_back(!runtime);
            if (!runtime) {
                if (workshop_.next_group > std::numeric_limits<std::uint16_t>::max())
                    throw Error("edits of this run have made more rate groups than its log can tell apart; start anew");
                runtime = std::make_shared<GroupRuntime>(group, workshop_.next_group++, frames);
            }
            made_->groups.push_back(std::move(runtime));
            auto& program = *made_->programs.emplace_back(std::make_unique<GroupProgram>());
            program.generation = made_->number;
            program.backlog = group.backlog;
        }
    }

    void find_survivors() {
        for (std::size_t i = 0; i < plan().nodes.size(); ++i) {
            PlanNode& node = plan().nodes[i];
            const std::string structure = structure_of(plan(), static_cast<int>(i));
            std::shared_ptr<LiveNode> live;
            if (before_)
                for (const auto& old : before_->nodes)
                    if (old->name == node.name && old->type == node.type && old->group == &group_of(node) &&
                        old->structure == structure)
                        live = old;
            made_->survived.push_back(live != nullptr);
            if (!live) {
                live = std::make_shared<LiveNode>();
                live->name = node.name;
                live->type = node.type;
                live->group = &group_of(node);
                live->structure = structure;
                for (const PlanInput& input : node.inputs) live->inputs.push_back(input.port);
                for (const PlanOutput& output : node.outputs) live->outputs.push_back(output.port);
                live->params = node.params;
                live->instance = std::move(node.instance);
            } else {
                for (std::size_t k = 0; k < node.inputs.size(); ++k) moved_[node.inputs[k].port] = live->inputs[k];
                for (std::size_t k = 0; k < node.outputs.size(); ++k) moved_[node.outputs[k].port] = live->outputs[k];
                for (const auto& [name, param] : node.params) moved_[param] = live->params.at(name);
            }
            made_->nodes.push_back(std::move(live));
        }
    }

    void allocate() {
        std::vector<int> frames;
        std::vector<std::byte*> silence;  // per group, what a signal input without a wire reads
        for (const auto& group : made_->groups) {
            frames.push_back(group->max_frames);
            silence.push_back(memory(static_cast<std::size_t>(group->max_frames) * sizeof(float)));
        }
        const ValueLayout layout = lay_out_values(plan(), frames);
        void* start = memory(layout.bytes + value_alignment);
        std::size_t room = layout.bytes + value_alignment;
        auto* block = static_cast<std::byte*>(std::align(value_alignment, layout.bytes, start, room));
        for (std::size_t n = 0; n < plan().nodes.size(); ++n) {
            const PlanNode& node = plan().nodes[n];
            const GroupRuntime& group = group_of(node);
            for (std::size_t k = 0; k < node.outputs.size(); ++k) {
                Output& port = *node.outputs[k].port;
                const std::size_t size = port.type->size;
                const auto count = static_cast<std::size_t>(group.plan->has_audio ? group.max_frames : 1);
                port.data = block + layout.offsets[n][k];
                port.stride = group.plan->has_audio ? static_cast<std::ptrdiff_t>(size) : 0;
                for (std::size_t f = 0; f < count; ++f) port.type->make_default(port.data + f * size);
                // The place of a signal is shared: its values do not outlive a call.
                const bool keeps_value = port.type != &value::signal;
                if (made_->survived[n])
                    program_of(node.group)
                        .moved.push_back({made_->nodes[n]->outputs[k], port.data, keeps_value ? count * size : 0});
            }
            for (const PlanInput& input : node.inputs) {
                if (!input.port->type) continue;
                const bool is_signal = input.port->type == &value::signal && input.port->kind == InputKind::stream;
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

    std::byte* memory(std::size_t bytes) {
        return made_->memory.emplace_back(std::make_unique<std::vector<std::byte>>(bytes))->data();
    }

    void prepare() {
        std::vector<SoundCard*> playing;
        for (std::size_t i = 0; i < plan().nodes.size(); ++i)
            if (const auto& cards = made_->nodes[i]->uses.cards; made_->survived[i])
                playing.insert(playing.end(), cards.begin(), cards.end());
        workshop_.outside.keep_cards(std::move(playing));
        for (std::size_t i = 0; i < plan().nodes.size(); ++i) {
            if (made_->survived[i]) continue;
            const PlanNode& node = plan().nodes[i];
            const GroupRuntime& group = group_of(node);
            workshop_.outside.prepare_for(group.index, group.plan->period, made_->nodes[i]->uses);
            Hash seed;
            seed.add_word(plan().patch.seed);
            seed.add_text(node.name);
            const Setup setup{node.name,        node.where,   group.plan->period,
                              group.max_frames, seed.value(), &workshop_.outside};
            node.type->prepare(made_->nodes[i]->instance.get(), setup);
        }
    }

    Link& link_for(const PlanWire& wire) {
        const PlanNode &from = plan().nodes[static_cast<std::size_t>(wire.from_node)],
                       &to = plan().nodes[static_cast<std::size_t>(wire.to_node)];
        const PlanGroup& producer = plan().groups[static_cast<std::size_t>(from.group)];
        const Flicks latency = wire_latency(producer, wire);
        for (const auto& link : made_->links)
            if (link->producer == &group_of(from) && link->consumer == &group_of(to) && link->latency == latency)
                return *link;
        auto& link = *made_->links.emplace_back(std::make_shared<Link>());
        link.producer = &group_of(from);
        link.consumer = &group_of(to);
        link.producer_period = producer.period;
        link.consumer_period = group_of(to).plan->period;
        link.latency = latency;
        return link;
    }

    void connect_constant(const PlanWire& wire) {
        Input& input =
            *plan().nodes[static_cast<std::size_t>(wire.to_node)].inputs[static_cast<std::size_t>(wire.to_input)].port;
        const auto asset = std::ranges::find(plan().patch.assets, wire.asset, &PatchAsset::name);
        auto& [owner, handle] = workshop_.constants[{input.type, asset->path.string()}];
        if (!owner) {
            handle.resize(input.type->size);
            try {
                owner = input.type->load_asset(asset->path.string(), handle.data());
            } catch (const Error& error) {
                throw Error(asset->where, error.what());
            }
        }
        input.data = handle.data();
    }

    void connect_delay(const PlanWire& wire, const Output& source, Input* target, int group_index) {
        const GroupRuntime& group = *made_->groups[static_cast<std::size_t>(group_index)];
        DelayLine& line = *program_of(group_index).delays.emplace_back(std::make_unique<DelayLine>());
        line.type = source.type;
        line.source = &source;
        line.target = target;
        line.param = wire.param;
        line.count = wire.delay;
        const std::size_t size = source.type->size;
        line.history.resize(static_cast<std::size_t>(wire.delay) * size);
        // The values of a node that runs are not looked at from here.
        const bool is_running = made_->survived[static_cast<std::size_t>(wire.from_node)];
        for (int i = 0; i < wire.delay; ++i) {
            std::byte* place = line.history.data() + static_cast<std::size_t>(i) * size;
            if (is_running) source.type->make_default(place);
            else std::memcpy(place, source.data, size);
        }
        line.delayed.resize(static_cast<std::size_t>(group.max_frames) * size);
        if (!target) return;
        target->data = line.delayed.data();
        target->stride = group.plan->has_audio ? static_cast<std::ptrdiff_t>(size) : 0;
    }

    void connect(const PlanWire& wire) {
        if (wire.from_node < 0) return connect_constant(wire);
        PlanNode& to = plan().nodes[static_cast<std::size_t>(wire.to_node)];
        const PlanNode& from = plan().nodes[static_cast<std::size_t>(wire.from_node)];
        const Output& source = *from.outputs[static_cast<std::size_t>(wire.from_output)].port;
        Input* target = wire.to_input < 0 ? nullptr : to.inputs[static_cast<std::size_t>(wire.to_input)].port;
        if (from.group != to.group) {
            LinkWire& moved = link_for(wire).wires.emplace_back();
            moved.type = source.type;
            moved.source = &source;
            moved.target = target;
            moved.param = wire.param;
            moved.mode = wire.mode == WireMode::delay ? WireMode::hold : wire.mode;
            moved.starts_from_output = !made_->survived[static_cast<std::size_t>(wire.from_node)];
            return;
        }
        if (wire.mode == WireMode::delay) return connect_delay(wire, source, target, to.group);
        if (!target) {
            drives_[static_cast<std::size_t>(wire.to_node)].push_back({wire.param, &source, nullptr});
            return;
        }
        target->data = source.data;
        target->stride = source.stride;
        if (target->kind == InputKind::batch) {
            // Within one group a batch is the one value of this tick.
            GroupRuntime& group = group_of(to);
            target->count = 1;
            target->times = &group.now;
            target->period = group.plan->period;
        }
    }

    template <class T>
    T* live(T* port) const {
        const auto found = moved_.find(port);
        return found == moved_.end() ? port : static_cast<T*>(found->second);
    }
    const Output* live(const Output* port) const { return live(const_cast<Output*>(port)); }

    bool is_same_wire(const LinkWire& old, const LinkWire& wire) const {
        return old.source == live(wire.source) && old.target == live(wire.target) && old.param == live(wire.param) &&
               old.mode == wire.mode;
    }

    /// The link of the generation before between the same groups with the same latency.
    Link* predecessor(const Link& link) const {
        if (!before_) return nullptr;
        for (const auto& old : before_->links)
            if (old->producer == link.producer && old->consumer == link.consumer && old->latency == link.latency)
                return old.get();
        return nullptr;
    }

    void finish_links() {
        for (auto& link : made_->links) {
            Link* old = predecessor(*link);
            std::size_t same = 0;
            for (LinkWire& wire : link->wires) {
                wire.before = nullptr;
                if (!old) continue;
                for (LinkWire& candidate : old->wires)
                    if (is_same_wire(candidate, wire)) wire.before = &candidate;
                same += wire.before != nullptr;
            }
            if (old && same == link->wires.size() && same == old->wires.size()) {
                // Nothing changed: the channel itself goes on, and inputs stay pointed at it.
                for (LinkWire& wire : link->wires)
                    if (wire.target) wire.before->point(*wire.target, old->producer_period);
                for (const auto& kept : before_->links)
                    if (kept.get() == old) link = kept;
                continue;
            }
            new_links_.push_back(link.get());
            link->id = workshop_.next_link++;
            link->continued = same > 0 ? old : nullptr;
            link->prepare(link_slack, link->producer->max_frames, link->consumer->max_frames,
                          before_ ? Link::unknown : 0);
            for (LinkWire& wire : link->wires) {
                wire.source = live(wire.source);
                wire.target = live(wire.target);
                wire.param = live(wire.param);
            }
        }
    }

    std::vector<bool> vary_within_call() const {
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

    void make_steps() {
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

    void add_step(GroupProgram& program, std::size_t index, bool varies) {
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

    /// Where the output of a node is seen from outside. One that goes on is looked at as before.
    ObservedPort& observed(LiveNode& node, std::size_t output, const std::string& name) {
        if (node.seen.size() <= output) {
            const GroupRuntime& group = *node.group;
            node.seen.push_back(
                workshop_.observer->open({name, group.plan->period, group.plan->has_audio ? group.max_frames : 1},
                                         *node.outputs[output]->type, node.outputs[output]->data));
        }
        return *node.seen[output];
    }

    void make_programs() {
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

    void assign_devices(std::size_t index) {
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

    void finish_program(std::size_t g) {
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

    bool is_driven(const Generation& generation, int node, const Param* param) const {
        return std::ranges::any_of(generation.plan.wires, [&](const PlanWire& wire) {
            return wire.to_node == node && wire.to_input < 0 && wire.from_node >= 0 && wire.param == param;
        });
    }

    /// What has to be set on a node that goes on.
    void rewire(std::size_t index) {
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

    const Generation* before_;
    Workshop& workshop_;
    std::unique_ptr<Generation> made_;
    std::unordered_map<const void*, void*> moved_;  // ports and parameters of compiled nodes to those that live
    std::vector<std::vector<Drive>> drives_;
    std::vector<Link*> new_links_;
};

}  // namespace

int Generation::find(std::string_view node) const {
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i]->name == node) return static_cast<int>(i);
    return -1;
}

bool Generation::keeps(const GroupRuntime* group) const {
    return std::ranges::any_of(groups, [group](const auto& mine) { return mine.get() == group; });
}

bool Generation::settled() const {
    return std::ranges::all_of(links, [](const auto& link) { return link->settled(); });
}

std::unique_ptr<Generation> build_generation(Plan plan, const Generation* before, Workshop& workshop) {
    flush_denormals_to_zero();
    return Builder(std::move(plan), before, workshop).build();
}

}  // namespace tactus
