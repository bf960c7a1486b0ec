// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/kerf_heat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

using namespace tactus;
using test::NodeHarness;

namespace {

constexpr test::HarnessOptions slow{.period = flicks_per_second / 60};

/// A blade that advances along its own y, which is -z of the bone, by 0.67 mm/s.
Pose advancing(std::int64_t k) {
    Pose pose;
    pose.orientation = glm::angleAxis(-glm::radians(90.0), Vec3(1.0, 0.0, 0.0));
    pose.position = Vec3(10e-3, 5e-3, 40e-3 - 0.67e-3 * static_cast<double>(k) / 60.0);
    return pose;
}

void cut(NodeHarness& node, double thrust) {
    node.feed<Pose>("pose", advancing);
    node.feed<double>("load", [thrust](std::int64_t) { return thrust; });
    node.disconnect_optional();
    node.prepare();
    node.run(600);
}

}  // namespace

TEST_CASE("a kerf gets as hot as the teeth's work in it says") {
    NodeHarness node("kerf_heat", slow);
    cut(node, 8.0);
    // 8 N of thrust over 1.6 is 5 N along the teeth, at a mean speed of 2 × 3 mm × 228 Hz, over 15 mm of teeth.
    saw::KerfHeat expected;
    for (int k = 0; k < 600; ++k)
        expected.advance(1.0 / 60.0, 0.67e-3 * k / 60.0, 0.5 * 5.0 * 6e-3 * 228.0 / 15e-3, false);
    // The hottest cell depends a little on where in it the source is.
    CHECK(node.last<double>("peak") == Approx(expected.peak()).epsilon(0.03));
    CHECK(node.last<double>("rise") == Approx(expected.hottest()).epsilon(0.07));
    CHECK(node.last<double>("hot_time") == Approx(expected.longest_above()).margin(0.1));
    CHECK(node.last<double>("peak") > 20.0);
}

TEST_CASE("half the thrust is half the heat, no thrust and a saw that stands are none") {
    NodeHarness full("kerf_heat", slow), half("kerf_heat", slow), none("kerf_heat", slow), off("kerf_heat", slow);
    cut(full, 8.0);
    cut(half, 4.0);
    cut(none, 0.0);
    NodeHarness on("kerf_heat", slow);
    for (NodeHarness* const node : {&off, &on}) {
        node->feed<Pose>("pose", advancing);
        node->feed<double>("load", [](std::int64_t) { return 8.0; });
        node->feed<bool>("running", node == &on);
        for (const char* port : {"strokes", "irrigated", "feed", "cutting", "teeth"}) node->disconnect(port);
        node->prepare();
        node->run(600);
    }
    CHECK(half.last<double>("peak") == Approx(0.5 * full.last<double>("peak")).epsilon(1e-3));
    CHECK(none.last<double>("peak") == 0.0);
    CHECK(off.last<double>("peak") == 0.0);
    CHECK(on.last<double>("peak") == full.last<double>("peak"));
}

TEST_CASE("a second cut elsewhere is in cool bone, and the hottest of both counts") {
    NodeHarness node("kerf_heat", slow);
    node.feed<Pose>("pose", [](std::int64_t k) {
        Pose pose = advancing(k % 600);
        if (k >= 600) pose.position.y += 20e-3;
        return pose;
    });
    node.feed<double>("load", [](std::int64_t k) { return k < 600 * 20 ? 8.0 : 2.0; });
    node.disconnect_optional();
    node.prepare();
    node.run(1200);
    NodeHarness second("kerf_heat", slow);
    cut(second, 2.0);
    CHECK(node.last<double>("rise") == Approx(second.last<double>("rise")).epsilon(0.02));
    CHECK(node.last<double>("peak") > 3.0 * node.last<double>("rise"));
}

TEST_CASE("heat follows the force along the teeth and the teeth that bear, and the stroke has no say") {
    const auto peak = [](double cutting, double teeth, const char* stroke) {
        NodeHarness node("kerf_heat", slow);
        node.feed<Pose>("pose", advancing);
        node.feed<double>("load", [](std::int64_t) { return 8.0; });
        node.feed<double>("cutting", [cutting](std::int64_t) { return cutting; });
        node.feed<double>("teeth", [teeth](std::int64_t) { return teeth; });
        node.set("stroke", stroke);
        node.disconnect("strokes").disconnect("irrigated").disconnect("running").disconnect("feed");
        node.prepare();
        node.run(600);
        return node.last<double>("peak");
    };
    const double one = peak(5.0, 4.0, "3 mm");
    saw::KerfHeat expected;
    for (int k = 0; k < 600; ++k)
        expected.advance(1.0 / 60.0, 0.67e-3 * k / 60.0, 0.5 * 2.0 * 228.0 * 5.0 / 4.0, false);
    CHECK(one == Approx(expected.peak()).epsilon(0.03));
    CHECK(peak(5.0, 4.0, "6 mm") == one);
    CHECK(peak(10.0, 8.0, "3 mm") == Approx(one).epsilon(1e-9));
    CHECK(peak(5.0, 8.0, "3 mm") == Approx(0.5 * one).epsilon(1e-3));
    CHECK(peak(5.0, 0.0, "3 mm") == 0.0);
}
