// SPDX-License-Identifier: Apache-2.0
// A hand that is deep inside of a body when forces might begin gets none until it has left the body, whatever the rates of
// the groups in between.
#include "tests/engine/chaos.hpp"
#include "tests/engine/watched_hand.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/times.hpp"
#include "tests/support/virtual_clock.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <atomic>
#include <functional>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

/// A hand at a spring, and what brings the spring's force to it.
struct Way {
    std::string rate;  ///< of the spring
    std::string wires;
    std::string more;

    std::string toml(const std::string& latency = "") const {
        return "wires = [\"hand.pose -> spring.device\", \"end.pose -> spring.object\", " + wires +
               "]\n[devices.left]\ndriver = \"left\"\n[nodes]\nhand = {type = \"device_input\", rate = \"1 kHz\"}\n"
               "end = {type = \"still\", rate = \"1 kHz\"}\nspring = {type = \"spring\", group = \"contact\", "
               "stiffness = \"1 N/mm\"}\n"
               "out = {type = \"device_output\", rate = \"1 kHz\", energy_cap = false}\n" +
               more + "[groups.contact]\nrate = \"" + rate + "\"\n" +
               (latency.empty() ? "" : "latency = \"" + latency + "\"\n");
    }
};

const std::vector<Way>& ways() {
    static const std::string direct = R"("spring.wrench -> out.wrench")";
    static const std::vector<Way> all{{"1 kHz", direct, ""},
                                      {"4 kHz", direct, ""},
                                      {"200 Hz", direct, ""},
                                      {"30 Hz", direct, ""},
                                      {"1 kHz", R"("spring.wrench -> out.wrench as delay 8")", ""},
                                      {"1 kHz", R"("spring.wrench -> far.in", "far.out -> out.wrench")",
                                       "far = {type = \"gain\", rate = \"100 Hz\"}\n"}};
    return all;
}

using Depth = std::function<double(double seconds)>;

/// A hand that is so deep at a time, and the largest force that it was given, N.
struct DeepHand {
    explicit DeepHand(Depth at) : depth(std::move(at)) {
        hand.performance.acquire = [this](std::int64_t, double elapsed, const Wrench&) {
            DeviceSample sample = hand.acquire(elapsed);
            sample.pose.position.z = -depth(hand.logical_s);
            return sample;
        };
        hand.performance.commit = [this](const Wrench& given) {
            hand.commit(given);
            largest_N = std::max(largest_N, glm::length(given.force));
        };
    }

    Depth depth;
    WatchedHand& hand = watched_hand("left");
    double largest_N = 0.0;
};

double largest_offline(const Way& way, const Depth& depth, double seconds) {
    const DeepHand deep(depth);
    run::EngineOptions options;
    options.seconds = seconds;
    run::Engine(compile_text(way.toml()), options).render(1);
    return deep.largest_N;
}

}  // namespace

TEST_CASE("a hand that is deep inside when the run begins gets no force until it has left the body") {
    for (const Way& way : ways()) {
        CAPTURE(way.rate, way.wires);
        CHECK(largest_offline(way, [](double) { return 2e-3; }, 0.5) == 0.0);
        CHECK(largest_offline(way, [](double t) { return t < 0.3 ? 0.0 : 2e-3; }, 0.8) > 1.5);
    }
}

TEST_CASE("a hand that moves deep into a body while an edit takes the force away gets none until it has left it") {
    for (const Way& way : ways()) {
        CAPTURE(way.rate, way.wires);
        // Forces fade 20 ms before the switch.
        const DeepHand deep([](double t) { return t < 0.495 ? 0.0 : 2e-3; });
        run::EngineOptions options;
        options.seconds = 1.0;
        run::Engine engine(compile_text(way.toml()), options);
        engine.schedule(compile_text(way.toml("40 ms")), 500 * ms);
        engine.render(1);
        CHECK(deep.largest_N == 0.0);
    }
}

TEST_CASE("a hand that moves deep into a body during a pause gets no force until it has left it", "[virtual]") {
    for (const Way& way : ways()) {
        CAPTURE(way.rate, way.wires);
        const VirtualClock clock;
        std::atomic<bool> has_moved{false};
        DeepHand deep([&](double) { return has_moved ? 2e-3 : 0.0; });
        run::EngineOptions options;
        options.seconds = 1.0;
        options.live = true;
        run::Engine engine(compile_text(way.toml()), options);
        bool has_paused = false;
        engine.run_live({.dilate = 1.0, .log = {}, .stop = nullptr, .watch = [&] {
                             if (!has_paused && deep.hand.logical_s > 0.4) {
                                 has_paused = true;
                                 engine.pause(true);
                             } else if (has_paused && !has_moved && engine.pausing() == run::Engine::Pausing::stands) {
                                 has_moved = true;
                                 engine.pause(false);
                             }
                         }});
        CHECK(has_moved);
        CHECK(deep.largest_N == 0.0);
    }
}
