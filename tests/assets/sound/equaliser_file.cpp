// SPDX-License-Identifier: Apache-2.0
#include "assets/sound/equaliser_file.hpp"

#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <fstream>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

vibration::Equaliser read(const TemporaryFolder& folder, const std::string& text) {
    const auto path = folder / "e.toml";
    std::ofstream(path, std::ios::binary) << text;
    return sound::load_equaliser(path);
}

}  // namespace

TEST_CASE("an equaliser comes back from its file as it was, to the last bit of every tap") {
    const TemporaryFolder folder;
    vibration::Equaliser made;
    made.kind = vibration::EqualiserKind::linear_phase;
    made.rate = 44100.0;
    made.delay = 0.001;
    made.lowest = 45.0;
    made.highest = 1000.0;
    made.mean_gain = 12.345678901234;
    made.unit = "m/s^2 per V";
    for (int i = 0; i < 100; ++i) made.taps.push_back(static_cast<float>(std::sin(i * 1.7) * std::pow(10.0, -i / 3)));
    sound::save_equaliser(made, "a \"quoted\" title\\", folder / "e.toml");
    const vibration::Equaliser back = sound::load_equaliser(folder / "e.toml");
    CHECK(back.kind == made.kind);
    CHECK(back.rate == made.rate);
    CHECK(back.delay == made.delay);
    CHECK(back.lowest == made.lowest);
    CHECK(back.highest == made.highest);
    CHECK(back.mean_gain == made.mean_gain);
    CHECK(back.unit == made.unit);
    CHECK(back.taps == made.taps);
}

TEST_CASE("a damaged equaliser is refused with its place") {
    const TemporaryFolder folder;
    const std::pair<const char*, const char*> slips[] = {
        {"rate = \"48 kHz\"\ntaps = [1, \"x\"]", ":2:"},
        {"rate = \"48 kHz\"\ntaps = [1e9]", "from -1e6 to 1e6"},
        {"rate = \"48 kHz\"\ntaps = [nan]", "from -1e6 to 1e6"},
        {"rate = \"48 kHz\"\ntaps = []", "list"},
        {"rate = 48000\ntaps = [1]", ":1:"},
        {"rate = \"48 s\"\ntaps = [1]", ":1:"},
        {"taps = [1]", "needs 'rate'"},
        {"rate = \"48 kHz\"", "needs 'rate' and 'taps'"},
        {"rate = \"0 Hz\"\ntaps = [1]", "1 Hz to 1 MHz"},
        {"rate = \"48 kHz\"\ndelay = \"1 s\"\ntaps = [1]", "shorter"},
        {"rate = \"48 kHz\"\ndelai = \"1 s\"\ntaps = [1]", "did you mean 'delay'?"},
        {"rate = \"48 kHz\"\nkind = \"other\"\ntaps = [1]", "minimum_phase"},
        {"rate = \"48 kHz\"\nband = [\"1 Hz\"]\ntaps = [1]", "two frequencies"},
        {"rate = ", "not valid TOML"},
    };
    for (const auto& [text, message] : slips) {
        INFO(text);
        CHECK_THROWS_WITH(read(folder, text), ContainsSubstring(message) && ContainsSubstring("e.toml"));
    }
    CHECK_THROWS_AS(sound::load_equaliser(folder / "none.toml"), Error);
}
