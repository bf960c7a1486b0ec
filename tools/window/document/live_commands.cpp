// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/live_commands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace tactus::window {

namespace {

// A command that the run has not confirmed after this time was lost with a node that was replaced. It is sent again under
// its number, and done at most once.
constexpr double again_after_s = 1.0;

}  // namespace

void LiveCommands::clear() {
    waiting_.clear();
    is_sent_ = false;
    number_ = 0;
}

std::deque<plan::PlanCommand> LiveCommands::take_left() {
    std::deque<plan::PlanCommand> left = std::exchange(waiting_, {});
    clear();
    return left;
}

bool LiveCommands::is_paused() const {
    const RunStatus::State state = bench_.status()->state;
    return state == RunStatus::State::fades || state == RunStatus::State::stands;
}

void LiveCommands::tell_pause() {
    if (is_paused() && !std::exchange(has_told_, true))
        bench_.tell("the run is paused: the change comes when it goes on");
}

void LiveCommands::send(const std::string& node) {
    const plan::PlanCommandNumbers numbers = plan::numbers_of(waiting_.front());
    // The kind comes first: a node that an edit of the patch replaces while a command is on its way has none, and does
    // nothing.
    for (std::size_t n = 0; n < numbers.size(); ++n) {
        const plan::PlanCommandNumber& port = plan::plan_command_port[n];
        bench_.turn(node, std::string(port.name), fmt::format("{:.17g}{}", numbers[n], port.unit));
    }
    bench_.turn(node, "command_number", fmt::format("{}", number_));
    sent_s_ = bench_.status()->time;
}

void LiveCommands::tend(const std::string& node, std::int64_t received) {
    const std::shared_ptr<const RunStatus> status = bench_.status();
    if (is_sent_ && received >= number_) {
        waiting_.pop_front();
        is_sent_ = false;
    }
    if (status->state == RunStatus::State::over) return;
    if (!is_paused()) has_told_ = false;
    else if (!waiting_.empty()) tell_pause();
    if (waiting_.empty() || status->state != RunStatus::State::runs) return;
    if (is_sent_ && status->time < sent_s_ + again_after_s) return;
    if (!std::exchange(is_sent_, true)) number_ = std::max(number_, received) + 1;
    send(node);
}

}  // namespace tactus::window
