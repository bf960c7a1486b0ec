// SPDX-License-Identifier: Apache-2.0
// A system that refuses threads: the run or the edit says so.
#include "tests/support/refused_threads.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/engine/live_case.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <optional>
#include <string>
#include <system_error>

using namespace tactus;
using namespace tactus::test;

TEST_CASE("a run whose threads are refused says so and does not hang", "[virtual]") {
    const VirtualClock clock;
    watched_hand("left");
    PatchText patch;
    add_hand(patch, "left");
    for (const char* rate : {"500 Hz", "200 Hz", "60 Hz"})
        patch.nodes.push_back({std::string("n") + rate[0], "chaos", rate, {}});
    for (int allowed = 0; allowed < 6; ++allowed) {
        INFO(allowed << " threads");
        run::EngineOptions options;
        options.seconds = 0.05;
        options.live = true;
        run::Engine engine(compile_text(patch.toml()), options);
        const RefusedThreads refused(allowed);
        bool failed = false;
        try {
            engine.run_live({});
        } catch (const std::system_error& error) {
            failed = true;
            CHECK_THAT(error.what(), Catch::Matchers::ContainsSubstring("thread"));
        }
        CHECK(failed == (refused.asked() > allowed));
    }
}

TEST_CASE("an edit whose threads are refused is not made, and the patch runs on as it was", "[virtual]") {
    const VirtualClock clock;
    WatchedHand& hand = watched_hand("left");
    watched_hand("right");
    PatchText plain, more;
    add_hand(plain, "left");
    add_hand(more, "left");
    add_hand(more, "right");
    for (const char* rate : {"500 Hz", "200 Hz", "60 Hz"})
        more.nodes.push_back({std::string("n") + rate[0], "chaos", rate, {}});
    int failed = 0, made = 0;
    std::optional<RefusedThreads> refused;
    int allowed = 0;
    bool is_waiting = false;
    run_case({plain.toml(), 30.0, [](run::Engine&) {},
              [&](run::Engine& engine) {
                  if (is_waiting || !engine.is_settled()) return false;
                  if (made > 0) return true;
                  is_waiting = true;
                  refused.reset();
                  refused.emplace(allowed++);
                  engine.edit([&] { return compile_text(more.toml()); },
                              [&](const run::EditOutcome& outcome) {
                                  is_waiting = false;
                                  (outcome.error ? failed : made) += 1;
                                  if (outcome.error)
                                      CHECK_THAT(*outcome.error, Catch::Matchers::ContainsSubstring("thread"));
                              });
                  return false;
              }},
             hand);
    CHECK(made == 1);
    CHECK(failed >= 3);
    CHECK(hand.largest_after(0) == Approx(2.0));
}
