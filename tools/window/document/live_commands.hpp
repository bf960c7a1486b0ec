// SPDX-License-Identifier: Apache-2.0
// Changes of parameters and presses of buttons that a run gets one after another, so that each takes effect. No user
// interface.
#pragma once

#include "tools/window/document/workbench.hpp"

#include <chrono>
#include <deque>
#include <string>
#include <vector>

namespace tactus::window {

class LiveCommands {
public:
    struct Command {
        std::string node;  ///< a button, or of `param`
        std::string param, value;  ///< empty: the button is pressed
    };
    /// chooses: says for itself what it means; tidies: sets back what one that chooses has set.
    enum class Kind { acts, chooses, tidies };

    explicit LiveCommands(Workbench& bench) : bench_(bench) {}

    /// Given to the run at once, after those before have taken effect. One that tidies makes way for one that chooses.
    void add(std::vector<Command> together, Kind kind = Kind::acts);
    void clear();
    /// Once per picture: sends what may be sent. In a pause commands wait, and the messages say so.
    void tend();
    /// Something waits, or was sent and may not have taken effect yet.
    bool is_under_way() const;
    /// The run stands still or is about to.
    bool is_paused() const;
    /// Says that a change waits for the end of the pause, once per pause.
    void tell_pause();

private:
    struct Batch {
        std::vector<Command> commands;
        Kind kind = Kind::acts;
    };
    Workbench& bench_;
    std::deque<Batch> waiting_;
    std::int64_t sent_ = 0;  ///< Workbench::requests after what was sent last
    bool is_sent_ = false;  ///< the run has not carried it out
    double acts_s_ = -1.0;  ///< logical: when it takes effect
    bool has_told_ = false;
};

}  // namespace tactus::window
