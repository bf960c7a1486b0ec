// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/clock.hpp"
#include "tests/support/catch.hpp"

#include <pthread.h>
#include <signal.h>

#include <algorithm>
#include <atomic>
#include <thread>

using namespace tactus;

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
