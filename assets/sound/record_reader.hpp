// SPDX-License-Identifier: Apache-2.0
// Reads a vibration record in calibrated blocks: from a sound file, or from a CSV log resampled to a constant rate.
#pragma once

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

/// Calibration: the quantity of a value of 1 in the file (for sound: full scale).
struct Calibration {
    double factor = 1.0;
    std::string unit = "full scale";
    bool known = false;
    /// scale to SI; true when the unit is an acceleration
    double si = 1.0;
    bool is_acceleration = false;
};

/// "9.81 m/s²", "0.02 mm/s". Throws Error naming what is expected.
Calibration parse_calibration(const std::string& text);

/// Statistics of resampling an uneven log.
struct LogFacts {
    std::size_t rows = 0, lost_rows = 0, gaps = 0;
    double lost_seconds = 0.0;
    double shortest_step = 0.0, longest_step = 0.0;  ///< s
    std::vector<signal::Level> levels;   ///< per channel, of the rows themselves, calibrated
    std::vector<std::size_t> at_limit;  ///< rows at the ends of 16 bits in a channel of whole numbers
    double usable = 0.0;  ///< Hz, usable bandwidth given the uneven steps; at most half the mean rate
};

/// A block with equal length in each channel.
struct RecordBlock {
    std::vector<std::vector<double>> channels;
    bool after_gap = false;  ///< does not continue the previous block

    std::size_t size() const { return channels.empty() ? 0 : channels.front().size(); }
};

class RecordReader {
public:
    /// Opens .csv, .tsv, .txt and .log as logs, others as sound. Without a calibration the values are not scaled.
    /// Reads only `stretch`; all that is said of the record is then said of that. Throws Error when the file cannot be
    /// used, or is shorter.
    RecordReader(const std::filesystem::path& path, const table::LogSelection& selection,
                 const std::optional<Calibration>& calibration, const Stretch& stretch = {});
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
    /// Returns to the start of the stretch. Throws Error when the file is gone.
    void rewind();

private:
    struct Source;
    std::unique_ptr<Source> source_;
};

}  // namespace tactus::sound
