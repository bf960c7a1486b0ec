// SPDX-License-Identifier: Apache-2.0
// What can be found out about a patch before it runs: errors, latencies, stable stiffness, load.
#pragma once

#include "devices/audio/portaudio.hpp"
#include "engine/build/generation.hpp"
#include "graph/analyse/latency.hpp"
#include "graph/analyse/schedule.hpp"
#include "graph/analyse/stiffness.hpp"
#include "tools/analysis/passivity/z_width.hpp"
#include "tools/analysis/patch/device_processes.hpp"
#include "tools/analysis/patch_stiffness.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

struct CheckedGroup {
    std::string name;
    double rate = 0.0, latency_ms = 0.0;  ///< rate in Hz
    std::vector<std::string> nodes;
};

/// A path from a hand to an output; a loop through a hand has a limit of its stiffness.
struct CheckedPath {
    analyse::PathLatency path;
    std::optional<analyse::ForceLoop> loop;

    double latency_ms() const { return loop ? loop->latency_s * 1e3 : path.latency_ms; }
};

/// The position loop of an admittance controller.
struct CheckedLoop {
    std::string node;
    double gain = 0.0, gain_limit = 0.0;  ///< 1/s
    double hand_stiffness = 0.0;  ///< N/m

    bool is_stable() const { return gain < gain_limit; }
};

/// An output to a hand.
struct CheckedOutput {
    std::string node;
    std::optional<double> energy_bound;  ///< J, which a contact may return beyond what it took; none: no energy cap
};

/// What a sound card adds to the latency of paths that begin or end there.
struct CheckedSound {
    double buffer_ms = 0.0;
    std::optional<audio::AudioCard> card;
    bool plays = false, hears = false;
};

/// A group in the order of priority.
struct CheckedSchedule {
    analyse::ScheduledGroup group;
    int priority = 0;
    double may_use = 0.0;  ///< fraction of a core, beside the more critical groups
    bool is_measured = false;  ///< the cost of the group is known
};

struct PatchCheck {
    std::string patch;  ///< as it was given
    std::vector<Error> errors;
    std::vector<CheckedGroup> groups;
    std::vector<CheckedPath> paths;
    std::vector<DeviceProcess> processes;
    bool is_prepared = false;  ///< the nodes could be prepared; otherwise the rest is unknown
    std::vector<NodeContactLaw> contact;
    std::vector<ClassVerdict> classes;
    std::vector<CheckedLoop> loops;
    std::vector<CheckedSchedule> schedule;
    std::vector<CheckedOutput> outputs;
    std::optional<CheckedSound> sound;
    std::optional<std::vector<ZWidthCurve>> z_width;
    std::vector<std::string> warnings;

    /// No path exceeds its stiffness limit and no loop is unstable.
    bool is_stable() const;
    /// A stiffness could not be judged.
    bool is_unknown() const;
};

std::vector<CheckedGroup> checked_groups(const compile::Schedule& plan);
std::vector<CheckedPath> checked_paths(const compile::Schedule& plan, const std::vector<analyse::ForceLoop>& loops);
std::vector<CheckedLoop> checked_loops(const std::vector<std::shared_ptr<build::LiveNode>>& nodes);
/// Adds a warning for each output without an energy cap.
std::vector<CheckedOutput> checked_outputs(const std::vector<std::shared_ptr<build::LiveNode>>& nodes,
                                           const std::vector<analyse::ForceLoop>& loops,
                                           std::vector<std::string>& warnings);
/// Empty if the patch neither plays nor hears.
std::optional<CheckedSound> checked_sound(const compile::Schedule& plan);

/// The cost of one call of each group, in s, as plan.groups: from a short run on the virtual clock. Empty when the patch
/// needs hardware, which is not opened here.
std::vector<double> measured_costs(const std::function<compile::Schedule()>& plan);
std::vector<CheckedSchedule> checked_schedule(const compile::Schedule& plan, const std::vector<double>& cost_s);
/// A warning for each class on which a hand depends and that does not fit, also when all else waits.
std::vector<std::string> schedule_warnings(const compile::Schedule& plan, const std::vector<double>& cost_s);

}  // namespace tactus::analysis
