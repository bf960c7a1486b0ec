// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/vibration/card_channels.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <string>

using namespace tactus;

namespace {

constexpr const char* text = R"([nodes.value]
type = "constant"
rate = "1 kHz"
[actuators.handle]
channel = 3
full_scale = 2
preset = "haptuator_large"
[actuators.plain]
card = "USB"
[sensors.skin]
channel = 2
full_scale = 49
[sensors.usb]
card = "USB"
channel = 4
[sensors.half]
channel = 1.5
[sensors.huge]
full_scale = 1e9
[sensors.metre]
full_scale = "1 m"
)";

std::string refusal(const std::string& actuator, const std::string& sensor) {
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(text, "p.toml", problems);
    for (const Error& problem : problems.list) UNSCOPED_INFO(problem.what());
    REQUIRE(problems.empty());
    try {
        analysis::card_channels(patch, actuator, sensor);
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

}  // namespace

TEST_CASE("an actuator and a sensor of a patch say card, channels and full scale of a sweep") {
    patch::Problems problems;
    const patch::Patch patch = patch::read_patch(text, "p.toml", problems);
    const analysis::CardChannels at = analysis::card_channels(patch, "handle", "skin");
    CHECK(at.card.empty());
    CHECK(at.output == 3);
    CHECK(at.input == 2);
    CHECK(at.full_output == 2.0);
    CHECK(at.full_input == 49.0);
    const analysis::CardChannels usb = analysis::card_channels(patch, "plain", "usb");
    CHECK(usb.card == "USB");
    CHECK(usb.output == 1);
    CHECK(usb.input == 4);
    CHECK(usb.full_input == 1.0);
}

TEST_CASE("a sweep between two cards, and what is no channel or no full scale, is refused at its line") {
    using Catch::Matchers::ContainsSubstring;
    CHECK_THAT(refusal("handel", "skin"),
               ContainsSubstring("no actuator 'handel' in [actuators]; did you mean 'handle'?"));
    CHECK_THAT(refusal("handle", "skim"), ContainsSubstring("no sensor 'skim' in [sensors]; did you mean 'skin'?"));
    CHECK_THAT(refusal("handle", "handle"), ContainsSubstring("no sensor 'handle'"));
    CHECK_THAT(refusal("skin", "skin"), ContainsSubstring("no actuator 'skin'"));
    CHECK_THAT(refusal("handle", "usb"), ContainsSubstring("p.toml:13:") && ContainsSubstring("goes through one card"));
    CHECK_THAT(refusal("handle", "half"), ContainsSubstring("p.toml:17:") && ContainsSubstring("a whole number"));
    CHECK_THAT(refusal("handle", "huge"), ContainsSubstring("p.toml:19:") && ContainsSubstring("outside the range"));
    CHECK_THAT(refusal("handle", "metre"), ContainsSubstring("p.toml:21:"));
}
