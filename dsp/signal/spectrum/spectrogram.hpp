// SPDX-License-Identifier: Apache-2.0
// Spectrogram with a fixed number of columns for records of any length.
#pragma once

#include "dsp/signal/spectrum/segment_fft.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

class Spectrogram {
public:
    static constexpr std::size_t max_columns = 1024;

    /// Hann segments of `segment` samples with 50 % overlap; `rate` in Hz.
    Spectrogram(std::size_t segment, double rate);

    /// Any number of samples. When the columns are full, pairs are averaged, which doubles the duration of a column.
    void push(std::span<const double> samples);

    std::size_t bins() const noexcept { return transform_.bins(); }
    std::size_t columns() const noexcept { return columns_.size(); }
    double df() const noexcept { return df_; }  ///< Hz
    double column_seconds() const noexcept;
    /// Density (unit²/Hz) per bin, averaged over the column's time.
    std::span<const float> column(std::size_t i) const noexcept { return columns_[i]; }

private:
    void add_column();

    SegmentFft<double> transform_;
    double rate_, df_, scale_;
    std::size_t step_, held_ = 0, per_column_ = 1, in_column_ = 0;
    std::vector<double> waiting_, sum_;
    std::vector<std::vector<float>> columns_;
};

}  // namespace tactus::signal
