// SPDX-License-Identifier: Apache-2.0
// Two files compared and judged.
#pragma once

#include "assets/sound/record_reader.hpp"
#include "dsp/signal/spectrum/spectrogram.hpp"
#include "tools/study/vibration/verdict.hpp"

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tactus::study {

struct CompareSettings {
    std::filesystem::path reference, output;
    table::Thresholds thresholds;
    signal::ThresholdUnit touch = signal::ThresholdUnit::displacement;
    std::string actuator;                              ///< whose limits decide the level gap; empty: none
    double mass = 0.3;                                 ///< that it shakes, kg
    double reference_scale = 1.0, output_scale = 1.0;  ///< units per full scale
    double longest_delay = 2.0;                        ///< s
    int channel = 0;                                   ///< 0: the mean of all
    std::array<table::LogSelection, 2> logs;  ///< how the reference and the output are read if they are CSV
    bool pictures = false;  ///< spectrograms are wanted
};

struct ComparedPair {
    std::filesystem::path reference, output;
    signal::Comparison comparison;
    Verdict verdict;
    table::Thresholds thresholds;
    signal::ThresholdUnit touch = signal::ThresholdUnit::displacement;
    double level_gap_db = 0.0;
    bool actuator_known = false;  ///< the gap is that of an actuator at its limit
    std::vector<std::string> notes;
    std::vector<signal::Spectrogram> spectrograms;  ///< of reference and output, when pictures are wanted
};

/// Fills in the comparison of two takes; spectrograms when pictures are wanted. Throws Error.
void compare_takes(ComparedPair& pair, const signal::Take& reference, const signal::Take& output,
                   const signal::ComparisonOptions& options, bool pictures);

/// Compares `settings.reference` with `settings.output`. Throws Error.
ComparedPair compare_files(const CompareSettings& settings);

/// "displacement", "acceleration" or "none".
const char* touch_unit(signal::ThresholdUnit unit);

/// Two files to be compared; one is empty when a folder has no partner for the other.
struct PairedFiles {
    std::filesystem::path reference, output;
};

/// Of two folders, or of a file and a folder: every output with the reference of its name, or with the only one; and the
/// other way round. Throws Error for a folder without records.
std::vector<PairedFiles> paired_files(const std::filesystem::path& reference, const std::filesystem::path& output);

/// What tells the pairs apart: the output, or the reference when all share one output.
std::string pair_name(const ComparedPair& pair, std::span<const ComparedPair> all);

}  // namespace tactus::study
