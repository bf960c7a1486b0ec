// SPDX-License-Identifier: Apache-2.0
// A plan that can run: prepared nodes, connected wires, one program per rate group. When it follows another plan, nodes
// and links that the edit did not touch are kept.
#pragma once

#include "engine/build/group_program.hpp"
#include "engine/io/frames.hpp"
#include "engine/io/host.hpp"
#include "engine/observe/observer.hpp"
#include "engine/run/group_runtime.hpp"
#include "engine/run/param_ramps.hpp"
#include "graph/compile/plan.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace tactus::build {

/// A running node. It lives until the last plan that keeps it is gone.
struct LiveNode {
    std::string name;
    const NodeType* type = nullptr;
    compile::NodeInstance instance{nullptr, nullptr};
    run::GroupRuntime* group = nullptr;
    std::string structure;  ///< what must be equal for a node to survive an edit
    observe::NodeTelemetry time;
    std::vector<Input*> inputs;
    std::vector<Output*> outputs;
    std::map<std::string, Param*> params;
    io::HostUses uses;  ///< what its prepare asked for
    std::vector<std::shared_ptr<observe::ObservedPort>> seen;  ///< as outputs, when there is an observer
};

/// What the generations of one run share. Used by one builder at a time.
struct BuildContext {
    io::EngineHost& host;
    int block = 0;  ///< most samples per call of an audio group, 0: the patch's quantum
    bool hash = true;  ///< keep hashes of all outputs
    /// A value that a wire brings from a file.
    struct Constant {
        std::shared_ptr<const void> owner;
        std::vector<std::byte> handle;
        std::uint64_t content = 0;  ///< hash of the file, from when it was loaded
    };
    std::map<std::pair<const ValueType*, std::string>, Constant> constants;
    /// Returns where the outputs of a group are recorded, as frames of that layout, or null. Empty: there is no take.
    std::function<RecordStream*(const io::FrameLayout&, const run::GroupRuntime&)> take;
    int next_group = 0, next_link = 0;
    int group_before = 0, link_before = 0;  ///< the same before the plan that is being built
    observe::Observer* observer = nullptr;  ///< who looks on, or null
    bool only_checked = false;  ///< a plan that is too stiff for the devices that it declares is built as it is
};

struct Generation {
    std::int64_t number = 0;
    compile::Plan plan;
    std::vector<std::map<std::string, double>> patch_values;  ///< of each node's parameters, SI
    std::vector<std::shared_ptr<LiveNode>> nodes;  ///< as plan.nodes
    std::vector<bool> survived;  ///< as plan.nodes
    std::vector<std::shared_ptr<run::GroupRuntime>> groups;  ///< as plan.groups
    std::vector<bool> group_is_new;  ///< as plan.groups
    std::vector<std::unique_ptr<GroupProgram>> programs;  ///< as plan.groups
    std::vector<std::shared_ptr<run::Link>> links;
    std::vector<std::unique_ptr<std::vector<std::byte>>> memory;  ///< values of outputs and unconnected inputs
    /// Of each live parameter on which a force depends.
    std::unordered_map<const Param*, std::shared_ptr<run::ParamRamp>> ramps;
    std::unique_ptr<SwitchGate> gate;  ///< live, when it reaches a hand
    std::unordered_map<const Input*, std::uint64_t> constants;  ///< content of what a file gives an input of plan.nodes
    /// Of each driven device: a hash of all that its force depends on, but for parameters that ramp.
    std::map<const DeviceSlot*, std::uint64_t> force_paths;

    /// Of a parameter, or null: it changes at once.
    run::ParamRamp* ramp_of(const Param* param) const;

    /// Index of a node, −1: none of that name.
    int find(std::string_view node) const;
    bool keeps(const run::GroupRuntime* group) const;
    /// Nothing reads from links of the generation before any more. Any thread.
    bool settled() const;
};

/// Builds what follows `before` (null: nothing). What runs is not touched. Throws Error, also for an asset that is not
/// loaded.
std::unique_ptr<Generation> build_generation(compile::Plan plan, const Generation* before, BuildContext& context);

}  // namespace tactus::build
