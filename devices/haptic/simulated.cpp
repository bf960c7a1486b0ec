// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/simulated.hpp"

#include "devices/haptic/operated.hpp"
#include "dsp/simulate/stroke.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace tactus::haptic {
namespace {

/// Three numbers separated by spaces, scaled to unit length.
Vec3 read_axis(Options& options, std::string_view name, std::string_view standard) {
    const std::string text = options.text(name, standard);
    Vec3 axis(0.0);
    const char *at = text.data(), *const end = at + text.size();
    bool good = true;
    for (int i = 0; i < 3 && good; ++i) {
        while (at != end && *at == ' ') ++at;
        const auto [stop, error] = std::from_chars(at, end, axis[i]);
        good = error == std::errc{} && std::isfinite(axis[i]);
        at = stop;
    }
    if (!good || at != end || !(glm::length(axis) > 1e-9) || !std::isfinite(glm::length(axis)))
        throw Error(options.where(name), fmt::format("{}: option '{}' is '{}'; write a direction as \"{}\"",
                                                     options.owner(), name, text, standard));
    return glm::normalize(axis);
}

struct Sawing {
    simulate::StrokePlan plan;
    simulate::StrokeOperator moves;

    explicit Sawing(const simulate::StrokePlan& given) : plan(given), moves(given) {}
    simulate::Intention operator()(double h, const Wrench& force, const Pose& hand) noexcept {
        return moves(h, force, hand);
    }
    Pose start() const { return plan.start; }
    std::uint32_t buttons() const noexcept { return moves.trigger() ? button_trigger : 0; }
};

simulate::StrokePlan read_plan(Options& options) {
    simulate::StrokePlan plan;
    plan.start.position.x = options.quantity("start_x", "0 mm", "-1 m", "1 m");
    plan.start.position.y = options.quantity("start_y", "0 mm", "-1 m", "1 m");
    plan.start.position.z = options.quantity("start_z", "0 mm", "-1 m", "1 m");
    // Every orientation is a rotation about one axis.
    const Vec3 turn_axis = read_axis(options, "turn_axis", "0 0 1");
    plan.start.orientation = rotation_by(turn_axis * options.quantity("turn", "0 deg", "-360 deg", "360 deg"));
    plan.stroke_axis = read_axis(options, "stroke_axis", "1 0 0");
    plan.feed_axis = read_axis(options, "feed_axis", "0 0 -1");
    plan.stroke_amplitude = options.quantity("stroke_amplitude", "8 mm", "0 mm", "100 mm");
    plan.stroke_rate = options.quantity("stroke_rate", "0.7 Hz", "0 Hz", "5 Hz");
    plan.thrust = options.quantity("thrust", "7 N", "0.1 N", "50 N");
    plan.feed_speed = options.quantity("feed_speed", "30 mm/s", "0.1 mm/s", "200 mm/s");
    plan.depth = options.quantity("depth", "30 mm", "0 mm", "300 mm");
    plan.retract_speed = options.quantity("retract_speed", "40 mm/s", "0.1 mm/s", "500 mm/s");
    plan.feed_at = options.quantity("feed_at", "0.5 s", "0 s");
    plan.stroke_at = options.quantity("stroke_at", "1 s", "0 s");
    plan.retract_at = options.quantity("retract_at", "60 s", "0 s");
    plan.trigger_on = options.quantity("trigger_on", "0.3 s", "0 s");
    plan.trigger_off = options.quantity("trigger_off", "1e9 s", "0 s");
    plan.reaction_time = options.quantity("reaction_time", "0 ms", "0 ms", "500 ms");
    plan.tremor.rms = options.quantity("tremor", "0.05 mm", "0 mm", "5 mm");
    plan.tremor.random.seed = static_cast<std::uint64_t>(options.quantity("seed", "1", "0", "4294967295"));
    return plan;
}

}  // namespace

std::unique_ptr<HapticDevice> open_simulated(Options& options) {
    simulate::StrokePlan plan = read_plan(options);
    const simulate::HandDynamics hand = read_hand(options);
    plan.grip_stiffness = hand.stiffness;
    const simulate::DeviceModel* const model = read_model(options);
    DeviceInfo info = read_device_info(options, hand, "simulated hand");
    options.finish();
    return std::make_unique<OperatedDevice<Sawing>>(std::move(info), hand, Sawing(plan), model);
}

}  // namespace tactus::haptic
