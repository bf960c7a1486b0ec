// SPDX-License-Identifier: Apache-2.0
// Compares two files and judges the result.
#pragma once

#include "assets/sound/record_reader.hpp"
#include "dsp/signal/spectrum/spectrogram.hpp"
#include "tools/analysis/vibration/verdict.hpp"

#include <array>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::analysis {

/// Selection of channels in records with several channels.
enum class Axes {
    strongest,  ///< the strongest channel of the reference, and the same of the output
    vector,     ///< the root sum of squares of the spectra of all channels
};

struct CompareSettings {
    std::filesystem::path reference, output;
    table::Thresholds thresholds;
    signal::ThresholdUnit touch = signal::ThresholdUnit::displacement;
    std::string actuator;                              ///< actuator whose limits define the level gap; empty: none
    double mass = 0.3;                                 ///< moving mass, kg
    double reference_scale = 1.0, output_scale = 1.0;  ///< units per full scale
    double longest_delay = std::numeric_limits<double>::infinity();  ///< s
    std::optional<int> channel;                        ///< of both, from 1; 0: the mean of all; none: by `axes`
    Axes axes = Axes::strongest;
    std::array<table::LogSelection, 2> logs;  ///< columns of the reference and the output if they are CSV
    std::array<sound::Stretch, 2> stretches{};  ///< of the reference and the output, each from its own start
    std::optional<std::pair<double, double>> plotted;  ///< Hz: the range of figures; none: that of the spectra
    bool pictures = false;  ///< also compute spectrograms
};

struct ComparedPair {
    std::filesystem::path reference, output;
    signal::Comparison comparison;
    Verdict verdict;
    table::Thresholds thresholds;
    signal::ThresholdUnit touch = signal::ThresholdUnit::displacement;
    double level_gap_db = 0.0;
    double not_judged =
        0.0;  ///< greater fraction of the power of a take outside of the judged band; 0: at most a tenth
    bool actuator_known = false;  ///< the level gap refers to an actuator at its limits
    std::array<sound::ReadStretch, 2> stretches{};  ///< the stretches of the reference and the output that were read
    std::optional<std::pair<double, double>> plotted;  ///< as in the settings
    std::vector<std::string> notes;
    std::vector<signal::Spectrogram> spectrograms;  ///< of reference and output, if requested
};

/// Computes the comparison of two takes, with spectrograms if requested. Throws Error.
void compare_takes(ComparedPair& pair, const signal::Take& reference, const signal::Take& output,
                   const signal::ComparisonOptions& options, bool pictures);

/// Compares `settings.reference` with `settings.output`. Throws Error.
ComparedPair compare_files(const CompareSettings& settings);

/// "displacement", "acceleration" or "none".
const char* touch_unit(signal::ThresholdUnit unit);
/// Its inverse.
signal::ThresholdUnit touch_of(std::string_view name);

/// Two files to compare; one is empty if a folder has no partner.
struct PairedFiles {
    std::filesystem::path reference, output;
};

/// Pairs two folders by name, or a file with every file of a folder. Throws Error for a folder without records.
std::vector<PairedFiles> paired_files(const std::filesystem::path& reference, const std::filesystem::path& output);

/// Returns the distinguishing file of a pair: the output, or the reference if all have the same output.
std::string pair_name(const ComparedPair& pair, std::span<const ComparedPair> all);

}  // namespace tactus::analysis
