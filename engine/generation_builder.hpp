// SPDX-License-Identifier: Apache-2.0
// How a plan is made runnable, step by step. Only generation*.cpp include it.
#pragma once

#include "engine/generation.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace tactus {

/// Builds on the freshly compiled nodes, then points everything at the nodes that live. A compiled node whose older
/// self goes on is never prepared: it only shows how the inputs of that one are to be wired.
class GenerationBuilder {
public:
    GenerationBuilder(Plan plan, const Generation* before, Workshop& workshop);
    std::unique_ptr<Generation> build();

private:
    Plan& plan() { return made_->plan; }
    GroupRuntime& group_of(const PlanNode& node) { return *made_->groups[static_cast<std::size_t>(node.group)]; }
    GroupProgram& program_of(int group) { return *made_->programs[static_cast<std::size_t>(group)]; }
    GroupProgram& program_of(const GroupRuntime* runtime) {
        const auto at = std::ranges::find(made_->groups, runtime, &std::shared_ptr<GroupRuntime>::get);
        return *made_->programs[static_cast<std::size_t>(at - made_->groups.begin())];
    }
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

    // generation_wires.cpp
    void allocate();
    std::byte* memory(std::size_t bytes);
    void connect(const PlanWire& wire);
    void connect_constant(const PlanWire& wire);
    void connect_delay(const PlanWire& wire, const Output& source, Input* target, int group_index);
    Link& link_for(const PlanWire& wire);
    bool is_same_wire(const LinkWire& old, const LinkWire& wire) const;
    /// The link of the generation before between the same groups with the same latency.
    Link* predecessor(const Link& link) const;
    int ring_frames(const GroupRuntime& group);
    void finish_links();

    // generation_programs.cpp
    void make_steps();
    std::vector<bool> vary_within_call() const;
    void add_step(GroupProgram& program, std::size_t index, bool varies);
    /// Where the output of a node is seen from outside. One that goes on is looked at as before.
    ObservedPort& observed(LiveNode& node, std::size_t output, const std::string& name);
    void make_programs();
    void finish_program(std::size_t g);
    void assign_devices(std::size_t index);
    bool is_driven(const Generation& generation, int node, const Param* param) const;
    /// What has to be set on a node that goes on.
    void rewire(std::size_t index);

    const Generation* before_;
    Workshop& workshop_;
    std::unique_ptr<Generation> made_;
    std::unordered_map<const void*, void*> moved_;  // ports and parameters of compiled nodes to those that live
    std::vector<std::vector<Drive>> drives_;
    std::vector<Link*> new_links_;
};

}  // namespace tactus
