// SPDX-License-Identifier: Apache-2.0
// What device_output does after a tick was late, and after other faults.
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <utility>

using namespace tactus;
using test::NodeHarness;

namespace {

constexpr double asked = 4.0;  // N, from 300 ms on, for ever: the hand is deep inside of a body

/// A device_output whose device is late at some ticks.
struct LateOutput {
    NodeHarness node{"device_output", test::servo};
    std::set<std::int64_t> taken, late, invalid;
    std::int64_t held_from = -1, held_to = -1;  ///< a pause

    LateOutput() {
        node.device_feed = [this](std::int64_t k, DevicePort& port) {
            port.sample = {};
            port.sample.counter = k;
            port.sample.valid = !invalid.contains(k);
            port.sample.taken = taken.contains(k);
            port.sample.late = late.contains(k);
            port.hold_off = k >= held_from && k < held_to;
        };
        node.feed<Wrench>("wrench", [](std::int64_t k) { return k < 300 ? Wrench{} : Wrench{{asked, 0.0, 0.0}, {}}; });
    }
    void run(int ticks) {
        node.prepare();
        node.run(ticks);
        const auto all = node.values<Wrench>("applied");
        for (const Wrench& one : all) applied.push_back(one.force.x);
    }
    std::vector<double> applied;
    const DevicePort& port() { return *node.host.devices.at(""); }
};

}  // namespace

TEST_CASE("after a late tick the force comes back by itself, to a hand that stays in the body: 1 s later, over 0.5 s") {
    LateOutput out;
    const bool by_driver = GENERATE(false, true);
    (by_driver ? out.late : out.taken).insert(600);
    out.run(2600);
    CHECK(out.applied[599] == Approx(asked));
    CHECK(out.applied[615] == 0.0);
    CHECK(out.applied[1590] == 0.0);
    CHECK(out.applied[1850] == Approx(0.5 * asked).epsilon(0.1));
    CHECK(out.applied[2200] == Approx(asked));
    for (std::size_t k = 1600; k + 1 < out.applied.size(); ++k) {
        REQUIRE(out.applied[k] - out.applied[k - 1] <= asked / 500.0 + 1e-9);
        if (k < 2090) REQUIRE(out.applied[k] < asked);
    }
    CHECK(out.port().state == control::ForceState::on);
    CHECK(out.port().fault == control::Fault::none);
}

TEST_CASE("while ticks go on being late the force stays away") {
    LateOutput out;
    for (int k = 600; k < 3000; k += 900) out.taken.insert(k);
    out.run(3400);
    for (std::size_t k = 615; k < out.applied.size(); ++k) REQUIRE(out.applied[k] == 0.0);
    CHECK(out.port().state == control::ForceState::returns);
}

TEST_CASE("without an energy cap a force that is large already waits for the hand to leave the body") {
    LateOutput out;
    out.node.set("energy_cap", "false");
    out.taken.insert(600);
    out.run(3000);
    CHECK(out.applied.back() == 0.0);
    CHECK(out.port().state == control::ForceState::waits);
}

TEST_CASE("the fourth late tick in a minute takes the force away until a person lets it return") {
    LateOutput out;
    for (int n = 0; n < 4; ++n) out.taken.insert(600 + 2000 * n);
    out.run(12000);
    CHECK(out.applied[2500] == Approx(asked));
    CHECK(out.applied[4500] == Approx(asked));
    CHECK(out.applied[6500] == Approx(asked));
    CHECK(out.applied.back() == 0.0);
    CHECK(out.port().state == control::ForceState::by_hand);

    // Somebody changes the number.
    out.node.set("recover", "1");
    out.node.run(2000);
    CHECK(out.node.values<Wrench>("applied").back().force.x == Approx(asked));
}

TEST_CASE("a press that lets forces return is forgotten when they could not for ten seconds") {
    LateOutput out;
    const bool never = GENERATE(false, true);
    if (never) out.node.set("recover_after", "0 s");
    for (int n = 0; n < 4; ++n) out.taken.insert(600 + 2000 * n);
    const int late_for = GENERATE(9'000, 12'000);
    // Also just before the press: it does not bring the force back at once.
    for (int n = -500; n < late_for; n += 500) out.taken.insert(8001 + n);
    out.run(8000);
    REQUIRE(out.port().state == control::ForceState::by_hand);
    out.node.set("recover", "1");
    out.node.run(16'000);
    const double force = out.node.values<Wrench>("applied").back().force.x;
    CHECK(force == Approx(late_for < 10'000 ? asked : 0.0));
    CHECK((out.port().state == control::ForceState::by_hand) == (late_for > 10'000));
}

TEST_CASE("nothing but lateness brings a force back to a hand that stays in the body") {
    LateOutput out;
    control::ForceState expected = control::ForceState::on;
    SECTION("not a force that is no number") {
        out.node.feed<Wrench>("wrench", [](std::int64_t k) {
            return Wrench{{k == 600 ? std::numeric_limits<double>::quiet_NaN() : k < 300 ? 0.0 : asked, 0.0, 0.0}, {}};
        });
        expected = control::ForceState::never;
    }
    SECTION("not a force that is no number after a late tick") {
        out.taken.insert(600);
        out.node.feed<Wrench>("wrench", [](std::int64_t k) {
            return Wrench{{k == 700 ? std::numeric_limits<double>::infinity() : k < 300 ? 0.0 : asked, 0.0, 0.0}, {}};
        });
        expected = control::ForceState::never;
    }
    SECTION("not a device that gave a bad sample") {
        out.invalid.insert(600);
        expected = control::ForceState::waits;
    }
    SECTION("not a device that gave a bad sample after a late tick") {
        out.taken.insert(600);
        out.invalid.insert(700);
        expected = control::ForceState::waits;
    }
    SECTION("not lateness, where the patch says never") {
        out.node.set("recover_after", "0 s");
        out.taken.insert(600);
        expected = control::ForceState::by_hand;
    }
    out.run(6000);
    for (std::size_t k = 615; k < out.applied.size(); ++k) REQUIRE(out.applied[k] == 0.0);
    CHECK(out.port().state == expected);
}

TEST_CASE("a pause while ticks were late: the force waits for the hand to leave the body") {
    LateOutput out;
    out.taken.insert(600);
    SECTION("after the late tick") { out.held_from = 700, out.held_to = 800; }
    SECTION("before it") { out.held_from = 500, out.held_to = 595; }
    SECTION("when it came") { out.held_from = 590, out.held_to = 650; }
    SECTION("longer than the wait") { out.held_from = 700, out.held_to = 3000; }
    out.run(4000);
    for (std::size_t k = 615; k < out.applied.size(); ++k) REQUIRE(out.applied[k] == 0.0);
    CHECK(out.port().state == control::ForceState::waits);
    // It leaves, and comes in again.
    out.node.feed<Wrench>("wrench", [](std::int64_t k) { return Wrench{{k < 4010 ? 0.0 : asked, 0.0, 0.0}, {}}; });
    out.node.forget();
    out.node.run(700);
    const auto later = out.node.values<Wrench>("applied");
    CHECK(later[250].force.x <= 0.5 * asked);
    CHECK(later.back().force.x == Approx(asked));
}

TEST_CASE("a late tick before forces were on brings none to a hand that was deep inside from the start") {
    LateOutput out;
    out.node.feed<Wrench>("wrench", Wrench{{asked, 0.0, 0.0}, {}});
    out.taken.insert(600);
    out.run(4000);
    for (const double force : out.applied) REQUIRE(force == 0.0);
    CHECK(out.port().state == control::ForceState::waits);
}

TEST_CASE("a wait for the hand is told as such while ticks are late") {
    LateOutput out;
    out.taken.insert(600);
    out.held_from = 700, out.held_to = 800;
    out.run(1000);
    CHECK(out.port().state == control::ForceState::returns_freed);
}

namespace {

/// The node that an edit puts in the place of another; the device and its port stay.
struct EditedOutput {
    LateOutput before, after;

    explicit EditedOutput(const std::function<Wrench(std::int64_t)>& wrench = {}) {
        if (wrench) before.node.feed<Wrench>("wrench", wrench);
    }
    void edit() {
        after.node.host.devices = std::move(before.node.host.devices);
        after.node.set("max_force", "9 N");
    }
};

}  // namespace

TEST_CASE("an edit that replaces the node clears no fault") {
    SECTION("a force that is no number: never again in this run") {
        EditedOutput out([](std::int64_t k) {
            return Wrench{{k == 600 ? std::numeric_limits<double>::quiet_NaN() : 0.0, 0.0, 0.0}, {}};
        });
        out.before.run(1000);
        REQUIRE(out.before.port().state == control::ForceState::never);
        out.edit();
        out.after.run(4000);
        for (const double force : out.after.applied) REQUIRE(force == 0.0);
        CHECK(out.after.port().state == control::ForceState::never);
        CHECK(out.after.port().fault == control::Fault::not_finite);
    }
    SECTION("the fourth late tick in a minute: until a person lets forces return") {
        EditedOutput out;
        for (int n = 0; n < 4; ++n) out.before.taken.insert(600 + 2000 * n);
        out.before.run(8000);
        REQUIRE(out.before.port().state == control::ForceState::by_hand);
        out.edit();
        out.after.run(4000);
        for (const double force : out.after.applied) REQUIRE(force == 0.0);
        CHECK(out.after.port().state == control::ForceState::by_hand);
    }
    SECTION("a late tick: forces wait for the hand") {
        EditedOutput out;
        out.before.taken.insert(600);
        out.before.run(800);
        out.edit();
        out.after.node.feed<Wrench>("wrench", Wrench{{asked, 0.0, 0.0}, {}});
        out.after.run(4000);
        for (const double force : out.after.applied) REQUIRE(force == 0.0);
        CHECK(out.after.port().state == control::ForceState::waits);
    }
}

TEST_CASE("returns after late ticks count across an edit") {
    EditedOutput out;
    for (int n = 0; n < 3; ++n) out.before.taken.insert(600 + 2000 * n);
    out.before.run(8000);
    REQUIRE(out.before.port().state == control::ForceState::on);
    out.edit();
    out.after.taken.insert(600);
    out.after.run(4000);
    CHECK(out.after.applied[599] == Approx(asked));
    CHECK(out.after.applied.back() == 0.0);
    CHECK(out.after.port().state == control::ForceState::by_hand);
}

TEST_CASE("a node that an edit prepares touches nothing of a device that another drives") {
    LateOutput out;
    out.run(1000);
    REQUIRE(out.port().state == control::ForceState::on);
    LateOutput next;
    next.node.host.devices = std::move(out.node.host.devices);
    next.node.prepare();
    CHECK(next.port().state == control::ForceState::on);
}

namespace {

/// The largest force at a tick of a ramp that begins in tick `from` at the earliest and takes half a second.
bool comes_in_slowly(const std::vector<double>& applied, std::size_t from) {
    for (std::size_t k = from; k < applied.size(); ++k)
        if (applied[k] > asked * static_cast<double>(k - from + 1) / 500.0 + 1e-9) return false;
    return true;
}

}  // namespace

TEST_CASE("a force that is no number is not forgotten for a bad device that becomes good again") {
    LateOutput out;
    for (int k = 600; k < 650; ++k) out.invalid.insert(k);
    out.node.feed<Wrench>("wrench", [](std::int64_t k) {
        return Wrench{{k == 620               ? std::numeric_limits<double>::quiet_NaN()
                       : k > 1000 && k < 2000 ? 0.0
                                              : 0.3,
                       0, 0},
                      {}};
    });
    out.run(4000);
    for (std::size_t k = 615; k < out.applied.size(); ++k) REQUIRE(out.applied[k] == 0.0);
    CHECK(out.port().fault == control::Fault::not_finite);
    CHECK(out.port().state == control::ForceState::never);
}

TEST_CASE("a wait for a person is not forgotten for a bad sample") {
    LateOutput out;
    for (int n = 0; n < 4; ++n) out.taken.insert(600 + 2000 * n);
    SECTION("after the fourth late tick") { out.invalid.insert(7000); }
    SECTION("before it") {
        out.invalid.insert(6595);
        out.taken.insert(6605);
    }
    out.node.feed<Wrench>("wrench", [](std::int64_t k) {
        return Wrench{{k < 300 || (k > 9000 && k < 9100) ? 0.0 : asked, 0.0, 0.0}, {}};
    });
    out.run(12000);
    CHECK(out.applied[6590] == Approx(asked));
    for (std::size_t k = 6620; k < out.applied.size(); ++k) REQUIRE(out.applied[k] == 0.0);
    CHECK(out.port().fault == control::Fault::invalid_input);
    CHECK(out.port().state == control::ForceState::by_hand);

    // Somebody changes the number, and the hand leaves the body.
    out.node.set("recover", "1");
    out.node.feed<Wrench>("wrench", [](std::int64_t k) { return Wrench{{k < 12100 ? 0.0 : asked, 0.0, 0.0}, {}}; });
    out.node.run(2000);
    CHECK(out.node.values<Wrench>("applied").back().force.x == Approx(asked));
}

TEST_CASE("after a late tick and a bad sample forces wait for both and come in slowly") {
    LateOutput out;
    out.node.set("recover_after", "10 ms").set("engage_time", "0 ms");
    SECTION("the late tick first") {
        out.taken.insert(600);
        out.invalid.insert(605);
    }
    SECTION("the bad sample first") {
        out.invalid.insert(595);
        out.taken.insert(600);
    }
    out.node.feed<Wrench>("wrench", [](std::int64_t k) {
        return Wrench{{k < 300 || (k > 620 && k % 100 < 10) ? 0.0 : asked, 0.0, 0.0}, {}};
    });
    out.run(3000);
    for (std::size_t k = 615; k < 1600; ++k) REQUIRE(out.applied[k] == 0.0);
    CHECK(comes_in_slowly({out.applied.begin() + 1600, out.applied.end()}, 0));
    CHECK(out.applied[2990] == Approx(asked));
}

TEST_CASE("a pause or an edit while forces come in after a late tick does not make them come in faster") {
    const auto leaves = [](std::int64_t from) {
        return [from](std::int64_t k) {
            return Wrench{{k < 300 || (k >= from && k < from + 10) ? 0.0 : asked, 0.0, 0.0}, {}};
        };
    };
    LateOutput out;
    out.taken.insert(600);
    out.node.set("engage_time", "0 ms");
    SECTION("a pause") {
        out.held_from = 1700, out.held_to = 1750;
        out.node.feed<Wrench>("wrench", std::function<Wrench(std::int64_t)>(leaves(1800)));
        out.run(2500);
        REQUIRE(out.applied[1699] > 0.5);
        REQUIRE(out.applied[1790] == 0.0);
        CHECK(comes_in_slowly(out.applied, 1802));
        CHECK(out.applied.back() == Approx(asked));
    }
    SECTION("an edit") {
        out.held_from = 1700, out.held_to = 1730;
        out.run(1730);
        LateOutput next;
        next.node.host.devices = std::move(out.node.host.devices);
        next.node.set("max_force", "9 N").set("engage_time", "0 ms");
        next.run(1000);
        CHECK(comes_in_slowly(next.applied, 2));
        CHECK(next.applied.back() == Approx(asked));
        // The next time is the next time.
        next.node.forget();
        next.held_from = 1000, next.held_to = 1050;
        next.node.feed<Wrench>("wrench", std::function<Wrench(std::int64_t)>(leaves(1100)));
        next.node.run(300);
        CHECK(next.node.values<Wrench>("applied")[120].force.x == Approx(asked));
    }
}

TEST_CASE(
    "a device without motors keeps the force, whatever is late, held off or large, up to the strength of its hand") {
    LateOutput out;
    DeviceInfo& info = out.node.host.device("", DeviceUse::read, {}).info;
    info.without_motors = true;
    info.max_force = 20.0;
    out.node.set("max_force", "3 N");
    for (int k = 600; k < 2000; k += 7) out.taken.insert(k);
    for (int k = 500; k < 700; ++k) out.late.insert(k);
    out.held_from = 1000, out.held_to = 1200;
    out.invalid.insert(1500);
    // Large in the first tick: nothing waits for a small one.
    out.node.feed<Wrench>("wrench", [](std::int64_t k) { return Wrench{{k < 1800 ? asked : 50.0, 0.0, 0.0}, {}}; });
    out.run(2000);
    for (std::size_t k = 0; k < 1800; ++k)
        if (k != 1500 && k != 1501) REQUIRE(out.applied[k] == Approx(asked));  // there is no hand without a sample
    CHECK(out.applied.back() == Approx(20.0));
    CHECK(out.port().state == control::ForceState::on);
    CHECK(out.port().fault == control::Fault::none);
}
