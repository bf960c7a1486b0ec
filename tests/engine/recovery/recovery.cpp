// SPDX-License-Identifier: Apache-2.0
// Forces that go and come back, over and over: the rules of a hand hold in every order of what can happen to it.
#include "tests/engine/recovery/shaken_hand.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using test::ShakenCounts, test::ShakenHand;

namespace {

ShakenCounts shake(std::uint64_t first, std::uint64_t past, double seconds) {
    ShakenCounts all;
    for (std::uint64_t seed = first; seed < past; ++seed) {
        ShakenHand hand(seed);
        const std::string broken = hand.run(seconds);
        CHECK(broken == "");
        all.add(hand.counts());
    }
    CAPTURE(all.max_gained_J, all.max_allowed_J);
    CHECK(all.late > 10);
    CHECK(all.pauses > 5);
    CHECK(all.edits > 5);
    CHECK(all.device_faults > 10);
    CHECK(all.not_finite > 0);
    CHECK(all.returns > 5);
    CHECK(all.full_forces > 1000);
    return all;
}

}  // namespace

TEST_CASE("a hand that everything happens to keeps its limits and its faults and its energy") { shake(1, 11, 60.0); }

TEST_CASE("many hands that everything happens to keep their limits and faults and energy", "[slow]") {
    const ShakenCounts all = shake(100, 130, 120.0);
    CHECK(all.waits_for_person > 2);
    CHECK(all.presses > 2);
}

TEST_CASE("a hundred hands that everything happens to keep their limits and faults and energy", "[long]") {
    const ShakenCounts all = shake(100, 200, 120.0);
    CHECK(all.waits_for_person > 10);
    CHECK(all.presses > 10);
}
