// SPDX-License-Identifier: Apache-2.0
// Sound card channels of an actuator and a sensor of a patch.
#pragma once

#include "graph/patch/patch.hpp"

#include <string>

namespace tactus::analysis {

/// One output and one input channel of one card.
struct CardChannels {
    std::string card;            ///< substring of its name; "": the default
    int output = 1, input = 1;   ///< from 1
    double full_output = 1.0;    ///< the actuator's value at full scale of the card, in its unit
    double full_input = 1.0;     ///< the sensor's
};

/// Reads them from [actuators.ACTUATOR] and [sensors.SENSOR]. Throws Error with the position in the file.
CardChannels card_channels(const patch::Patch& patch, const std::string& actuator, const std::string& sensor);

}  // namespace tactus::analysis
