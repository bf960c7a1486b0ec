// SPDX-License-Identifier: Apache-2.0
#include "graph/node/options.hpp"
#include "tests/support/catch.hpp"

#include <array>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

Options written(std::string name, std::string text) {
    return Options("device 'hand'", {{std::move(name), std::move(text), {"saw.toml", 7, 3}}}, {"saw.toml", 5, 1});
}

template <typename Ask>
std::string message_of(Ask ask) {
    try {
        ask();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

const std::array<std::string, 2> shapes{"saw", "hold"};

}  // namespace

TEST_CASE("an option that is not given has its default, in SI") {
    Options options("device 'hand'");
    CHECK(options.quantity("mass", "200 g", "0.01 kg", "5 kg") == Approx(0.2));
    CHECK(options.quantity("gain", "2") == Approx(2.0));
    CHECK(options.text("path", "a.csv") == "a.csv");
    CHECK(options.flag("loop", true));
    CHECK(options.choice("plan", shapes, "hold") == 1);
    CHECK_NOTHROW(options.finish());
}

TEST_CASE("a given option replaces the default") {
    Options options("device 'hand'", {{"mass", "300 g", {}}, {"loop", "false", {}}, {"plan", "saw", {}}});
    CHECK(options.quantity("mass", "0.2 kg", "0.01 kg", "5 kg") == Approx(0.3));
    CHECK_FALSE(options.flag("loop", true));
    CHECK(options.choice("plan", shapes, "hold") == 0);
    CHECK(options.has("plan"));
    CHECK_FALSE(options.has("path"));
    CHECK_NOTHROW(options.finish());
}

TEST_CASE("a quantity out of range is refused where it is written, with the range") {
    const std::string said = message_of([] { written("mass", "9 kg").quantity("mass", "0.2 kg", "0.01 kg", "5 kg"); });
    CHECK_THAT(said, ContainsSubstring("saw.toml:7:3") && ContainsSubstring("mass") && ContainsSubstring("0.01 kg") &&
                         ContainsSubstring("5 kg"));
    const std::string low = message_of([] { written("mass", "-1 g").quantity("mass", "0.2 kg", "0 kg"); });
    CHECK_THAT(low, ContainsSubstring("at least 0 kg"));
}

TEST_CASE("a quantity of another dimension is refused where it is written") {
    const std::string said = message_of([] { written("mass", "9 mm").quantity("mass", "0.2 kg"); });
    CHECK_THAT(said, ContainsSubstring("saw.toml:7:3") && ContainsSubstring("mass"));
    CHECK_FALSE(message_of([] { written("mass", "9").quantity("mass", "0.2 kg"); }).empty());
    CHECK_FALSE(message_of([] { written("mass", "nan kg").quantity("mass", "0.2 kg", "0 kg", "1 kg"); }).empty());
}

TEST_CASE("a misspelt option is refused with the nearest name and all that exist") {
    Options options = written("mas", "1 kg");
    options.quantity("mass", "0.2 kg");
    options.flag("loop", false);
    CHECK_THAT(message_of([&] { options.finish(); }), ContainsSubstring("saw.toml:7:3") &&
                                                          ContainsSubstring("did you mean 'mass'") &&
                                                          ContainsSubstring("mass, loop"));
}

TEST_CASE("a wrong flag or choice names what may be written") {
    CHECK_THAT(message_of([] { written("loop", "yes").flag("loop", true); }), ContainsSubstring("true or false"));
    CHECK_THAT(message_of([] { written("plan", "sew").choice("plan", shapes, "hold"); }),
               ContainsSubstring("did you mean 'saw'") && ContainsSubstring("saw, hold"));
}
