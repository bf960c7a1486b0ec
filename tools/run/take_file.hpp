// SPDX-License-Identifier: Apache-2.0
// A file as a take for comparison: one channel, or the mean of all, read from disk as often as needed.
#pragma once

#include "assets/sound/record_reader.hpp"
#include "dsp/signal/spectrum/comparison.hpp"

#include <memory>
#include <string>
#include <vector>

namespace tactus::run {

struct TakeChoice {
    std::filesystem::path file;
    std::string role;      ///< "reference" or "output", for messages
    table::LogSelection log;
    /// Units per full scale, or per unit of a log; 1: as stated in the file, accelerations in m/s².
    double scale = 1.0;
    int channel = 0;       ///< from 1; 0: the mean of all
    sound::Stretch stretch{};
};

struct ChannelLevels {
    std::vector<std::string> names;
    std::vector<double> rms;  ///< about the mean
    std::size_t strongest() const;  ///< index
};

/// Reads a file with several channels once. Throws Error.
ChannelLevels channel_levels(const std::filesystem::path& file, const table::LogSelection& log,
                             const sound::Stretch& stretch = {});

class TakeFile {
public:
    /// Reads the stretch once. For a log with gaps, the longest part is the take. Throws Error.
    explicit TakeFile(const TakeChoice& choice);

    signal::Take take() const;
    const std::filesystem::path& file() const { return choice_.file; }
    double rate() const { return reader_->rate(); }  ///< Hz
    const sound::ReadStretch& stretch() const { return reader_->stretch(); }
    double peak() const { return peak_; }            ///< greatest absolute value, scaled
    /// True if the values are in SI units according to the file.
    bool is_calibrated() const { return is_calibrated_; }
    const std::vector<std::string>& notes() const { return notes_; }

private:
    /// Computes the value of the channel, or the mean, per frame.
    void mix(const sound::RecordBlock& block, std::vector<double>& out) const;

    TakeChoice choice_;
    std::shared_ptr<sound::RecordReader> reader_;
    std::size_t piece_ = 0, frames_ = 0;  // index and length of the part
    double peak_ = 0.0, factor_ = 1.0;
    bool is_calibrated_ = false;
    std::vector<std::string> notes_;
};

}  // namespace tactus::run
