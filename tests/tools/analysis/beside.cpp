// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/beside.hpp"

#include "dsp/core/stop.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/held_lane.hpp"
#include "tools/analysis/leaving.hpp"
#include "tools/analysis/workers.hpp"

#include <sys/resource.h>

#include <atomic>
#include <memory>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

using namespace tactus::analysis;

TEST_CASE("what is computed beside the pictures is let go at once and told to stop") {
    const auto begun = std::make_shared<std::atomic<bool>>(false),
               was_told = std::make_shared<std::atomic<bool>>(false);
    {
        Beside<int> result;
        result.begin(Lane::studies, [begun, was_told](std::stop_token stop) {
            *begun = true;
            begun->notify_all();
            // Whoever waited for it would wait for ever.
            while (!stop.stop_requested()) std::this_thread::yield();
            *was_told = true;
            was_told->notify_all();
            return 1;
        });
        begun->wait(false);
        CHECK(result.is_busy());
        CHECK_FALSE(result.is_ready());
    }
    was_told->wait(false);
    CHECK(*was_told);
}

namespace {

/// Tells when what holds it is gone.
struct Gone {
    std::shared_ptr<std::atomic<bool>> is_gone;
    ~Gone() {
        *is_gone = true;
        is_gone->notify_all();
    }
};

}  // namespace

TEST_CASE("a computation beside the pictures that is let go leaves at its next look on all of its threads") {
    const auto begun = std::make_shared<std::atomic<bool>>(false), is_gone = std::make_shared<std::atomic<bool>>(false);
    {
        Beside<int> result;
        result.begin(Lane::studies, leaving([begun, is_gone] {
                         const Gone gone{is_gone};
            // Nothing in between knows of a token.
                         on_threads(3)(3, [&](int) {
                             *begun = true;
                             begun->notify_all();
                             for (;;) tactus::leave_if_stopped();
                         });
                         return 1;
                     }));
        begun->wait(false);
    }
    is_gone->wait(false);
    Beside<int> next;
    next.begin(Lane::studies, leaving([] {
                   tactus::leave_if_stopped();
                   return 2;
               }));
    CHECK(next.take() == 2);
}

TEST_CASE("what waits to be computed and is wanted no longer is not computed") {
    const auto count = std::make_shared<std::atomic<int>>(0);
    Beside<int> kept;
    {
        const tactus::test::HeldLane held(Lane::studies);
        Beside<int> dropped, replaced;
        dropped.begin(Lane::studies, [count] { return ++*count; });
        replaced.begin(Lane::studies, [count] { return ++*count; });
        replaced.begin(Lane::studies, [count] { return 10 + ++*count; });
        CHECK(jobs_waiting(Lane::studies) == 3);
        kept = std::move(replaced);
        CHECK_FALSE(replaced.is_busy());
        dropped.let_go();
        CHECK_FALSE(dropped.is_busy());
    }
    CHECK(kept.take() == 11);
    CHECK_FALSE(kept.is_busy());
    CHECK(*count == 1);
}

TEST_CASE("a lane does one thing after another at low priority and the other lane goes on") {
    const tactus::test::HeldLane studies(Lane::studies);
    std::atomic<int> at_once{0}, most{0};
    std::vector<Beside<int>> all(8);
    for (auto& one : all)
        one.begin(Lane::scene, [&] {
            const int now = ++at_once;
            if (now > most) most = now;
            std::this_thread::yield();
            --at_once;
            return getpriority(PRIO_PROCESS, 0);
        });
    for (auto& one : all) CHECK(one.take() >= 10);
    CHECK(most == 1);
}

TEST_CASE("what a computation beside the pictures throws comes out where its result is taken") {
    Beside<int> result;
    result.begin(Lane::scene, []() -> int { throw std::runtime_error("no such bone"); });
    CHECK_THROWS_WITH(result.take(), "no such bone");
    CHECK_FALSE(result.is_busy());
    result.begin(Lane::scene, [] { return 2; });
    CHECK(result.take() == 2);
}
