// SPDX-License-Identifier: Apache-2.0
#include "assets/file/toml_file.hpp"

#include "assets/display/display_file.hpp"
#include "assets/sound/equaliser_file.hpp"
#include "assets/sound/recording_set.hpp"
#include "assets/table/thresholds.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <fstream>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

TEST_CASE("a key of a hundred thousand parts is refused by every reader of TOML, and crashes none") {
    std::string deep = "title = \"x\"\na";
    for (int i = 0; i < 100'000; ++i) deep += ".a";
    deep += " = 1\n";
    CHECK_THROWS_WITH(file::parse_toml(deep, "deep.toml"),
                      ContainsSubstring("deep.toml:2:66: a key has at most 32 dots"));
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "deep.toml";
    std::ofstream(file) << deep;
    const auto refusal = ContainsSubstring("at most 32 dots");
    CHECK_THROWS_WITH(display::load_display_file(file), refusal);
    CHECK_THROWS_WITH(sound::load_recording_set(file), refusal);
    CHECK_THROWS_WITH(sound::load_equaliser(file), refusal);
    CHECK_THROWS_WITH(table::load_thresholds(file), refusal);
}

TEST_CASE("what is no TOML is refused with its place") {
    CHECK_THROWS_WITH(file::parse_toml("a = 1\nb = = 2\n", "x.toml"), ContainsSubstring("x.toml:2:5: not valid TOML"));
}
