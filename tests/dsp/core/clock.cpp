// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/clock.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/support/virtual_clock.hpp"

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

using namespace tactus;
using test::VirtualClock;

namespace {

constexpr std::int64_t ms = 1'000'000, second = 1'000 * ms;

/// Which of three threads woke up when.
std::vector<std::int64_t> wakeups(const VirtualClock::Lateness& lateness, std::uint64_t seed) {
    const VirtualClock clock(lateness, seed);
    const std::int64_t begin = steady_ns();
    std::vector<std::int64_t> order;
    std::vector<std::thread> threads;
    for (int n = 0; n < 3; ++n)
        threads.emplace_back([&, n] {
            for (int i = 1; i <= 100; ++i) {
                sleep_until(begin + i * ms);
                order.push_back(10 * (steady_ns() - begin) + n);  // one thread runs at a time
            }
        });
    for (std::thread& thread : threads) thread.join();
    return order;
}

}  // namespace

TEST_CASE("a signal does not wake a thread before its time") {
    struct sigaction action = {}, before = {};
    action.sa_handler = [](int) {};
    sigaction(SIGUSR1, &action, &before);
    std::atomic<bool> ended{false};
    std::int64_t early = 0;
    std::thread sleeper([&] {
        for (int i = 0; i < 10; ++i) {
            const std::int64_t due = steady_ns() + 10'000'000;
            sleep_until(due);
            early = std::max(early, due - steady_ns());
        }
        ended = true;
    });
    while (!ended) {
        pthread_kill(sleeper.native_handle(), SIGUSR1);
        sleep_for(1'000'000);
    }
    sleeper.join();
    CHECK(early <= 0);
    sigaction(SIGUSR1, &before, nullptr);
}

TEST_CASE("threads in virtual time run in the order that the seed gives, none before its time") {
    if (!VirtualClock::is_virtual()) return test::skip("ThreadSanitizer: threads are real");
    const VirtualClock::Lateness lateness{2 * ms, 0.1, 20 * ms};
    const auto first = wakeups(lateness, 1);
    CHECK(first.size() == 300);
    CHECK(first == wakeups(lateness, 1));
    CHECK(first != wakeups(lateness, 2));
    CHECK(std::ranges::is_sorted(first));
    std::vector<std::int64_t> count(3);
    std::int64_t latest = 0;
    for (const std::int64_t wake : first) {
        const std::int64_t late = wake / 10 - ++count[static_cast<std::size_t>(wake % 10)] * ms;
        REQUIRE(late > 0);
        latest = std::max(latest, late);
    }
    CHECK(latest > 10 * ms);
}

TEST_CASE("an hour of virtual time passes at once, and each clock counts what happens to it") {
    if (!VirtualClock::is_virtual()) return test::skip("ThreadSanitizer: threads are real");
    VirtualClock clock({.max_ns = 0});
    const auto clocks = [] { return std::array{steady_ns(), boot_ns(), thread_ns()}; };
    auto passed = [&, before = clocks()]() mutable {
        const auto now = clocks();
        std::array<std::int64_t, 3> in_ms{};
        for (std::size_t i = 0; i < now.size(); ++i) in_ms[i] = (now[i] - before[i] + ms / 2) / ms;
        before = now;
        return in_ms;
    };
    using Passed = std::array<std::int64_t, 3>;
    std::this_thread::sleep_for(std::chrono::hours(1));
    CHECK(passed() == Passed{3'600'000, 3'600'000, 0});
    clock.stop_machine(70 * ms);
    CHECK(passed() == Passed{70, 70, 0});
    clock.suspend_machine(10 * second);
    CHECK(passed() == Passed{0, 10'000, 0});
    clock.preempt(30 * ms);
    CHECK(passed() == Passed{30, 30, 0});
    clock.compute(20 * ms);
    CHECK(passed() == Passed{20, 20, 20});
    wait_until(steady_ns() + 15 * ms, 5 * ms);
    CHECK(passed() == Passed{15, 15, 5});
}

TEST_CASE("a thread that is preempted, computes or holds a mutex in virtual time keeps nobody else from running") {
    if (!VirtualClock::is_virtual()) return test::skip("ThreadSanitizer: threads are real");
    VirtualClock clock({.max_ns = 0});
    std::mutex mutex;
    std::int64_t locked_ns = 0;
    int steps = 0;
    const std::int64_t begin = steady_ns();
    std::thread holder([&] {
        const std::lock_guard lock(mutex);
        clock.preempt(20 * ms);
        for (const std::int64_t until = steady_ns() + 20 * ms; steady_ns() < until;) {
        }
    });
    std::thread waiter([&] {
        sleep_for(ms);
        const std::lock_guard lock(mutex);
        locked_ns = steady_ns() - begin;
    });
    for (; steady_ns() < begin + 39 * ms; ++steps) sleep_for(ms);
    CHECK(locked_ns == 0);
    holder.join();
    waiter.join();
    CHECK(steps >= 35);
    CHECK(locked_ns >= 40 * ms);
    CHECK(locked_ns < 41 * ms);
}

TEST_CASE("condition variables and atomic waits end in virtual time by a notification or at their time") {
    if (!VirtualClock::is_virtual()) return test::skip("ThreadSanitizer: threads are real");
    VirtualClock clock({.max_ns = 0});
    std::mutex mutex;
    std::condition_variable changed;
    bool is_set = false;
    std::atomic<int> value{0};
    const std::int64_t begin = steady_ns();
    std::thread setter([&] {
        sleep_for(30 * ms);
        const std::lock_guard lock(mutex);
        is_set = true;
        changed.notify_one();
        value = 1;
        value.notify_one();
    });
    {
        std::unique_lock lock(mutex);
        CHECK_FALSE(changed.wait_for(lock, std::chrono::milliseconds(20), [&] { return is_set; }));
        CHECK((steady_ns() - begin) / ms == 20);
        CHECK(changed.wait_for(lock, std::chrono::seconds(20), [&] { return is_set; }));
        CHECK((steady_ns() - begin) / ms == 30);
    }
    value.wait(0);
    CHECK((steady_ns() - begin) / ms == 30);
    setter.join();
}
