// SPDX-License-Identifier: Apache-2.0
// Virtual time for tests of threads. The test programs define the C library's clocks, sleeps, condition variables and
// threads (realtime_counters.cpp, virtual_clock.cpp). Threads that take part in a VirtualClock run one at a time; when
// all of them wait, its time advances to the next wake-up. A run of a second takes milliseconds, its threads are as
// late as the test requests, and the same seed gives the same order of all threads. Precedents: FoundationDB's
// simulation; Shadow (Jansen, Newsome, Wails, USENIX ATC 2022), which runs unchanged programs.
#pragma once

#include <cstdint>

namespace tactus::test {

/// While it exists, the thread that made it, every thread that this one starts, and those that they start, are in
/// virtual time: std::chrono's clocks, sleeps, std::thread, std::mutex, std::condition_variable, atomic waits, poll.
/// Time begins at the steady clock's. Reading a clock takes virtual time, computing takes none, and so a loop that
/// reads the clock is a thread that computes. `poll` checks its files every millisecond of virtual time, in which the
/// kernel may have done little: what waits for processes or terminals stays in real time. Other system calls that block
/// stop virtual time. Real-time priorities are accepted and ignored. One at a time. Threads that have not ended when it
/// is destroyed go on in real time. Under ThreadSanitizer, which owns these functions, time and threads are real.
class VirtualClock {
public:
    struct Lateness {
        std::int64_t max_ns = 50'000;  ///< every wake-up is late by up to this, uniformly
        double rare_fraction = 0.0;  ///< of the wake-ups
        std::int64_t max_rare_ns = 0;  ///< which are late by up to this
    };

    /// The seed is that of the environment variable TACTUS_TEST_SEED, else 1, and is printed.
    VirtualClock();
    explicit VirtualClock(const Lateness& lateness);
    VirtualClock(const Lateness& lateness, std::uint64_t seed);
    ~VirtualClock();
    VirtualClock(const VirtualClock&) = delete;
    VirtualClock& operator=(const VirtualClock&) = delete;

    /// False under ThreadSanitizer.
    static bool is_virtual();
    std::uint64_t seed() const { return seed_; }

    // By any thread that takes part.
    /// Of wake-ups from now on.
    void set_lateness(const Lateness& lateness);
    /// The machine stops for this long, ns: the steady clock and `boot_ns` advance, no thread runs.
    void stop_machine(std::int64_t duration_ns);
    /// The machine is suspended for this long, ns: only `boot_ns` advances.
    void suspend_machine(std::int64_t duration_ns);
    /// The calling thread is preempted for this long, ns: the others run on.
    void preempt(std::int64_t duration_ns);
    /// The calling thread computes for this long, ns: like `preempt`, but it is processor time.
    void compute(std::int64_t duration_ns);

private:
    std::uint64_t seed_;
};

}  // namespace tactus::test
