// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/card_channels.hpp"

#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <vector>

namespace tactus::analysis {

namespace {

/// Sensors are among the actuators, as "sensors.NAME".
const patch::PatchActuator& entry_of(const patch::Patch& patch, const std::string& name, bool is_sensor) {
    constexpr std::string_view prefix = "sensors.";
    const std::string wanted = is_sensor ? std::string(prefix) + name : name;
    std::vector<std::string> names;
    for (const patch::PatchActuator& entry : patch.actuators) {
        if (entry.name == wanted) return entry;
        if (entry.name.starts_with(prefix) == is_sensor)
            names.push_back(is_sensor ? entry.name.substr(prefix.size()) : entry.name);
    }
    throw Error({patch.file.string(), 0, 0},
                is_sensor ? fmt::format("no sensor '{}' in [sensors]{}", name, did_you_mean(name, names))
                          : fmt::format("no actuator '{}' in [actuators]{}", name, did_you_mean(name, names)));
}

struct Place {
    std::string card;
    int channel = 1;
    double full_scale = 1.0;
};

double number_of(const OptionText& option, double least, double most) {
    const double value = [&] {
        try {
            return parse_as(option.text, "");
        } catch (const Error& error) {
            throw Error(option.where, error.message());
        }
    }();
    if (!(value >= least && value <= most))
        throw Error(option.where, fmt::format("{} = {} is outside the range from {:g} to {:g}", option.name,
                                              option.text, least, most));
    return value;
}

Place place_of(const patch::PatchActuator& entry) {
    Place place;
    for (const OptionText& option : entry.settings) {
        if (option.name == "card") place.card = option.text;
        if (option.name == "full_scale") place.full_scale = number_of(option, 1e-6, 1e6);
        if (option.name != "channel") continue;
        const double channel = number_of(option, 0.0, 64.0);
        if (channel != std::floor(channel)) throw Error(option.where, "a channel is a whole number");
        place.channel = channel == 0.0 ? 1 : static_cast<int>(channel);
    }
    return place;
}

}  // namespace

CardChannels card_channels(const patch::Patch& patch, const std::string& actuator, const std::string& sensor) {
    const patch::PatchActuator& heard = entry_of(patch, sensor, true);
    const Place out = place_of(entry_of(patch, actuator, false)), in = place_of(heard);
    if (out.card != in.card)
        throw Error(
            heard.where,
            fmt::format("actuator '{}' is at card '{}' and sensor '{}' at card '{}'; a sweep goes through one card",
                        actuator, out.card, sensor, in.card));
    return {out.card, out.channel, in.channel, out.full_scale, in.full_scale};
}

}  // namespace tactus::analysis
