// SPDX-License-Identifier: Apache-2.0
#include "engine/observe/observer.hpp"

#include "dsp/volume/bricks.hpp"
#include "graph/compile/compile.hpp"
#include "graph/patch/patch.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/virtual_clock.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

using namespace tactus;
using namespace tactus::test;

namespace {

volume::Grid field_of(double radius) {
    volume::Grid grid{{33, 33, 33}, Vec3(-16.0), Vec3(1.0), {}};
    for (int k = 0; k < 33; ++k)
        for (int j = 0; j < 33; ++j)
            for (int i = 0; i < 33; ++i)
                grid.values.push_back(static_cast<float>(glm::length(grid.position(i, j, k)) - radius));
    return grid;
}

/// Takes bites out of a ball, at places that a number decides, and publishes every tick.
struct Whittler {
    static constexpr auto about = "Changes a bone at random.";

    In<double> where{optional, "of the bites"};
    Out<volume::BoneSnapshot> bone{"as bitten so far"};

    void prepare(const Setup& setup) {
        volume::BoneEditorOptions options;
        options.band = 100.0;
        volume::Grid density = field_of(0.0);
        std::ranges::fill(density.values, 1500.0f);
        editor_ = std::make_unique<volume::BoneEditor>(field_of(10.0), density, options);
        random_ = Random{setup.seed};
        bone = editor_->current();
    }
    void process(const Tick& tick) noexcept {
        if (bone.last_was_dropped) editor_->forget(bone.get().version);
        editor_->reclaim(bone.oldest_readable);
        for (std::uint64_t n = 0; n < 20; ++n) {
            const std::uint64_t bits = random_.bits(static_cast<std::uint64_t>(tick.index) * 20 + n);
            const int i = static_cast<int>(bits % 33), j = static_cast<int>(bits / 33 % 33),
                      k = static_cast<int>(bits / 1089 % 33);
            editor_->set(i, j, k, static_cast<float>(where + static_cast<double>(bits % 1000) * 1e-3));
        }
        bone = editor_->publish();
    }
    std::unique_ptr<volume::BoneEditor> editor_;
    Random random_{1};
};
TACTUS_NODE(Whittler, where, bone)

/// Reads a bone slowly, so that versions stay pinned for a while.
struct Taster {
    static constexpr auto about = "Sums a bone.";
    In<volume::BoneSnapshot> bone{"to be read"};
    Out<double> sum{"over some places"};
    void process(const Tick& tick) noexcept {
        double all = 0.0;
        for (int n = 0; n < 50; ++n) all += bone->value(Vec3(n % 16 - 8, (n + tick.index) % 16 - 8, n % 7));
        sum = all;
    }
};
TACTUS_NODE(Taster, bone, sum)

compile::Schedule compiled(const std::string& toml) {
    static const std::vector<const NodeType*> types = [] {
        std::vector<const NodeType*> with(chaos_catalogue().begin(), chaos_catalogue().end());
        with.push_back(&node_type_Whittler());
        with.push_back(&node_type_Taster());
        return with;
    }();
    patch::Problems problems;
    auto plan = compile::compile(patch::read_patch(toml, "test.toml", problems), types, problems);
    for (const Error& problem : problems.list) UNSCOPED_INFO(problem.what());
    REQUIRE(problems.empty());
    return std::move(*plan);
}

std::string whittling() {
    return PatchText{{{"a", "chaos", "1 kHz", {}},
                      {"voice", "chaos_signal", "48 kHz", {}},
                      {"carve", "whittler", "60 Hz", {}},
                      {"taste", "taster", "150 Hz", {}}},
                     {"a.out -> carve.where", "carve.bone -> taste.bone", "a.out -> voice.held"},
                     "seed = 3"}
        .toml();
}

void watch_everything(observe::Observer& observer, observe::Watch how) {
    for (const char* port : {"a.out", "a.pose", "voice.signal", "voice.level", "carve.bone", "taste.sum"})
        observer.watch(port, how);
}

bool holds_the_same(const observe::SeenBone& seen, const volume::BoneSnapshot& bone) {
    for (std::size_t b = 0; b < bone.root->distance.size(); ++b)
        if (!std::equal(bone.root->distance[b], bone.root->distance[b] + volume::brick_samples, seen.root.distance[b]))
            return false;
    return true;
}

volume::BoneSnapshot bone_of(const run::Engine& engine) {
    const auto& node = *engine.nodes()[static_cast<std::size_t>(2)];
    REQUIRE(node.name == "carve");
    return *reinterpret_cast<const volume::BoneSnapshot*>(node.outputs.front()->data);
}

}  // namespace

TEST_CASE("a run has the same hash whether nobody, a busy or a sleeping observer looks on") {
    std::uint64_t lost = 0;
    const auto hash_with = [&lost](observe::Observer* observer) {
        run::EngineOptions options;
        options.seconds = 2.0;
        options.observer = observer;
        run::Engine engine(compiled(whittling()), options);
        engine.render(2);
        lost = 0;
        for (const char* port : {"voice.signal", "carve.bone", "a.out"}) lost += observer ? observer->lost(port) : 0;
        return engine.output_hash();
    };
    const std::uint64_t alone = hash_with(nullptr);
    observe::Observer blind, sleeping, lossless(observe::Observer::Pace::lossless), busy;
    CHECK(hash_with(&blind) == alone);
    watch_everything(sleeping, observe::Watch::every);
    CHECK(hash_with(&sleeping) == alone);
    CHECK(lost > 0);
    watch_everything(lossless, observe::Watch::every);
    CHECK(hash_with(&lossless) == alone);
    CHECK(lost == 0);
    watch_everything(busy, observe::Watch::every);
    std::atomic<bool> stop{false};
    std::thread viewer([&] {
        observe::SeenValues values;
        while (!stop) {
            busy.advance();
            busy.fetch("voice.signal", values);
            busy.latest<Pose>("a.pose");
            busy.bone("carve.bone");
        }
    });
    CHECK(hash_with(&busy) == alone);
    stop = true;
    viewer.join();
}

TEST_CASE("a lossless observer sees every value, and a bone as it was at any time") {
    observe::Observer observer(observe::Observer::Pace::lossless);
    watch_everything(observer, observe::Watch::every);
    run::EngineOptions options;
    options.seconds = 2.0;
    options.observer = &observer;
    run::Engine engine(compiled(whittling()), options);
    const auto before = observer.bone("carve.bone");
    REQUIRE(before);
    CHECK(holds_the_same(*before, bone_of(engine)));
    engine.render(2);

    observer.advance(flicks_per_second);
    const auto then = observer.bone("carve.bone");
    CHECK(then.get() == before.get());
    CHECK(then->when == flicks_per_second);
    CHECK(then->version == 62);  // 61 activations, each with bites, after version 1
    CHECK_FALSE(holds_the_same(*then, bone_of(engine)));
    CHECK(observer.latest<double>("a.out")->when == flicks_per_second);
    observe::SeenValues values;
    CHECK(observer.fetch("voice.signal", values));
    CHECK(values.when.size() == 48001);

    observer.advance();
    CHECK(holds_the_same(*observer.bone("carve.bone"), bone_of(engine)));
    CHECK(observer.fetch("voice.signal", values));
    REQUIRE(values.when.size() == 96000);
    for (std::size_t i = 0; i < values.when.size(); ++i) CHECK(values.when[i] == Flicks(i) * flicks_per_second / 48000);
}

TEST_CASE("an observer that begins late, or sleeps until its ring is full, has the whole bone soon after it looks") {
    // 17 x 17 x 17 bricks, all of them stored.
    volume::Grid grid{{137, 137, 137}, Vec3(0.0), Vec3(1.0), {}};
    grid.values.assign(grid.count(), 0.5f);
    volume::BoneEditor editor(grid, grid, {.band = 100.0, .max_dirty = 4913});
    const volume::BoneSnapshot initial = editor.current();
    observe::Observer observer;
    const auto port = observer.open({"carve.bone", flicks_per_second / 60, 1}, value::snapshot<volume::BoneSnapshot>,
                                    reinterpret_cast<const std::byte*>(&initial));
    std::int64_t tick = 0;
    const auto run = [&](int ticks, int step) {
        for (; ticks > 0; --ticks, ++tick) {
            // One sample of each brick changes.
            for (int n = 0; step > 0 && n < 4913; n += step)
                editor.set(n % 17 * 8 + 4, n / 17 % 17 * 8 + 4, n / 289 * 8 + 4, static_cast<float>(tick + 1));
            const volume::BoneSnapshot now = editor.publish();
            port->see(tick, reinterpret_cast<const std::byte*>(&now), 1, 0);
            editor.reclaim(now.version);
        }
    };
    const auto bone = observer.bone("carve.bone");
    run(3, 10);  // unseen
    CHECK_FALSE(holds_the_same(*bone, editor.current()));
    observer.watch("carve.bone", observe::Watch::latest);
    run(1, 10);
    run(80, 0);  // everything comes again, 64 bricks at a time
    CHECK(observer.lost("carve.bone") > 0);  // more than the ring holds
    for (int n = 0; n < 80; ++n) {
        observer.advance();
        run(1, 0);
    }
    observer.advance();
    CHECK(holds_the_same(*bone, editor.current()));
    CHECK(bone->version == editor.current().version);
    CHECK(bone->changed_since(1).size() == 4913);
    const std::uint64_t before = bone->update;
    run(1, 100);
    observer.advance();
    CHECK(bone->changed_since(before).size() == 50);
    CHECK(holds_the_same(*bone, editor.current()));
}

TEST_CASE("a live run goes on alike under an observer that comes, goes and reads while values change", "[virtual]") {
    const VirtualClock clock;
    observe::Observer observer;
    run::EngineOptions options;
    options.seconds = 1.0;
    options.live = true;
    options.observer = &observer;
    run::Engine engine(compiled(whittling()), options);
    std::atomic<bool> stop{false};
    std::int64_t seen = 0;
    bool rises = true;
    std::thread viewer([&] {
        Flicks last = -1;
        for (int n = 0; !stop; ++n) {
            watch_everything(observer, n % 8 == 7   ? observe::Watch::nothing
                                       : n % 3 == 0 ? observe::Watch::every
                                                    : observe::Watch::latest);
            observer.advance();
            if (const auto value = observer.latest<Pose>("a.pose")) {
                rises = rises && value->when >= last;
                last = value->when;
                ++seen;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    });
    engine.run_live({});
    stop = true;
    viewer.join();
    CHECK(rises);
    CHECK(seen > 10);
    CHECK(engine.progress_seconds() == Approx(1.0));
}

TEST_CASE("outputs are followed by name through edits, and those that are gone are not there") {
    observe::Observer observer(observe::Observer::Pace::lossless);
    observer.watch("a.out", observe::Watch::latest);
    observer.watch("b.out", observe::Watch::latest);
    observer.watch("carve.bone", observe::Watch::latest);
    const std::string more = whittling() + "[nodes.b]\ntype = \"chaos\"\nrate = \"1 kHz\"\n";
    std::string other = more;
    other.replace(other.find("seed = 3"), 8, "seed = 4");
    run::EngineOptions options;
    options.seconds = 2.0;
    options.observer = &observer;
    run::Engine engine(compiled(whittling()), options);
    const auto first = observer.bone("carve.bone");
    engine.schedule(compiled(more), flicks_per_second / 2);
    engine.schedule(compiled(other), flicks_per_second);  // another seed makes every node anew
    engine.render(1);
    observer.advance(flicks_per_second * 3 / 4);
    CHECK(observer.latest<double>("a.out")->when == flicks_per_second * 3 / 4);
    CHECK(observer.latest<double>("b.out")->when == flicks_per_second * 3 / 4);
    CHECK(observer.bone("carve.bone").get() == first.get());
    CHECK_FALSE(observer.latest<Pose>("a.out"));
    CHECK_FALSE(observer.latest<double>("nobody.out"));
    observer.advance();
    CHECK(seconds(observer.latest<double>("b.out")->when) == Approx(1.999));
    const auto last = observer.bone("carve.bone");
    CHECK(last.get() != first.get());
    CHECK(holds_the_same(*last, bone_of(engine)));
}

TEST_CASE("what was seen outlives the run") {
    observe::Observer observer(observe::Observer::Pace::lossless);
    watch_everything(observer, observe::Watch::latest);
    std::shared_ptr<const observe::SeenBone> bone;
    {
        run::EngineOptions options;
        options.seconds = 0.5;
        options.observer = &observer;
        run::Engine engine(compiled(whittling()), options);
        engine.render(1);
        observer.advance();
        bone = observer.bone("carve.bone");
    }
    CHECK(bone->snapshot().value(Vec3(0.0)) != 0.0);
    observer.advance();
    CHECK(observer.ports().empty());
    CHECK_FALSE(observer.bone("carve.bone"));
    CHECK_FALSE(observer.latest<double>("a.out"));
}
