// SPDX-License-Identifier: Apache-2.0
#include "tests/engine/chaos.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/realtime_check.hpp"

using namespace tactus;
using namespace tactus::test;

TEST_CASE("taking a plan over, setting a parameter and recording a take are real-time safe") {
    const RealtimeWatch watch = realtime_watch();
    if (!watch.missing.empty()) WARN(watch.missing);
    const auto folder = scratch("swaps");
    {
        take::TakeWriter take(folder,
                              {.patch_file = "swaps.toml", .overrides = {}, .seed = {}, .seconds = 1.0, .live = false});
        run::EngineOptions options;
        options.take = &take;
        run::Engine engine(compile_text(edited(0)), options);
        for (int i = 1; i <= 40; ++i)
            engine.schedule(compile_text(edited(static_cast<std::uint64_t>(i))), i * flicks_per_second / 50);
        const RealtimeViolations seen = watch_scopes([&] { engine.render(1); });
        INFO(seen.describe());
        CHECK(seen.none());
        CHECK(engine.edits() == 40);
        engine.finish();
    }
    std::filesystem::remove_all(folder);
}
