// SPDX-License-Identifier: Apache-2.0
// Listings of folders as a shared file system may give them, for any program: built as a shared library for LD_PRELOAD.
// An entry whose file was created less than SLOW_LISTING_SECONDS (default 2) ago is left out, if the folder's path contains
// SLOW_LISTING_PATH (default: every folder). Opening a file by name works at once, as on NFS.
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <string>

namespace {

template <class F>
F* next(const char* name) {
    return reinterpret_cast<F*>(::dlsym(RTLD_NEXT, name));
}

std::string path_of(int handle) {
    char path[4096];
    const ssize_t size = ::readlink(("/proc/self/fd/" + std::to_string(handle)).c_str(), path, sizeof path);
    return size > 0 ? std::string(path, static_cast<std::size_t>(size)) : std::string();
}

/// Whether the file is too new to be listed. By its time of birth: a file that grows does not vanish.
bool is_hidden(DIR* folder, const char* name) {
    if (!::strcmp(name, ".") || !::strcmp(name, "..")) return false;
    const char* wanted = ::getenv("SLOW_LISTING_PATH");
    const int handle = ::dirfd(folder);
    if (wanted && path_of(handle).find(wanted) == std::string::npos) return false;
    struct statx status{};
    if (::statx(handle, name, AT_SYMLINK_NOFOLLOW, STATX_BTIME | STATX_MTIME, &status) != 0) return false;
    const bool has_birth = (status.stx_mask & STATX_BTIME) != 0;
    const auto& made = has_birth ? status.stx_btime : status.stx_mtime;
    timespec now{};
    ::clock_gettime(CLOCK_REALTIME, &now);
    const double age =
        static_cast<double>(now.tv_sec - made.tv_sec) + 1e-9 * (static_cast<double>(now.tv_nsec) - made.tv_nsec);
    const char* delay = ::getenv("SLOW_LISTING_SECONDS");
    return age < (delay ? ::atof(delay) : 2.0);
}

}  // namespace

extern "C" {

dirent* readdir(DIR* folder) {
    dirent* entry = nullptr;
    do entry = next<dirent*(DIR*)>("readdir")(folder);
    while (entry && is_hidden(folder, entry->d_name));
    return entry;
}

dirent64* readdir64(DIR* folder) {
    dirent64* entry = nullptr;
    do entry = next<dirent64*(DIR*)>("readdir64")(folder);
    while (entry && is_hidden(folder, entry->d_name));
    return entry;
}
}
