// SPDX-License-Identifier: Apache-2.0
// Builds an executable plan, step by step. Only generation*.cpp and fit_to_devices.cpp include it.
#pragma once

#include "engine/build/generation.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace tactus::build {

/// Builds on the compiled nodes, then redirects all pointers to the live nodes. If a node of the previous plan
/// survives, its compiled copy is never prepared: it only provides the new wiring of the live node's inputs.
class GenerationBuilder {
public:
    GenerationBuilder(compile::Schedule plan, const Generation* before, BuildContext& context);
    std::unique_ptr<Generation> build();

private:
    compile::Schedule& plan() { return made_->plan; }
    run::GroupRuntime& group_of(const compile::ScheduleNode& node) {
        return *made_->groups[static_cast<std::size_t>(node.group)];
    }
    GroupProgram& program_of(int group) { return *made_->programs[static_cast<std::size_t>(group)]; }
    GroupProgram& program_of(const run::GroupRuntime* runtime) { return program_of(group_index_.at(runtime)); }
    template <class T>
    T* live(T* port) const {
        const auto found = moved_.find(port);
        return found == moved_.end() ? port : static_cast<T*>(found->second);
    }
    const Output* live(const Output* port) const { return live(const_cast<Output*>(port)); }

    // generation.cpp: groups and nodes, new or kept
    void note_patch_values();
    void form_groups();
    void find_survivors();
    void prepare();
    void prepare_node(std::size_t node);

    // fit_to_devices.cpp
    bool is_declared(const io::DeviceSlot& slot);
    bool is_unknown(const io::DeviceSlot& slot);
    void fit_to_devices();
    void scale_forces();
    void limit_stiffness();

    // generation_wires.cpp
    void allocate();
    std::byte* memory(std::size_t bytes);
    void connect(const compile::ScheduleWire& wire);
    void connect_constant(const compile::ScheduleWire& wire);
    void connect_delay(const compile::ScheduleWire& wire, const Output& source, Input* target, int group_index);
    void connect_events(const compile::ScheduleWire& wire, const Output& source, Input& target);
    /// Returns the merger of the events of an input of a live node.
    EventMerge& merge_into(Input* target, int group);
    run::Link& link_for(const compile::ScheduleWire& wire);
    /// Returns true if the producer's values change so often that they would split each call of the consumer, an audio
    /// group.
    bool changes_within_calls(int producer, int consumer) const;
    bool is_same_wire(const run::LinkWire& old, const run::LinkWire& wire) const;
    /// Number of wires of a link that continue: all, and those whose source continues too.
    struct WireMatch {
        std::size_t continued = 0, same = 0;
    };
    /// Matches each wire of `link` with the same wire of `old`.
    WireMatch match_wires(run::Link& link, run::Link* old) const;
    int live_frames(const run::GroupRuntime& group);
    void finish_links();

    // generation_programs.cpp
    void make_steps();
    std::vector<bool> vary_within_call() const;
    void add_step(GroupProgram& program, std::size_t index, bool varies);
    void make_stretches(std::size_t group);
    void record(std::size_t group);
    /// Returns the port by which an observer reads the output of a node. A node that survives keeps its port.
    observe::ObservedPort& observed(LiveNode& node, std::size_t output, const std::string& name);
    void make_programs();
    void finish_program(std::size_t g);
    static void find_readers(GroupProgram& program);
    void find_delays_before(GroupProgram& program, const GroupProgram& old) const;
    void find_outputs_before(GroupProgram& program, const GroupProgram& old) const;
    void assign_devices(std::size_t index);
    void make_ramps();
    /// Determines the settings that a surviving node needs.
    void rewire(std::size_t index);

    /// The groups that a link connects, and its latency.
    using LinkEnds = std::tuple<const run::GroupRuntime*, const run::GroupRuntime*, Flicks>;
    static LinkEnds ends_of(const run::Link& link) { return {link.producer, link.consumer, link.latency}; }
    void index_before();

    const Generation* before_;
    BuildContext& context_;
    std::unique_ptr<Generation> made_;
    // Indices by node, wire and group, so that a plan of n nodes is built in O(n).
    std::unordered_map<std::string_view, std::size_t> nodes_before_;  // by name, in `before_`
    std::unordered_map<const run::GroupRuntime*, std::size_t> groups_before_;  // in `before_`
    std::unordered_set<const Param*> driven_before_, driven_;  // parameters driven by a wire
    std::unordered_map<const run::GroupRuntime*, int> group_index_;  // in `made_`
    std::unordered_map<std::string_view, const patch::PatchAsset*> assets_;
    std::map<LinkEnds, std::shared_ptr<run::Link>> links_before_, links_made_;
    std::unordered_set<const run::Link*> links_going_on_;  // of `before_`
    std::unordered_map<const void*, void*> moved_;  // ports and parameters of compiled nodes → those of the live nodes
    std::vector<std::vector<Drive>> drives_;
    std::unordered_map<const Input*, const run::LinkWire*> batches_;  // wires that change within calls
    std::unordered_map<const Input*, EventMerge*> merges_;
    std::unordered_set<const run::Link*> new_links_;
};

}  // namespace tactus::build
