// SPDX-License-Identifier: Apache-2.0
// The rows of a sweep, merged from the logs of all workers.
#pragma once

#include "assets/sweep/row_log.hpp"
#include "tools/analysis/sweep/sweep_folder.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::analysis {

/// Points with a successful row, by index. A log that is not listed yet (a shared file system may delay it) only makes
/// its points run twice.
std::vector<bool> finished_points(const SweepFolder& folder);

/// Points are in the order of the task list, whoever ran them, and however often: equal rows of a point count once.
class Results {
public:
    enum class State : std::uint8_t { unfinished, failed, done };

    /// Reads the heads of all rows. Throws Error when a log cannot be read.
    explicit Results(const SweepFolder& folder);

    const SweepFolder& folder() const { return folder_; }
    std::size_t size() const { return places_.size(); }
    State state(std::size_t index) const { return places_[index].state; }
    std::size_t done() const { return done_; }
    std::size_t failed() const { return failed_; }
    std::size_t unfinished() const { return size() - done_ - failed_; }
    std::size_t repeated() const { return repeated_; }  ///< equal rows beyond the first
    std::size_t foreign() const { return foreign_; }    ///< rows of points that the sweep no longer has
    std::size_t damaged() const { return damaged_; }    ///< lines that are no rows
    /// Points with rows that differ, each with the reason. Such a sweep has no result.
    const std::vector<std::string>& conflicts() const { return conflicts_; }
    /// Throws Error if there is a conflict.
    void require_agreement() const;

    std::uint64_t output(std::size_t index) const { return places_[index].output; }
    /// The row of a point that is not unfinished. Throws Error.
    sweep::Row row(std::size_t index) const;
    /// Description of the worker that made it; an empty object if its log has none.
    const file::Json& worker(std::size_t index) const { return workers_[places_[index].log]; }
    /// Hash of all points with their outputs: two runs of a sweep with the same hash have the same results.
    std::uint64_t hash() const;

    /// Failures, most frequent first: reason, number of points, and the index of one of them with the step that failed
    /// (from 1; 0: its worker ended).
    struct Failure {
        std::string reason;
        std::size_t count = 0, example = 0;
        int step = 0;
    };
    std::vector<Failure> failures() const;

    /// Seconds of a point, mean over at most 400 that are spread over the sweep; nothing without any.
    std::optional<double> mean_seconds() const;
    /// Workers whose log has grown in the last two minutes, or within three points: processes times their jobs.
    std::size_t active_workers() const;

    /// All rows that are not unfinished, with levels, values and provenance; replaced as a whole. Throws Error, also for
    /// conflicts.
    void write_csv(const std::filesystem::path& path) const;
    /// The same as tables `results`, `workers` and `axes`.
    void write_sqlite(const std::filesystem::path& path) const;

private:
    struct Place {
        std::uint64_t at = 0, output = 0;
        std::uint32_t length = 0, log = 0;
        State state = State::unfinished;
    };

    const SweepFolder& folder_;
    std::vector<std::unique_ptr<sweep::LogReader>> logs_;
    std::vector<file::Json> workers_;
    std::vector<Place> places_;
    std::vector<std::string> conflicts_;
    std::size_t done_ = 0, failed_ = 0, repeated_ = 0, foreign_ = 0, damaged_ = 0;
};

}  // namespace tactus::analysis
