// SPDX-License-Identifier: Apache-2.0
// model: fits the bundled saw, and what it writes is played by a patch.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <string>

using Catch::Matchers::ContainsSubstring;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;

namespace {

std::string bundled_set() { return (tactus::test::library_folder() / "saw/reciprocating.toml").string(); }

}  // namespace

TEST_CASE("the model of the bundled saw, made without one of its recordings, is within 2 dB of it between the others",
          "[long]") {
    const Folder folder;
    const Outcome made =
        folder.tactus("model " + bundled_set() + " -o " + (folder.path / "saw.toml").string() + " --json");
    REQUIRE(made.code == 0);
    const json rows = json::parse(made.out).at("rows");
    REQUIRE(rows.size() == 12);
    int inner = 0;
    for (const json& row : rows) {
        CHECK(row.at("fitted").at("log_spectral_db") < 2.0);
        CHECK(std::abs(row.at("fitted").at("level_db").get<double>()) < 0.3);
        if (!row.at("inner")) continue;
        ++inner;
        CHECK(row.at("left_out").at("log_spectral_db") < 2.0);
    }
    CHECK(inner == 7);

    folder.write("play.toml",
                 "title = \"A modelled saw\"\nwires = [\"load.value -> saw.load\", \"saw.signal -> out.in\"]\n"
                 "[assets]\nsaw = \"saw.toml\"\n"
                 "[nodes.load]\ntype = \"constant\"\nrate = \"1 kHz\"\nnumber = 7\n"
                 "[nodes.saw]\ntype = \"saw\"\nrate = \"48 kHz\"\nsaw = \"saw\"\n"
                 "[nodes.out]\ntype = \"record\"\nrate = \"48 kHz\"\nfile = \"out.wav\"\n");
    const Outcome checked = folder.tactus("check " + (folder.path / "play.toml").string());
    INFO(checked.out << checked.err);
    CHECK(checked.code == 0);
    const Outcome again =
        folder.tactus("model " + (folder.path / "saw.toml").string() + " -o " + (folder.path / "other.toml").string());
    CHECK(again.code == 2);
    CHECK_THAT(again.err, ContainsSubstring("holds a model already"));
}

TEST_CASE("a model of a stretch of each recording says which") {
    const Folder folder;
    const std::string library = (tactus::test::library_folder() / "saw").string();
    folder.write("set.toml", "full_scale = \"100 m/s^2\"\n[[recording]]\nfile = \"" + library +
                                 "/cutting_150_12N.flac\"\nstate = \"cutting\"\nrate = \"150 Hz\"\nload = \"12 N\"\n");
    const std::string out = " -o " + (folder.path / "saw.toml").string(), set = (folder.path / "set.toml").string();
    const Outcome made = folder.tactus("model " + set + out + " --json --from '200 ms' --to 1.2");
    INFO(made.err);
    REQUIRE(made.code == 0);
    CHECK(json::parse(made.out)["rows"][0]["used_s"] == json({0.2, 1.2}));
    CHECK(tactus::test::broken_schema(folder, "model", json::parse(made.out)) == "");
    const Outcome beyond = folder.tactus("model " + set + out + " --to 1000");
    CHECK(beyond.code == 2);
    CHECK_THAT(beyond.err, ContainsSubstring("s long"));
}

TEST_CASE("recordings without rate or thrust are refused with a reason") {
    const Folder folder;
    const auto library = tactus::test::library_folder() / "saw";
    const Outcome sound = folder.tactus("model " + (library / "cutting_233_7N.flac").string() + " -o " +
                                        (folder.path / "saw.toml").string());
    CHECK(sound.code == 2);
    CHECK_THAT(sound.err, ContainsSubstring("unknown thrust"));
    std::ofstream(folder.path / "set.toml") << "[[recording]]\nfile = \"" << (library / "cutting_233_7N.flac").string()
                                            << "\"\nstate = \"cutting\"\nload = \"7 N\"\n";
    const Outcome rate =
        folder.tactus("model " + (folder.path / "set.toml").string() + " -o " + (folder.path / "saw.toml").string());
    CHECK(rate.code == 2);
    CHECK_THAT(rate.err, ContainsSubstring("does not state its rate"));
    CHECK_FALSE(std::filesystem::exists(folder.path / "saw.toml"));
}
