// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/rig_matrix.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;

namespace {

analysis::RigMatrix read(const std::string& text) {
    const TemporaryFolder folder;
    file::write_whole_file(folder / "m.toml", text);
    return analysis::load_rig_matrix(folder / "m.toml");
}

}  // namespace

TEST_CASE("a matrix says what is tried, in units, and the rest is the standard") {
    const analysis::RigMatrix m = read(R"(motors = ["a"]
rates = ["0.5 Hz", "2 Hz"]
amplitudes = ["1 cm"]
cycles = 7
[[objects]]
stiffness = "2 N/mm"
damping = "0.03 N s/mm"
[[objects]]
kind = "wall"
[crossover]
rates = ["3 Hz", "1 Hz"]
[assumed.a]
lag = ["1 ms", "2 ms"]
)");
    CHECK(m.motors == std::vector<std::string>{"a"});
    CHECK(m.rates == std::vector<double>{0.5, 2.0});
    CHECK(m.amplitudes == std::vector<double>{0.01});
    CHECK(m.cycles == 7);
    REQUIRE(m.objects.size() == 2);
    CHECK(m.objects[0].stiffness == Approx(2000.0));
    CHECK(m.objects[0].damping == Approx(30.0));
    CHECK(m.objects[1].kind == control::ObjectKind::wall);
    CHECK(m.crossover_rates == std::vector<double>{1.0, 3.0});
    REQUIRE(m.assumptions.size() == 1);
    CHECK(m.assumptions[0].high == "2 ms");
    CHECK(read("").objects.size() == analysis::RigMatrix{}.objects.size());
}

TEST_CASE("a matrix that cannot be tried says where") {
    CHECK_THROWS_WITH(read("rats = []"), Catch::Matchers::ContainsSubstring("did you mean 'rates'"));
    CHECK_THROWS_WITH(read("rates = [1]"), Catch::Matchers::ContainsSubstring("m.toml:1:10"));
    CHECK_THROWS_WITH(read("rates = [\"1 mm\"]"), Catch::Matchers::ContainsSubstring("wrong kind of unit"));
    CHECK_THROWS_WITH(read("rates = [\"0 Hz\"]"), Catch::Matchers::ContainsSubstring("above 0"));
    CHECK_THROWS_WITH(read("rates = []"), Catch::Matchers::ContainsSubstring("1 to 100"));
    CHECK_THROWS_WITH(read("[[objects]]\nname = \"nothing\""),
                      Catch::Matchers::ContainsSubstring("needs a stiffness or a damping"));
    CHECK_THROWS_WITH(read("cycles = 1"), Catch::Matchers::ContainsSubstring("from 2"));
    CHECK_THROWS_WITH(read("[assumed.a]\nlag = [\"1 ms\"]"), Catch::Matchers::ContainsSubstring("two limits"));
    CHECK_THROWS_WITH(read("rates = "), Catch::Matchers::ContainsSubstring("not valid TOML"));
    std::string deep = "a";
    for (int i = 0; i < 100'000; ++i) deep += ".a";
    CHECK_THROWS_WITH(read(deep + " = 1\n"), Catch::Matchers::ContainsSubstring("at most 32 dots"));
}
