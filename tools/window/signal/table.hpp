// SPDX-License-Identifier: Apache-2.0
// What a scope shows, as CSV: units in the first line, times to the nanosecond, numbers without loss.
#pragma once

#include "tools/window/signal/plot.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace tactus::window {

/// A trace in a table, with the units of its columns. `name` stands before the names of its columns; may be empty.
struct TableTrace {
    const Trace* trace = nullptr;
    std::vector<std::string> units;
    std::string name = {};
};

/// The rows of traces in a time range, "time s,px m,…". A row holds what has its time; the other columns are empty there.
/// This and the others throw Error when the file cannot be written.
void write_csv(std::span<const TableTrace> traces, Range time, const std::filesystem::path& path);

/// The levels of the curves of a spectrum over the frequency.
void write_spectrum_csv(const Plot& plot, const std::filesystem::path& path);
/// A row per time, a column per frequency. A cell without values is empty.
void write_waterfall_csv(const Plot& plot, const std::filesystem::path& path);
/// The parts of a histogram with their shares.
void write_histogram_csv(const Plot& plot, const std::filesystem::path& path);
/// The pairs of a curve, in the order of time.
void write_pairs_csv(const Plot& plot, const std::filesystem::path& path);

}  // namespace tactus::window
