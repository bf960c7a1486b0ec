// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/commit_guard.hpp"
#include "tests/support/catch.hpp"

#include <atomic>
#include <thread>

using namespace tactus;

namespace {
constexpr std::int64_t ms = 1'000'000;
}

TEST_CASE("the watchdog leaves a device alone that is committed to in time") {
    control::CommitGuard guard;
    Wrench out;
    CHECK_FALSE(guard.poll(50 * ms, out));
    for (std::int64_t now = 0; now < 100 * ms; now += ms) {
        REQUIRE(guard.begin());
        guard.end({{0.0, 0.0, 5.0}, {}}, now);
        REQUIRE_FALSE(guard.poll(now + 2 * ms, out));
    }
}

TEST_CASE("a force older than 3 ms fades to zero within 10 ms and stays there until released") {
    control::CommitGuard guard;
    REQUIRE(guard.begin());
    guard.end({{0.0, 0.0, 5.0}, {}}, 0);
    Wrench out;
    CHECK_FALSE(guard.poll(3 * ms, out));
    REQUIRE(guard.poll(4 * ms, out));
    CHECK(out.force.z == Approx(5.0));
    REQUIRE(guard.poll(9 * ms, out));
    CHECK(out.force.z == Approx(2.5));
    REQUIRE(guard.poll(14 * ms, out));
    CHECK(out.force.z == 0.0);
    CHECK(guard.is_taken());
    CHECK_FALSE(guard.begin());
    guard.release();
    CHECK(guard.begin());
    guard.end({}, 30 * ms);
    CHECK_FALSE(guard.poll(31 * ms, out));
}

TEST_CASE("a device inside a commit is not taken over") {
    control::CommitGuard guard;
    REQUIRE(guard.begin());
    guard.end({}, 0);
    REQUIRE(guard.begin());
    Wrench out;
    CHECK_FALSE(guard.poll(100 * ms, out));
    guard.end({}, 100 * ms);
    CHECK_FALSE(guard.poll(101 * ms, out));
}

TEST_CASE("two threads never commit at the same time") {
    control::CommitGuard guard;
    guard.limit_ns = 0;
    std::atomic<std::int64_t> now{1};
    std::atomic<int> inside{0};
    std::atomic<int> overlaps{0};
    std::atomic<bool> done{false};
    const auto commit = [&] {
        if (inside.fetch_add(1) != 0) overlaps.fetch_add(1);
        inside.fetch_sub(1);
    };
    std::thread watchdog([&] {
        Wrench out;
        while (!done.load()) {
            if (!guard.poll(now.fetch_add(1) + 1, out)) continue;
            commit();
            guard.release();
        }
    });
    for (int i = 0; i < 50'000; ++i) {
        if (!guard.begin()) continue;
        commit();
        guard.end({}, now.load());
    }
    done.store(true);
    watchdog.join();
    CHECK(overlaps.load() == 0);
}

TEST_CASE("a device without a commit is not taken over, not even at once") {
    control::CommitGuard guard;
    Wrench out;
    CHECK_FALSE(guard.poll(50 * ms, out, true));
    CHECK_FALSE(guard.is_taken());
    CHECK(guard.begin());
}
