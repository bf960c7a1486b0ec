// SPDX-License-Identifier: Apache-2.0
// An executable plan: prepared nodes, connected wires, one program per rate group. When it replaces another plan, nodes
// and links that the edit does not change are kept.
#pragma once

#include "engine/build/group_program.hpp"
#include "engine/io/frames.hpp"
#include "engine/io/host.hpp"
#include "engine/observe/observer.hpp"
#include "engine/run/group_runtime.hpp"
#include "engine/run/param_ramps.hpp"
#include "graph/compile/schedule.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tactus::build {

/// A running node. It is destroyed with the last plan that uses it.
struct LiveNode {
    std::string name;
    const NodeType* type = nullptr;
    compile::NodeInstance instance{nullptr, nullptr};
    run::GroupRuntime* group = nullptr;
    std::string structure;  ///< description; a node survives an edit if it is equal
    observe::NodeTelemetry time;
    std::vector<Input*> inputs;
    std::vector<Output*> outputs;
    std::map<std::string, Param*> params;
    io::HostUses uses;  ///< resources that its prepare opened
    std::vector<std::shared_ptr<observe::ObservedPort>> seen;  ///< its outputs as seen by the observer, if there is one
};

/// State common to the generations of one run. Used by one builder at a time.
struct BuildContext {
    io::EngineHost& host;
    int block = 0;  ///< most samples per call of an audio group, 0: the patch's quantum
    bool hash = true;  ///< keep hashes of all outputs
    /// A value that a wire brings from a file.
    struct Constant {
        std::shared_ptr<const void> owner;
        std::vector<std::byte> handle;
        std::uint64_t content = 0;  ///< hash of the file's content when it was loaded
    };
    std::map<std::pair<const ValueType*, std::string>, Constant> constants;
    /// Returns the stream that records the outputs of a group, as frames of that layout, or null. Empty if there is no
    /// take.
    std::function<RecordStream*(const io::FrameLayout&, const run::GroupRuntime&)> take;
    int next_group = 0, next_link = 0;
    int group_before = 0, link_before = 0;  ///< the same, before the plan that is being built
    observe::Observer* observer = nullptr;  ///< the observer of the run, or null
    bool only_checked = false;  ///< build a plan although it is too stiff for the devices that it declares
};

struct Generation {
    std::int64_t number = 0;
    compile::Schedule plan;
    std::vector<std::map<std::string, double>> patch_values;  ///< of each node's parameters, SI
    std::vector<std::shared_ptr<LiveNode>> nodes;  ///< as plan.nodes
    std::vector<bool> survived;  ///< as plan.nodes
    std::vector<std::shared_ptr<run::GroupRuntime>> groups;  ///< as plan.groups
    std::vector<bool> group_is_new;  ///< as plan.groups
    std::vector<std::unique_ptr<GroupProgram>> programs;  ///< as plan.groups
    std::vector<std::shared_ptr<run::Link>> links;
    std::vector<std::unique_ptr<std::vector<std::byte>>> memory;  ///< values of outputs and unconnected inputs
    /// For each live parameter on which a force depends.
    std::unordered_map<const Param*, std::shared_ptr<run::ParamRamp>> ramps;
    std::unique_ptr<SwitchGate> gate;  ///< in a live run, if the plan reaches a hand
    std::unordered_map<const Input*, std::uint64_t> constants;  ///< content hashes of the inputs that files set
    /// For each driven device: a hash of everything that its force depends on, except ramped parameters.
    std::map<const io::DeviceSlot*, std::uint64_t> force_paths;

    /// Returns the ramp of a parameter, or null if it changes immediately.
    run::ParamRamp* ramp_of(const Param* param) const;

    /// Returns the index of a node, −1 if there is none of that name.
    int find(std::string_view node) const;
    bool keeps(const run::GroupRuntime* group) const;
    /// True when nothing reads from links of the previous generation any more. Any thread.
    bool settled() const;
};

/// Builds the generation that follows `before` (null: the first). Does not modify the running one. Throws Error, also
/// for an asset that is not loaded.
std::unique_ptr<Generation> build_generation(compile::Schedule plan, const Generation* before, BuildContext& context);

}  // namespace tactus::build
