// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/unsaved.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "tools/run/load_plan.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>

namespace tactus::window {

namespace fs = std::filesystem;

namespace {

constexpr int max_kept = 99;  // files per patch and folder

/// Resolves a link to the file.
fs::path true_path(const fs::path& patch) {
    std::error_code failure;
    fs::path path = fs::weakly_canonical(fs::absolute(patch), failure);
    return failure ? fs::absolute(patch).lexically_normal() : path;
}

/// Empty without a home folder.
std::optional<fs::path> state_folder() {
    const char* given = std::getenv("XDG_STATE_HOME");
    // The XDG specification requires to ignore a relative path.
    if (given && fs::path(given).is_absolute()) return fs::path(given) / "tactus" / "unsaved";
    const char* home = std::getenv("HOME");
    if (!home || !fs::path(home).is_absolute()) return std::nullopt;
    return fs::path(home) / ".local" / "state" / "tactus" / "unsaved";
}

/// Path stems without number and extension: beside the patch, and in the common folder.
struct Stems {
    std::optional<fs::path> beside, state;
    std::string extension;  // of a patch or of a plan
};
Stems stems_of(const fs::path& patch) {
    const fs::path path = true_path(patch);
    Stems stems;
    stems.extension = path.extension().string();
    if (!run::is_of_library(path)) stems.beside = path.parent_path() / (path.stem().string() + ".unsaved");
    Hash hash;
    hash.add_text(path.string());
    if (const auto folder = state_folder())
        stems.state = *folder / fmt::format("{}-{:016x}.unsaved", path.stem().string(), hash.value());
    return stems;
}

fs::path numbered(const fs::path& stem, int number, const std::string& extension) {
    return number == 1 ? stem.string() + extension : fmt::format("{}-{}{}", stem.string(), number, extension);
}

/// Creates a new, empty file exclusively. Throws Error.
fs::path reserve(const fs::path& stem, const std::string& extension) {
    for (int number = 1; number <= max_kept; ++number) {
        const fs::path path = numbered(stem, number, extension);
        const int handle = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (handle >= 0) {
            ::close(handle);
            return path;
        }
        if (errno != EEXIST) throw Error(fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno)));
    }
    throw Error(fmt::format("{}{}: there are {} such files already", stem.string(), extension, max_kept));
}

fs::path keep_at(const fs::path& stem, const std::string& extension, std::string_view text) {
    const fs::path path = reserve(stem, extension);
    try {
        file::write_durable_file(path, text);
    } catch (const Error&) {
        std::error_code ignored;
        fs::remove(path, ignored);
        throw;
    }
    return path;
}

}  // namespace

fs::path keep_unsaved(const fs::path& patch, std::string_view text) {
    const Stems stems = stems_of(patch);
    std::string why = "neither XDG_STATE_HOME nor HOME is set";
    if (stems.beside) try {
            return keep_at(*stems.beside, stems.extension, text);
        } catch (const Error& error) {
            why = error.message();
        }
    if (!stems.state) throw Error(why);
    std::error_code failure;
    fs::create_directories(stems.state->parent_path(), failure);
    if (failure)
        throw Error(
            fmt::format("{}: cannot make the folder: {}", stems.state->parent_path().string(), failure.message()));
    return keep_at(*stems.state, stems.extension, text);
}

std::vector<fs::path> find_unsaved(const fs::path& patch) {
    struct Kept {
        fs::path path;
        fs::file_time_type when;
    };
    std::vector<Kept> kept;
    const Stems stems = stems_of(patch);
    for (const auto& stem : {stems.beside, stems.state}) {
        if (!stem) continue;
        for (int number = 1; number <= max_kept; ++number) {
            const fs::path path = numbered(*stem, number, stems.extension);
            std::error_code failure;
            // An empty file was reserved and never written.
            if (!fs::is_regular_file(path, failure) || fs::file_size(path, failure) == 0 || failure) continue;
            kept.push_back({path, fs::last_write_time(path, failure)});
        }
    }
    std::ranges::stable_sort(kept, {}, &Kept::when);
    std::vector<fs::path> paths;
    for (Kept& one : kept) paths.push_back(std::move(one.path));
    return paths;
}

}  // namespace tactus::window
