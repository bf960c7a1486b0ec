// SPDX-License-Identifier: Apache-2.0
// Nodes that do what a tick must not. The walk over the catalogue would catch each of them; without the real-time scope
// around the tick nobody would notice, since all of them give the right values.
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"
#include "tests/support/realtime_check.hpp"

#include <unistd.h>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <shared_mutex>
#include <stdexcept>
#include <thread>

namespace tactus::test {

namespace {

// Hides a value from the optimiser, which may otherwise remove what nobody reads.
template <class T>
void keep(T&& value) {
    asm volatile("" ::"r"(&value) : "memory");
}

std::mutex mutex;
std::shared_mutex shared;
std::condition_variable condition;
std::FILE* buffered = nullptr;

/// Made at first use only, by an initialiser that itself does nothing wrong.
double slow_constant() {
    static const double constant = [] {
        volatile double half = 0.5;
        return half + half;
    }();
    return constant;
}

}  // namespace

struct Violator {
    static constexpr auto about = "Passes a number on, and does something bad meanwhile.";

    In<double> in{"a number"};
    Out<double> out{"the same"};
    Choice what{{"nothing", "malloc", "free", "lock", "read lock", "print", "sleep", "big allocation", "throw",
                 "first use of a static", "open a file", "notify a condition", "wait for a condition", "yield"},
                "the violation"};

    void prepare(const Setup&) { memory_ = std::malloc(100); }
    void process(const Tick& tick) noexcept {
        if (tick.index == 3) violate();
        out = in;
    }
    ~Violator() { std::free(memory_); }

private:
    void violate() noexcept {
        if (what.is("malloc")) {
            std::vector<int> numbers(3);
            keep(numbers);
        } else if (what.is("free")) {
            std::free(memory_);
            memory_ = nullptr;
        } else if (what.is("lock")) {
            const std::lock_guard lock(mutex);
        } else if (what.is("read lock")) {
            const std::shared_lock lock(shared);
        } else if (what.is("print")) {
            std::fprintf(buffered, "tick\n");
        } else if (what.is("sleep")) {
            std::this_thread::sleep_for(std::chrono::microseconds(1));
        } else if (what.is("big allocation")) {
            std::vector<char> large(std::size_t{64} << 20);
            keep(large);
        } else if (what.is("throw")) {
            try {
                throw std::runtime_error("planted");
            } catch (const std::runtime_error&) {
            }
        } else if (what.is("first use of a static")) {
            keep(slow_constant());
        } else if (what.is("open a file")) {
            if (std::FILE* file = std::fopen("/dev/null", "r")) std::fclose(file);
        } else if (what.is("notify a condition")) {
            condition.notify_one();
        } else if (what.is("wait for a condition")) {
            std::unique_lock lock(mutex);
            condition.wait_for(lock, std::chrono::microseconds(1));
        } else if (what.is("yield")) {
            std::this_thread::yield();
        }
    }

    void* memory_ = nullptr;
};
TACTUS_NODE(Violator, in, out, what)

namespace {

RealtimeViolations seen_in(const std::string& what) {
    NodeHarness harness(node_type_Violator());
    harness.set("what", what);
    harness.prepare();
    return watch_scopes([&] { harness.run(10); });
}

}  // namespace

TEST_CASE("a node that plants a violation in one tick is caught, whichever it is") {
    const RealtimeWatch watch = realtime_watch();
    if (!watch.missing.empty()) WARN("skipped in part: " << watch.missing);
    buffered = std::tmpfile();
    REQUIRE(buffered != nullptr);
    CHECK(seen_in("nothing").none());
    CHECK(seen_in("malloc").allocations == 1);
    CHECK(seen_in("free").releases == 1);
    CHECK(seen_in("throw").allocations >= 1);
    CHECK(seen_in("big allocation").allocations == 1);
    if (watch.locks_and_waits) {
        CHECK(seen_in("lock").locks == 1);
        CHECK(seen_in("read lock").locks == 1);
        CHECK(seen_in("print").prints == 1);
        CHECK(seen_in("sleep").waits >= 1);
        CHECK(seen_in("notify a condition").waits == 1);
        CHECK(seen_in("wait for a condition").waits >= 1);
        CHECK(seen_in("first use of a static").locks == 1);
        CHECK(seen_in("first use of a static").none());  // it was the second
    }
    if (watch.system_calls) {
        CHECK(seen_in("big allocation").system_calls >= 1);
        CHECK(seen_in("open a file").system_calls >= 1);
        CHECK(seen_in("sleep").system_calls >= 1);
        CHECK(seen_in("yield").system_calls == 1);
    }
    std::fclose(buffered);
}

TEST_CASE("without the scope around the tick no planted violation is noticed") {
    buffered = std::tmpfile();
    REQUIRE(buffered != nullptr);
    for (const std::string what : {"malloc", "free", "lock", "print", "sleep", "big allocation", "throw", "open a file",
                                   "notify a condition", "yield"}) {
        INFO(what);
        Violator violator;
        violator.what.set(what);
        double value = 2.0, result = 0.0;
        violator.in.data = reinterpret_cast<const std::byte*>(&value);
        violator.out.data = reinterpret_cast<std::byte*>(&result);
        violator.prepare({});
        const RealtimeViolations seen = watch_scopes([&] {
            for (std::int64_t k = 0; k < 10; ++k) violator.process({k, flicks_per_second / 1000, 0, 1});
        });
        CHECK(seen.none());
        CHECK(result == 2.0);
    }
    std::fclose(buffered);
}

}  // namespace tactus::test
