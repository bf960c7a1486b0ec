// SPDX-License-Identifier: Apache-2.0
// From a measured response to a filter that undoes it, and what the actuator's limits say to it.
#pragma once

#include "assets/sound/equaliser_file.hpp"
#include "dsp/vibration/actuator.hpp"
#include "dsp/vibration/headroom.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::study {

struct EqualiseSettings {
    std::filesystem::path response;              ///< a measured response
    std::filesystem::path signal;                ///< a recording that will be played; empty: none
    vibration::EqualiserDesign design;
    std::string actuator = "haptuator_large";    ///< whose limits count
    double volts = 1.0;                          ///< per unit of the response's input
    double scale = 1.0;                          ///< units of the response's input per unit of the signal file
};

/// The chain of actuator and equaliser within the band, by third octaves.
struct Flatness {
    double before_db = 0.0, after_db = 0.0;  ///< greatest deviation from the mean gain
    double boost_db = -400.0, boost_hz = 0.0;
    struct Band {
        double hz, filter_db, loudest;  ///< `loudest`: peak of what the actuator can make of a sine there
    };
    std::vector<Band> bands;
};

/// What the limits do to a recording, without and with the equaliser.
struct Programme {
    vibration::Headroom plain, equalised;
};

struct Equalisation {
    vibration::Equaliser equaliser;
    std::string title, unit;               ///< of the response
    const vibration::ActuatorModel* actuator = nullptr;
    double limit = 0.0;                    ///< V, of the drive
    Flatness flat;
    std::optional<Programme> programme;    ///< when there is a signal
};

/// Throws Error.
Equalisation equalise(const EqualiseSettings& settings);

}  // namespace tactus::study
