// SPDX-License-Identifier: Apache-2.0
// Takes of runs that were killed.
#include "engine/take/take_writer.hpp"
#include "engine/take/timing_log.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <filesystem>
#include <vector>

using namespace tactus;
using namespace tactus::test;

TEST_CASE("the take of a killed offline run can be replayed up to the last 64 KiB of its log", "[virtual]") {
    // The clock stands still, so no flush is due by time. Group 1 writes progress records only.
    const VirtualClock clock;
    const auto folder = scratch("cut_off");
    {
        take::TakeWriter take(folder,
                              {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 60.0, .live = false});
        const compile::Schedule plan = compile_text("[nodes.n]\ntype = \"chaos\"\nrate = \"1 kHz\"\n");
        take.begin(plan.patch, 1);
        take::TimingRecord record;
        record.kind = take::TimingKind::device_sample;
        Flicks flushed = 0;
        std::vector<std::uint64_t> sizes;  // of the log after each tick
        for (std::int64_t tick = 0; tick < 20'000; ++tick) {
            record.tick = tick;
            record.sample.pose.position = {1e-3 * static_cast<double>(tick % 97), 1.0 / (1.0 + tick), 0.1};
            take.record(record);
            take.checkpoint({{0, tick + 1, (tick + 1) * 1000}, {1, tick / 10, tick * 1000}});
            sizes.push_back(take.size());
            if (tick % 1000 != 999) continue;
            const take::TimingLog log = take::TimingLog::load(folder / "timing.log", true);
            CHECK(log.cut >= flushed);
            CHECK(log.cut <= tick * 1000);
            flushed = log.cut;
            // 64 KiB, and a chunk of 16 KiB that is not full yet.
            CHECK(take.size() - sizes[static_cast<std::size_t>(log.cut / 1000)] <= 80 * 1024);
        }
        CHECK(flushed > 5'000'000);
    }
    std::filesystem::remove_all(folder);
}
