// SPDX-License-Identifier: Apache-2.0
// Recording that begins and ends within a live run.
#include "tests/engine/chaos.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <sndfile.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <set>

using namespace tactus;
using namespace tactus::test;

namespace {

take::TakeAbout about() { return {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 1.0, .live = true}; }

/// A run of a second whose control thread does at each time what is written beside it.
run::Engine::PortHashes run_with(const std::filesystem::path& folder,
                                 std::map<double, std::function<void(run::Engine&)>> deeds,
                                 const std::function<void(run::EngineOptions&)>& choose = {}) {
    take::TakeWriter take(folder, about());
    run::EngineOptions options;
    options.seconds = 1.0;
    options.live = true;
    options.take = &take;
    options.take_values = run::TakeValues::on_request;
    if (choose) choose(options);
    run::Engine engine(compile_text(edited(3)), options);
    run::LiveOptions live;
    live.watch = [&] {
        while (!deeds.empty() && engine.progress_seconds() >= deeds.begin()->first && engine.is_settled()) {
            deeds.begin()->second(engine);
            deeds.erase(deeds.begin());
        }
    };
    engine.run_live(live);
    engine.finish();
    CHECK(deeds.empty());
    return engine.port_hashes();
}

void change_to(run::Engine& engine, std::uint64_t seed) {
    engine.edit([seed] { return compile_text(edited(seed)); }, {});
}

}  // namespace

TEST_CASE("recording begins within a run for all outputs at one time, and the take repeats the run to the bit",
          "[virtual]") {
    const VirtualClock clock;
    const auto folder = scratch("record");
    Flicks begun = 0;
    const auto hashes = run_with(folder, {{0.1, [](run::Engine& e) { change_to(e, 4); }},
                                          {0.3,
                                           [&](run::Engine& e) {
                                               e.record(true);
                                               begun = static_cast<Flicks>(e.progress_seconds() * 1e6) *
                                                       (flicks_per_second / 1'000'000);
                                           }},
                                          {0.5, [](run::Engine& e) { change_to(e, 5); }},
                                          {0.7, [](run::Engine& e) { e.record(false); }},
                                          {0.75, [](run::Engine& e) { CHECK_FALSE(e.is_recording()); }}});
    const take::Take take = take::Take::load(folder);
    REQUIRE_FALSE(take.streams.empty());
    // Streams of nodes that were there already begin together, to the tick of each group.
    std::multiset<Flicks> starts;
    for (const take::TakeStreamInfo& info : take.streams) {
        const Flicks start = info.start * info.period;
        CHECK(start >= begun);
        starts.insert(start / (flicks_per_second / 60));
        const take::TakeStreamReader reader(folder / info.file, info);
        CHECK(seconds((info.start + reader.frames()) * info.period) < 0.95);
    }
    CHECK(starts.count(*starts.begin()) + starts.count(*starts.begin() + 1) >= take.streams.size() / 2);
    const Repetition again = repeat(folder, 2);
    if (again.difference) FAIL(again.difference->port << " differs at tick " << again.difference->tick);
    CHECK(again.compared > 1000);
    CHECK(again.hashes == hashes);
    CHECK(again.matches_result);
    std::filesystem::remove_all(folder);
}

TEST_CASE("a run that is recorded twice has two stretches of each output in one take", "[virtual]") {
    const VirtualClock clock;
    const auto folder = scratch("twice");
    const auto hashes = run_with(folder, {{0.1, [](run::Engine& e) { e.record(true); }},
                                          {0.25, [](run::Engine& e) { e.record(false); }},
                                          {0.5, [](run::Engine& e) { e.record(true); }}});
    const take::Take take = take::Take::load(folder);
    std::map<std::string, int> stretches;
    for (const take::TakeStreamInfo& info : take.streams) ++stretches[info.port];
    for (const auto& [port, count] : stretches) CHECK(count == 2);
    const Repetition again = repeat(folder, 1);
    if (again.difference) FAIL(again.difference->port << " differs at tick " << again.difference->tick);
    CHECK(again.compared > 1000);
    CHECK(again.hashes == hashes);
    std::filesystem::remove_all(folder);
}

TEST_CASE("a request to record lifts the limit of a take that records already, and nothing says that its values ended",
          "[virtual]") {
    const VirtualClock clock;
    const auto folder = scratch("lifted");
    const auto bytes_with = [&](std::uint64_t limit, std::map<double, std::function<void(run::Engine&)>> deeds) {
        std::vector<std::string> notices;
        deeds[0.9] = [&](run::Engine& e) { notices = e.host().notices; };
        run_with(folder, deeds, [limit](run::EngineOptions& options) {
            options.take_values = run::TakeValues::all;
            options.take->limit_values(limit);
        });
        const take::Take take = take::Take::load(folder);
        CHECK(take.values_end_s.has_value() == (limit > 0 && deeds.size() == 1));
        const auto tells = [](const std::string& notice) { return notice.find("holds values") != notice.npos; };
        CHECK(std::ranges::any_of(notices, tells) == take.values_end_s.has_value());
        std::uint64_t bytes = 0;
        for (const take::TakeStreamInfo& info : take.streams)
            bytes += 8 * static_cast<std::uint64_t>(info.channels) *
                     static_cast<std::uint64_t>(take::TakeStreamReader(folder / info.file, info).frames());
        std::filesystem::remove_all(folder);
        return bytes;
    };
    const std::uint64_t all = bytes_with(0, {}), limit = all * 6 / 10;
    CHECK(bytes_with(limit, {}) <= limit);
    CHECK(bytes_with(limit, {{0.3, [](run::Engine& e) { e.record(true); }}}) > all * 95 / 100);
}

TEST_CASE("a value that was changed in the second stretch of a take is found", "[virtual]") {
    const VirtualClock clock;
    const auto folder = scratch("forged");
    run_with(folder, {{0.1, [](run::Engine& e) { e.record(true); }},
                      {0.25, [](run::Engine& e) { e.record(false); }},
                      {0.5, [](run::Engine& e) { e.record(true); }}});
    const take::Take take = take::Take::load(folder);
    const auto second = std::ranges::find_if(take.streams, [](const auto& s) {
        return s.port == "a.out" && s.start * s.period > flicks_per_second * 2 / 5;
    });
    REQUIRE(second != take.streams.end());
    std::fstream file(folder / second->file, std::ios::in | std::ios::out | std::ios::binary);
    // A number of `a.out` in the last frame.
    SF_INFO format{};
    sf_close(sf_open((folder / second->file).c_str(), SFM_READ, &format));
    const std::int64_t from_end = 8 * (format.channels - second->channel);
    file.seekg(-from_end, std::ios::end);
    const char byte = static_cast<char>(file.peek() ^ 0x10);
    file.seekp(-from_end, std::ios::end);
    file.put(byte);
    file.close();
    const Repetition again = repeat(folder, 1);
    REQUIRE(again.difference);
    CHECK(again.difference->port == "a.out");
    CHECK(again.difference->tick > second->start);
    std::filesystem::remove_all(folder);
}

TEST_CASE("a journal that grows too long is given up, and only recording is refused from then on", "[virtual]") {
    const VirtualClock clock;
    const auto folder = scratch("long");
    bool was_refused = false;
    std::vector<std::string> notices;
    run_with(folder,
             {{0.8,
               [&](run::Engine& e) {
                   CHECK_THROWS_WITH(e.record(true), Catch::Matchers::ContainsSubstring("restart it"));
                   was_refused = true;
                   notices = e.host().notices;
               }}},
             [](run::EngineOptions& options) { options.longest_journal = 100; });
    CHECK(was_refused);
    CHECK(std::ranges::any_of(notices, [](const auto& n) { return n.find("no longer be recorded") != n.npos; }));
    CHECK(take::Take::load(folder).streams.empty());
    std::filesystem::remove_all(folder);
}
