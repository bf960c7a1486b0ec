// SPDX-License-Identifier: Apache-2.0
#include "graph/patch/patch.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

std::string rate_refusal(std::string_view text) {
    try {
        patch::parse_rate(text);
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

}  // namespace

TEST_CASE("the rates of haptics, sound and pictures are exact") {
    CHECK(patch::parse_rate("1 kHz") == 705'600);
    CHECK(patch::parse_rate("60 Hz") == 11'760'000);
    CHECK(patch::parse_rate("44.1 kHz") == 16'000);
    CHECK(patch::parse_rate("48 kHz") == 14'700);
    CHECK(patch::parse_rate("96 kHz") == 7'350);
    CHECK(patch::parse_rate("0.5 Hz") == 1'411'200'000);
    CHECK(patch::parse_rate("0.001 Hz") == 705'600'000'000);
    CHECK(patch::parse_rate("0.003 Hz") == 235'200'000'000);
}

TEST_CASE("a rate whose period is no whole number of flicks names exact ones beside it") {
    CHECK_THAT(rate_refusal("1001 Hz"), ContainsSubstring("1000 Hz and 1008 Hz"));
    CHECK_THAT(rate_refusal("999.9 Hz"), ContainsSubstring("1000 Hz"));
    for (const char* text : {"1001 Hz", "61 Hz", "59.94 Hz", "44.099 kHz", "0.0011 Hz", "191.999 kHz"}) {
        const std::string message = rate_refusal(text);
        INFO(message);
        const std::size_t first = message.find("that are: ") + 10, second = message.find(" and ", first) + 5;
        CHECK_NOTHROW(patch::parse_rate(message.substr(first, second - 5 - first)));
        CHECK_NOTHROW(patch::parse_rate(message.substr(second)));
    }
}

TEST_CASE("what is no rate is refused") {
    for (const char* text : {"", "1000", "1 ms", "0 Hz", "-1 kHz", "1 GHz", "nan Hz", "inf Hz", "1e-300 Hz", "Hz"})
        CHECK_FALSE(rate_refusal(text).empty());
}
