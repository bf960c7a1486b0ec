// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/sweep/sweep_folder.hpp"

#include "assets/bone/bone.hpp"
#include "assets/file/json.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "engine/take/take_writer.hpp"
#include "graph/patch/patch.hpp"
#include "graph/patch/sub_patch.hpp"

#include <fmt/format.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <map>

namespace tactus::analysis {

namespace fs = std::filesystem;
using file::Json;

namespace {

Json read_state(const fs::path& folder) {
    const fs::path path = folder / "sweep.json";
    const Json json = Json::parse_or_null(file::read_whole_file(path));
    if (!json.is_object() || json.value("format", 0) != sweep::sweep_format)
        throw Error(fmt::format("{}: not the state of a sweep", path.string()));
    return json;
}

}  // namespace

/// Hashes of files, which are read again only if their size or time has changed.
class SweepFolder::KnownHashes {
public:
    explicit KnownHashes(const Json& known) {
        if (!known.is_object()) return;
        for (const auto& [path, entry] : known.items())
            if (entry.is_array() && entry.size() == 3 && entry[2].is_string())
                if (const auto hash = sweep::id_of_text(entry[2].as_text()))
                    known_[path] = {{entry[0].get<std::int64_t>(), entry[1].get<std::int64_t>()}, *hash};
    }

    std::uint64_t operator()(const fs::path& path) {
        // Before it is read: a change meanwhile is noticed when its points run.
        Entry entry{stamp_of(path), 0};
        const auto known = known_.find(path.string());
        // A patch depends on other files.
        const bool is_known =
            path.extension() != ".toml" && known != known_.end() && known->second.stamp == entry.stamp;
        entry.hash = is_known ? known->second.hash : hash_of_input(path);
        used_[path.string()] = entry;
        return entry.hash;
    }

    Stamp stamp(const fs::path& path) const { return used_.at(path.string()).stamp; }
    Json json() const {
        Json all = Json::object();
        for (const auto& [path, entry] : used_)
            all[path] = Json::array({entry.stamp.size, entry.stamp.time, sweep::text_of_id(entry.hash)});
        return all;
    }

private:
    struct Entry {
        Stamp stamp;
        std::uint64_t hash = 0;
    };
    std::map<std::string, Entry> known_, used_;
};

SweepFolder::Stamp SweepFolder::stamp_of(const fs::path& path) {
    struct stat status{};
    if (::stat(path.c_str(), &status) != 0)
        throw Error(fmt::format("{}: cannot be read: {}", path.string(), std::strerror(errno)));
    return {status.st_size, status.st_mtim.tv_sec * 1'000'000'000 + status.st_mtim.tv_nsec};
}

void SweepFolder::keep_stamps(const KnownHashes& hashes) {
    for (const auto& [name, path] : sweep_.inputs) input_stamps_.emplace_back(path, hashes.stamp(path));
    for (const sweep::Axis& axis : sweep_.axes) {
        axis_stamps_.emplace_back();
        for (const fs::path& path : axis.files) axis_stamps_.back().push_back(hashes.stamp(path));
    }
}

fs::path SweepFolder::changed_file(const sweep::Point& point) const {
    const auto is_changed = [](const fs::path& path, const Stamp& stamp) {
        try {
            return stamp_of(path) != stamp;
        } catch (const Error&) {
            return true;
        }
    };
    for (const auto& [path, stamp] : input_stamps_)
        if (is_changed(path, stamp)) return path;
    for (std::size_t a = 0; a < axis_stamps_.size(); ++a) {
        if (axis_stamps_[a].empty()) continue;
        const std::size_t level = point.levels[a];
        const fs::path& path = sweep_.axes[a].files[level];
        if (is_changed(path, axis_stamps_[a][level])) return path;
    }
    return {};
}

bool is_sweep_folder(const fs::path& folder) {
    std::error_code ignored;
    return fs::is_regular_file(folder / "sweep.json", ignored);
}

std::uint64_t hash_of_input(const fs::path& path) {
    if (path.extension() != ".toml") {
        Hash hash;
        file::add_file(hash, path);
        return hash.value();
    }
    Hash hash;
    hash.add_word(take::hash_of_asset(path));
    patch::Problems problems;
    try {
        patch::Patch patch = patch::load_patch(path, problems);
        patch::read_parts(patch);
        for (const fs::path& part : patch::part_files(patch)) file::add_file(hash, part);
        patch::flatten(patch, problems);
        for (const patch::PatchAsset& asset : patch.assets)
            if (fs::exists(bone::file_of_bone(asset.path))) hash.add_word(take::hash_of_asset(asset.path));
    } catch (const Error&) {
        // Another kind of TOML file: its bytes are all of it.
    }
    return hash.value();
}

SweepFolder::SweepFolder(const fs::path& file, const fs::path& folder, const fs::path& library)
    : path_(fs::absolute(folder).lexically_normal()) {
    Json before;
    std::error_code failure;
    if (is_sweep_folder(path_)) before = read_state(path_);
    else if (fs::exists(path_, failure) && !fs::is_empty(path_, failure))
        throw Error(fmt::format("{}: is neither empty nor a sweep; choose another folder", path_.string()));
    sweep_ = sweep::load_sweep(file, {}, library);
    const Json* files = before.find("files");
    KnownHashes hashes(files ? *files : Json());
    tasks_ = std::make_unique<sweep::TaskList>(sweep_, std::ref(hashes));
    keep_stamps(hashes);
    fs::create_directories(path_ / "log", failure);
    if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", path_.string(), failure.message()));
    const Json state{{"format", sweep::sweep_format},
                     {"source", fs::absolute(file).lexically_normal().string()},
                     {"points", tasks_->size()},
                     {"list", sweep::text_of_id(tasks_->hash())},
                     {"files", hashes.json()}};
    // The copy first: a folder with sweep.json is whole.
    write_renamed(path_ / "sweep.toml", file::read_whole_file(file));
    write_renamed(path_ / "sweep.json", state.dump(2) + "\n");
}

SweepFolder::SweepFolder(const fs::path& folder, const fs::path& library)
    : path_(fs::absolute(folder).lexically_normal()) {
    if (!is_sweep_folder(path_))
        throw Error(fmt::format("{}: not a sweep folder; 'tactus sweep run SWEEP.toml -o {}' creates one",
                                folder.string(), folder.string()));
    const Json state = read_state(path_);
    const fs::path source = state["source"].as_text();
    sweep_ = sweep::load_sweep(path_ / "sweep.toml", source.parent_path(), library);
    const Json* files = state.find("files");
    KnownHashes hashes(files ? *files : Json());
    tasks_ = std::make_unique<sweep::TaskList>(sweep_, std::ref(hashes));
    keep_stamps(hashes);
    if (sweep::text_of_id(tasks_->hash()) != state["list"].as_text())
        throw Error(
            fmt::format("{}: an input of the sweep, or the files of an axis, have changed since it was prepared; "
                        "to follow them, call 'tactus sweep run {} -o {}'",
                        path_.string(), source.string(), path_.string()));
}

fs::path SweepFolder::files_of(std::uint64_t id) const {
    const std::string name = sweep::text_of_id(id);
    return path_ / "files" / name.substr(0, 2) / name;
}

std::string host_name() {
    std::array<char, 256> host{};
    ::gethostname(host.data(), host.size() - 1);
    return host.data();
}

std::string process_name() {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    return fmt::format("{}-{}-{:x}", host_name(), ::getpid(),
                       std::chrono::duration_cast<std::chrono::microseconds>(now).count());
}

void write_renamed(const fs::path& path, std::string_view bytes) {
    fs::path part = path;
    part += "." + process_name() + ".part";
    const auto fail = [&](int code) {
        ::unlink(part.c_str());
        throw Error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(code)));
    };
    const int handle = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (handle < 0) fail(errno);
    for (std::size_t written = 0; written < bytes.size();) {
        const ssize_t count = ::write(handle, bytes.data() + written, bytes.size() - written);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) {
            const int code = count < 0 ? errno : EIO;
            ::close(handle);
            fail(code);
        }
        written += static_cast<std::size_t>(count);
    }
    // NFS reports a full disk here.
    if (::close(handle) != 0 && errno != EINTR) fail(errno);
    if (std::rename(part.c_str(), path.c_str()) != 0) fail(errno);
}

}  // namespace tactus::analysis
