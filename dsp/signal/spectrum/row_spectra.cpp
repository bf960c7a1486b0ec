// SPDX-License-Identifier: Apache-2.0
#include "dsp/signal/spectrum/row_spectra.hpp"

#include <algorithm>

namespace tactus::signal {

RowSpectra::RowSpectra(const WelchSettings& settings, std::size_t values, std::size_t columns)
    : fresh_(settings),
      length_(settings.segment),
      hop_(std::max<std::size_t>(1, settings.segment / 2)),
      columns_(std::min(columns, settings.segment / 2 + 1)) {
    if (values > hop_ * (max_rows + 1)) length_ = hop_ = std::max(length_, (values + max_rows - 1) / max_rows);
}

void RowSpectra::push(std::span<const double> values) {
    held_.insert(held_.end(), values.begin(), values.end());
    std::size_t begin = 0;
    for (; begin + length_ <= held_.size(); begin += hop_) {
        WelchStream<double> row = fresh_;
        row.push(std::span(held_).subspan(begin, length_));
        const Spectrum spectrum = row.spectrum();
        rows_.emplace_back(spectrum.power.begin(), spectrum.power.begin() + static_cast<std::ptrdiff_t>(columns_));
    }
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(begin));
}

}  // namespace tactus::signal
