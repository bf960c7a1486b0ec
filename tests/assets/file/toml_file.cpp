// SPDX-License-Identifier: Apache-2.0
#include "assets/file/toml_file.hpp"

#include "assets/display/rig_file.hpp"
#include "assets/sound/equaliser_file.hpp"
#include "assets/sound/recording_set.hpp"
#include "assets/table/thresholds.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tools/study/rig_matrix.hpp"

#include <catch2/catch.hpp>

#include <fstream>

using namespace tactus;
using Catch::Matchers::Contains;

TEST_CASE("a key of a hundred thousand parts is refused by every reader of TOML, and crashes none") {
    std::string deep = "title = \"x\"\na";
    for (int i = 0; i < 100'000; ++i) deep += ".a";
    deep += " = 1\n";
    CHECK_THROWS_WITH(file::parse_toml(deep, "deep.toml"), Contains("deep.toml:2:66: a key has at most 32 dots"));
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "deep.toml";
    std::ofstream(file) << deep;
    const auto refusal = Contains("at most 32 dots");
    CHECK_THROWS_WITH(display::load_rig_file(file), refusal);
    CHECK_THROWS_WITH(study::load_rig_matrix(file), refusal);
    CHECK_THROWS_WITH(sound::load_recording_set(file), refusal);
    CHECK_THROWS_WITH(sound::load_equaliser(file), refusal);
    CHECK_THROWS_WITH(table::load_thresholds(file), refusal);
}

TEST_CASE("what is no TOML is refused with its place") {
    CHECK_THROWS_WITH(file::parse_toml("a = 1\nb = = 2\n", "x.toml"), Contains("x.toml:2:5: not valid TOML"));
}
