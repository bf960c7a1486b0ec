// SPDX-License-Identifier: Apache-2.0
// Whether the hands of a run feel forces, and what brings them back, for people: in the terminal and in the window.
#pragma once

#include "dsp/control/force_state.hpp"
#include "engine/run/engine.hpp"

#include <map>
#include <string>
#include <vector>

namespace tactus::session {

/// The forces of one device now.
struct HandForces {
    std::string device;
    std::string node;  ///< that sends them: device_output or gripper_output
    control::ForceState state = control::ForceState::unknown;
    double since_s = 0.0;  ///< logical
    std::string fault;     ///< why they are away: "no force arrived in time"; empty: no fault
    double fault_since_s = 0.0;

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

    std::string text() const;
};

/// Of all devices that the patch drives.
std::vector<HandForces> forces_of(const run::Engine& engine);
/// In the order of devices, oldest first.
std::vector<FaultOnRecord> faults_on_record(const run::Engine& engine);

/// What changed since the last call, a line each, for the terminal.
class ForceNews {
public:
    std::vector<std::string> next(const run::Engine& engine);

private:
    static constexpr double told_after_s = 0.5;  ///< of a wait without a fault

    struct Told {
        std::size_t faults = 0, over = 0;
        double wait_s = -1.0;  ///< since when the wait is that was told last
        bool is_away = false;
    };
    std::map<std::string, Told> told_;
};

}  // namespace tactus::session
