// SPDX-License-Identifier: Apache-2.0
// A record of vibration, whatever its file: sound, or a CSV log brought to an even rate; in blocks, calibrated.
#pragma once

#include "assets/table/sample_log.hpp"

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace tactus::sound {

/// What a value of 1 in the file (for sound: full scale) is worth.
struct Calibration {
    double factor = 1.0;
    std::string unit = "full scale";
    bool known = false;
    /// SI value of one `unit`, and whether that is an acceleration.
    double si = 1.0;
    bool is_acceleration = false;
};

/// "9.81 m/s²", "0.02 mm/s". Throws Error naming what is expected.
Calibration parse_calibration(const std::string& text);

/// What making a log even has left and lost.
struct LogFacts {
    std::size_t rows = 0, lost_rows = 0, gaps = 0;
    double lost_seconds = 0.0;
    double shortest_step = 0.0, longest_step = 0.0;  ///< s
    double usable = 0.0;  ///< Hz up to which the uneven steps carry; half the mean rate is the limit of all
};

/// One block: as many values in each channel.
struct RecordBlock {
    std::vector<std::vector<double>> channels;
    bool after_gap = false;  ///< does not continue the block before

    std::size_t size() const { return channels.empty() ? 0 : channels.front().size(); }
};

class RecordReader {
public:
    /// Files that end in .csv, .tsv, .txt or .log are logs, all others sound. Without a calibration the values stay as they
    /// are. Throws Error when the file cannot be used.
    RecordReader(const std::filesystem::path& path, const table::LogSelection& selection,
                 const std::optional<Calibration>& calibration);
    ~RecordReader();
    RecordReader(RecordReader&&) noexcept;

    double rate() const noexcept;  ///< Hz
    std::size_t frames() const noexcept;
    const std::vector<std::string>& channels() const noexcept;  ///< names
    const Calibration& calibration() const noexcept;
    const std::optional<LogFacts>& log() const noexcept;

    /// At most 65536 values per channel; false at the end. Throws Error when the file is damaged.
    bool next(RecordBlock& block);
    /// Back to the start. Throws Error when the file has gone.
    void rewind();

private:
    struct Source;
    std::unique_ptr<Source> source_;
};

}  // namespace tactus::sound
