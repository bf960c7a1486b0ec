// SPDX-License-Identifier: Apache-2.0
#include "assets/table/repeated_rows.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace tactus::table {

namespace {

/// Calls use(row, has_equal_time, has_equal_values) for each row, compared with the one before; a row is its time and values.
template <class Use>
void compare_rows(const SampleLog& log, const Use& use) {
    constexpr std::size_t block = 4096;
    const std::size_t width = log.columns.size() + 1;
    std::vector<std::vector<double>> read(width);
    std::vector<double> row(width), before;
    for (std::size_t first = 0; first < log.times.size(); first += block) {
        const std::size_t count = std::min(block, log.times.size() - first);
        for (std::vector<double>& values : read) values.resize(count);
        log.times.read(first, read[0]);
        for (std::size_t c = 1; c < width; ++c) log.columns[c - 1].read(first, read[c]);
        for (std::size_t i = 0; i < count; ++i) {
            for (std::size_t c = 0; c < width; ++c) row[c] = read[c][i];
            const bool has_before = !before.empty();
            use(row, has_before && row[0] == before[0],
                has_before && std::equal(row.begin() + 1, row.end(), before.begin() + 1));
            before = row;
        }
    }
}

}  // namespace

std::size_t leave_out_repeated_rows(SampleLog& log) {
    std::size_t equal_times = 0, repeated = 0, other_times = 0, at_rest = 0;
    compare_rows(log, [&](const std::vector<double>&, bool has_equal_time, bool has_equal_values) {
        equal_times += has_equal_time, other_times += !has_equal_time;
        repeated += has_equal_time && has_equal_values;
        at_rest += !has_equal_time && has_equal_values;
    });
    // A few rows show nothing.
    if (repeated == 0 || other_times < 16 || 20 * repeated < 19 * equal_times || 10 * at_rest > other_times) return 0;
    PackedColumn times;
    std::vector<PackedColumn> columns(log.columns.size());
    compare_rows(log, [&](const std::vector<double>& row, bool has_equal_time, bool has_equal_values) {
        if (has_equal_time && has_equal_values) return;
        times.push_back(row[0]);
        for (std::size_t c = 0; c < columns.size(); ++c) columns[c].push_back(row[c + 1]);
    });
    log.times = std::move(times);
    log.columns = std::move(columns);
    return repeated;
}

}  // namespace tactus::table
