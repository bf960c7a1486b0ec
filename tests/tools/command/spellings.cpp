// SPDX-License-Identifier: Apache-2.0
// One spelling for one thing in every verb, and the spellings before it, which no help text shows.
#include "tests/tools/run_command.hpp"
#include "tools/command/old_words.hpp"
#include "tools/command/options.hpp"
#include "tools/run/load_plan.hpp"
#include "tools/window/script.hpp"

#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <nlohmann/json.hpp>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;
using namespace tactus;

namespace {

/// $TACTUS_LIBRARY is `folder` while this lives.
struct OwnLibrary {
    explicit OwnLibrary(const std::filesystem::path& folder) { ::setenv("TACTUS_LIBRARY", folder.c_str(), 1); }
    ~OwnLibrary() {
        if (before) ::setenv("TACTUS_LIBRARY", before->c_str(), 1);
        else ::unsetenv("TACTUS_LIBRARY");
    }
    std::optional<std::string> before =
        std::getenv("TACTUS_LIBRARY") ? std::optional<std::string>(std::getenv("TACTUS_LIBRARY")) : std::nullopt;
};

bool shows(const Outcome& help, const std::string& text) { return help.out.find(text) != std::string::npos; }

/// Two sines of half a second.
const std::string tone =
    "wires = [\"tone.signal -> loud.in\", \"loud.out -> kept.in\"]\n"
    "[nodes.tone]\ntype = \"sine\"\nrate = \"48 kHz\"\n[nodes.loud]\ntype = \"gain\"\nrate = \"48 kHz\"\n"
    "[nodes.kept]\ntype = \"record\"\nrate = \"48 kHz\"\nfile = \"kept.wav\"\n";

}  // namespace

TEST_CASE("every verb that writes has -o,--out, and jobs, bands, probes and displays are called alike") {
    const Folder folder;
    for (const char* verb : {"render", "run", "replay", "draw", "gripper", "measure", "equalise", "calibrate", "import",
                             "info", "export", "fracture", "fracture-surface", "plan export", "plan report"}) {
        CAPTURE(verb);
        CHECK(shows(folder.tactus(std::string(verb) + " --help"), "-o,--out"));
    }
    for (const char* verb : {"render", "gripper", "spectrum", "exposure", "compare", "validate"}) {
        const Outcome help = folder.tactus(std::string(verb) + " --help");
        CAPTURE(verb);
        CHECK(shows(help, "--jobs"));
        CHECK_FALSE(shows(help, "--threads"));
    }
    for (const char* verb : {"orders", "measure", "equalise"})
        CHECK(shows(folder.tactus(std::string(verb) + " --help"), "--band LOW:HIGH"));
    for (const char* verb : {"measure", "validate"})
        CHECK(shows(folder.tactus(std::string(verb) + " --help"), "--probe"));
    for (const char* verb : {"run", "render", "view"}) {
        const Outcome help = folder.tactus(std::string(verb) + " --help");
        CHECK(shows(help, "--display"));
        CHECK_FALSE(shows(help, "--rig"));
    }
    CHECK_FALSE(shows(folder.tactus("--help"), "rig "));
    CHECK_FALSE(shows(folder.tactus("snap --help"), "thesis"));
}

TEST_CASE("old spellings still work") {
    const Folder folder;
    const std::string patch = folder.write("p.toml", tone).string(), out = (folder.path / "out").string();
    CHECK(folder.tactus("render " + patch + " --seconds 0.1 --threads 1 --out " + out).code == 0);
    CHECK(folder.tactus("render " + patch + " --seconds 0.1 --threads=1 --overwrite -o " + out).code == 0);
    CHECK(folder.tactus("rig --help").code == 0);
    // Read as --display, whose message it is.
    CHECK(folder.tactus("render touch-sphere --seconds 0.1 --frames 1 --rig nowhere.toml --overwrite -o " + out)
              .err.find("nowhere.toml") != std::string::npos);
    const std::string old_way = (folder.path / "old.csv").string(), new_way = (folder.path / "new.csv").string();
    const std::string sweep = "measure saw-vibration --in actuator.drive --duration 1 --amplitude 100 ";
    const Outcome old = folder.tactus(sweep + "--out handle.out --csv " + old_way +
                                      " --first 25 --last 900 --fit-from 40 --fit-to 300");
    INFO(old.err);
    REQUIRE(old.code == 0);
    REQUIRE(
        folder.tactus(sweep + "--probe handle.out -o " + new_way + " --band '25 Hz:0.9 kHz' --fit-band 40:300").code ==
        0);
    CHECK(slurp(old_way) == slurp(new_way));
    CHECK(folder.tactus("snap none.vdb none.vdb --mode thesis").err.find("none.vdb") != std::string::npos);
}

TEST_CASE("a display file is found by path, by name, in a library with the old folder, and by its path before") {
    const Folder folder;
    const OwnLibrary library(folder.path);
    std::filesystem::create_directories(folder.path / "displays");
    std::filesystem::create_directories(folder.path / "rigs");
    const auto now = folder.write("displays/mirror.toml", "");
    const auto own = folder.write("rigs/own.toml", "");
    CHECK(run::find_display(now.string()) == now);
    CHECK(run::find_display("mirror") == now);
    CHECK(run::find_display((folder.path / "rigs/mirror.toml").string()) == now);
    CHECK(run::find_display("own") == own);
    CHECK(run::find_display(own.string()) == own);
    CHECK_THROWS_WITH(run::find_display("mirrors"),
                      "no display 'mirrors': neither a file nor one of the library (mirror); did you mean 'mirror'?");
}

TEST_CASE("a script of the window understands 'display', and 'rig' without telling of it") {
    const Folder folder;
    CHECK_NOTHROW(window::Script(folder.write("new", "display mirror\n")));
    CHECK_NOTHROW(window::Script(folder.write("old", "rig mirror\n")));
    CHECK_THROWS_WITH(window::Script(folder.write("wrong", "rigg mirror\n")),
                      !Catch::Matchers::ContainsSubstring("'rig'"));
}

TEST_CASE("quantities have units, or are in the unit of the help text") {
    const Folder folder;
    const std::string patch = folder.write("p.toml", tone).string();
    const auto seconds = [&](const std::string& text) {
        const Outcome o = folder.tactus("render " + patch + " --json --overwrite -o " + (folder.path / "out").string() +
                                        " --seconds " + text);
        INFO(o.err);
        REQUIRE(o.code == 0);
        return json::parse(o.out)["seconds"].get<double>();
    };
    CHECK(seconds("0.25") == 0.25);
    CHECK(seconds("'250 ms'") == 0.25);
    CHECK(seconds("'0.05 min'") == 3.0);
    for (const char* wrong : {"'1 mm'", "soon", "'-1 s'", "'0 s'", "''"}) {
        const Outcome o =
            folder.tactus("render " + patch + " -o " + (folder.path / "no").string() + " --seconds " + wrong);
        CAPTURE(wrong, o.err);
        CHECK(o.code == 2);
        CHECK(o.err.find("--seconds") != std::string::npos);
    }
    CHECK_FALSE(std::filesystem::exists(folder.path / "no"));
}

TEST_CASE("a band is LOW:HIGH in Hz or with units") {
    CHECK(command::parse_band("200:600", "--band") == std::pair(200.0, 600.0));
    CHECK(command::parse_band("200 Hz:1 kHz", "--band") == std::pair(200.0, 1000.0));
    for (const char* wrong :
         {"", "5", "5:", ":5", "600:200", "5:5", "0:5", "-1:5", "1 mm:2 mm", "1:2:3", "nan:5", "1:inf"})
        CHECK_THROWS_AS(command::parse_band(wrong, "--band"), Error);
}

TEST_CASE("a value of an option is renamed, alone, in a list and behind an equals sign") {
    std::vector<std::string> words{"a.vdb", "thesis", "--mode", "thesis", "--mode=global,thesis", "--of", "thesis"};
    command::rename_value(words, "--mode", "thesis", "baseline");
    CHECK(words == std::vector<std::string>{"a.vdb", "thesis", "--mode", "baseline", "--mode=global,baseline", "--of",
                                            "thesis"});
}
