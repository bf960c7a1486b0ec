// SPDX-License-Identifier: Apache-2.0
// A take that is looked at, at any instant and in any order.
#include "tests/support/catch.hpp"
#include "tests/tools/patches.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/run/replayed_take.hpp"
#include "tools/window/desk/take_bench.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

using namespace tactus;
using namespace tactus::run;
using namespace tactus::window;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::voice;

namespace {

std::filesystem::path rendered(Folder& folder, const std::string& patch, const std::string& seconds) {
    const std::filesystem::path take = folder.path / "take";
    const Outcome done = folder.tactus("render " + patch + " --seconds " + seconds + " --out " +
                                       (folder.path / "out").string() + " --record " + take.string());
    INFO(done.err);
    REQUIRE(done.code == 0);
    return take;
}

void wait_for_scene(TakeBench& bench) {
    for (int i = 0; i < 6000 && !bench.scene_is_there(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    REQUIRE(bench.scene_is_there());
    bench.tend(0.0);
}

/// Version and samples, bit by bit.
bool same(const observe::SeenBone& a, const observe::SeenBone& b) {
    if (a.version != b.version || a.root.distance.size() != b.root.distance.size()) return false;
    for (std::size_t i = 0; i < a.root.distance.size(); ++i) {
        const float *x = a.root.distance[i], *y = b.root.distance[i];
        if (!x != !y || (x && !std::equal(x, x + volume::brick_samples, y))) return false;
    }
    return true;
}

}  // namespace

TEST_CASE("the bone at an instant of a take is that of a run to there, whatever was looked at before", "[slow]") {
    Folder folder;
    TakeBench bench(rendered(folder, "saw-training", "3"));
    bench.go_to(bench.length());
    wait_for_scene(bench);
    compile::AssetCache assets;
    std::int64_t last_version = -1;
    std::size_t changed = 0;
    for (const double t : {2.0041, 0.3456, 2.9876, 1.2345, 2.0041}) {
        bench.go_to(t);
        observe::Observer observer(observe::Observer::Pace::lossless);
        for (const char* port : {"carve.bone", "place.pose"}) observer.watch(port, observe::Watch::latest);
        run::EngineOptions options;
        options.observer = &observer;
        options.seconds = t;
        ReplayedTake run(bench.take(), options, assets);
        run.engine().render(1);
        observer.advance();
        const auto scrubbed = bench.scene()->bone("carve.bone"), reached = observer.bone("carve.bone");
        REQUIRE((scrubbed && reached));
        INFO("at " << t << " s");
        CHECK(same(*scrubbed, *reached));
        CHECK(scrubbed->version != last_version);
        const auto pose = bench.scene()->latest<Pose>("place.pose"), there = observer.latest<Pose>("place.pose");
        CHECK((there && pose && pose->value.position == there->value.position));
        last_version = scrubbed->version;
        changed += scrubbed->changed_since(1).size();
    }
    CHECK(changed > 0);
}

TEST_CASE("a take that is played gives the values that a jump to the same instant gives") {
    Folder folder;
    const std::string patch = folder.write("voice.toml", voice).string();
    const take::Take take = take::Take::load(rendered(folder, patch, "2"));
    TakeFeed played(take);
    const std::set<std::string> ports{"tone.signal", "level.value"};
    played.traced_s = 0.3;
    for (double t = 0.1; t < 1.95; t += 0.0173) {
        played.set_now(t);
        played.follow(ports, ports);
        CHECK(played.trace("tone.signal")->times.size() < std::size_t{48000} / 2);
    }
    for (const double t : {1.2, 0.4, 1.6}) {
        played.set_now(t);
        played.follow(ports, ports);
        TakeFeed jumped(take);
        jumped.traced_s = 0.3;
        jumped.set_now(t);
        jumped.follow(ports, ports);
        for (const std::string& port : ports) {
            const Trace &a = *played.trace(port), &b = *jumped.trace(port);
            REQUIRE(a.times.size() >= b.times.size());
            const auto more = static_cast<std::ptrdiff_t>(a.times.size() - b.times.size());
            CHECK(std::equal(a.times.begin() + more, a.times.end(), b.times.begin(), b.times.end()));
            CHECK(std::equal(a.columns[0].begin() + more, a.columns[0].end(), b.columns[0].begin()));
            CHECK(played.latest(port).columns[0] == jumped.latest(port).columns[0]);
        }
    }
}
