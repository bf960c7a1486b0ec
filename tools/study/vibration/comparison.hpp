// SPDX-License-Identifier: Apache-2.0
// Two files compared, judged, and told as text and JSON.
#pragma once

#include "dsp/spectrum/spectrogram.hpp"
#include "tools/verbs.hpp"
#include "tools/study/vibration/verdict.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace tactus {

struct ComparedPair {
    std::filesystem::path reference, output;
    Comparison comparison;
    Verdict verdict;
    Thresholds thresholds;
    ThresholdUnit touch = ThresholdUnit::displacement;
    double level_gap_db = 0.0;
    bool actuator_known = false;            ///< the gap is that of an actuator at its limit
    std::vector<std::string> notes;
    std::vector<Spectrogram> spectrograms;  ///< of reference and output, when pictures are wanted
};

/// Fills in the comparison of two takes; spectrograms when pictures are wanted. Throws Error.
void compare_takes(ComparedPair& pair, const Take& reference, const Take& output, const ComparisonOptions& options,
                   bool pictures);

/// Compares `choice.reference` with `choice.output`. Throws Error.
ComparedPair compare_files(const CompareChoice& choice, const Thresholds& thresholds, bool pictures);

std::string comparison_json(const ComparedPair& pair);
/// On standard output.
void print(const ComparedPair& pair);

/// "displacement", "acceleration" or "none", and back.
const char* touch_unit(ThresholdUnit unit);
ThresholdUnit touch_of(const std::string& name);

}  // namespace tactus
