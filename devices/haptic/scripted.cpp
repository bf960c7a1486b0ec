// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/scripted.hpp"

#include "devices/haptic/operated.hpp"
#include "dsp/core/units.hpp"
#include "dsp/coupling/placement.hpp"
#include "dsp/operator/script.hpp"

#include <fmt/format.h>

#include <sstream>
#include <string>
#include <string_view>

namespace tactus {
namespace {

struct Following {
    ScriptOperator moves;
    double trigger_on = 0.0, trigger_off = 0.0;

    Intention operator()(double h, const Wrench& force, const Pose& hand) noexcept { return moves(h, force, hand); }
    Pose start() const { return moves.start(); }
    std::uint32_t buttons() const noexcept {
        return moves.time() >= trigger_on && moves.time() < trigger_off ? button_trigger : 0;
    }
};

std::string_view trimmed(std::string_view text) {
    const auto begin = text.find_first_not_of(" \t\n\r");
    return begin == std::string_view::npos ? std::string_view{}
                                           : text.substr(begin, text.find_last_not_of(" \t\n\r") - begin + 1);
}

/// "1 2 3 mm" in SI. Throws Error without a location.
Vec3 three(std::string_view text, std::string_view example) {
    std::istringstream words{std::string(text)};
    std::string number[3], unit, more;
    if (!(words >> number[0] >> number[1] >> number[2] >> unit) || words >> more)
        throw Error(fmt::format("'{}' is not three numbers and a unit, as \"{}\" is", text, example));
    Vec3 value;
    for (int axis = 0; axis < 3; ++axis) value[axis] = parse_as(number[axis] + " " + unit, example.substr(6));
    return value;
}

HandTarget read_target(std::string_view text) {
    const auto colon = text.find(':');
    if (colon == std::string_view::npos) throw Error(fmt::format("'{}' has no time; write \"2 s: 0 0 -30 mm\"", text));
    const std::string_view place = text.substr(colon + 1);
    const auto comma = place.find(',');
    HandTarget target;
    target.time = parse_as(trimmed(text.substr(0, colon)), "s");
    target.pose.position = three(trimmed(place.substr(0, comma)), "0 0 0 mm");
    if (comma != std::string_view::npos)
        target.pose.orientation = glm::normalize(rotation_xyz(three(trimmed(place.substr(comma + 1)), "0 0 0 deg")));
    return target;
}

std::vector<HandTarget> read_targets(Options& options) {
    const std::string text = options.text("targets", "0 s: 0 0 0 mm");
    std::vector<HandTarget> targets;
    std::string_view rest = text;
    while (!rest.empty()) {
        const auto end = rest.find(';');
        const std::string_view one = trimmed(rest.substr(0, end));
        rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
        if (one.empty()) continue;
        try {
            targets.push_back(read_target(one));
        } catch (const Error& error) {
            throw Error(options.where("targets"),
                        fmt::format("{}: option 'targets': {}", options.owner(), error.message()));
        }
        if (targets.size() > 1 && !(targets.back().time > targets[targets.size() - 2].time))
            throw Error(options.where("targets"),
                        fmt::format("{}: option 'targets': times must rise; '{}' does not", options.owner(), one));
    }
    if (targets.empty())
        throw Error(options.where("targets"), fmt::format("{}: option 'targets' names no place", options.owner()));
    return targets;
}

}  // namespace

std::unique_ptr<HapticDevice> open_scripted(Options& options) {
    std::vector<HandTarget> targets = read_targets(options);
    HandWiggle wiggle;
    wiggle.amplitude = options.quantity("wiggle", "0 mm", "0 mm", "20 mm");
    wiggle.turn = options.quantity("wiggle_turn", "0 deg", "0 deg", "45 deg");
    wiggle.rate = options.quantity("wiggle_rate", "1.5 Hz", "0 Hz", "10 Hz");
    const double on = options.quantity("trigger_on", "0 s", "0 s"),
                 off = options.quantity("trigger_off", "1e9 s", "0 s");
    const HandDynamics hand = read_hand(options);
    DeviceInfo info = read_device_info(options, hand, "scripted hand");
    options.finish();
    return std::make_unique<OperatedDevice<Following>>(std::move(info), hand,
                                                       Following{ScriptOperator(std::move(targets), wiggle), on, off});
}

}  // namespace tactus
