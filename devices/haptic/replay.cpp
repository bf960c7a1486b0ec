// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/replay.hpp"

#include "assets/table/trajectory.hpp"
#include "devices/haptic/operated.hpp"
#include "dsp/simulate/path_alignment.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

namespace tactus::haptic {
namespace {

struct Replaying {
    std::shared_ptr<const simulate::TrajectoryPlayer> player;  // shared with the copy that `prepare` restores
    double trigger_from = 0.0;                       // s
    double time = 0.0;
    std::size_t hint = 0;
    bool gap = false, done = false;

    simulate::Intention operator()(double h, const Wrench&, const Pose&) noexcept {
        const simulate::TrajectoryState state = player->at(time + 0.5 * h, hint);
        time += h;
        gap = state.gap;
        done = state.done;
        return state.intention;
    }
    Pose start() const { return player->start(); }
    std::uint32_t buttons() const noexcept {
        return (time >= trigger_from && !done ? button_trigger : 0) | (gap ? button_gap : 0);
    }
};

double read_trigger(Options& options) {
    static const std::array<std::string, 3> choices{"always", "from", "never"};
    const std::size_t choice = options.choice("trigger", choices, "always");
    const double from = options.quantity("trigger_from", "0 s", "0 s");
    if (choice == 0 && options.has("trigger_from"))
        throw Error(options.where("trigger_from"),
                    fmt::format("{}: option 'trigger_from' needs trigger = \"from\"", options.owner()));
    return choice == 0 ? 0.0 : choice == 1 ? from : std::numeric_limits<double>::infinity();
}

/// Reads the recording. The Error of one that lacks the tool or the trial names the option that asks for it.
table::Trajectory read_recording(const Options& options, const std::string& file,
                                 const table::TrajectorySelection& selection) {
    try {
        return table::read_trajectory(file, selection);
    } catch (const Error& error) {
        const char* const option = options.has("tool") ? "tool" : options.has("trial") ? "trial" : "file";
        throw Error(options.where(option), fmt::format("{}: option '{}': {}", options.owner(), option, error.what()));
    }
}

}  // namespace

std::unique_ptr<HapticDevice> open_replay(Options& options, const PathResolver& resolve) {
    const std::string file = options.text("file", "");
    table::TrajectorySelection selection;
    selection.tool = options.text("tool", "");
    const double trial = options.quantity("trial", "0", "0", "1000000");
    if (trial != std::floor(trial))
        throw Error(options.where("trial"), fmt::format("{}: option 'trial' must be a whole number", options.owner()));
    selection.trial = static_cast<int>(trial);
    const double max_speed = options.quantity("max_speed", "100 mm/s", "1 mm/s", "2 m/s");
    static const std::array<std::string, 2> places{"rest", "recorded"};
    const bool at_rest = options.choice("place", places, "rest") == 0;
    const double reach = options.quantity("reach", "9 mm", "-1 m", "1 m");
    Replaying operated;
    operated.trigger_from = read_trigger(options);
    const simulate::HandDynamics hand = read_hand(options);
    const simulate::DeviceModel* const model = read_model(options);
    DeviceInfo info = read_device_info(options, hand, "replayed hand");
    options.finish();
    if (file.empty())
        throw Error(options.where(),
                    fmt::format("{} needs a recording; name it with the option 'file'", options.owner()));
    table::Trajectory trajectory = read_recording(options, resolve(file), selection);
    // The tool's working direction is −z of the device, as for the simulated hand.
    if (at_rest) simulate::align_to_rest(trajectory.samples, Vec3(0.0, 0.0, -1.0), reach);
    simulate::TrajectoryRules rules = trajectory.rules();
    rules.max_speed = max_speed;
    operated.player = std::make_shared<const simulate::TrajectoryPlayer>(trajectory.samples, trajectory.breaks, rules);
    return std::make_unique<OperatedDevice<Replaying>>(std::move(info), hand, std::move(operated), model);
}

}  // namespace tactus::haptic
