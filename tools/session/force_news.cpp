// SPDX-License-Identifier: Apache-2.0
#include "tools/session/force_news.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::session {

using control::ForceState;

std::string HandForces::text(bool has_button) const {
    if (state == ForceState::on || state == ForceState::unknown) return {};
    std::string how = control::describe(state);
    if (state == ForceState::by_hand && !has_button)
        how += fmt::format(": tactus set {}.recover=N, with another N each time", node);
    if (fault.empty()) return fmt::format("{} (since {:.2f} s)", how, since_s);
    return fmt::format("{}, since {:.2f} s: {}", fault, fault_since_s, how);
}

std::string FaultOnRecord::text() const {
    const std::string when =
        over_s < 0.0 ? fmt::format("from {:.2f} s on", began_s) : fmt::format("{:.2f} s to {:.2f} s", began_s, over_s);
    return fmt::format("{}: {}: {}, {:.2g} N before", when, device, what, force_N);
}

std::vector<HandForces> forces_of(const run::Engine& engine) {
    std::vector<HandForces> all;
    for (const auto& slot : engine.host().devices) {
        const io::DeviceState state = slot->guard.state();
        if (state.state == ForceState::unknown) continue;
        HandForces forces{slot->name, {}, state.state, seconds(state.since * slot->period), {}, 0.0};
        for (const auto& node : engine.nodes())
            for (const auto& [used, use] : node->uses.devices)
                if (used == slot.get() && use == DeviceUse::drive) forces.node = node->name;
        if (control::is_off(state.state)) {
            // Only so many faults are kept.
            const auto faults = slot->guard.faults();
            const bool is_kept = !faults.empty() && faults.back().over < 0;
            forces.fault = is_kept ? control::describe(faults.back().reason) : "one more fault";
            forces.fault_since_s = is_kept ? seconds(faults.back().tick * slot->period) : forces.since_s;
        }
        all.push_back(std::move(forces));
    }
    return all;
}

std::vector<FaultOnRecord> faults_on_record(const run::Engine& engine) {
    std::vector<FaultOnRecord> all;
    for (const auto& slot : engine.host().devices)
        for (const io::DeviceFault& fault : slot->guard.faults())
            all.push_back({slot->name, control::describe(fault.reason), seconds(fault.tick * slot->period),
                           fault.over < 0 ? -1.0 : seconds(fault.over * slot->period), fault.force_N});
    return all;
}

std::vector<std::string> ForceNews::next(const run::Engine& engine) {
    std::vector<std::string> lines;
    const std::vector<FaultOnRecord> record = faults_on_record(engine);
    for (const HandForces& forces : forces_of(engine)) {
        Told& told = told_[forces.device];
        std::vector<const FaultOnRecord*> faults;
        for (const FaultOnRecord& fault : record)
            if (fault.device == forces.device) faults.push_back(&fault);
        for (; told.faults < faults.size(); ++told.faults) {
            const FaultOnRecord& fault = *faults[told.faults];
            lines.push_back(fmt::format("no force on '{}' at {:.2f} s: {}; {:.2g} N faded to nothing", fault.device,
                                        fault.began_s, fault.what, fault.force_N));
            told.is_away = true;
        }
        for (; told.over < faults.size() && faults[told.over]->over_s >= 0.0; ++told.over)
            lines.push_back(fmt::format("'{}': over at {:.2f} s, after {:.2f} s", forces.device,
                                        faults[told.over]->over_s,
                                        faults[told.over]->over_s - faults[told.over]->began_s));
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

}  // namespace tactus::session
