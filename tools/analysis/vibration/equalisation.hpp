// SPDX-License-Identifier: Apache-2.0
// Designs an inverse filter from a measured response and checks it against the actuator's limits.
#pragma once

#include "assets/sound/equaliser_file.hpp"
#include "dsp/vibration/actuator.hpp"
#include "dsp/vibration/headroom.hpp"

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

struct EqualiseSettings {
    std::filesystem::path response;              ///< a measured response
    std::filesystem::path signal;                ///< a recording to be played; empty: none
    vibration::EqualiserDesign design;
    std::string actuator = "haptuator_large";    ///< actuator with the limits
    double volts = 1.0;                          ///< V per unit of the response's input
    double scale = 1.0;                          ///< units of the response's input per unit of the signal file
};

/// Flatness of actuator and equaliser within the band. Extremes are taken on a grid that resolves the narrowest feature
/// of both, because a notch may lie between the centres of two bands.
struct Flatness {
    double before_db = 0.0, after_db = 0.0;  ///< largest deviation from the mean gain, dB
    double after_hz = 0.0;  ///< frequency of `after_db`
    double boost_db = -400.0, boost_hz = 0.0;  ///< largest gain of the filter, at any frequency
    double loudest = std::numeric_limits<double>::infinity();  ///< peak of the loudest sine at the weakest frequency
    double loudest_hz = 0.0;
    struct Band {
        double hz;  ///< centre of the third octave
        double filter_db;  ///< largest gain of the filter in it
        double loudest;  ///< peak of the loudest sine at its weakest frequency
    };
    std::vector<Band> bands;
};

/// Effect of the limits on a recording, without and with the equaliser.
struct Programme {
    vibration::Headroom plain, equalised;
};

struct Equalisation {
    vibration::Equaliser equaliser;
    std::string title, unit;  ///< title and unit of the response
    const vibration::ActuatorModel* actuator = nullptr;
    double limit = 0.0;  ///< drive limit, V
    Flatness flat;
    std::optional<Programme> programme;  ///< with a signal only
    std::vector<std::string> notes{};  ///< defects of the signal's header
};

/// Throws Error.
Equalisation equalise(const EqualiseSettings& settings);

}  // namespace tactus::analysis
