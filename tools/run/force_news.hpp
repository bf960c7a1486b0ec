// SPDX-License-Identifier: Apache-2.0
// Whether the hands of a run receive forces, and how to re-enable them, as text for the terminal and the window.
#pragma once

#include "dsp/control/force_state.hpp"
#include "engine/run/engine.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace tactus::run {

/// User action that re-enables forces that wait for one.
enum class LetReturn { by_set, by_button, by_nothing };

/// Current state of the forces of one device.
struct HandForces {
    std::string device;
    /// Node that sends them, device_output or gripper_output; after a fault that arrived by a wire, the node that sent
    /// it. Its parameter `recover` re-enables forces.
    std::string node;
    control::ForceState state = control::ForceState::unknown;
    double since_s = 0.0;  ///< s, logical time
    std::string fault;  ///< reason why they are off: "no force arrived in time"; empty: no fault
    double fault_since_s = 0.0;
    control::Fault reason = control::Fault::none;  ///< the same as a number
    double on_time_s = 1.0;  ///< s; time for which ticks must be on time before forces return automatically
    bool is_windowless = false;  ///< the window that moves the hand is closed
    LetReturn way = LetReturn::by_set;

    /// Describes the fault, its time, and the remedy: "no force arrived in time, since 1.62 s: forces return …". Empty
    /// while forces are on. `has_button`: a button is shown beside the text, which then names no command for it.
    std::string text(bool has_button = false) const;
};

/// A present or past fault of a device.
struct FaultOnRecord {
    std::string device, what;
    double began_s = 0.0;
    double over_s = -1.0;  ///< negative: still active
    double force_N = 0.0;  ///< on the hand before the fault
    std::int64_t number = 0;  ///< of the device's faults in this run, counted from 0

    std::string text() const;
};

/// Returns the state of all devices that the patch drives.
std::vector<HandForces> forces_of(const run::Engine& engine, LetReturn way = LetReturn::by_set);
/// Returns the newest faults of each device, in the order of devices, oldest first.
std::vector<FaultOnRecord> faults_on_record(const run::Engine& engine);
/// Returns the number of older faults, which are not stored.
std::int64_t faults_not_kept(const run::Engine& engine);

/// Reports changes since the last call, one line each, for the terminal.
class ForceNews {
public:
    explicit ForceNews(LetReturn way = LetReturn::by_set) : way_(way) {}
    std::vector<std::string> next(const run::Engine& engine);

private:
    static constexpr double told_after_s = 0.5;  ///< duration of a wait without a fault before it is reported

    struct Told {
        std::int64_t faults = 0, over = 0;  ///< number of the next fault, and of the next end of a fault, to report
        double wait_s = -1.0;  ///< start of the wait that was reported last
        bool is_away = false;
    };
    static void tell_faults(const std::string& device, const std::vector<FaultOnRecord>& record, Told& told,
                            std::vector<std::string>& lines);

    LetReturn way_;
    std::map<std::string, Told> told_;
};

}  // namespace tactus::run
