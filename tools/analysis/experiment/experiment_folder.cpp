// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/experiment/experiment_folder.hpp"

#include "assets/bone/bone.hpp"
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "engine/take/take_writer.hpp"
#include "graph/patch/patch.hpp"
#include "graph/patch/sub_patch.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <sstream>

namespace tactus::analysis {

namespace fs = std::filesystem;
using experiment::FrozenFile;
using experiment::Protocol;
using experiment::SubjectEntry;

namespace {

constexpr const char *state_name = "experiment.json", *frozen_name = "frozen";

std::string hash_of(const fs::path& file) {
    Hash hash;
    file::add_file(hash, file);
    return fmt::format("{:016x}", hash.value());
}

struct UsedFiles {
    std::vector<fs::path> texts;  ///< the protocol first, then all that it names, and the patches within those patches
    std::vector<fs::path> assets;  ///< other files that the patches load
};

UsedFiles used_files(const Protocol& protocol) {
    UsedFiles used{protocol.files(), {}};
    const auto add = [](std::vector<fs::path>& to, const fs::path& file) {
        if (std::ranges::find(to, file) == to.end()) to.push_back(file);
    };
    const auto add_patch = [&](const fs::path& patch_file) {
        if (patch_file.empty()) return;
        patch::Problems problems;
        patch::Patch loaded = patch::load_patch(patch_file, problems);
        patch::read_parts(loaded);
        for (const fs::path& part : patch::part_files(loaded)) add(used.texts, fs::absolute(part).lexically_normal());
        for (const patch::PatchAsset& asset : loaded.assets) {
            add(used.assets, fs::absolute(bone::file_of_bone(asset.path)).lexically_normal());
        }
    };
    add_patch(protocol.patch);
    for (const experiment::Task& task : protocol.tasks) add_patch(task.patch);
    std::erase_if(used.assets, [&](const fs::path& file) {
        return std::ranges::find(used.texts, file) != used.texts.end() || !fs::is_regular_file(file);
    });
    return used;
}

/// With the files that a recording set, a task or another TOML file names, in whatever folder.
std::vector<FrozenFile> hashes_of(const std::vector<fs::path>& assets, const Protocol& protocol) {
    std::vector<FrozenFile> hashes;
    for (const fs::path& file : assets)
        hashes.push_back({file.lexically_relative(protocol.file.parent_path()).string(),
                          fmt::format("{:016x}", take::hash_of_asset(file))});
    return hashes;
}

/// Relative to the lowest folder that holds all files: their copies name each other as the files do.
std::string frozen_file_name(const Protocol& protocol, const std::vector<fs::path>& files, const fs::path& file) {
    fs::path root = protocol.file.parent_path();
    for (const fs::path& one : files)
        while (root.has_relative_path() && *one.lexically_relative(root).begin() == "..") root = root.parent_path();
    return file.lexically_relative(root).string();
}

/// "line 12: 'min = 0.02' is now 'min = 0.05'"; the first difference.
std::string first_difference(const std::string& before, const std::string& now) {
    std::istringstream a(before), b(now);
    std::string x, y;
    for (int line = 1;; ++line) {
        const bool more_a = static_cast<bool>(std::getline(a, x)), more_b = static_cast<bool>(std::getline(b, y));
        if (!more_a && !more_b) return "the ends of lines";
        if (!more_a) return fmt::format("line {}: '{}' was added", line, y);
        if (!more_b) return fmt::format("line {}: '{}' was removed", line, x);
        if (x != y) return fmt::format("line {}: '{}' is now '{}'", line, x, y);
    }
}

}  // namespace

bool is_experiment_result(std::string_view name) {
    return std::ranges::any_of(result_stems, [name](std::string_view stem) {
        return name.starts_with(stem) && name.size() > stem.size() + 1 && name[stem.size()] == '.';
    });
}

void check_subject_name(const std::string& name) {
    const auto is_plain = [](char c) {
        return static_cast<unsigned char>(c) < 128 && std::isalnum(static_cast<unsigned char>(c)) != 0;
    };
    if (name.empty() || name.size() > 40 || !std::ranges::all_of(name, is_plain))
        throw Error(fmt::format(
            "--subject '{}': must be a pseudonym of 1 to 40 letters a to z and digits, as P07; not a name", name));
}

ExperimentFolder::ExperimentFolder(const fs::path& folder, const Protocol& protocol) : folder_(folder) {
    std::error_code failure;
    fs::create_directories(folder_, failure);
    if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", folder_.string(), failure.message()));
    lock();
    try {
        if (fs::exists(folder_ / state_name)) {
            file_ = experiment::load_experiment_file(folder_ / state_name);
            if (file_.name != protocol.name)
                throw Error(fmt::format("{}: holds the data of the experiment '{}'; choose another folder by --out",
                                        folder_.string(), file_.name));
        } else {
            for (const auto& entry : fs::directory_iterator(folder_)) {
                // Left by a run that was killed before it had written its state.
                if (entry.path().filename() == frozen_name || entry.path().filename().string().starts_with(state_name))
                    continue;
                throw Error(
                    fmt::format("{}: is no folder of an experiment, but holds '{}'; choose another one by --out",
                                folder_.string(), entry.path().filename().string()));
            }
        }
        if (file_.subjects.empty()) freeze(protocol);
        else check_frozen(protocol);
    } catch (...) {
        ::close(lock_);
        throw;
    }
}

ExperimentFolder::ExperimentFolder(const fs::path& folder) : folder_(folder) {
    if (!fs::exists(folder_ / state_name))
        throw Error(fmt::format("{}: is no folder of an experiment (it has no {})", folder_.string(), state_name));
    lock();
    try {
        file_ = experiment::load_experiment_file(folder_ / state_name);
    } catch (...) {
        ::close(lock_);
        throw;
    }
}

ExperimentFolder::~ExperimentFolder() { ::close(lock_); }

void ExperimentFolder::lock() {
    lock_ = ::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0) throw Error(fmt::format("{}: cannot be used: {}", folder_.string(), std::strerror(errno)));
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        ::close(lock_);
        throw Error(fmt::format("{}: another program runs this experiment", folder_.string()));
    }
}

void ExperimentFolder::freeze(const Protocol& protocol) {
    file_.name = protocol.name;
    file_.protocol = protocol.file.string();
    file_.files.clear();
    const UsedFiles used = used_files(protocol);
    const std::vector<fs::path>& files = used.texts;
    for (const fs::path& file : files) {
        const std::string name = frozen_file_name(protocol, files, file);
        const fs::path copy = folder_ / frozen_name / name;
        std::error_code failure;
        fs::create_directories(copy.parent_path(), failure);
        if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", copy.string(), failure.message()));
        file::write_durable_file(copy, file::read_whole_file(file));
        file_.files.push_back({name, hash_of(copy)});
    }
    file_.assets = hashes_of(used.assets, protocol);
    save();
}

void ExperimentFolder::check_frozen(const Protocol& protocol) const {
    std::vector<FrozenFile> now;
    const UsedFiles used = used_files(protocol);
    const std::vector<fs::path>& files = used.texts;
    for (const fs::path& file : files) now.push_back({frozen_file_name(protocol, files, file), hash_of(file)});
    const auto refuse = [&](const std::string& why) {
        throw Error(
            fmt::format("{}: the protocol must not change after the first subject: {}; restore the file, or begin "
                        "another experiment with --out",
                        folder_.string(), why));
    };
    for (const FrozenFile& before : file_.files) {
        const auto found = std::ranges::find(now, before.name, &FrozenFile::name);
        if (found == now.end()) refuse(fmt::format("it no longer names {}", before.name));
        if (found->hash == before.hash) continue;
        const std::size_t index = static_cast<std::size_t>(found - now.begin());
        const fs::path& current = files[index];
        refuse(fmt::format("{}, {}", before.name,
                           first_difference(file::read_whole_file(folder_ / frozen_name / before.name),
                                            file::read_whole_file(current))));
    }
    for (const FrozenFile& one : now)
        if (std::ranges::find(file_.files, one.name, &FrozenFile::name) == file_.files.end())
            refuse(fmt::format("it now names {}", one.name));
    // Folders of before assets were hashed have none.
    if (file_.assets.empty()) return;
    const std::vector<FrozenFile> assets = hashes_of(used.assets, protocol);
    for (const FrozenFile& before : file_.assets) {
        const auto found = std::ranges::find(assets, before.name, &FrozenFile::name);
        if (found == assets.end()) refuse(fmt::format("its patches no longer load {}", before.name));
        if (found->hash != before.hash) refuse(fmt::format("the content of {} has changed", before.name));
    }
    for (const FrozenFile& one : assets)
        if (std::ranges::find(file_.assets, one.name, &FrozenFile::name) == file_.assets.end())
            refuse(fmt::format("its patches now load {}", one.name));
}

void ExperimentFolder::save() const { experiment::save_experiment_file(file_, folder_ / state_name); }

std::size_t ExperimentFolder::row_of(const std::string& pseudonym) const {
    std::size_t next = 0;
    for (const SubjectEntry& one : file_.subjects) {
        if (one.pseudonym == pseudonym) return one.row;
        next = std::max(next, one.row + 1);
    }
    const auto freed = std::ranges::min_element(file_.freed_rows);
    return freed == file_.freed_rows.end() ? next : *freed;
}

SubjectEntry ExperimentFolder::enrol(const std::string& pseudonym, bool is_simulated) {
    check_subject_name(pseudonym);
    const auto found = std::ranges::find(file_.subjects, pseudonym, &SubjectEntry::pseudonym);
    if (found != file_.subjects.end()) {
        if (found->is_simulated != is_simulated)
            throw Error(fmt::format("{} is a {} subject in {}; choose another pseudonym", pseudonym,
                                    found->is_simulated ? "simulated" : "real", folder_.string()));
        return *found;
    }
    const SubjectEntry entry{pseudonym, row_of(pseudonym), is_simulated, {}, false, {}, std::vector<std::string>()};
    std::erase(file_.freed_rows, entry.row);
    file_.subjects.push_back(entry);
    save();
    return entry;
}

void ExperimentFolder::update(const SubjectEntry& entry) {
    for (SubjectEntry& one : file_.subjects)
        if (one.pseudonym == entry.pseudonym) one = entry;
    save();
}

void ExperimentFolder::withdraw(const std::string& pseudonym) {
    const auto found = std::ranges::find(file_.subjects, pseudonym, &SubjectEntry::pseudonym);
    if (found == file_.subjects.end()) {
        std::vector<std::string> names;
        for (const SubjectEntry& one : file_.subjects) names.push_back(one.pseudonym);
        throw Error(
            fmt::format("{}: there is no subject '{}'{}", folder_.string(), pseudonym, did_you_mean(pseudonym, names)));
    }
    // The data go first: an entry without data is harmless, data without an entry would stay for ever.
    std::error_code failure;
    fs::remove_all(subject_folder(pseudonym), failure);
    if (failure)
        throw Error(fmt::format("{}: cannot be deleted: {}", subject_folder(pseudonym).string(), failure.message()));
    file_.freed_rows.push_back(found->row);
    file_.subjects.erase(found);
    save();
    // Results of an analysis may name the subject.
    std::vector<fs::path> results{folder_ / "participants.tsv", folder_ / "mixed"};
    for (const auto& entry : fs::directory_iterator(folder_))
        if (is_experiment_result(entry.path().filename().string())) results.push_back(entry.path());
    for (const fs::path& result : results) {
        fs::remove_all(result, failure);
        if (failure) throw Error(fmt::format("{}: cannot be deleted: {}", result.string(), failure.message()));
    }
}

std::string ExperimentFolder::protocol_hash() const {
    Hash hash;
    for (const std::vector<FrozenFile>* list : {&file_.files, &file_.assets})
        for (const FrozenFile& one : *list) {
            hash.add_text(one.name);
            hash.add_text(one.hash);
        }
    return fmt::format("{:016x}", hash.value());
}

Protocol frozen_protocol(const fs::path& folder) {
    if (!fs::exists(folder / state_name))
        throw Error(fmt::format("{}: is no folder of an experiment (it has no {})", folder.string(), state_name));
    const experiment::ExperimentFile file = experiment::load_experiment_file(folder / state_name);
    if (file.files.empty()) throw Error(fmt::format("{}: is damaged: it has no protocol", folder.string()));
    return experiment::load_protocol(folder / frozen_name / file.files.front().name);
}

}  // namespace tactus::analysis
