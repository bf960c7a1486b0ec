// SPDX-License-Identifier: Apache-2.0
// The files of values in a take, one for each group, and their lines in events.jsonl.
#pragma once

#include "engine/io/frames.hpp"
#include "engine/io/streams.hpp"

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

namespace tactus::run {
class GroupRuntime;
}

namespace tactus::take {

struct TakeFile;

/// Bytes of values with which a take of an hour stays small: a hand at 1 kHz that moves all the time has 217 MB of decisions.
inline constexpr std::uint64_t max_first_bytes = 30'000'000;

class TakeStreams {
public:
    /// `write_line` adds a line to events.jsonl when a file is opened; it may throw Error, and is called by any thread that
    /// drains a stream.
    explicit TakeStreams(std::function<void(const std::string&)> write_line) : write_line_(std::move(write_line)) {}

    /// Returns the sink for the frames of a group: files of at most `max_channels` channels in the take `folder`, opened at
    /// the first frame.
    std::unique_ptr<io::Sink> sink(const std::filesystem::path& folder, const io::FrameLayout& layout,
                                   const run::GroupRuntime& group);
    /// Values end where all files together have `bytes`: each file at the same time, which depends on nothing but the outputs
    /// and the times of edits. 0: no limit, for files whose values have not ended yet.
    void limit(std::uint64_t bytes);
    /// Time at which the values of an output ended first by the limit, s from the begin of the run; none: they did not. Any
    /// thread.
    std::optional<double> limited_at() const;
    /// True if one of the files ends before the run.
    bool is_cut() const noexcept { return is_cut_; }
    /// Number of frames of each completed file.
    std::map<std::string, std::int64_t> frames() const;

private:
    /// Returns a name that no other file of the take has.
    std::string file_for(const std::string& group);
    void opened(const TakeFile& file, std::int64_t start, const run::GroupRuntime& group);
    /// The values of one group between two edits.
    struct Part {
        int group = 0;
        double bytes_per_second = 0.0;
        double begin = 0.0, end = 0.0;  // s; infinite: not known yet
        bool has_values = false;
    };
    /// Returns the activation from which on a part has no values, which has some from `first` on.
    std::int64_t end_of(std::size_t part, std::int64_t first, Flicks period);
    /// After a change of the parts or of the limit.
    void find_full();
    void limited(double end);

    std::function<void(const std::string&)> write_line_;
    mutable std::mutex guard_;
    std::map<std::string, std::int64_t> frames_;  // under it, as are the next four
    std::vector<Part> parts_;  // of each sink
    std::optional<double> limited_at_;  // s
    std::uint64_t max_bytes_ = 0;  // 0: no limit
    double full_at_ = 0.0;  // s: all parts that have begun have the bytes of the limit
    std::atomic<bool> is_cut_{false};
    std::unordered_set<std::string> files_;
};

}  // namespace tactus::take
