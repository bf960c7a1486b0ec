// SPDX-License-Identifier: Apache-2.0
// Records as they are analysed.
#pragma once

#include "assets/sound/record_reader.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::study {

/// How a record is read, and what its values are worth.
struct RecordSettings {
    table::LogSelection log;
    std::string calibration;  ///< "9.81 m/s^2": worth of a value of 1, for sound of full scale; empty: as the file says
    std::vector<int> channels;  ///< from 1; empty: all
};

/// Opens a record. Throws Error.
sound::RecordReader open_record(const std::filesystem::path& file, const RecordSettings& settings);

/// Indices of the wanted channels. Throws Error naming the file when one is missing.
std::vector<std::size_t> chosen_channels(const sound::RecordReader& reader, const std::filesystem::path& file,
                                         const RecordSettings& settings);

/// Folders give the records that lie in them, in order of name; files give themselves.
std::vector<std::filesystem::path> expand_folders(const std::vector<std::filesystem::path>& files);

/// All of the chosen channels of a record in memory: records of at most 2^28 values. Pieces between gaps must be one.
struct WholeRecord {
    double rate = 0.0;  ///< Hz
    std::vector<std::string> names;
    std::vector<std::vector<double>> channels;
    sound::Calibration calibration;
};
WholeRecord read_whole(const std::filesystem::path& file, const RecordSettings& settings);

}  // namespace tactus::study
