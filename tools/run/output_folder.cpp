// SPDX-License-Identifier: Apache-2.0
#include "tools/run/output_folder.hpp"

#include "dsp/core/error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <utility>

namespace tactus::run {

namespace fs = std::filesystem;

namespace {

constexpr off_t room_for_summary = 256 * 1024;  // bytes; several times the usual size

/// The first file that looks like the result of a run, including part files of a killed run.
std::string result_in(const fs::path& folder) {
    constexpr std::array<std::string_view, 6> endings{".part", ".csv", ".wav", ".vdb", ".png", ".plan.json"};
    std::string found;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const std::string name = entry.path().filename().string();
        const bool is_result = name == "summary.json" || std::ranges::any_of(endings, [&name](std::string_view ending) {
                                   return name.ends_with(ending);
                               });
        if (is_result && !name.starts_with('.') && (found.empty() || name < found)) found = name;
    }
    return found;
}

/// The first folder of the path that does not exist; empty: all are there.
fs::path first_missing(const fs::path& folder) {
    std::error_code ignored;
    fs::path so_far;
    for (const fs::path& part : folder) {
        so_far /= part;
        if (!fs::exists(so_far, ignored)) return so_far;
    }
    return {};
}

/// Points the link to `target`, at once.
bool point(const fs::path& link, const fs::path& target) {
    std::error_code failure;
    const fs::path part = fmt::format("{}.{}.part", link.string(), ::getpid());
    fs::create_symlink(target, part, failure);
    if (failure) return false;
    fs::rename(part, link, failure);
    if (!failure) return true;
    fs::remove(part, failure);
    return false;
}

}  // namespace

OutputFolder::OutputFolder(const OutputChoice& choice) {
    // "out/" names the folder "out".
    const fs::path base = choice.folder.has_filename() ? choice.folder : choice.folder.parent_path();
    std::string why = take(base, choice.overwrite);
    const fs::path stem = base == "." || base.filename() == ".." ? base / "run" : base;
    constexpr int most = 100'000;
    for (int n = 2; !why.empty() && choice.is_numbered && n < most; ++n)
        why = take(fmt::format("{}-{}", stem.string(), n), choice.overwrite);
    if (!why.empty()) throw Error(why);
    if (!choice.is_linked) return;
    link_ = base.string() + "-latest";
    link();
}

/// An existing file that is not a link is kept.
void OutputFolder::link() {
    std::error_code ignored;
    if (fs::is_symlink(link_, ignored)) linked_before_ = fs::read_symlink(link_, ignored);
    else if (fs::exists(link_, ignored)) link_.clear();
    if (!link_.empty() && !point(link_, path_.filename())) link_.clear();
}

OutputFolder::~OutputFolder() { let_go(); }

void OutputFolder::let_go() {
    std::error_code ignored;
    if (summary_ >= 0) {
        ::close(std::exchange(summary_, -1));
        fs::remove(part_, ignored);
        drop_if_empty();
    }
    if (lock_ >= 0) ::close(std::exchange(lock_, -1));
}

void OutputFolder::drop_if_empty() {
    std::error_code failure;
    if (made_.empty() || !fs::remove(path_, failure)) return;
    // Another run may have led the link on, or have taken away where it led before.
    if (!link_.empty() && fs::read_symlink(link_, failure) == path_.filename()) {
        const bool is_there = !linked_before_.empty() && fs::exists(link_.parent_path() / linked_before_, failure);
        if (!is_there) fs::remove(link_, failure);
        else point(link_, linked_before_);
    }
    for (fs::path folder = path_; folder != made_;) {
        folder = folder.parent_path();
        if (!fs::remove(folder, failure)) return;
    }
}

std::string OutputFolder::take(const fs::path& folder, bool overwrite) {
    std::error_code failure;
    made_ = first_missing(folder);
    fs::create_directories(folder, failure);
    if (failure) throw Error(fmt::format("{}: cannot make the folder: {}", folder.string(), failure.message()));
    lock_ = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (lock_ < 0) throw Error(fmt::format("{}: cannot be used: {}", folder.string(), std::strerror(errno)));
    // Other failures mean a file system without locks.
    if (::flock(lock_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        let_go();
        return fmt::format("{}: another run writes to this folder; choose another one", folder.string());
    }
    if (const std::string found = result_in(folder); !found.empty() && !overwrite) {
        let_go();
        return fmt::format(
            "{}: the folder already has results ({}); choose another one, or use --overwrite to replace them",
            folder.string(), found);
    }
    path_ = folder;
    part_ = folder / "summary.json.part";
    try {
        reserve();
    } catch (const Error&) {
        let_go();
        drop_if_empty();
        throw;
    }
    return {};
}

void OutputFolder::reserve() {
    summary_ = ::open(part_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (summary_ < 0)
        throw Error(fmt::format("{}: the folder is not writable: {}", path_.string(), std::strerror(errno)));
    if (const int code = ::posix_fallocate(summary_, 0, room_for_summary); code == ENOSPC || code == EDQUOT)
        throw Error(fmt::format("{}: there is no room for results: {}", path_.string(), std::strerror(code)));
}

void OutputFolder::write_summary(std::string_view text) {
    const fs::path summary = path_ / "summary.json";
    const auto fail = [&summary](int code) {
        throw Error(fmt::format("{}: cannot be written: {}", summary.string(), std::strerror(code)));
    };
    for (std::size_t written = 0; written < text.size();) {
        const ssize_t count =
            ::pwrite(summary_, text.data() + written, text.size() - written, static_cast<off_t>(written));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) fail(count < 0 ? errno : EIO);
        written += static_cast<std::size_t>(count);
    }
    if (::ftruncate(summary_, static_cast<off_t>(text.size())) != 0) fail(errno);
    // From here on the part file is complete and kept.
    if (::close(std::exchange(summary_, -1)) != 0 && errno != EINTR) fail(errno);
    if (std::rename(part_.c_str(), summary.c_str()) != 0) fail(errno);
}

}  // namespace tactus::run
