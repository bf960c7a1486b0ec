// SPDX-License-Identifier: Apache-2.0
// The common convention for levels: root mean square, in dB re 1 µm/s² (ISO 1683) for an acceleration; otherwise re
// full scale of a sound, for which a full sine has −3.01 dB, or re 1 of the unit.
#pragma once

#include "assets/sound/record_reader.hpp"

#include <string>

namespace tactus::analysis {

struct LevelReference {
    double value = 1.0;  ///< rms in the record's unit that corresponds to 0 dB
    std::string text;    ///< "1 µm/s²", "full scale", "1 count"

    double db(double mean_square) const;
};

LevelReference level_reference(const sound::Calibration& calibration);

}  // namespace tactus::analysis
