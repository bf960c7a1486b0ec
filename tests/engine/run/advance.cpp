// SPDX-License-Identifier: Apache-2.0
// Runs that a program advances from a loop of its own.
#include "dsp/core/random.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;
using namespace tactus::test;

namespace {

constexpr Flicks length = flicks_per_second / 2;

run::EngineOptions long_enough() {
    run::EngineOptions options;
    options.seconds = 1e6;
    return options;
}

std::uint64_t rendered(const std::string& toml) {
    run::EngineOptions options;
    options.seconds = seconds(length);
    run::Engine engine(compile_text(toml), options);
    engine.render(1);
    return engine.output_hash();
}

}  // namespace

TEST_CASE("a run that is advanced in steps of any length has the bits of a render") {
    for (const std::uint64_t seed : {0, 1, 2, 3, 4}) {
        const std::string patch = seed == 0 ? four_rates() : edited(seed);
        run::Engine engine(compile_text(patch), long_enough());
        const Random random{seed};
        std::uint64_t draws = 0;
        // From less than a sample to many ticks.
        for (Flicks now = 0; now < length;) {
            now = std::min(length, now + static_cast<Flicks>(std::exp2(10.0 + 16.0 * random.uniform(draws++))));
            engine.advance(now);
        }
        engine.end_advance();
        INFO("seed " << seed << ", " << draws << " steps");
        CHECK(engine.output_hash() == rendered(patch));
        for (const auto& group : engine.groups()) CHECK(group->next() == ceil_div(length, group->plan->period));
    }
}

TEST_CASE("a program's loop may advance a run in real time: nothing is allocated, locked, waited for or written") {
    run::Engine engine(compile_text(four_rates()), long_enough());
    engine.advance(flicks_per_second / 100);  // the first call lists the groups
    const RealtimeViolations seen = watch([&] {
        for (int tick = 11; tick < 200; ++tick) engine.advance(tick * (flicks_per_second / 1000));
    });
    CHECK(seen.describe() == "none");
}

TEST_CASE("a parameter that is set between two steps holds 3 ms later, whatever the steps are") {
    const PatchText text{{{"level", "constant", "1 kHz", {{"number", "1"}}}, {"keeper", "keeper", "1 kHz", {}}},
                         {"level.value -> keeper.number"},
                         "seed = 7\n"};
    for (const Flicks step : {Flicks{1}, Flicks{7}, Flicks{50}}) {
        run::Engine engine(compile_text(text.toml()), long_enough());
        const Flicks ms = flicks_per_second / 1000;
        Flicks now = 0;
        const auto advance_to = [&](Flicks end) {
            while (now < end * ms) engine.advance(now = std::min(end * ms, now + step * ms));
        };
        advance_to(100);
        CHECK(engine.set("level", "number", "2") == 103 * ms);
        advance_to(200);
        engine.end_advance();
        const std::vector<double>& values = kept_values();
        REQUIRE(values.size() == 200);
        CHECK(values[102] == 1.0);
        CHECK(values[103] == 2.0);
    }
}
