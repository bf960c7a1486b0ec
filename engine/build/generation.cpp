// SPDX-License-Identifier: Apache-2.0
#include "engine/build/generation.hpp"

#include "dsp/core/realtime.hpp"
#include "engine/build/generation_builder.hpp"
#include "engine/build/survival.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>

namespace tactus::build {

GenerationBuilder::GenerationBuilder(compile::Schedule plan, const Generation* before, BuildContext& context)
    : before_(before), context_(context), made_(std::make_unique<Generation>()) {
    made_->plan = std::move(plan);
    made_->number = before ? before->number + 1 : 0;
}

namespace {

std::unordered_set<const Param*> driven_params(const compile::Schedule& plan) {
    std::unordered_set<const Param*> driven;
    for (const compile::ScheduleWire& wire : plan.wires)
        if (wire.to_input < 0 && wire.from_node >= 0) driven.insert(wire.param);
    return driven;
}

}  // namespace

void GenerationBuilder::index_before() {
    driven_ = driven_params(plan());
    for (const patch::PatchAsset& asset : plan().patch.assets) assets_.emplace(asset.name, &asset);
    if (!before_) return;
    driven_before_ = driven_params(before_->plan);
    for (std::size_t i = 0; i < before_->nodes.size(); ++i) nodes_before_.emplace(before_->nodes[i]->name, i);
    for (std::size_t g = 0; g < before_->groups.size(); ++g) groups_before_.emplace(before_->groups[g].get(), g);
    for (const auto& link : before_->links) links_before_.emplace(ends_of(*link), link);
}

std::unique_ptr<Generation> GenerationBuilder::build() {
    index_before();
    note_patch_values();
    form_groups();
    find_survivors();
    allocate();
    prepare();
    drives_.resize(plan().nodes.size());
    for (const compile::ScheduleWire& wire : plan().wires) connect(wire);
    finish_links();
    make_steps();
    make_programs();
    return std::move(made_);
}

void GenerationBuilder::note_patch_values() {
    for (const compile::ScheduleNode& node : plan().nodes) {
        auto& values = made_->patch_values.emplace_back();
        for (const auto& [name, param] : node.params) values[name] = param->value;
    }
}

void GenerationBuilder::form_groups() {
    std::unordered_map<std::string_view, std::shared_ptr<run::GroupRuntime>> old_groups;
    if (before_)
        for (const auto& old : before_->groups) old_groups.emplace(old->plan->name, old);
    for (const compile::ScheduleGroup& group : plan().groups) {
        int frames = 1;
        if (group.has_audio)
            frames = context_.block > 0 ? context_.block
                                        : static_cast<int>(std::max<Flicks>(1, plan().patch.quantum / group.period));
        std::shared_ptr<run::GroupRuntime> runtime;
        if (const auto found = old_groups.find(group.name); found != old_groups.end()) {
            const auto& old = found->second;
            if (old->plan->period == group.period && old->plan->has_audio == group.has_audio &&
                old->max_frames == frames)
                runtime = old;
        }
        made_->group_is_new.push_back(!runtime);
        if (!runtime) {
            if (context_.next_group > std::numeric_limits<std::uint16_t>::max())
                throw Error("edits of this run have made more rate groups than its log can number; restart the run");
            runtime = std::make_shared<run::GroupRuntime>(group, context_.next_group++, frames);
        }
        group_index_.emplace(runtime.get(), static_cast<int>(made_->groups.size()));
        made_->groups.push_back(std::move(runtime));
        auto& program = *made_->programs.emplace_back(std::make_unique<GroupProgram>());
        program.plan_number = made_->number;
        program.backlog = group.backlog;
    }
}

void GenerationBuilder::find_survivors() {
    std::vector<std::string> structures = structures_of(plan());
    for (std::size_t i = 0; i < plan().nodes.size(); ++i) {
        compile::ScheduleNode& node = plan().nodes[i];
        std::string& structure = structures[i];
        std::shared_ptr<LiveNode> live;
        if (const auto found = nodes_before_.find(node.name); found != nodes_before_.end()) {
            const auto& old = before_->nodes[found->second];
            if (old->type == node.type && old->group == &group_of(node) && old->structure == structure) live = old;
        }
        made_->survived.push_back(live != nullptr);
        if (!live) {
            live = std::make_shared<LiveNode>();
            live->name = node.name;
            live->type = node.type;
            live->group = &group_of(node);
            live->structure = std::move(structure);
            for (const compile::ScheduleInput& input : node.inputs) live->inputs.push_back(input.port);
            for (const compile::ScheduleOutput& output : node.outputs) live->outputs.push_back(output.port);
            live->params = node.params;
            live->instance = std::move(node.instance);
            // Analyses of the plan still ask the node.
            node.instance = compile::NodeInstance(live->instance.get(), [](void*) {});
        } else {
            for (std::size_t k = 0; k < node.inputs.size(); ++k) moved_[node.inputs[k].port] = live->inputs[k];
            for (std::size_t k = 0; k < node.outputs.size(); ++k) moved_[node.outputs[k].port] = live->outputs[k];
            for (const auto& [name, param] : node.params) moved_[param] = live->params.at(name);
        }
        made_->nodes.push_back(std::move(live));
    }
}

void GenerationBuilder::prepare() {
    std::vector<io::SoundChannel*> playing;
    for (std::size_t i = 0; i < plan().nodes.size(); ++i)
        if (const auto& sounds = made_->nodes[i]->uses.sounds; made_->survived[i])
            playing.insert(playing.end(), sounds.begin(), sounds.end());
    context_.host.expect_sounds(plan());
    context_.host.keep_sounds(std::move(playing));
    const auto is_hand = [](const compile::ScheduleNode& node) {
        return node.type->role == NodeRole::hand_source || node.type->role == NodeRole::hand_sink;
    };
    // Devices are opened first: other nodes are prepared with parameters that fit them.
    for (std::size_t i = 0; i < plan().nodes.size(); ++i)
        if (is_hand(plan().nodes[i])) prepare_node(i);
    fit_to_devices();
    for (std::size_t i = 0; i < plan().nodes.size(); ++i)
        if (!is_hand(plan().nodes[i])) prepare_node(i);
}

void GenerationBuilder::prepare_node(std::size_t i) {
    if (made_->survived[i]) return;
    const compile::ScheduleNode& node = plan().nodes[i];
    // Nodes use their assets unchecked. Report a missing one here, where the loader's error is available.
    for (const AssetParam* asset : node.assets)
        if (!asset->name.empty() && !asset->loaded)
            throw Error(asset->where,
                        fmt::format("the asset '{}' of the node '{}' was not loaded", asset->name, node.name));
    const run::GroupRuntime& group = group_of(node);
    context_.host.prepare_for(group.index, group.plan->period, node.where, made_->nodes[i]->uses);
    Hash seed;
    seed.add_word(plan().patch.seed);
    seed.add_text(node.name);
    const Setup setup{node.name, node.where, group.plan->period, group.max_frames, seed.value(), &context_.host};
    node.type->prepare(made_->nodes[i]->instance.get(), setup);
}

int Generation::find(std::string_view node) const {
    for (std::size_t i = 0; i < nodes.size(); ++i)
        if (nodes[i]->name == node) return static_cast<int>(i);
    return -1;
}

run::ParamRamp* Generation::ramp_of(const Param* param) const {
    const auto found = ramps.find(param);
    return found == ramps.end() ? nullptr : found->second.get();
}

bool Generation::keeps(const run::GroupRuntime* group) const {
    return std::ranges::any_of(groups, [group](const auto& mine) { return mine.get() == group; });
}

bool Generation::settled() const {
    return std::ranges::all_of(links, [](const auto& link) { return link->settled(); });
}

std::unique_ptr<Generation> build_generation(compile::Schedule plan, const Generation* before, BuildContext& context) {
    flush_denormals_to_zero();
    return GenerationBuilder(std::move(plan), before, context).build();
}

}  // namespace tactus::build
