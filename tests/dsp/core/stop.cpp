// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/stop.hpp"

#include "tests/support/catch.hpp"
#include "tests/support/counted_looks.hpp"

#include <stop_token>
#include <thread>
#include <vector>

using namespace tactus;

TEST_CASE("a computation is left when its token says so, and only within the scope of that token") {
    CHECK_NOTHROW(leave_if_stopped());
    std::stop_source source;
    {
        const StopScope scope(source.get_token());
        CHECK_NOTHROW(leave_if_stopped());
        source.request_stop();
        CHECK_THROWS_AS(leave_if_stopped(), Stopped);
        {
            // Another computation in between.
            const StopScope inner{IsStopped()};
            CHECK_NOTHROW(leave_if_stopped());
        }
        CHECK_THROWS_AS(leave_if_stopped(), Stopped);
        std::thread([] { CHECK_NOTHROW(leave_if_stopped()); }).join();
        const IsStopped same = stop_of_this_thread();
        std::thread([&] {
            const StopScope there(same);
            CHECK_THROWS_AS(leave_if_stopped(), Stopped);
        }).join();
    }
    CHECK_NOTHROW(leave_if_stopped());
    CHECK_FALSE(stop_of_this_thread());
}

TEST_CASE("stoppable jobs are the same jobs with a look before each of them") {
    std::vector<int> done;
    const auto run = stoppable(run_in_turn);
    CHECK(test::looks_of([&] { run(5, [&](int n) { done.push_back(n); }); }) == 5);
    CHECK(done == std::vector<int>{0, 1, 2, 3, 4});
    done.clear();
    CHECK(test::leaves_at(3, [&] { run(5, [&](int n) { done.push_back(n); }); }));
    CHECK(done == std::vector<int>{0, 1});
}
