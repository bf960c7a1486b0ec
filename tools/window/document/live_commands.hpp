// SPDX-License-Identifier: Apache-2.0
// Commands that a run applies to its plan, one after another. No user interface.
#pragma once

#include "assets/plan/plan_command.hpp"
#include "tools/window/document/workbench.hpp"

#include <cstdint>
#include <deque>
#include <string>

namespace tactus::window {

/// The sender of the command port of a case_scene node. The run confirms each command before the next one is sent, so
/// that none is lost in a pause, by an edit or on a slow machine.
class LiveCommands {
public:
    explicit LiveCommands(Workbench& bench) : bench_(bench) {}

    void add(const plan::PlanCommand& command) { waiting_.push_back(command); }
    void clear();
    /// What a run has not done that is over.
    std::deque<plan::PlanCommand> take_left();
    /// Once per picture: sends what may be sent. In a pause commands wait, and the messages say so. `node`: of the plan;
    /// `received`: its output, the number of the last command that it has done or refused.
    void tend(const std::string& node, std::int64_t received);
    /// A command waits, or is not confirmed.
    bool is_under_way() const { return !waiting_.empty(); }
    /// The run stands still or is about to.
    bool is_paused() const;
    /// Says that a change waits for the end of the pause, once per pause.
    void tell_pause();

private:
    void send(const std::string& node);

    Workbench& bench_;
    std::deque<plan::PlanCommand> waiting_;  // the first one may be sent
    bool is_sent_ = false;
    std::int64_t number_ = 0;  // of the command that was sent last
    double sent_s_ = 0.0;  // logical
    bool has_told_ = false;
};

}  // namespace tactus::window
