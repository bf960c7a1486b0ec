// SPDX-License-Identifier: Apache-2.0
// A take: a folder with everything needed to repeat a run and to verify the repetition. Files only grow, and after a
// crash can be read up to the last second:
//
//   take.json       the patch, what the command line changed, hashes of assets, build, CPU family, seconds asked for
//   patch-N.toml    the text of the plan numbered N, 0 first
//   events.jsonl    one line for each edit, each parameter set, each device opened, each file of streams
//   timing.log      everything that timing decided, see engine/take/timing_log.hpp
//   streams/        every published value of every output, a file for each group, see engine/take/take_stream.hpp
//   result.json     when the run came to its end and every stream is whole: hash of every output, and how much each file
//                   of the take holds
#pragma once

#include "assets/file/growing_file.hpp"
#include "engine/io/host.hpp"
#include "engine/io/streams.hpp"
#include "engine/take/take_stream.hpp"
#include "engine/take/take_streams.hpp"
#include "engine/take/timing_log.hpp"
#include "graph/patch/patch.hpp"

#include <atomic>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

namespace tactus::take {

/// Format number of take.json. Format 2, with one file per output, can be read as well; other formats are rejected.
constexpr int take_format = 3, oldest_take_format = 2;

/// Description of a run in its take.
struct TakeAbout {
    std::filesystem::path patch_file;  ///< absolute
    patch::PatchOverrides overrides;
    std::optional<std::uint64_t> seed;
    double seconds = 0.0;
    bool live = false;
};

/// If the disk is full during the run, the take keeps its data, can repeat the run up to that point, and stops growing.
class TakeWriter {
public:
    /// Creates the folder; a folder with other content is rejected. Throws Error.
    TakeWriter(std::filesystem::path folder, TakeAbout about);
    /// Removes the files of a run that never started, so that the folder can be used again.
    ~TakeWriter();
    TakeWriter(const TakeWriter&) = delete;
    TakeWriter& operator=(const TakeWriter&) = delete;

    /// Sets the first plan; call before anything is recorded.
    void begin(const patch::Patch& patch, std::uint64_t plan_hash);
    void device(const io::DeviceSlot& slot);
    /// Returns the sink for the frames of a group: files of at most `max_channels` channels, opened at the first
    /// frame.
    std::unique_ptr<io::Sink> sink(const io::FrameLayout& layout, const run::GroupRuntime& group);
    /// As TakeStreams::limit and TakeStreams::limited_at.
    void limit_values(std::uint64_t bytes) { streams_.limit(bytes); }
    std::optional<double> values_limited_at() const { return streams_.limited_at(); }
    /// Describes the assets of an edit, which reads all of them. Any thread. Throws Error.
    static std::string describe_assets(const patch::Patch& patch);
    /// Records the plan that takes over at `when`; `assets` from describe_assets.
    void edit(std::int64_t number, Flicks when, const patch::Patch& patch, const std::string& assets);
    void change(std::int64_t id, std::int64_t plan, const std::string& node, const std::string& param, double value);
    void record(const TimingRecord& record);
    /// Progress of each group (index in the log, activation, logical time) before the last records were written.
    struct Progress {
        int group;
        std::int64_t done;
        Flicks time;
    };
    void checkpoint(const std::vector<Progress>& progress);
    void finish(const std::vector<std::pair<std::string, std::uint64_t>>& port_hashes);
    /// Reason why the take repeats only a part of the run; empty if it repeats all of it. Any thread.
    std::string loss() const;
    bool is_lost() const { return is_lost_; }
    /// Marks the take as valid only up to the current time.
    void lose(const std::string& why);

    const std::filesystem::path& folder() const { return folder_; }
    /// Renames the folder, on the same disk, while it grows. Throws Error.
    void move_to(const std::filesystem::path& folder);
    /// Current size of its log, bytes.
    std::uint64_t size() const { return log_ ? log_->size() : 0; }

private:
    void line(const std::string& json);
    std::filesystem::path folder_;
    TakeAbout about_;
    std::unique_ptr<TimingLogWriter> log_;
    std::unique_ptr<file::GrowingFile> events_;
    mutable std::mutex writing_;  // every thread that drains a stream writes lines
    std::int64_t lines_ = 0;  // of events.jsonl
    std::atomic<bool> is_lost_{false};
    std::atomic<bool> holds_a_run_{false};  // some data of a run was written
    std::string loss_;
    TakeStreams streams_;
    std::int64_t flush_ns_ = 0;  // of the next flush
    std::uint64_t flush_bytes_ = 0;  // log size at which a flush is due, if not due by time
};

/// Returns the hash of a file's bytes; for a text that names other files, including their bytes. Throws Error.
std::uint64_t hash_of_asset(const std::filesystem::path& path);
/// Identifies the code that computes: the same in all programs of one build (cmake/identity.cmake).
std::string build_identity();
/// Returns vendor, family and model of the processor, as far as they may affect rounding.
std::string cpu_family();

}  // namespace tactus::take
