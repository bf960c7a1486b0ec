// SPDX-License-Identifier: Apache-2.0
#include "devices/hosted/force_gate.hpp"

#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <cstdint>

using namespace tactus;
using namespace tactus::hosted;

namespace {

constexpr std::int64_t ms = 1'000'000;

/// An engine that commits once a millisecond, and what the gate makes of it.
struct Played {
    ForceGate gate;
    ForceRecord newest;
    std::uint64_t number = 0;
    std::int64_t now = 5'000 * ms;

    double commit(double force) {
        newest = pack(Wrench{{force, 0.0, 0.0}, {}}, now);
        ++number;
        return give();
    }
    double give() { return glm::length(gate.give(newest, number, now).force); }
    double after(std::int64_t ns) {
        now += ns;
        return give();
    }
    void engage() {
        for (int i = 0; i < 3; ++i) {
            commit(0.0);
            now += ms;
        }
    }
};

}  // namespace

TEST_CASE("a device's process gives forces after three small ones, and no large one before") {
    Played played;
    CHECK(played.commit(4.0) == 0.0);
    CHECK(played.gate.holds());
    played.now += ms;
    CHECK(played.commit(0.4) == 0.0);
    CHECK(played.after(ms) == 0.0);  // the same commit, seen again
    CHECK(played.after(ms) == 0.0);
    CHECK(played.after(ms) == 0.0);
    CHECK(played.commit(0.4) == 0.0);
    CHECK(played.commit(0.4) == Approx(0.4));
    CHECK_FALSE(played.gate.holds());
    CHECK(played.commit(4.0) == Approx(4.0));
}

TEST_CASE("a force of an engine that is silent for 10 ms fades to zero in 5 ms") {
    Played played;
    played.engage();
    CHECK(played.commit(4.0) == Approx(4.0));
    CHECK(played.after(10 * ms) == Approx(4.0));
    CHECK(played.after(ms) == Approx(3.2));
    CHECK(played.gate.holds());
    CHECK(played.after(3 * ms) == Approx(0.8));
    CHECK(played.after(ms) == 0.0);
    CHECK(played.after(100 * ms) == 0.0);
}

TEST_CASE("after a suspend nothing of the force before is given") {
    Played played;
    played.engage();
    CHECK(played.commit(4.0) == Approx(4.0));
    CHECK(played.after(3'600'000 * ms) == 0.0);
}

TEST_CASE("an engine that was silent engages anew from small forces") {
    Played played;
    played.engage();
    played.commit(4.0);
    CHECK(played.after(12 * ms) > 0.0);
    CHECK(played.commit(4.0) < 4.0);  // still fading
    for (int i = 0; i < 100; ++i) {
        played.now += ms;
        played.commit(4.0);
    }
    CHECK(played.commit(4.0) == 0.0);
    CHECK(played.gate.holds());
    played.engage();
    CHECK_FALSE(played.gate.holds());
    CHECK(played.commit(4.0) == Approx(4.0));
}

TEST_CASE("a wrench that is not finite, or a stamp from the future, is no force") {
    for (const double nonsense : {std::nan(""), HUGE_VAL}) {
        Played played;
        played.engage();
        CHECK(played.commit(4.0) == Approx(4.0));
        CHECK(played.commit(nonsense) == 0.0);
        played.now += ms;
        CHECK(played.commit(4.0) == 0.0);
        CHECK(played.gate.holds());
    }
    Played played;
    played.engage();
    played.commit(4.0);
    for (const std::int64_t stamp : {played.now + 50 * ms, INT64_MAX, INT64_MIN, std::int64_t{0}}) {
        played.newest.committed_ns = stamp;
        ++played.number;
        played.give();  // from where it fades
        CHECK(played.after(5 * ms) == 0.0);
        CHECK(played.gate.holds());
    }
}

TEST_CASE("a device's process gives no more than its device bears") {
    Played played;
    played.gate.bounds = {3.0, 0.2};
    played.engage();
    CHECK(played.commit(4.0) == Approx(3.0));
    played.newest = pack(Wrench{{}, {0.0, 5.0, 0.0}}, played.now);
    CHECK(glm::length(played.gate.give(played.newest, ++played.number, played.now).torque) == Approx(0.2));
}

TEST_CASE("every force of a device without motors passes, however old") {
    Played played;
    played.gate.is_felt = false;
    played.gate.bounds.force = 20.0;
    CHECK(played.commit(4.0) == Approx(4.0));
    CHECK(played.after(500 * ms) == Approx(4.0));
    CHECK_FALSE(played.gate.holds());
    CHECK(played.commit(30.0) == Approx(20.0));
    CHECK(played.commit(std::nan("")) == 0.0);
}
