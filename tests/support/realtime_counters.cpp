// SPDX-License-Identifier: Apache-2.0
// The executable's own malloc, mutex and sleep functions come before those of libc, also for calls from shared
// libraries. They count inside a real-time scope and pass the call on, or act in virtual time (virtual_clock.hpp).
#include "tests/support/realtime_counters.hpp"

#include "tests/support/next_definition.hpp"
#include "tests/support/virtual_calls.hpp"

#include <pthread.h>
#include <semaphore.h>
#include <unistd.h>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdio>
#include <ctime>

#if defined(__SANITIZE_THREAD__)
#define TACTUS_UNDER_TSAN
#elif defined(__SANITIZE_ADDRESS__)
#define TACTUS_UNDER_ASAN
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define TACTUS_UNDER_TSAN
#elif __has_feature(address_sanitizer)
#define TACTUS_UNDER_ASAN
#endif
#endif

#if defined(TACTUS_UNDER_ASAN) || defined(TACTUS_UNDER_TSAN)
// gcc 12 ships the function but not its header.
extern "C" int __sanitizer_install_malloc_and_free_hooks(void (*on_malloc)(const volatile void*, std::size_t),
                                                         void (*on_free)(const volatile void*));
#endif

namespace tactus {
namespace {

struct Counters {
    std::atomic<std::int64_t> allocations, releases, locks, waits, prints, system_calls, system_call;
};
constinit Counters counters{};

inline void count(std::atomic<std::int64_t>& counter) noexcept {
    if (realtime_depth > 0) counter.fetch_add(1, std::memory_order_relaxed);
}

}  // namespace

void start_counting() {
#if defined(TACTUS_UNDER_ASAN) || defined(TACTUS_UNDER_TSAN)
    [[maybe_unused]] static const int installed = __sanitizer_install_malloc_and_free_hooks(
        [](const volatile void*, std::size_t) { count(counters.allocations); },
        [](const volatile void*) { count(counters.releases); });
#endif
    for (auto* counter : {&counters.allocations, &counters.releases, &counters.locks, &counters.waits, &counters.prints,
                          &counters.system_calls})
        *counter = 0;
    counters.system_call = -1;
}

RealtimeViolations counted() {
    return {counters.allocations, counters.releases,     counters.locks,      counters.waits,
            counters.prints,      counters.system_calls, counters.system_call};
}

void count_system_call(std::int64_t number) noexcept {
    if (realtime_depth == 0) return;
    counters.system_calls.fetch_add(1, std::memory_order_relaxed);
    counters.system_call.store(number, std::memory_order_relaxed);
}

bool interposes_locks() {
#if defined(TACTUS_UNDER_TSAN)
    return false;
#else
    return true;
#endif
}

}  // namespace tactus

namespace virtual_time = tactus::test::virtual_time;

extern "C" {

#if !defined(TACTUS_UNDER_ASAN) && !defined(TACTUS_UNDER_TSAN)

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);

void* malloc(std::size_t size) noexcept {
    tactus::count(tactus::counters.allocations);
    return __libc_malloc(size);
}

void* calloc(std::size_t n, std::size_t size) noexcept {
    tactus::count(tactus::counters.allocations);
    return __libc_calloc(n, size);
}

void* realloc(void* memory, std::size_t size) noexcept {
    tactus::count(tactus::counters.allocations);
    return __libc_realloc(memory, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
    tactus::count(tactus::counters.allocations);
    return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
    tactus::count(tactus::counters.allocations);
    if (alignment % sizeof(void*) != 0 || (alignment & (alignment - 1)) != 0 || alignment == 0) return EINVAL;
    void* const got = __libc_memalign(alignment, size);
    if (got == nullptr) return ENOMEM;
    *memory = got;
    return 0;
}

void free(void* memory) noexcept {
    if (memory != nullptr) tactus::count(tactus::counters.releases);
    __libc_free(memory);
}

#endif

#if !defined(TACTUS_UNDER_TSAN)

#define TACTUS_PASS_ON(function, counter, ...) \
    tactus::count(tactus::counters.counter);   \
    return TACTUS_NEXT(function)(__VA_ARGS__)

// In virtual time it is `instead`.
#define TACTUS_PASS_ON_UNLESS_VIRTUAL(instead, function, counter, ...) \
    if (virtual_time::applies()) {                                     \
        tactus::count(tactus::counters.counter);                       \
        return virtual_time::instead;                                  \
    }                                                                  \
    TACTUS_PASS_ON(function, counter, __VA_ARGS__)

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
    TACTUS_PASS_ON_UNLESS_VIRTUAL(lock(mutex), pthread_mutex_lock, locks, mutex);
}

int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
    TACTUS_PASS_ON_UNLESS_VIRTUAL(wait(condition, mutex, CLOCK_MONOTONIC, nullptr), pthread_cond_wait, waits, condition,
                                  mutex);
}

int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex, const timespec* until) {
    TACTUS_PASS_ON_UNLESS_VIRTUAL(wait(condition, mutex, CLOCK_REALTIME, until), pthread_cond_timedwait, waits,
                                  condition, mutex, until);
}

int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock, const timespec* until) {
    TACTUS_PASS_ON_UNLESS_VIRTUAL(wait(condition, mutex, clock, until), pthread_cond_clockwait, waits, condition, mutex,
                                  clock, until);
}

int nanosleep(const timespec* duration, timespec* left) {
    TACTUS_PASS_ON_UNLESS_VIRTUAL(sleep_for(*duration), nanosleep, waits, duration, left);
}

int clock_nanosleep(clockid_t clock, int flags, const timespec* duration, timespec* left) {
    TACTUS_PASS_ON_UNLESS_VIRTUAL(sleep(clock, flags, *duration), clock_nanosleep, waits, clock, flags, duration, left);
}

int usleep(useconds_t duration) {
    TACTUS_PASS_ON_UNLESS_VIRTUAL(sleep_for({duration / 1'000'000, duration % 1'000'000 * 1'000L}), usleep, waits,
                                  duration);
}

int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept { TACTUS_PASS_ON(pthread_mutex_trylock, locks, mutex); }
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept { TACTUS_PASS_ON(pthread_rwlock_rdlock, locks, lock); }
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept { TACTUS_PASS_ON(pthread_rwlock_wrlock, locks, lock); }
int pthread_cond_signal(pthread_cond_t* condition) noexcept {
    if (virtual_time::wake(condition, false)) return 0;
    TACTUS_PASS_ON(pthread_cond_signal, waits, condition);
}
int pthread_cond_broadcast(pthread_cond_t* condition) noexcept {
    virtual_time::wake(condition, true);
    TACTUS_PASS_ON(pthread_cond_broadcast, waits, condition);
}
int sem_wait(sem_t* semaphore) { TACTUS_PASS_ON(sem_wait, waits, semaphore); }

// The guard of a local static, asked for until it is initialised: no other function tells of the first use when the
// initialiser itself is harmless.
int __cxa_guard_acquire(long long* guard) { TACTUS_PASS_ON(__cxa_guard_acquire, locks, guard); }

int puts(const char* text) { TACTUS_PASS_ON(puts, prints, text); }
int putchar(int character) { TACTUS_PASS_ON(putchar, prints, character); }
int fputc(int character, FILE* file) { TACTUS_PASS_ON(fputc, prints, character, file); }
int fputs(const char* text, FILE* file) { TACTUS_PASS_ON(fputs, prints, text, file); }
std::size_t fwrite(const void* data, std::size_t size, std::size_t n, FILE* file) {
    TACTUS_PASS_ON(fwrite, prints, data, size, n, file);
}
int vfprintf(FILE* file, const char* format, va_list arguments) {
    TACTUS_PASS_ON(vfprintf, prints, file, format, arguments);
}
int printf(const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int written = vfprintf(stdout, format, arguments);
    va_end(arguments);
    return written;
}
int fprintf(FILE* file, const char* format, ...) {
    va_list arguments;
    va_start(arguments, format);
    const int written = vfprintf(file, format, arguments);
    va_end(arguments);
    return written;
}

#endif
}
