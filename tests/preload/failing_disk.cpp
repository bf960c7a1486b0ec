// SPDX-License-Identifier: Apache-2.0
// A disk that fails when a test says so, for any program: built as a shared library for LD_PRELOAD, because root may
// write anywhere and a small disk needs root. Environment:
//
//   FAILING_DISK_ERRNO   ENOSPC (default), EROFS, EIO, EACCES, EDQUOT or a number
//   FAILING_DISK_CALLS   which calls fail: any of write,open,rename with commas between (default write); open is opening
//                        for writing and making folders, rename is renaming and linking
//   FAILING_DISK_FROM    from which such call on, counted from 1 over all files that are meant (default 1)
//   FAILING_DISK_COUNT   how many of them fail (default: all that follow)
//   FAILING_DISK_PATH    files whose path contains this are meant; several with ':' between (default: all below no
//                        system folder)
//
// The first write that fails with ENOSPC or EDQUOT takes half of its bytes, as a disk does that gets full.
#include <dlfcn.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <map>
#include <mutex>
#include <string>
#include <string_view>

namespace {

template <class F>
F* next(const char* name) {
    return reinterpret_cast<F*>(::dlsym(RTLD_NEXT, name));
}

std::string_view variable(const char* name, const char* otherwise) {
    const char* given = ::getenv(name);
    return given && *given ? given : otherwise;
}

int error_number() {
    const std::string_view name = variable("FAILING_DISK_ERRNO", "ENOSPC");
    if (name == "ENOSPC") return ENOSPC;
    if (name == "EROFS") return EROFS;
    if (name == "EIO") return EIO;
    if (name == "EACCES") return EACCES;
    if (name == "EDQUOT") return EDQUOT;
    return ::atoi(name.data());
}

bool is_meant(std::string_view path) {
    std::string_view wanted = variable("FAILING_DISK_PATH", "");
    if (wanted.empty()) {
        for (const char* system : {"/dev/", "/proc/", "/sys/", "/run/", "pipe:", "socket:", "anon_inode:"})
            if (path.starts_with(system)) return false;
        return true;
    }
    while (!wanted.empty()) {
        const std::size_t end = std::min(wanted.find(':'), wanted.size());
        if (end > 0 && path.find(wanted.substr(0, end)) != path.npos) return true;
        wanted.remove_prefix(std::min(end + 1, wanted.size()));
    }
    return false;
}

std::string path_of(int handle) {
    char path[4096];
    const ssize_t size = ::readlink(("/proc/self/fd/" + std::to_string(handle)).c_str(), path, sizeof path);
    return size > 0 ? std::string(path, static_cast<std::size_t>(size)) : std::string();
}

enum class Verdict { passes, first, fails };

/// Counts a call on a file that is meant.
Verdict judge(const char* call, std::string_view path) {
    const std::string_view calls = variable("FAILING_DISK_CALLS", "write");
    if (calls.find(call) == calls.npos || !is_meant(path)) return Verdict::passes;
    static std::atomic<long> calls_seen{0};
    const long from = ::atol(variable("FAILING_DISK_FROM", "1").data());
    const long count = ::atol(variable("FAILING_DISK_COUNT", "0").data());
    const long seen = ++calls_seen;
    if (seen < from || (count > 0 && seen >= from + count)) return Verdict::passes;
    return seen == from ? Verdict::first : Verdict::fails;
}

bool fails(const char* call, std::string_view path) {
    if (judge(call, path) == Verdict::passes) return false;
    errno = error_number();
    return true;
}

/// How many bytes a write at `offset` may still take; −1: it fails. A disk that is full still takes what is written over.
ssize_t room(int handle, std::size_t size, off64_t offset) {
    const int full = error_number();
    struct stat64 status{};
    if ((full == ENOSPC || full == EDQUOT) && offset >= 0 && ::fstat64(handle, &status) == 0 &&
        S_ISREG(status.st_mode) && offset + static_cast<off64_t>(size) <= status.st_size)
        return static_cast<ssize_t>(size);
    const int before = errno;
    const Verdict verdict = judge("write", path_of(handle));
    errno = before;
    if (verdict == Verdict::passes) return static_cast<ssize_t>(size);
    const int code = error_number();
    if (verdict == Verdict::first && size > 1 && (code == ENOSPC || code == EDQUOT))
        return static_cast<ssize_t>(size / 2);
    errno = code;
    return -1;
}

// Streams of the C library write by calls within it, which cannot be replaced; those that are meant are made anew, over a
// descriptor.
std::mutex streams_lock;
std::map<std::FILE*, int>& streams() {
    static auto* const all = new std::map<std::FILE*, int>;
    return *all;
}

int handle_of(void* cookie) { return static_cast<int>(reinterpret_cast<std::intptr_t>(cookie)) - 1; }

ssize_t stream_write(void* cookie, const char* bytes, std::size_t size) {
    std::size_t written = 0;
    while (written < size) {
        const ssize_t count = ::write(handle_of(cookie), bytes + written, size - written);
        if (count <= 0) return static_cast<ssize_t>(written);  // less than asked for: an error, with errno
        written += static_cast<std::size_t>(count);
    }
    return static_cast<ssize_t>(written);
}

ssize_t stream_read(void* cookie, char* bytes, std::size_t size) { return ::read(handle_of(cookie), bytes, size); }

int stream_seek(void* cookie, off64_t* offset, int whence) {
    const off64_t reached = ::lseek64(handle_of(cookie), *offset, whence);
    if (reached < 0) return -1;
    *offset = reached;
    return 0;
}

int stream_close(void* cookie) { return ::close(handle_of(cookie)); }

int flags_of(std::string_view mode) {
    const bool both = mode.find('+') != mode.npos;
    if (mode.starts_with('r')) return both ? O_RDWR : O_RDONLY;
    return (both ? O_RDWR : O_WRONLY) | O_CREAT | (mode.starts_with('w') ? O_TRUNC : O_APPEND) |
           (mode.find('x') != mode.npos ? O_EXCL : 0);
}

std::FILE* open_stream(const char* path, const char* mode, const char* name) {
    const int flags = flags_of(mode);
    if (flags == O_RDONLY || !is_meant(path)) return next<std::FILE*(const char*, const char*)>(name)(path, mode);
    const int handle = ::open(path, flags | (::strchr(mode, 'e') ? O_CLOEXEC : 0), 0666);
    if (handle < 0) return nullptr;
    std::FILE* stream = ::fopencookie(reinterpret_cast<void*>(static_cast<std::intptr_t>(handle) + 1), mode,
                                      {stream_read, stream_write, stream_seek, stream_close});
    const std::lock_guard lock(streams_lock);
    streams()[stream] = handle;
    return stream;
}

int open_file(const char* name, int folder, const char* path, int flags, mode_t mode) {
    const bool writes = (flags & O_ACCMODE) != O_RDONLY || (flags & O_CREAT) != 0;
    if (writes && fails("open", path)) return -1;
    if (folder == AT_FDCWD) return next<int(const char*, int, ...)>(name)(path, flags, mode);
    return next<int(int, const char*, int, ...)>(name)(folder, path, flags, mode);
}

}  // namespace

extern "C" {

ssize_t write(int handle, const void* bytes, std::size_t size) {
    const ssize_t some = room(handle, size, ::lseek64(handle, 0, SEEK_CUR));
    return some < 0
               ? -1
               : next<ssize_t(int, const void*, std::size_t)>("write")(handle, bytes, static_cast<std::size_t>(some));
}

ssize_t pwrite64(int handle, const void* bytes, std::size_t size, off64_t offset) {
    const ssize_t some = room(handle, size, offset);
    return some < 0 ? -1
                    : next<ssize_t(int, const void*, std::size_t, off64_t)>("pwrite64")(
                          handle, bytes, static_cast<std::size_t>(some), offset);
}

ssize_t pwrite(int handle, const void* bytes, std::size_t size, off_t offset) {
    return pwrite64(handle, bytes, size, offset);
}

ssize_t writev(int handle, const iovec* parts, int count) {
    std::size_t size = 0;
    for (int n = 0; n < count; ++n) size += parts[n].iov_len;
    const ssize_t some = room(handle, size, ::lseek64(handle, 0, SEEK_CUR));
    if (some < 0) return -1;
    if (static_cast<std::size_t>(some) == size)
        return next<ssize_t(int, const iovec*, int)>("writev")(handle, parts, count);
    // The first part only: callers go on behind what was taken.
    const std::size_t first = std::min(parts[0].iov_len, static_cast<std::size_t>(some));
    return next<ssize_t(int, const void*, std::size_t)>("write")(handle, parts[0].iov_base, first);
}

int posix_fallocate64(int handle, off64_t from, off64_t size) {
    const int before = errno;
    const bool is_full = fails("write", path_of(handle));
    const int code = errno;
    errno = before;
    return is_full ? code : next<int(int, off64_t, off64_t)>("posix_fallocate64")(handle, from, size);
}

int posix_fallocate(int handle, off_t from, off_t size) { return posix_fallocate64(handle, from, size); }

#define TACTUS_MODE                        \
    mode_t mode = 0;                       \
    if ((flags & (O_CREAT | O_TMPFILE))) { \
        va_list list;                      \
        va_start(list, flags);             \
        mode = va_arg(list, mode_t);       \
        va_end(list);                      \
    }

int open(const char* path, int flags, ...) {
    TACTUS_MODE
    return open_file("open", AT_FDCWD, path, flags, mode);
}
int open64(const char* path, int flags, ...) {
    TACTUS_MODE
    return open_file("open64", AT_FDCWD, path, flags, mode);
}
int openat(int folder, const char* path, int flags, ...) {
    TACTUS_MODE
    return folder == AT_FDCWD ? open_file("open", folder, path, flags, mode)
                              : open_file("openat", folder, path, flags, mode);
}
int openat64(int folder, const char* path, int flags, ...) {
    TACTUS_MODE
    return folder == AT_FDCWD ? open_file("open64", folder, path, flags, mode)
                              : open_file("openat64", folder, path, flags, mode);
}
int creat(const char* path, mode_t mode) { return open(path, O_WRONLY | O_CREAT | O_TRUNC, mode); }
int creat64(const char* path, mode_t mode) { return open64(path, O_WRONLY | O_CREAT | O_TRUNC, mode); }
int mkdir(const char* path, mode_t mode) {
    return fails("open", path) ? -1 : next<int(const char*, mode_t)>("mkdir")(path, mode);
}

std::FILE* fopen(const char* path, const char* mode) { return open_stream(path, mode, "fopen"); }
std::FILE* fopen64(const char* path, const char* mode) { return open_stream(path, mode, "fopen64"); }
int fclose(std::FILE* stream) {
    {
        const std::lock_guard lock(streams_lock);
        streams().erase(stream);
    }
    return next<int(std::FILE*)>("fclose")(stream);
}
int fileno(std::FILE* stream) noexcept {
    {
        const std::lock_guard lock(streams_lock);
        if (const auto found = streams().find(stream); found != streams().end()) return found->second;
    }
    return next<int(std::FILE*)>("fileno")(stream);
}

int rename(const char* from, const char* to) noexcept {
    return fails("rename", to) ? -1 : next<int(const char*, const char*)>("rename")(from, to);
}
int renameat(int old_folder, const char* from, int folder, const char* to) noexcept {
    return fails("rename", to)
               ? -1
               : next<int(int, const char*, int, const char*)>("renameat")(old_folder, from, folder, to);
}
int link(const char* from, const char* to) noexcept {
    return fails("rename", to) ? -1 : next<int(const char*, const char*)>("link")(from, to);
}
int symlink(const char* from, const char* to) noexcept {
    return fails("rename", to) ? -1 : next<int(const char*, const char*)>("symlink")(from, to);
}
}
