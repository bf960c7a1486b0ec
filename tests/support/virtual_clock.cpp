// SPDX-License-Identifier: Apache-2.0
#include "tests/support/virtual_clock.hpp"

#include "tests/support/next_definition.hpp"
#include "tests/support/refused_threads.hpp"
#include "tests/support/system_call_trap.hpp"
#include "tests/support/virtual_calls.hpp"

#include <linux/futex.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#if defined(__SANITIZE_THREAD__)
#define TACTUS_REAL_THREADS
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define TACTUS_REAL_THREADS
#endif
#endif

// Clang's sanitizers are part of the executable, so RTLD_NEXT would go past them.
extern "C" int __interceptor_pthread_create(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)
    __attribute__((weak));

namespace tactus::test {

namespace {

int create_real(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* argument) {
    if (__interceptor_pthread_create) return __interceptor_pthread_create(thread, attributes, run, argument);
    return TACTUS_NEXT(pthread_create)(thread, attributes, run, argument);
}

}  // namespace

#if !defined(TACTUS_REAL_THREADS)

namespace virtual_time {

namespace {

constexpr std::int64_t never = INT64_MAX, second_ns = 1'000'000'000;
// What reading a clock takes. A loop that only reads it gets on faster.
constexpr std::int64_t read_cost_ns(int reads_since_wait) noexcept {
    return reads_since_wait <= 16 ? 50 : reads_since_wait <= 200 ? 1'000 : 10'000;
}
// A mutex that a thread in real time holds is tried again.
constexpr std::int64_t try_again_ns = 50'000;
constexpr std::int64_t poll_again_ns = 1'000'000;
constexpr std::size_t max_threads = 1024;
constexpr int max_idle_s = 30;  // real time

std::int64_t ns_of(const timespec& t) noexcept { return t.tv_sec * second_ns + t.tv_nsec; }
timespec timespec_of(std::int64_t ns) noexcept { return {ns / second_ns, ns % second_ns}; }

std::int64_t real_ns(clockid_t clock) noexcept {
    timespec t{};
    TACTUS_NEXT(clock_gettime)(clock, &t);
    return ns_of(t);
}

long futex(std::atomic<int>& word, int operation, int value, const timespec* longest = nullptr) noexcept {
    return TACTUS_NEXT(syscall)(SYS_futex, reinterpret_cast<int*>(&word), operation | FUTEX_PRIVATE_FLAG, value,
                                longest, nullptr, 0);
}

/// A mutex that no definition of this program counts or replaces.
class PlainLock {
public:
    void lock() noexcept {
        int seen = 0;
        if (word_.compare_exchange_strong(seen, locked)) return;
        while (word_.exchange(contended) != 0) futex(word_, FUTEX_WAIT, contended);
    }
    void unlock() noexcept {
        if (word_.exchange(0) == contended) futex(word_, FUTEX_WAKE, 1);
    }

private:
    static constexpr int locked = 1, contended = 2;
    std::atomic<int> word_{0};
};

}  // namespace

struct Thread {
    int number = 0;
    pthread_t handle{};
    std::int64_t wake_ns = 0;  ///< `never`: only when it is woken
    const void* waits_for = nullptr;
    bool was_woken = false, has_ended = false;
    std::int64_t processor_ns = 0;
    int reads = 0;  ///< since it last waited
    std::atomic<int> may_run{0};
    void* (*run)(void*) = nullptr;
    void* argument = nullptr;
};

constinit thread_local Thread* current = nullptr;

namespace {

/// One at a time; never destroyed, because threads that were released may still be inside.
class Scheduler {
public:
    Scheduler(std::uint64_t seed, const VirtualClock::Lateness& lateness)
        : lateness_(lateness),
          random_(seed),
          begin_ns_(real_ns(CLOCK_MONOTONIC)),
          now_ns_(begin_ns_),
          boot_ahead_ns_(real_ns(CLOCK_BOOTTIME) - begin_ns_),
          date_ahead_ns_(real_ns(CLOCK_REALTIME) - begin_ns_) {}

    Thread* add() noexcept {
        const Hold hold(lock_);
        if (count_ == max_threads) fail("too many threads in virtual time");
        auto* thread = new Thread;
        thread->number = static_cast<int>(count_);
        thread->wake_ns = late(now_ns_);
        threads_[count_++] = thread;
        return thread;
    }
    void started(Thread* thread, pthread_t handle) noexcept {
        const Hold hold(lock_);
        // A detached thread that has ended had the same handle.
        const auto end = threads_.begin() + static_cast<std::ptrdiff_t>(count_);
        const auto old = std::find_if(threads_.begin(), end, [&](const Thread* t) { return t->handle == handle; });
        if (old != end) forget(*old);
        thread->handle = handle;
    }
    void remove(Thread* thread) noexcept {
        const Hold hold(lock_);
        forget(thread);
        delete thread;
    }

    bool read(clockid_t clock, timespec* out) noexcept {
        Thread& me = *current;
        switch (clock) {
            case CLOCK_MONOTONIC:
            case CLOCK_MONOTONIC_RAW:
            case CLOCK_MONOTONIC_COARSE: *out = timespec_of(read_steady()); return true;
            case CLOCK_BOOTTIME: *out = timespec_of(read_steady() + boot_ahead_ns_); return true;
            case CLOCK_REALTIME:
            case CLOCK_REALTIME_COARSE: *out = timespec_of(read_steady() + date_ahead_ns_); return true;
            case CLOCK_THREAD_CPUTIME_ID: *out = timespec_of(me.processor_ns); return true;
            default: return false;
        }
    }
    std::int64_t steady_of(clockid_t clock, std::int64_t ns) const noexcept {
        return clock == CLOCK_REALTIME ? ns - date_ahead_ns_ : clock == CLOCK_BOOTTIME ? ns - boot_ahead_ns_ : ns;
    }
    std::int64_t now() const noexcept { return now_ns_; }

    void sleep_until(std::int64_t steady_ns) noexcept {
        const Hold hold(lock_);
        current->wake_ns = late(std::max(steady_ns, now_ns_));
        pass_on();
    }
    /// Until `wake(address)` or the time. True: woken.
    template <class Before>
    bool wait(const void* address, std::int64_t steady_ns, const Before& before) noexcept {
        const Hold hold(lock_);
        Thread& me = *current;
        me.waits_for = address;
        me.was_woken = false;
        me.wake_ns = steady_ns == never ? never : late(std::max(steady_ns, now_ns_));
        before();
        pass_on();
        me.waits_for = nullptr;
        return me.was_woken;
    }
    bool wake(const void* address, bool all) noexcept {
        const Hold hold(lock_);
        return wake_held(address, all);
    }
    bool wake_held(const void* address, bool all) noexcept {
        std::array<Thread*, max_threads>& found = found_;
        std::size_t count = 0;
        for (std::size_t i = 0; i < count_; ++i)
            if (threads_[i]->waits_for == address) found[count++] = threads_[i];
        if (count == 0) return false;
        const std::size_t only = all ? 0 : draw(count);
        for (std::size_t i = 0; i < count; ++i) {
            if (!all && i != only) continue;
            found[i]->waits_for = nullptr;
            found[i]->was_woken = true;
            found[i]->wake_ns = late(now_ns_);
        }
        news_.fetch_add(1);
        futex(news_, FUTEX_WAKE, 1);
        return true;
    }

    Thread* find(pthread_t handle) noexcept {
        const Hold hold(lock_);
        for (std::size_t i = 0; i < count_; ++i)
            if (threads_[i]->handle == handle) return threads_[i];
        return nullptr;
    }
    void begin() noexcept { await_turn(*current); }
    void end() noexcept {
        if (!current) return;  // it was released
        lock_.lock();
        Thread& me = *current;
        me.has_ended = true;
        me.wake_ns = never;
        wake_held(&me, true);
        current = nullptr;
        choose_and_start(nullptr);
        lock_.unlock();
    }
    void join(Thread& other) noexcept {
        while (current && !other.has_ended) wait(&other, never, [] {});
    }

    /// By the thread that runs, as the last call: the others go on in real time.
    void release() noexcept {
        const Hold hold(lock_);
        current = nullptr;
        is_released_ = true;
        for (std::size_t i = 0; i < count_; ++i) {
            threads_[i]->may_run = 1;
            futex(threads_[i]->may_run, FUTEX_WAKE, 1);
        }
    }

    void set_lateness(const VirtualClock::Lateness& lateness) noexcept {
        const Hold hold(lock_);
        lateness_ = lateness;
    }
    void stop_machine(std::int64_t duration_ns) noexcept {
        const Hold hold(lock_);
        now_ns_ += duration_ns;
    }
    void suspend_machine(std::int64_t duration_ns) noexcept {
        const Hold hold(lock_);
        boot_ahead_ns_ += duration_ns;
    }
    void preempt(std::int64_t duration_ns, bool computes) noexcept {
        const Hold hold(lock_);
        if (computes) current->processor_ns += duration_ns;
        current->wake_ns = now_ns_ + duration_ns;
        pass_on();
    }

private:
    struct Hold {
        explicit Hold(PlainLock& lock) : held(lock) { held.lock(); }
        ~Hold() { held.unlock(); }
        PlainLock& held;
    };

    std::uint64_t draw_bits() noexcept {
        // SplitMix64.
        std::uint64_t z = random_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    std::uint64_t draw(std::uint64_t count) noexcept { return draw_bits() % count; }
    std::int64_t late(std::int64_t ns) noexcept {
        const double part = static_cast<double>(draw_bits() >> 11) * 0x1p-53;
        const std::int64_t most = part < lateness_.rare_fraction ? lateness_.max_rare_ns : lateness_.max_ns;
        return most == 0 ? ns : ns + static_cast<std::int64_t>(draw(static_cast<std::uint64_t>(most) + 1));
    }

    std::int64_t read_steady() noexcept {
        const Hold hold(lock_);
        Thread& me = *current;
        const std::int64_t cost = read_cost_ns(++me.reads);
        now_ns_ += cost;
        me.processor_ns += cost;
        if (traps_system_calls()) return now_ns_;  // that of passing on is not the watched code's
        for (std::size_t i = 0; i < count_; ++i) {
            if (threads_[i] == &me || threads_[i]->wake_ns > now_ns_) continue;
            const int reads = me.reads;
            me.wake_ns = now_ns_;
            pass_on();
            me.reads = reads;  // it did not wait
            break;
        }
        return now_ns_;
    }

    /// The calling thread, whose `wake_ns` is set, lets others run until then. With the lock held.
    void pass_on() noexcept {
        Thread& me = *current;
        me.reads = 0;
        Thread* const next = choose_and_start(&me);
        if (next == &me) return;
        lock_.unlock();
        await_turn(me);
        lock_.lock();
    }
    /// With the lock held, which it releases while nobody can run.
    Thread* choose_and_start(Thread* me) noexcept {
        for (int idle = 0;;) {
            std::size_t ready = 0;
            std::int64_t first_ns = never;
            for (std::size_t i = 0; i < count_; ++i) {
                Thread* const thread = threads_[i];
                if (thread->wake_ns <= now_ns_) found_[ready++] = thread;
                first_ns = std::min(first_ns, thread->wake_ns);
            }
            if (ready > 0) {
                Thread* const next = found_[draw(ready)];
                next->wake_ns = never;
                if (next == me) return next;
                next->may_run = 1;
                futex(next->may_run, FUTEX_WAKE, 1);
                return next;
            }
            if (first_ns != never) {
                now_ns_ = first_ns;
                continue;
            }
            if (!me && all_ended()) return nullptr;
            // All wait for a thread in real time.
            const int seen = news_;
            lock_.unlock();
            const timespec one{1, 0};
            if (futex(news_, FUTEX_WAIT, seen, &one) != 0 && ++idle > max_idle_s)
                fail("every thread in virtual time waits, and none has a time to wake up");
            lock_.lock();
        }
    }
    bool all_ended() const noexcept {
        return std::all_of(threads_.begin(), threads_.begin() + static_cast<std::ptrdiff_t>(count_),
                           [](const Thread* thread) { return thread->has_ended; });
    }
    void await_turn(Thread& me) noexcept {
        while (me.may_run.load() == 0) futex(me.may_run, FUTEX_WAIT, 0);
        me.may_run = 0;
        if (is_released_) current = nullptr;
    }
    void forget(Thread* thread) noexcept {
        const auto end = threads_.begin() + static_cast<std::ptrdiff_t>(count_);
        const auto found = std::find(threads_.begin(), end, thread);
        if (found == end) return;
        std::copy(found + 1, end, found);
        --count_;
    }
    [[noreturn]] static void fail(const char* why) noexcept {
        const std::string_view text = why;
        [[maybe_unused]] ssize_t written = ::write(STDERR_FILENO, "virtual clock: ", 15);
        written = ::write(STDERR_FILENO, text.data(), text.size());
        written = ::write(STDERR_FILENO, "\n", 1);
        std::abort();
    }

    PlainLock lock_;
    VirtualClock::Lateness lateness_;
    std::uint64_t random_;
    std::int64_t begin_ns_, now_ns_, boot_ahead_ns_, date_ahead_ns_;
    std::array<Thread*, max_threads> threads_{}, found_{};
    std::size_t count_ = 0;
    std::atomic<int> news_{0};
    std::atomic<bool> is_released_{false};
};

std::atomic<Scheduler*> scheduler{nullptr};

/// Where a thread in virtual time begins.
void* run_thread(void* given) {
    auto* const thread = static_cast<Thread*>(given);
    current = thread;
    Scheduler& mine = *scheduler;
    mine.begin();
    void* const result = thread->run(thread->argument);
    mine.end();
    return result;
}

}  // namespace

int sleep(clockid_t clock, int flags, const timespec& when) noexcept {
    if ((flags & TIMER_ABSTIME) == 0) return sleep_for(when);
    Scheduler& time = *scheduler;
    time.sleep_until(time.steady_of(clock, ns_of(when)));
    return 0;
}

int sleep_for(const timespec& duration) noexcept {
    Scheduler& time = *scheduler;
    time.sleep_until(time.now() + ns_of(duration));
    return 0;
}

int lock(pthread_mutex_t* mutex) noexcept {
    while (current) {
        const int result = TACTUS_NEXT(pthread_mutex_trylock)(mutex);
        if (result != EBUSY) return result;
        Scheduler& time = *scheduler;
        time.wait(mutex, time.now() + try_again_ns, [] {});
    }
    return TACTUS_NEXT(pthread_mutex_lock)(mutex);
}

int unlock(pthread_mutex_t* mutex) noexcept {
    const int result = TACTUS_NEXT(pthread_mutex_unlock)(mutex);
    wake(mutex, false);
    return result;
}

int wait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock, const timespec* until) noexcept {
    Scheduler& time = *scheduler;
    const std::int64_t end_ns = until ? time.steady_of(clock, ns_of(*until)) : never;
    const bool woken = time.wait(condition, end_ns, [&] {
        TACTUS_NEXT(pthread_mutex_unlock)(mutex);
        time.wake_held(mutex, false);
    });
    lock(mutex);
    return woken || !until ? 0 : ETIMEDOUT;
}

int poll(pollfd* files, nfds_t count, int longest_ms) noexcept {
    Scheduler& time = *scheduler;
    const std::int64_t end_ns = longest_ms < 0 ? never : time.now() + longest_ms * poll_again_ns;
    for (;;) {
        const int ready = TACTUS_NEXT(poll)(files, count, 0);
        if (ready != 0 || time.now() >= end_ns) return ready;
        time.sleep_until(std::min(end_ns, time.now() + poll_again_ns));
        if (!current) return TACTUS_NEXT(poll)(files, count, longest_ms);
    }
}

bool wake(const void* address, bool all) noexcept {
    Scheduler* const time = scheduler;
    return time && time->wake(address, all);
}

}  // namespace virtual_time

using virtual_time::current;
using virtual_time::scheduler;

namespace {

std::uint64_t seed_of_tests() {
    const char* const given = std::getenv("TACTUS_TEST_SEED");
    return given ? std::strtoull(given, nullptr, 10) : 1;
}

}  // namespace

VirtualClock::VirtualClock() : VirtualClock(Lateness{}) {}

VirtualClock::VirtualClock(const Lateness& lateness) : VirtualClock(lateness, seed_of_tests()) {}

VirtualClock::VirtualClock(const Lateness& lateness, std::uint64_t seed) : seed_(seed) {
    if (scheduler) std::abort();
    std::fprintf(stderr, "virtual clock: TACTUS_TEST_SEED=%llu\n", static_cast<unsigned long long>(seed_));
    auto* const made = new virtual_time::Scheduler(seed_, lateness);
    virtual_time::Thread* const me = made->add();
    me->wake_ns = virtual_time::never;  // it runs
    me->handle = ::pthread_self();
    scheduler = made;
    current = me;
}

VirtualClock::~VirtualClock() {
    // Not destroyed: threads may still be inside.
    scheduler.exchange(nullptr)->release();
}

bool VirtualClock::is_virtual() { return true; }
void VirtualClock::set_lateness(const Lateness& lateness) { scheduler.load()->set_lateness(lateness); }
void VirtualClock::stop_machine(std::int64_t duration_ns) { scheduler.load()->stop_machine(duration_ns); }
void VirtualClock::suspend_machine(std::int64_t duration_ns) { scheduler.load()->suspend_machine(duration_ns); }
void VirtualClock::preempt(std::int64_t duration_ns) { scheduler.load()->preempt(duration_ns, false); }
void VirtualClock::compute(std::int64_t duration_ns) { scheduler.load()->preempt(duration_ns, true); }

#else

VirtualClock::VirtualClock() : VirtualClock(Lateness{}) {}
VirtualClock::VirtualClock(const Lateness& lateness) : VirtualClock(lateness, 0) {}
VirtualClock::VirtualClock(const Lateness&, std::uint64_t seed) : seed_(seed) {}
VirtualClock::~VirtualClock() = default;
bool VirtualClock::is_virtual() { return false; }
void VirtualClock::set_lateness(const Lateness&) {}
void VirtualClock::stop_machine(std::int64_t) {}
void VirtualClock::suspend_machine(std::int64_t) {}
void VirtualClock::preempt(std::int64_t duration_ns) {
    const timespec duration{duration_ns / 1'000'000'000, duration_ns % 1'000'000'000};
    ::nanosleep(&duration, nullptr);
}
void VirtualClock::compute(std::int64_t duration_ns) { preempt(duration_ns); }

#endif

}  // namespace tactus::test

#if !defined(TACTUS_REAL_THREADS)
namespace virtual_time = tactus::test::virtual_time;
#endif

extern "C" {

int pthread_create(pthread_t* handle, const pthread_attr_t* attributes, void* (*run)(void*), void* argument) noexcept {
    if (tactus::test::refuses_thread()) return EAGAIN;
#if !defined(TACTUS_REAL_THREADS)
    if (virtual_time::current) {
        auto& time = *virtual_time::scheduler.load();
        virtual_time::Thread* const thread = time.add();
        thread->run = run;
        thread->argument = argument;
        const int result = tactus::test::create_real(handle, attributes, virtual_time::run_thread, thread);
        if (result == 0) time.started(thread, *handle);
        else time.remove(thread);
        return result;
    }
#endif
    return tactus::test::create_real(handle, attributes, run, argument);
}

#if !defined(TACTUS_REAL_THREADS)

int pthread_join(pthread_t handle, void** result) {
    if (virtual_time::current) {
        auto& time = *virtual_time::scheduler.load();
        if (auto* const thread = time.find(handle)) {
            time.join(*thread);
            const int joined = TACTUS_NEXT(pthread_join)(handle, result);
            time.remove(thread);
            return joined;
        }
    }
    return TACTUS_NEXT(pthread_join)(handle, result);
}

int pthread_setschedparam(pthread_t handle, int policy, const sched_param* parameters) noexcept {
    if (virtual_time::current) return 0;
    return TACTUS_NEXT(pthread_setschedparam)(handle, policy, parameters);
}

int pthread_mutex_unlock(pthread_mutex_t* mutex) noexcept {
    if (virtual_time::current) return virtual_time::unlock(mutex);
    return TACTUS_NEXT(pthread_mutex_unlock)(mutex);
}

int clock_gettime(clockid_t clock, timespec* time) noexcept {
    if (virtual_time::current && virtual_time::scheduler.load()->read(clock, time)) return 0;
    return TACTUS_NEXT(clock_gettime)(clock, time);
}

int sched_yield() noexcept {
    if (!virtual_time::current) return TACTUS_NEXT(sched_yield)();
    return virtual_time::sleep_for({0, 0});
}

int poll(pollfd* files, nfds_t count, int longest_ms) {
    if (virtual_time::current && longest_ms != 0) return virtual_time::poll(files, count, longest_ms);
    return TACTUS_NEXT(poll)(files, count, longest_ms);
}

// Atomic waits: libstdc++ calls the futex itself.
long syscall(long number, ...) noexcept {
    va_list given;
    va_start(given, number);
    std::array<long, 6> a{};
    for (long& value : a) value = va_arg(given, long);
    va_end(given);
    if (number == SYS_futex && virtual_time::scheduler.load() != nullptr) {
        const auto* const word = reinterpret_cast<const std::atomic<int>*>(a[0]);
        const int operation = static_cast<int>(a[1]) & FUTEX_CMD_MASK;
        if (operation == FUTEX_WAKE || operation == FUTEX_WAKE_BITSET) virtual_time::wake(word, a[2] != 1);
        if (virtual_time::current && (operation == FUTEX_WAIT || operation == FUTEX_WAIT_BITSET)) {
            if (word->load() != static_cast<int>(a[2])) {
                errno = EAGAIN;
                return -1;
            }
            auto& time = *virtual_time::scheduler.load();
            const auto* const until = reinterpret_cast<const timespec*>(a[3]);
            std::int64_t end_ns = virtual_time::never;
            if (until && operation == FUTEX_WAIT) end_ns = time.now() + virtual_time::ns_of(*until);
            else if (until)
                end_ns = time.steady_of((a[1] & FUTEX_CLOCK_REALTIME) != 0 ? CLOCK_REALTIME : CLOCK_MONOTONIC,
                                        virtual_time::ns_of(*until));
            if (time.wait(word, end_ns, [] {}) || !until) return 0;
            errno = ETIMEDOUT;
            return -1;
        }
    }
    return TACTUS_NEXT(syscall)(number, a[0], a[1], a[2], a[3], a[4], a[5]);
}

#endif
}
