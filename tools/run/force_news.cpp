// SPDX-License-Identifier: Apache-2.0
#include "tools/run/force_news.hpp"

#include "devices/haptic/window_hand.hpp"
#include "dsp/control/late_return.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::run {

using control::ForceState;

namespace {

std::string how_to_go_on(const HandForces& forces, bool has_button) {
    using control::Fault;
    std::string how = control::describe(forces.state);
    const bool waits = forces.state >= ForceState::returns && forces.state <= ForceState::by_hand;
    if (waits && forces.is_windowless) return "forces stay off, as that window is closed; end the run";
    if (forces.state == ForceState::returns) return how + fmt::format(" for {:.3g} s", forces.on_time_s);
    if (forces.state == ForceState::never) {
        if (forces.reason == Fault::not_finite) return how + "; end it and mend the patch";
        return how + (forces.reason == Fault::sound_lost ? "; end it and look after the sound card"
                                                         : "; end it and look after the device");
    }
    if (forces.state != ForceState::by_hand || has_button) return how;
    switch (forces.way) {
        case LetReturn::by_set:
            return how + fmt::format(": tactus set {}.recover=N, with another N each time", forces.node);
        case LetReturn::by_button: return how + ", by the button in the window";
        case LetReturn::by_nothing: break;
    }
    return "forces stay off in this run, as --no-edits refuses 'tactus set'; end it and begin anew";
}

/// A fault that came by a wire is cleared where it comes from.
void name_source(const run::Engine& engine, HandForces& forces) {
    const compile::Schedule& plan = engine.plan();
    for (const compile::ScheduleWire& wire : plan.wires) {
        if (wire.to_input < 0 || wire.from_node < 0) continue;
        const compile::ScheduleNode& to = plan.nodes[static_cast<std::size_t>(wire.to_node)];
        if (to.name != forces.node || to.inputs[static_cast<std::size_t>(wire.to_input)].name != "fault") continue;
        const compile::ScheduleNode& from = plan.nodes[static_cast<std::size_t>(wire.from_node)];
        if (!from.params.contains("recover")) return;
        forces.node = from.name;
        forces.state = ForceState::by_hand;
        return;
    }
}

}  // namespace

std::string HandForces::text(bool has_button) const {
    if (state == ForceState::on || state == ForceState::unknown) return {};
    const std::string how = how_to_go_on(*this, has_button);
    if (fault.empty()) return fmt::format("{} (since {:.2f} s)", how, since_s);
    return fmt::format("{}, since {:.2f} s: {}", fault, fault_since_s, how);
}

std::string FaultOnRecord::text() const {
    const std::string when =
        over_s < 0.0 ? fmt::format("from {:.2f} s on", began_s) : fmt::format("{:.2f} s to {:.2f} s", began_s, over_s);
    return fmt::format("{}: {}: {}, {:.2g} N before", when, device, what, force_N);
}

std::vector<HandForces> forces_of(const run::Engine& engine, LetReturn way) {
    std::vector<HandForces> all;
    for (const auto& slot : engine.host().devices) {
        const io::DeviceState state = slot->guard.state();
        if (state.state == ForceState::unknown) continue;
        HandForces forces{slot->name, {}, state.state, seconds(state.since * slot->period), {}, 0.0};
        forces.way = way;
        for (const auto& node : engine.nodes())
            for (const auto& [used, use] : node->uses.devices)
                if (used == slot.get() && use == DeviceUse::drive) {
                    forces.node = node->name;
                    // Fixed while the node lives.
                    if (const auto wait = node->params.find("recover_after"); wait != node->params.end())
                        forces.on_time_s = std::max(control::LateReturn::on_time_s, wait->second->value);
                }
        if (control::is_off(state.state)) {
            if (const auto faults = slot->guard.faults(); !faults.empty()) {
                forces.reason = faults.back().reason;
                forces.fault = faults.back().text();
                forces.fault_since_s = seconds(faults.back().tick * slot->period);
            }
            forces.is_windowless =
                forces.reason == control::Fault::late_source && haptic::window_hand().windows.load() == 0;
        }
        if (forces.state == ForceState::by_source) name_source(engine, forces);
        all.push_back(std::move(forces));
    }
    return all;
}

std::vector<FaultOnRecord> faults_on_record(const run::Engine& engine) {
    std::vector<FaultOnRecord> all;
    for (const auto& slot : engine.host().devices)
        for (const io::DeviceFault& fault : slot->guard.faults())
            all.push_back({slot->name, fault.text(), seconds(fault.tick * slot->period),
                           fault.over < 0 ? -1.0 : seconds(fault.over * slot->period), fault.force_N, fault.number});
    return all;
}

std::int64_t faults_not_kept(const run::Engine& engine) {
    std::int64_t count = 0;
    for (const auto& slot : engine.host().devices)
        if (const auto faults = slot->guard.faults(); !faults.empty()) count += faults.front().number;
    return count;
}

void ForceNews::tell_faults(const std::string& device, const std::vector<FaultOnRecord>& record, Told& told,
                            std::vector<std::string>& lines) {
    for (const FaultOnRecord& fault : record) {
        if (fault.device != device || fault.number < told.faults) continue;
        if (fault.number > told.faults)
            lines.push_back(fmt::format("'{}': {} more faults before", device, fault.number - told.faults));
        lines.push_back(fmt::format("no force on '{}' at {:.2f} s: {}; {:.2g} N faded to nothing", device,
                                    fault.began_s, fault.what, fault.force_N));
        told.faults = fault.number + 1;
        told.is_away = true;
    }
    for (const FaultOnRecord& fault : record) {
        if (fault.device != device || fault.number < told.over) continue;
        if (fault.over_s < 0.0) break;
        lines.push_back(
            fmt::format("'{}': over at {:.2f} s, after {:.2f} s", device, fault.over_s, fault.over_s - fault.began_s));
        told.over = fault.number + 1;
    }
}

std::vector<std::string> ForceNews::next(const run::Engine& engine) {
    std::vector<std::string> lines;
    const std::vector<FaultOnRecord> record = faults_on_record(engine);
    for (const HandForces& forces : forces_of(engine, way_)) {
        Told& told = told_[forces.device];
        tell_faults(forces.device, record, told, lines);
        const bool is_on = forces.state == ForceState::on || forces.state == ForceState::ramps;
        const bool is_fault = control::is_off(forces.state);
        const bool lasts = engine.progress_seconds() - forces.since_s > told_after_s;
        if (!is_on && (is_fault || lasts) && told.wait_s != forces.since_s) {
            lines.push_back(fmt::format("'{}': {}", forces.device, forces.text()));
            told.wait_s = forces.since_s;
            told.is_away = true;
        }
        if (is_on && told.is_away) {
            lines.push_back(fmt::format("'{}': forces are on again from {:.2f} s", forces.device, forces.since_s));
            told.is_away = false;
        }
    }
    return lines;
}

}  // namespace tactus::run
