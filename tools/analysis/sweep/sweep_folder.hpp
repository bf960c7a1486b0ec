// SPDX-License-Identifier: Apache-2.0
// The folder of a sweep:
//
//   DIR/sweep.toml        the sweep as it is run
//   DIR/sweep.json        where it came from, hashes of its inputs and of its task list
//   DIR/log/              rows of finished points, a file per worker (assets/sweep/row_log.hpp)
//   DIR/files/            kept files: files/3f/3f0123456789abcd/
//   DIR/results.csv, DIR/results.sqlite   the table; made from the logs at any time
//
// Only files with names of their own are created, and whole files are renamed into place. No locks: those of shared file
// systems are often missing or local to a machine.
#pragma once

#include "assets/sweep/sweep_file.hpp"
#include "assets/sweep/task_list.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace tactus::analysis {

/// A sweep with its task list. Neither copied nor moved: the list refers to the sweep.
class SweepFolder {
public:
    /// Prepares `folder` for the sweep of `file`, or makes it follow the file as it is now: points that both have stay
    /// finished. `library`: the bundled library. Throws Error.
    SweepFolder(const std::filesystem::path& file, const std::filesystem::path& folder,
                const std::filesystem::path& library);
    /// Opens a prepared folder. Throws Error when it is none, or when an input has changed since.
    SweepFolder(const std::filesystem::path& folder, const std::filesystem::path& library);
    SweepFolder(const SweepFolder&) = delete;
    SweepFolder& operator=(const SweepFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    const sweep::Sweep& sweep() const { return sweep_; }
    const sweep::TaskList& tasks() const { return *tasks_; }
    /// Folder of the kept files of a point.
    std::filesystem::path files_of(std::uint64_t id) const;
    /// An input or a file of the point's levels whose size or time is no longer that of the hashed file: a result of the
    /// point would carry the name of other contents. Empty: none.
    std::filesystem::path changed_file(const sweep::Point& point) const;

private:
    struct Stamp {
        std::int64_t size = 0, time = 0;  ///< bytes, ns
        bool operator==(const Stamp&) const = default;
    };
    class KnownHashes;
    static Stamp stamp_of(const std::filesystem::path& path);
    void keep_stamps(const KnownHashes& hashes);

    std::filesystem::path path_;
    sweep::Sweep sweep_;
    std::unique_ptr<sweep::TaskList> tasks_;
    std::vector<std::pair<std::filesystem::path, Stamp>> input_stamps_;
    std::vector<std::vector<Stamp>> axis_stamps_;  ///< by axis and level; empty for axes without files
};

/// True if the folder has been prepared.
bool is_sweep_folder(const std::filesystem::path& folder);

/// Hash of an input: of its bytes; of a patch also of its sub-patches and assets. Throws Error.
std::uint64_t hash_of_input(const std::filesystem::path& path);

/// Writes under a name that no other process uses and renames the file into place. Throws Error.
void write_renamed(const std::filesystem::path& path, std::string_view bytes);
/// Of this machine.
std::string host_name();
/// "HOST-PID-TIME": unique among the processes that share a file system.
std::string process_name();

}  // namespace tactus::analysis
