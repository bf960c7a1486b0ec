// SPDX-License-Identifier: Apache-2.0
// Whether the hands of a run feel forces, and what brings them back, for people: in the terminal and in the window.
#pragma once

#include "dsp/control/force_state.hpp"
#include "engine/run/engine.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tactus::session {

/// How a person lets forces return that wait for one.
enum class LetReturn { by_set, by_button, by_nothing };

/// The forces of one device now.
struct HandForces {
    std::string device;
    /// That sends them, device_output or gripper_output; after a fault that came by a wire, the node that sent it. Its
    /// `recover` lets forces return.
    std::string node;
    control::ForceState state = control::ForceState::unknown;
    double since_s = 0.0;  ///< logical
    std::string fault;  ///< why they are away: "no force arrived in time"; empty: no fault
    double fault_since_s = 0.0;
    control::Fault reason = control::Fault::none;  ///< the same as a number
    double on_time_s = 1.0;  ///< for which ticks must be on time before forces return by themselves
    bool is_windowless = false;  ///< the window that moves the hand is closed
    LetReturn way = LetReturn::by_set;

    /// What happened, since when, and how to go on: "no force arrived in time, since 1.62 s: forces return …". Empty
    /// while forces are on. `has_button`: beside it, so that no command is named for what it does.
    std::string text(bool has_button = false) const;
};

/// A fault of a device that is or was.
struct FaultOnRecord {
    std::string device, what;
    double began_s = 0.0;
    double over_s = -1.0;  ///< negative: it is not over
    double force_N = 0.0;  ///< on the hand before
    std::int64_t number = 0;  ///< of the device's faults in this run, from 0 on

    std::string text() const;
};

/// Of all devices that the patch drives.
std::vector<HandForces> forces_of(const run::Engine& engine, LetReturn way = LetReturn::by_set);
/// The newest of each device, in the order of devices, oldest first.
std::vector<FaultOnRecord> faults_on_record(const run::Engine& engine);
/// Older ones, which are counted only.
std::int64_t faults_not_kept(const run::Engine& engine);

/// What changed since the last call, a line each, for the terminal.
class ForceNews {
public:
    explicit ForceNews(LetReturn way = LetReturn::by_set) : way_(way) {}
    std::vector<std::string> next(const run::Engine& engine);

private:
    static constexpr double told_after_s = 0.5;  ///< of a wait without a fault

    struct Told {
        std::int64_t faults = 0, over = 0;  ///< numbers of the next
        double wait_s = -1.0;  ///< since when the wait is that was told last
        bool is_away = false;
    };
    static void tell_faults(const std::string& device, const std::vector<FaultOnRecord>& record, Told& told,
                            std::vector<std::string>& lines);

    LetReturn way_;
    std::map<std::string, Told> told_;
};

}  // namespace tactus::session
