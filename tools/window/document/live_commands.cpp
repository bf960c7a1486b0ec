// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/live_commands.hpp"

#include <utility>

namespace tactus::window {

namespace {

// A button is pressed for 20 ms of the run, and what it presses must see it released before the next press.
constexpr double between_s = 0.05;

}  // namespace

void LiveCommands::add(std::vector<Command> together, Kind kind) {
    if (kind == Kind::chooses && !waiting_.empty() && waiting_.back().kind == Kind::tidies) waiting_.pop_back();
    waiting_.push_back({std::move(together), kind});
}

void LiveCommands::clear() {
    waiting_.clear();
    is_sent_ = false;
    acts_s_ = -1.0;
}

bool LiveCommands::is_paused() const {
    const RunStatus::State state = bench_.status()->state;
    return state == RunStatus::State::fades || state == RunStatus::State::stands;
}

bool LiveCommands::is_under_way() const {
    return !waiting_.empty() || is_sent_ || bench_.status()->time < acts_s_ + between_s;
}

void LiveCommands::tell_pause() {
    if (is_paused() && !std::exchange(has_told_, true))
        bench_.tell("the run is paused: the change comes when it goes on");
}

void LiveCommands::tend() {
    const std::shared_ptr<const RunStatus> status = bench_.status();
    if (status->state == RunStatus::State::over) return clear();
    if (is_sent_ && status->requests >= sent_) {
        is_sent_ = false;
        acts_s_ = status->changed_s;
    }
    if (!is_paused()) has_told_ = false;
    else if (!waiting_.empty()) tell_pause();
    // Two changes of one parameter at the same time of the run are one, and its time may go slowly or stand.
    if (waiting_.empty() || is_sent_ || status->state != RunStatus::State::runs || status->time < acts_s_ + between_s)
        return;
    for (const Command& command : waiting_.front().commands) {
        if (command.param.empty()) bench_.press(command.node);
        else bench_.turn(command.node, command.param, command.value);
    }
    waiting_.pop_front();
    sent_ = bench_.requests();
    is_sent_ = true;
}

}  // namespace tactus::window
