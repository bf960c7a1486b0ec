// SPDX-License-Identifier: Apache-2.0
// Values of ports over a trial, and the measures made of them: collected while the trial runs, or read from its take. Both give
// the same bits.
#pragma once

#include "assets/experiment/protocol.hpp"
#include "assets/experiment/records.hpp"
#include "engine/observe/observer.hpp"
#include "engine/run/options.hpp"
#include "graph/compile/schedule.hpp"

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace tactus::analysis {

/// One number per tick, from logical time 0 on.
struct PortSeries {
    double period = 1e-3;  ///< s
    std::vector<double> values;
};
/// By name as a measure gives it, "NODE.PORT" or "NODE.PORT.CHANNEL".
using PortValues = std::map<std::string, PortSeries>;

/// Ports that a protocol's measures and answers need; `task` is ignored in psychophysics.
std::set<std::string> ports_of(const experiment::Protocol& protocol, std::size_t task);

/// Throws Error naming a port that the patch does not have or that carries no numbers, or a channel that a port does not have.
void check_ports(const compile::Schedule& schedule, const std::set<std::string>& ports);

class PortCollector {
public:
    /// `done`: one of the ports, a bool that ends the trial; empty: none. `pressed`: bools whose presses are counted.
    explicit PortCollector(const std::set<std::string>& ports, std::string done = {},
                           const std::vector<std::string>& pressed = {});
    /// For RunChoice::tap. The collector must outlive the run.
    run::TapMaker tap();
    /// After the run. Throws Error naming a port that the patch does not have, or a channel that the port does not have.
    PortValues values() const;
    /// Set soon after `done` became true. Anybody may set it.
    std::atomic<bool>& over() { return over_; }
    /// How often a port of `pressed` became true since the last call. Any thread.
    int take_presses(const std::string& port);

private:
    struct Entry {
        PortSeries series;
        bool is_found = false;
    };
    std::map<std::string, Entry> entries_;
    std::map<std::string, std::string> problems_;
    std::map<std::string, std::atomic<int>> presses_;
    std::string done_;
    std::atomic<bool> over_{false};
};

/// The same of an offline run that is advanced in steps: values are there as soon as the step is done.
class SteppedPorts {
public:
    /// `observer` must be lossless. Both must outlive this. Throws Error like check_ports() with the schedule of the run.
    SteppedPorts(const std::set<std::string>& ports, observe::Observer& observer) : ports_(ports), observer_(observer) {
        watch();
    }
    /// Adds the values of the last step.
    void fetch();
    const PortValues& values() const { return values_; }

private:
    void watch();

    const std::set<std::string>& ports_;
    observe::Observer& observer_;
    PortValues values_;
};

/// Reads the same from a take. Throws Error.
PortValues port_values_of(const std::filesystem::path& take, const std::set<std::string>& ports);

/// The measure of each interval of a trial: in its window, or for an adjustment where it presented the last level longest or
/// last.
std::vector<double> rendered_of(const experiment::Protocol& protocol, const experiment::TrialRecord& trial,
                                const PortValues& values);

/// The measure within the window, or over the whole trial; not a number where there is nothing to measure, such as no press.
double measure_of(const experiment::Measure& measure, const PortValues& values,
                  const std::optional<experiment::Window>& window = {});

}  // namespace tactus::analysis
