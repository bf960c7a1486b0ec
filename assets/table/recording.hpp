// SPDX-License-Identifier: Apache-2.0
// Measured channels of files that are no text tables: universal files and MATLAB files.
#pragma once

#include "assets/table/sample_log.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace tactus::table {

/// Samples of one channel, or the times of others.
struct RecordedChannel {
    std::string name, unit;      ///< unit: as written; empty: none
    std::vector<double> values;
    double rate = 0.0;           ///< Hz, as the file states it; 0: it does not
    std::size_t group = 0;       ///< channels of one group have one clock and length
};

struct Recording {
    std::string format;      ///< what was read and left out: "UFF58, 3 of 4 datasets: 1 without times left out"
    std::string rate_place;  ///< where the rate is stated: "the abscissa", "variable 'fs'"
    std::vector<RecordedChannel> channels;
};

/// Chooses columns, times and their unit as read_sample_log does. Throws Error when channels with several clocks are to choose from.
SampleLog log_of_recording(const Recording& recording, const std::string& file, const LogSelection& selection);

/// True for files that begin with the delimiter of a universal file, and the number of a dataset.
bool is_universal_file(std::string_view start);
/// Functions of time in datasets 58 and 58b (text; IEEE binary of either byte order): real, single or double, even or uneven.
/// Functions of other abscissae are left out and counted. Throws Error for damaged files and for those without such a function.
Recording read_universal_file(std::string_view bytes, const std::string& file);

/// True for files of MATLAB 5 to 7.3.
bool is_matlab_file(std::string_view start);
/// Real vectors and matrices (one channel per column) of version 5 files, packed or not, at the top or in a structure, with at least
/// four samples. A scalar called fs, dt or alike is the rate or interval. Channels are grouped by their length; everything else is
/// left out and counted. Throws Error for damaged files and for version 7.3, which is HDF5.
Recording read_matlab_file(std::string_view bytes, const std::string& file);

}  // namespace tactus::table
