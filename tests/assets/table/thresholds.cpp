// SPDX-License-Identifier: Apache-2.0
#include "assets/table/thresholds.hpp"

#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <fstream>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

table::Thresholds read_thresholds(const std::string& text) {
    const TemporaryFolder folder;
    std::ofstream(folder / "t.toml", std::ios::binary) << text;
    return table::load_thresholds(folder / "t.toml");
}

}  // namespace

TEST_CASE("thresholds keep their defaults but for what the file says") {
    const table::Thresholds all = read_thresholds("");
    CHECK(all.lsd_db == 2.0);
    CHECK_FALSE(all.st_sim.has_value());
    const table::Thresholds some = read_thresholds("lsd_db = 1\nst_sim = 0.95\nadded_line_db = false\n");
    CHECK(some.lsd_db == 1.0);
    CHECK(some.st_sim == 0.95);
    CHECK_FALSE(some.added_line_db.has_value());
    CHECK(some.cosine_40_500 == all.cosine_40_500);
}

TEST_CASE("thresholds that make no sense are refused with their place") {
    CHECK_THROWS_WITH(read_thresholds("lsd = 1"), ContainsSubstring("did you mean 'lsd_db'?"));
    CHECK_THROWS_WITH(read_thresholds("\nlsd_db = \"1\""), ContainsSubstring(":2:") && ContainsSubstring("number"));
    CHECK_THROWS_WITH(read_thresholds("lsd_db = nan"), ContainsSubstring("number"));
    CHECK_THROWS_WITH(read_thresholds("lsd_db = true"), ContainsSubstring("number"));
    CHECK_THROWS_WITH(read_thresholds("lsd_db"), ContainsSubstring("TOML"));
}
