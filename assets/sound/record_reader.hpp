// SPDX-License-Identifier: Apache-2.0
// Reads a vibration record in calibrated blocks: from a sound file, or from a CSV log resampled to a constant rate.
#pragma once

#include "assets/sound/calibration.hpp"
#include "assets/sound/stretch.hpp"
#include "assets/table/sample_log.hpp"
#include "dsp/signal/spectrum/level.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::sound {

/// Statistics of resampling an uneven log.
struct LogFacts {
    std::size_t rows = 0, lost_rows = 0, gaps = 0;
    double lost_seconds = 0.0;
    double shortest_step = 0.0, longest_step = 0.0;  ///< s
    double step_deviation = 0.0;         ///< s, standard deviation of the steps without gaps
    double clock_step = 0.0;             ///< s, of a coarse clock whose times were made even; 0: none
    std::vector<signal::Level> levels;   ///< per channel, of the rows themselves, calibrated
    std::vector<std::size_t> at_limit;  ///< rows at the ends of 16 bits in a channel of whole numbers
    table::LogForm form;
    double usable = 0.0;  ///< Hz, usable bandwidth given the uneven steps; at most half the mean rate

    /// Of the rows or of the time, whichever is larger: what is missing between the first and the last row.
    double lost_fraction = 0.0;

    bool is_even() const;  ///< the steps differ by less than a thousandth, without gaps
    /// What is missing, as warnings for each result of the record: gaps, rows without values.
    std::vector<std::string> missing() const;
};

/// A block with equal length in each channel.
struct RecordBlock {
    std::vector<std::vector<double>> channels;
    bool after_gap = false;  ///< does not continue the previous block

    std::size_t size() const { return channels.empty() ? 0 : channels.front().size(); }
};

class RecordReader {
public:
    /// Opens .csv, .tsv, .txt, .log, .lvm, .asc and .dat as logs, also .uff, .unv, .uf, .58, .bunv and .mat, others as
    /// sound. Without a calibration the one stated in the file is used; without that the values are not scaled. A
    /// sensitivity converts volts to the quantity that the sensor measured. Only `stretch` is read, and all statistics
    /// refer to it. Throws Error if the file cannot be used or is shorter.
    RecordReader(const std::filesystem::path& path, const table::LogSelection& selection,
                 const std::optional<Calibration>& calibration,
                 const std::optional<Sensitivity>& sensitivity = std::nullopt, const Stretch& stretch = {});
    ~RecordReader();
    RecordReader(RecordReader&&) noexcept;

    double rate() const noexcept;  ///< Hz
    std::size_t frames() const noexcept;
    const std::vector<std::string>& channels() const noexcept;  ///< names
    const Calibration& calibration() const noexcept;
    const std::optional<LogFacts>& log() const noexcept;
    const ReadStretch& stretch() const noexcept;

    /// Reads at most 65536 values per channel; false at the end. Throws Error when the file is damaged.
    bool next(RecordBlock& block);
    /// Returns to the start of the stretch. Throws Error if the file no longer exists.
    void rewind();

private:
    void calibrate(const std::optional<Calibration>& option, const std::optional<Sensitivity>& sensitivity);
    /// By the sensitivities that the header of a log states for its columns.
    void calibrate_as_stated();
    struct Source;
    std::unique_ptr<Source> source_;
};

}  // namespace tactus::sound
