// SPDX-License-Identifier: Apache-2.0
// Node types whose code is callbacks of the program that embeds Tactus, as tactus_declare_node describes them. A
// callback may allocate, lock and wait (one in Python waits for the interpreter), so these nodes run on the logical
// clock only: a live run refuses them.
#pragma once

#include "dsp/core/error.hpp"
#include "graph/compile/schedule.hpp"
#include "tools/embed/tactus.h"

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>

namespace tactus::embed {

/// The first failure of a callback in a run. Nodes on several threads note theirs; the thread that runs the patch
/// checks for it.
class CallbackFailure {
public:
    /// `stop` ends the run soon; any thread may call it.
    explicit CallbackFailure(std::function<void()> stop) : stop_(std::move(stop)) {}

    /// Later failures of the same run are discarded. Any thread.
    void note(Error failure) noexcept;
    /// Throws the failure, if there is one.
    void check() const;

private:
    std::function<void()> stop_;
    mutable std::mutex lock_;
    std::optional<Error> first_;
};

/// Makes the type known to patches that are read from now on. All texts are copied. Throws Error if the declaration is
/// not valid, or if the name belongs to a type of Tactus or of a plug-in. A type of this name that was declared before
/// is replaced; runs that have begun keep it.
void declare_node(const tactus_node_type& type);

/// Gives each host node of the plan its place for failures, which must outlive the nodes. Throws Error, at the node in
/// the patch, if there is one and the run is live.
void admit_host_nodes(const compile::Schedule& plan, bool is_live, CallbackFailure& failure);

}  // namespace tactus::embed
