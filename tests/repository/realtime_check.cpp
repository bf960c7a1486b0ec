// SPDX-License-Identifier: Apache-2.0
// The watch over real-time code catches each planted violation and lets clean code pass.
#include "tests/support/realtime_check.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <unistd.h>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

using namespace tactus;

namespace {

// Hides a value from the optimiser, which may otherwise remove an allocation that nobody reads.
template <class T>
void keep(T&& value) {
    asm volatile("" ::"r"(&value) : "memory");
}

bool watches_locks() {
    const RealtimeWatch watch = realtime_watch();
    if (!watch.missing.empty()) WARN("skipped in part: " << watch.missing);
    return watch.locks_and_waits;
}

bool watches_system_calls() {
    const RealtimeWatch watch = realtime_watch();
    if (!watch.missing.empty()) WARN("skipped in part: " << watch.missing);
    return watch.system_calls;
}

}  // namespace

TEST_CASE("a growing vector is an allocation and its end a release") {
    const auto seen = watch([] {
        std::vector<int> numbers(3);
        keep(numbers);
    });
    CHECK(seen.allocations == 1);
    CHECK(seen.releases == 1);
    CHECK(seen.describe().find("1 allocation, 1 release") == 0);
}

TEST_CASE("aligned memory is an allocation") {
    if (!watches_locks()) return;  // ThreadSanitizer's hooks do not cover it
    void* memory = nullptr;
    const auto seen = watch([&] {
        memory = std::aligned_alloc(64, 128);
        keep(memory);
    });
    std::free(memory);
    CHECK(seen.allocations == 1);
}

TEST_CASE("an exception is an allocation") {
    const auto seen = watch([] {
        try {
            throw std::runtime_error("planted");
        } catch (const std::runtime_error&) {
        }
    });
    CHECK(seen.allocations >= 1);
}

TEST_CASE("the first use of a local static is seen, the second is clean") {
    const auto use = [] {
        static const auto table = std::make_unique<double[]>(100);
        keep(table);
    };
    CHECK(watch(use).allocations >= 1);  // its destructor is put on a list, which may grow
    CHECK(watch(use).none());
}

TEST_CASE("a mutex is a lock, even when nobody holds it") {
    if (!watches_locks()) return;
    std::mutex mutex;
    CHECK(watch([&] { const std::lock_guard lock(mutex); }).locks == 1);
}

TEST_CASE("a sleep is a wait") {
    if (!watches_locks()) return;
    CHECK(watch([] { std::this_thread::sleep_for(std::chrono::microseconds(10)); }).waits >= 1);
    CHECK(watch([] { usleep(10); }).waits >= 1);
}

TEST_CASE("printing is a system call that libc makes by itself, and its output arrives") {
    if (!watches_system_calls()) return;
    std::FILE* file = std::tmpfile();
    REQUIRE(file != nullptr);
    std::setvbuf(file, nullptr, _IONBF, 0);
    const auto seen = watch([&] {
        std::fputs("one", file);
        std::fputs("two", file);
    });
    std::rewind(file);
    char text[8] = {};
    CHECK(std::fread(text, 1, 7, file) == 6);
    CHECK(std::string(text) == "onetwo");
    std::fclose(file);
    CHECK(seen.system_calls == 2);
}

TEST_CASE("a large allocation asks the kernel") {
    if (!watches_system_calls()) return;
    const auto seen = watch([] {
        std::vector<char> large(std::size_t{256} << 20);
        keep(large);
    });
    CHECK(seen.allocations == 1);
    CHECK(seen.system_calls >= 1);
}

TEST_CASE("any other system call is trapped and still returns its answer") {
    if (!watches_system_calls()) return;
    const pid_t expected = getpid();
    pid_t got = 0;
    const auto seen = watch([&] { got = getpid(); });
    CHECK(got == expected);
    CHECK(seen.system_calls == 1);
}

TEST_CASE("outside of real-time scopes everything is allowed") {
    const auto seen = watch_scopes([] {
        std::vector<int> numbers(3);
        keep(numbers);
        getpid();
        const RealtimeScope scope;
        keep(scope);
    });
    CHECK(seen.none());
}

TEST_CASE("scopes on other threads are counted") {
    const auto seen = watch_scopes([] {
        std::thread([] {
            const RealtimeScope scope;
            std::vector<int> numbers(3);
            keep(numbers);
        }).join();
    });
    CHECK(seen.allocations == 1);
}

TEST_CASE("arithmetic is clean") {
    std::vector<double> values(1000, 0.5);
    const auto seen = watch([&] {
        for (double& value : values) value = std::sin(value) * 2.0;
    });
    CHECK(seen.none());
    CHECK(seen.describe() == "none");
}

TEST_CASE("reading the clock is clean where the kernel maps it into the process") {
    std::string clock;
    std::ifstream("/sys/devices/system/clocksource/clocksource0/current_clocksource") >> clock;
    if (clock != "tsc" && clock != "kvm-clock") {
        tactus::test::skip("clock source '" + clock + "' may need a system call");
        return;
    }
    CHECK(watch([] { keep(std::chrono::steady_clock::now()); }).none());
}

TEST_CASE("an exception that leaves the watch leaves nothing armed") {
    CHECK_THROWS_AS(watch([] { throw std::runtime_error("planted"); }), std::runtime_error);
    CHECK(realtime_depth == 0);
    CHECK(getpid() > 0);
}
