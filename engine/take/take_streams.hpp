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
#include <string>
#include <unordered_set>

namespace tactus::run {
class GroupRuntime;
}

namespace tactus::take {

struct TakeFile;

class TakeStreams {
public:
    /// `write_line` adds a line to events.jsonl when a file is opened; it may throw Error, and is called by any thread that
    /// drains a stream.
    explicit TakeStreams(std::function<void(const std::string&)> write_line) : write_line_(std::move(write_line)) {}

    /// Returns the sink for the frames of a group: files of at most `max_channels` channels in the take `folder`, opened at
    /// the first frame.
    std::unique_ptr<io::Sink> sink(const std::filesystem::path& folder, const io::FrameLayout& layout,
                                   const run::GroupRuntime& group);
    /// True if one of the files ends before the run.
    bool is_cut() const noexcept { return is_cut_; }
    /// Number of frames of each completed file.
    std::map<std::string, std::int64_t> frames() const;

private:
    /// Returns a name that no other file of the take has.
    std::string file_for(const std::string& group);
    void opened(const TakeFile& file, std::int64_t start, const run::GroupRuntime& group);

    std::function<void(const std::string&)> write_line_;
    mutable std::mutex finishing_;
    std::map<std::string, std::int64_t> frames_;
    std::atomic<bool> is_cut_{false};
    std::unordered_set<std::string> files_;
};

}  // namespace tactus::take
