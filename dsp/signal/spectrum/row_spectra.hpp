// SPDX-License-Identifier: Apache-2.0
// Spectra of consecutive sections of a record: the rows of a waterfall plot.
#pragma once

#include "dsp/signal/spectrum/welch.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::signal {

/// Each row is one segment, overlapping by half. For a long record, rows are averages of consecutive segments, so that
/// there are never more than `max_rows`.
class RowSpectra {
public:
    static constexpr std::size_t max_rows = 400;

    /// `values`: length of the record; `columns`: bins that are kept. A record shorter than a segment gives no row. Throws
    /// Error for settings that are invalid.
    RowSpectra(const WelchSettings& settings, std::size_t values, std::size_t columns);

    void push(std::span<const double> values);

    std::size_t length() const { return length_; }  ///< values per row
    std::size_t hop() const { return hop_; }  ///< from row to row
    /// Power per column, in the scaling of the settings.
    const std::vector<std::vector<float>>& rows() const { return rows_; }

private:
    WelchStream<double> fresh_;
    std::size_t length_, hop_, columns_;
    std::vector<double> held_;
    std::vector<std::vector<float>> rows_;
};

}  // namespace tactus::signal
