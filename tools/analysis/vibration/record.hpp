// SPDX-License-Identifier: Apache-2.0
// Records for analysis.
#pragma once

#include "assets/sound/record_reader.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::analysis {

/// Settings for reading a record, with its calibration.
struct RecordSettings {
    table::LogSelection log;
    std::string calibration;  ///< "9.81 m/s^2": quantity of a value of 1 (sound: full scale); empty: from the file
    std::string sensitivity;    ///< "100 mV/g" of a sensor whose volts were recorded; empty: none
    std::vector<int> channels;  ///< from 1; empty: all
    sound::Stretch stretch;     ///< the part to analyse
};

/// Opens a record. Throws Error.
sound::RecordReader open_record(const std::filesystem::path& file, const RecordSettings& settings);

/// Returns the interpretation of a record, one line each: the format of a log, its steps, the calibration.
std::vector<std::string> understood(const sound::Calibration& calibration, const std::optional<sound::LogFacts>& log,
                                    double rate);

/// Returns the indices of the selected channels. Throws Error naming the file if one is missing.
std::vector<std::size_t> chosen_channels(const sound::RecordReader& reader, const std::filesystem::path& file,
                                         const RecordSettings& settings);

/// Expands folders to their records in order of name.
std::vector<std::filesystem::path> expand_folders(const std::vector<std::filesystem::path>& files);

}  // namespace tactus::analysis
