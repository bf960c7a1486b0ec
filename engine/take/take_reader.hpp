// SPDX-License-Identifier: Apache-2.0
// Reads a take, see engine/take/take_writer.hpp.
#pragma once

#include "engine/io/host.hpp"
#include "engine/take/take_stream.hpp"
#include "engine/take/take_writer.hpp"
#include "engine/take/timing_log.hpp"

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace tactus::take {

struct TakenAsset {
    std::string name;
    std::filesystem::path path;
    std::uint64_t hash = 0;
};
/// A plug-in with node types that was loaded (graph/plugin/plugins.hpp).
struct TakenPlugin {
    std::string name;
    std::filesystem::path path;  ///< where it was; nothing is loaded from there
    std::uint64_t hash = 0;
};
/// A plan that took over while the run went on.
struct TakenEdit {
    std::int64_t number = 0;
    Flicks when = 0;
    std::string text;
};
/// A parameter that was set during the run.
struct TakenChange {
    std::int64_t id = 0;
    std::string node, param;
    double value = 0.0;
};

/// A file of a take whose length differs from what the run wrote.
struct TakeDamage {
    std::string file;  ///< within the take
    std::int64_t holds = 0, written = 0;
    std::string unit;  ///< "values", "records", "lines"
};

struct Take {
    std::filesystem::path folder;
    TakeAbout about;
    std::string title, text, build, cpu;
    std::vector<TakenAsset> assets;  ///< of all plans
    std::vector<TakenPlugin> plugins;
    std::vector<std::variant<TakenEdit, TakenChange>> events;  ///< in the order they happened
    std::vector<io::RecordedDevice> devices;
    std::vector<TakeStreamInfo> streams;
    TimingLog log;
    std::optional<double> values_end_s;  ///< values end there by their limit, before the run
    std::int64_t lines = 0;  ///< number of lines of events.jsonl
    bool is_complete = false;  ///< the run ended normally; false: the take ends early
    std::map<std::string, std::uint64_t> result;  ///< hash of every output; empty if the take ends early
    std::map<std::string, std::int64_t> written;  ///< frames, records or lines by file; empty if the take ends early

    /// Throws Error if the folder is not a take or is damaged. An incomplete take is read up to its last whole record.
    static Take load(const std::filesystem::path& folder);

    /// Returns the reasons why a replay may differ: another machine, another build, changed files. Empty if there are
    /// none.
    std::vector<std::string> differences() const;
    /// Returns the assets that are missing or have changed, for which a replay will differ.
    std::vector<std::string> changed_assets() const;
    /// Returns the files whose length differs from the length that the run wrote. In an incomplete take only the log
    /// can be checked.
    std::vector<TakeDamage> damages() const;
    /// Throws Error unless the take holds all values of the run.
    void require_values() const;
    /// Removes unreadable streams.
    void drop_unreadable_streams();
};

}  // namespace tactus::take
