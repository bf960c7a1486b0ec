// SPDX-License-Identifier: Apache-2.0
// For LD_PRELOAD: an event device at /dev/input/event7 that the system does not have. FAKE_EVENT_FOLDER is listed in place
// of /dev/input and holds a file event7; FAKE_EVENT_DEVICE is "wheel" or "pad". Its axis X goes to and fro once a second;
// the largest strength of an effect is written to the file FAKE_EVENT_FOLDER/strength.
#include <dirent.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <linux/input.h>
#include <sys/ioctl.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace {

constexpr const char *device = "/dev/input/event7", *folder = "/dev/input";
constexpr int max_files = 4096;
std::atomic<bool> is_ours[max_files];
std::atomic<int> next_effect{0}, largest{0};

bool is_wheel() {
    const char* const kind = std::getenv("FAKE_EVENT_DEVICE");
    return kind && std::strcmp(kind, "wheel") == 0;
}

bool knows(int file) { return file >= 0 && file < max_files && is_ours[file]; }

template <class Function>
Function* real(const char* name) {
    return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

double seconds() {
    timespec now{};
    ::clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

int position() { return static_cast<int>(32767.5 + (is_wheel() ? 1000.0 : 20000.0) * std::sin(6.283 * seconds())); }

int open_device() {
    const int file = ::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
    if (file < 0 || file >= max_files) return -1;
    const itimerspec every{{0, 2'000'000}, {0, 2'000'000}};
    ::timerfd_settime(file, 0, &every, nullptr);
    is_ours[file] = true;
    return file;
}

int fail(int why) {
    errno = why;
    return -1;
}

int upload(ff_effect& effect) {
    if (effect.id == -1) effect.id = static_cast<std::int16_t>(next_effect++);
    const int strength = effect.type == FF_CONSTANT ? std::abs(static_cast<int>(effect.u.constant.level))
                                                    : static_cast<int>(effect.u.rumble.strong_magnitude);
    const char* const where = std::getenv("FAKE_EVENT_FOLDER");
    if (strength > largest.load() && where) {
        largest = strength;
        if (std::FILE* const file = std::fopen((std::string(where) + "/strength").c_str(), "w")) {
            std::fprintf(file, "%d", strength);
            std::fclose(file);
        }
    }
    return 0;
}

int answer(unsigned long request, void* argument) {
    auto* const out = static_cast<unsigned char*>(argument);
    const std::size_t size = _IOC_SIZE(request);
    const unsigned number = _IOC_NR(request);
    const auto set = [&](unsigned code) {
        if (code / 8 < size) out[code / 8] = static_cast<unsigned char>(out[code / 8] | 1u << (code % 8));
    };
    if (request == EVIOCSFF) return upload(*static_cast<ff_effect*>(argument));
    if (request == EVIOCRMFF) return 0;
    if (_IOC_TYPE(request) != 'E') return fail(ENOTTY);
    if (number >= 0x40 && number < 0x80) {
        if (number != 0x40) return fail(EINVAL);
        const input_absinfo axis{position(), 0, 65535, 0, 0, 0};
        std::memcpy(out, &axis, sizeof axis);
        return 0;
    }
    if (number == 0x07 || number == 0x08) return fail(ENOENT);
    std::memset(out, 0, size);
    if (number == 0x06) std::snprintf(static_cast<char*>(argument), size, "Fake %s", is_wheel() ? "wheel" : "pad");
    else if (number == 0x20 + EV_ABS) set(ABS_X);
    else if (number == 0x20 + EV_KEY) set(is_wheel() ? BTN_TRIGGER : BTN_SOUTH);
    else if (number == 0x20 + EV_FF) {
        set(FF_GAIN);
        set(is_wheel() ? FF_CONSTANT : FF_RUMBLE);
    }
    return 0;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
    if (std::strcmp(path, device) == 0) return open_device();
    va_list list;
    va_start(list, flags);
    const int mode = va_arg(list, int);
    va_end(list);
    return real<int(const char*, int, ...)>("open")(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
    if (std::strcmp(path, device) == 0) return open_device();
    va_list list;
    va_start(list, flags);
    const int mode = va_arg(list, int);
    va_end(list);
    return real<int(const char*, int, ...)>("open64")(path, flags, mode);
}

int openat(int at, const char* path, int flags, ...) {
    va_list list;
    va_start(list, flags);
    const int mode = va_arg(list, int);
    va_end(list);
    const char* const instead = std::strcmp(path, folder) == 0 ? std::getenv("FAKE_EVENT_FOLDER") : nullptr;
    return real<int(int, const char*, int, ...)>("openat")(at, instead ? instead : path, flags, mode);
}

DIR* opendir(const char* path) {
    const char* const instead = std::strcmp(path, folder) == 0 ? std::getenv("FAKE_EVENT_FOLDER") : nullptr;
    return real<DIR*(const char*)>("opendir")(instead ? instead : path);
}

int close(int file) {
    if (file >= 0 && file < max_files) is_ours[file] = false;
    return real<int(int)>("close")(file);
}

int ioctl(int file, unsigned long request, ...) {
    va_list list;
    va_start(list, request);
    void* const argument = va_arg(list, void*);
    va_end(list);
    if (knows(file)) return answer(request, argument);
    return real<int(int, unsigned long, ...)>("ioctl")(file, request, argument);
}

ssize_t read(int file, void* into, std::size_t size) {
    if (!knows(file)) return real<ssize_t(int, void*, std::size_t)>("read")(file, into, size);
    std::uint64_t ticks = 0;
    if (real<ssize_t(int, void*, std::size_t)>("read")(file, &ticks, sizeof ticks) < 0) return -1;
    input_event events[2]{};
    if (size < sizeof events) return fail(EINVAL);
    events[0].type = EV_ABS;
    events[0].code = ABS_X;
    events[0].value = position();
    events[1].type = EV_SYN;
    std::memcpy(into, events, sizeof events);
    return sizeof events;
}

ssize_t write(int file, const void* from, std::size_t size) {
    if (knows(file)) return static_cast<ssize_t>(size);
    return real<ssize_t(int, const void*, std::size_t)>("write")(file, from, size);
}

}  // extern "C"
