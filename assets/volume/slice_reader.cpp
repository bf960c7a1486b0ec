// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/slice_reader.hpp"

#include "assets/file/room.hpp"
#include "dsp/core/stop.hpp"
#include "dsp/volume/value_range.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::volume {

void Tally::add(std::span<const float> slice, int k, const std::array<int, 3>& size) {
    if (slice.empty()) return;
    if (count == 0) low = std::numeric_limits<float>::infinity(), high = -low;
    const auto width = static_cast<std::size_t>(size[0]), rows = static_cast<std::size_t>(size[1]);
    const ValueRange range = range_of(slice);
    low = std::min(low, range.low), high = std::max(high, range.high);
    zeros += range.zeros;
    count += slice.size();
    const auto edge = [&](float value) { ++border, border_zeros += value == 0.0f; };
    if (k == 0 || k == size[2] - 1) {
        border += slice.size(), border_zeros += range.zeros;
    } else {
        for (std::size_t j = 0; j < rows; ++j) {
            const float* row = &slice[j * width];
            if (j == 0 || j == rows - 1) {
                for (std::size_t i = 0; i < width; ++i) edge(row[i]);
                continue;
            }
            edge(row[0]);
            if (width > 1) edge(row[width - 1]);
        }
    }
    if (!whole) return;
    whole = range.whole && low >= 0.0f && high <= 65535.0f;
    float last = -1.0f;
    for (std::size_t n = 0; whole && n < slice.size() && labels.size() <= 1000; ++n) {
        if (slice[n] == last) continue;
        last = slice[n];
        labels.insert(static_cast<int>(last));
    }
}

void Tally::add(const Tally& other) {
    if (other.count == 0) return;
    low = count == 0 ? other.low : std::min(low, other.low);
    high = count == 0 ? other.high : std::max(high, other.high);
    not_numbers += other.not_numbers;
    whole = whole && other.whole;
    count += other.count;
    zeros += other.zeros;
    border += other.border;
    border_zeros += other.border_zeros;
    if (whole && labels.size() <= 1000) labels.insert(other.labels.begin(), other.labels.end());
}

std::size_t SliceReader::read_finite(int k, std::span<float> values) {
    read(k, values);
    if (values.empty() || range_of(values).finite) return 0;
    float low = std::numeric_limits<float>::infinity();
    for (const float value : values)
        if (std::isfinite(value)) low = std::min(low, value);
    if (!std::isfinite(low)) low = 0.0f;
    std::size_t replaced = 0;
    for (float& value : values)
        if (!std::isfinite(value)) value = low, ++replaced;
    return replaced;
}

ScanVolume read_all(SliceReader& reader) {
    file::require_room(double(reader.about.count()) * sizeof(float), reader.about.source, "its samples");
    std::vector<float> values(reader.about.count());
    Tally tally;
    const std::size_t each = reader.slice_size();
    for (int k = 0; k < reader.about.size[2]; ++k) {
        leave_if_stopped();
        const auto slice = std::span(values).subspan(static_cast<std::size_t>(k) * each, each);
        tally.not_numbers += reader.read_finite(k, slice);
        tally.add(slice, k, reader.about.size);
    }
    reader.settle(tally);
    ScanVolume volume = reader.about;
    volume.values = std::move(values);
    return volume;
}

}  // namespace tactus::volume
