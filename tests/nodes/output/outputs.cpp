// SPDX-License-Identifier: Apache-2.0
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"

#include <limits>

using namespace tactus;
using test::NodeHarness;

namespace {

constexpr float no_sample = std::numeric_limits<float>::quiet_NaN();

}  // namespace

TEST_CASE("record writes every sample of a signal, in order, to a sound file named after the node") {
    NodeHarness node("record", {.any = &value::signal});
    node.set("unit", "m/s^2").feed<float>("in", [](std::int64_t k) { return static_cast<float>(k); });
    node.prepare();
    node.run(5000, 7);
    REQUIRE(node.host.records.size() == 1);
    const test::MemoryStream& stream = *node.host.records[0];
    CHECK(stream.format.file == "node.wav");
    CHECK(stream.format.unit == "m/s^2");
    CHECK(stream.gapless);
    const auto samples = stream.values<float>();
    REQUIRE(samples.size() == 5000);
    CHECK(samples[4321] == 4321.0f);
}

TEST_CASE("record writes one value per tick of anything else, to a table") {
    test::HarnessOptions options = test::servo;
    options.any = &value::wrench;
    NodeHarness node("record", options);
    node.feed<Wrench>("in", [](std::int64_t k) { return Wrench{{static_cast<double>(k), 0.0, 0.0}, {}}; });
    node.prepare();
    node.run(100);
    const test::MemoryStream& stream = *node.host.records[0];
    CHECK(stream.format.file == "node.csv");
    CHECK(stream.values<Wrench>().size() == 100);
    CHECK(stream.values<Wrench>()[42].force.x == 42.0);
}

TEST_CASE("sound beyond full scale is cut, NaN is silence, and both are counted") {
    NodeHarness node("audio_output");
    node.set("full_scale", "10").feed<float>("signal", [](std::int64_t k) {
        return k == 1 ? 25.0f : k == 2 ? -25.0f : k == 3 ? no_sample : 5.0f;
    });
    node.prepare();
    node.run(100, 3);
    const auto samples = node.host.sounds.at(0)->values<float>();
    REQUIRE(samples.size() == 100);
    CHECK(samples[0] == 0.5f);
    CHECK(samples[1] == 1.0f);
    CHECK(samples[2] == -1.0f);
    CHECK(samples[3] == 0.0f);
    CHECK(std::get<double>(node.report().sections.at("node").at("clipped_samples")) == 3.0);
}

TEST_CASE("no sample exceeds the limit of an audio output, and its peak is reported as it was") {
    NodeHarness node("audio_output");
    node.set("full_scale", "10").set("limit", "0.25").feed<float>("signal", [](std::int64_t k) {
        return k % 2 == 0 ? 2.0f : -8.0f;
    });
    node.prepare();
    node.run(100, 3);
    const auto samples = node.host.sounds.at(0)->values<float>();
    REQUIRE(samples.size() == 100);
    CHECK(samples[0] == 0.2f);
    CHECK(samples[1] == -0.25f);
    const auto& section = node.report().sections.at("node");
    CHECK(std::get<double>(section.at("clipped_samples")) == 50.0);
    CHECK(std::get<double>(section.at("samples")) == 100.0);
    CHECK(std::get<double>(section.at("peak")) == Approx(0.8));
}

TEST_CASE("a probe tells least, greatest, mean and last of each column, and counts what is not finite") {
    test::HarnessOptions options = test::servo;
    NodeHarness number("probe", options);
    number.feed<double>(
        "in", [](std::int64_t k) { return k == 4 ? static_cast<double>(no_sample) : static_cast<double>(k); });
    number.prepare();
    number.run(10);
    const Report report = number.report();
    const auto& told = report.sections.at("node");
    CHECK(std::get<double>(told.at("min")) == 0.0);
    CHECK(std::get<double>(told.at("max")) == 9.0);
    CHECK(std::get<double>(told.at("mean")) == Approx(41.0 / 9.0));
    CHECK(std::get<double>(told.at("last")) == 9.0);
    CHECK(std::get<double>(told.at("not_finite")) == 1.0);

    options.any = &value::twist;
    NodeHarness twist("probe", options);
    twist.feed("in", Twist{{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}});
    twist.prepare();
    twist.run(3);
    CHECK(std::get<std::vector<double>>(twist.report().sections.at("node").at("mean")) ==
          std::vector<double>{1.0, 2.0, 3.0, 4.0, 5.0, 6.0});
}
