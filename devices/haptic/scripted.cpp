// SPDX-License-Identifier: Apache-2.0
#include "devices/haptic/scripted.hpp"

#include "assets/file/whole_file.hpp"
#include "devices/haptic/operated.hpp"
#include "dsp/core/units.hpp"
#include "dsp/coupling/placement.hpp"
#include "dsp/simulate/script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <sstream>
#include <string>
#include <string_view>

namespace tactus::haptic {
namespace {

/// The buttons held from a time on, as bits of DeviceSample::buttons.
struct Press {
    double time = 0.0;
    std::uint32_t buttons = 0;
};

struct Following {
    simulate::ScriptOperator moves;
    double trigger_on = 0.0, trigger_off = 0.0;
    std::shared_ptr<const std::vector<Press>> presses;  // shared with the copy that `prepare` restores

    simulate::Intention operator()(double h, const Wrench& force, const Pose& hand) noexcept {
        return moves(h, force, hand);
    }
    Pose start() const { return moves.start(); }
    std::uint32_t buttons() const noexcept {
        if (presses->empty()) return moves.time() >= trigger_on && moves.time() < trigger_off ? button_trigger : 0;
        const auto next = std::ranges::upper_bound(*presses, moves.time(), {}, &Press::time);
        return next == presses->begin() ? 0u : (next - 1)->buttons;
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
        throw Error(fmt::format("'{}' must be three numbers and a unit, as in \"{}\"", text, example));
    Vec3 value;
    for (int axis = 0; axis < 3; ++axis) value[axis] = parse_as(number[axis] + " " + unit, example.substr(6));
    return value;
}

simulate::HandTarget read_target(std::string_view text) {
    const auto colon = text.find(':');
    if (colon == std::string_view::npos) throw Error(fmt::format("'{}' has no time; write \"2 s: 0 0 -30 mm\"", text));
    const std::string_view place = text.substr(colon + 1);
    const auto comma = place.find(',');
    simulate::HandTarget target;
    target.time = parse_as(trimmed(text.substr(0, colon)), "s");
    target.pose.position = three(trimmed(place.substr(0, comma)), "0 0 0 mm");
    if (comma != std::string_view::npos)
        target.pose.orientation =
            glm::normalize(coupling::rotation_xyz(three(trimmed(place.substr(comma + 1)), "0 0 0 deg")));
    return target;
}

/// Calls take(part) for the parts "TIME: REST" of a list with semicolons or lines. `take` returns the time; times must
/// increase. Throws Error with the position of the option.
template <class Take>
void read_list(Options& options, const char* name, const std::string& text, const Take& take) {
    double last = -1.0;
    std::string_view rest = text;
    while (!rest.empty()) {
        const auto end = rest.find_first_of(";\n");
        const std::string_view one = trimmed(rest.substr(0, end));
        rest = end == std::string_view::npos ? std::string_view{} : rest.substr(end + 1);
        if (one.empty() || one.front() == '#') continue;
        const auto fail = [&](const std::string& message) {
            throw Error(options.where(name), fmt::format("{}: option '{}': {}", options.owner(), name, message));
        };
        double time = 0.0;
        try {
            time = take(one);
        } catch (const Error& error) {
            fail(error.message());
        }
        if (!(time > last)) fail(fmt::format("times must increase; '{}' is not later than the previous one", one));
        last = time;
    }
}

/// Bit 1 is reserved for the gaps of a replayed hand.
constexpr std::uint32_t button_bits[] = {button_trigger, 4u, 8u, 16u};

std::uint32_t read_buttons(std::string_view text) {
    std::istringstream words{std::string(text)};
    std::uint32_t buttons = 0;
    for (std::string word; words >> word;) {
        static const std::vector<std::string> names{"trigger", "second", "third", "fourth"};
        const auto found = std::ranges::find(names, word);
        if (found == names.end())
            throw Error(fmt::format("there is no button '{}'{}", word, did_you_mean(word, names)));
        buttons |= button_bits[static_cast<std::size_t>(found - names.begin())];
    }
    return buttons;
}

/// Targets and buttons from the options, or from a script file: one target per line; the buttons after '|' are held
/// from then on.
void read_script(Options& options, const PathResolver& resolve, std::vector<simulate::HandTarget>& targets,
                 std::vector<Press>& presses) {
    const std::string asset = options.text("file", "");
    const bool is_file = !asset.empty();
    const std::string text = is_file ? file::read_whole_file(resolve(asset)) : options.text("targets", "0 s: 0 0 0 mm");
    read_list(options, is_file ? "file" : "targets", text, [&](std::string_view one) {
        const auto bar = one.find('|');
        targets.push_back(read_target(trimmed(one.substr(0, bar))));
        if (bar != std::string_view::npos) presses.push_back({targets.back().time, read_buttons(one.substr(bar + 1))});
        return targets.back().time;
    });
    if (targets.empty())
        throw Error(options.where("targets"), fmt::format("{}: option 'targets' has no target", options.owner()));
    read_list(options, "buttons", options.text("buttons", ""), [&](std::string_view one) {
        const auto colon = one.find(':');
        if (colon == std::string_view::npos)
            throw Error(fmt::format("'{}' has no time; write \"2 s: trigger second\"", one));
        presses.push_back({parse_as(trimmed(one.substr(0, colon)), "s"), read_buttons(one.substr(colon + 1))});
        return presses.back().time;
    });
}

}  // namespace

std::unique_ptr<HapticDevice> open_scripted(Options& options, const PathResolver& resolve) {
    std::vector<simulate::HandTarget> targets;
    std::vector<Press> presses;
    read_script(options, resolve, targets, presses);
    simulate::HandWiggle wiggle;
    wiggle.amplitude = options.quantity("wiggle", "0 mm", "0 mm", "20 mm");
    wiggle.rotation = options.quantity("wiggle_turn", "0 deg", "0 deg", "45 deg");
    wiggle.rate = options.quantity("wiggle_rate", "1.5 Hz", "0 Hz", "10 Hz");
    const double on = options.quantity("trigger_on", "0 s", "0 s"),
                 off = options.quantity("trigger_off", "1e9 s", "0 s");
    const simulate::HandDynamics hand = read_hand(options);
    const simulate::DeviceModel* const model = read_model(options);
    DeviceInfo info = read_device_info(options, hand, "scripted hand");
    options.finish();
    return std::make_unique<OperatedDevice<Following>>(
        std::move(info), hand,
        Following{simulate::ScriptOperator(std::move(targets), wiggle), on, off,
                  std::make_shared<const std::vector<Press>>(std::move(presses))},
        model);
}

}  // namespace tactus::haptic
