// SPDX-License-Identifier: Apache-2.0
// The command as scripts see it: exit codes, one clear error, nothing half-written.
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace fs = std::filesystem;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

namespace {

const std::string good = R"(title = "test"
wires = [
  "tone.signal -> loud.in",
  "loud.out -> kept.in",
  "half.value -> loud.factor",
]
[nodes.tone]
type = "sine"
rate = "48 kHz"
[nodes.loud]
type = "gain"
rate = "48 kHz"
[nodes.kept]
type = "record"
rate = "48 kHz"
[nodes.half]
type = "constant"
rate = "1 kHz"
number = 0.5
)";

}  // namespace

TEST_CASE("a render leaves recordings and a summary, and the hash depends on neither threads nor blocks") {
    const Folder folder;
    const std::string patch = folder.write("good.toml", good).string(), out = (folder.path / "out").string();
    std::string hash;
    for (const char* how : {"--jobs 1", "--jobs 2 --block 1", "--jobs 4 --block 480", "--block random"}) {
        const Outcome done = folder.tactus("render " + patch + " --seconds 0.2 --overwrite --out " + out + " " + how);
        INFO(done.err);
        REQUIRE(done.code == 0);
        const json summary = json::parse(slurp(folder.path / "out/summary.json"));
        CHECK(summary["seconds"] == 0.2);
        CHECK(summary["groups"][0]["ticks"] == 9600);
        CHECK(summary["signals"][0]["file"] == "kept.wav");
        CHECK(fs::file_size(folder.path / "out/kept.wav") > 9600 * 4);
        if (hash.empty()) hash = summary["output_hash"];
        CHECK(summary["output_hash"] == hash);
    }
}

// Costly: runs of a patch with a bone.
TEST_CASE("check says how stiff a hand may feel each path, and what the patch declares", "[slow]") {
    const Folder folder;
    const auto loop = [&](const std::string& settings, int code = 0) {
        const Outcome o = folder.tactus("check saw-training --json " + settings);
        INFO(o.err);
        REQUIRE(o.code == code);
        const json answer = json::parse(o.out);
        for (const json& path : answer["paths"])
            if (path["from"] == "hand" && path["to"] == "hand_out") return path;
        FAIL("no path hand -> hand_out");
        return json();
    };
    const json as_shipped = loop("");
    CHECK(as_shipped["latency_ms"] == 0.0);
    // 30 N s/m over half a millisecond.
    CHECK(as_shipped["stiffness_limit_N_per_mm"].get<double>() == Approx(60.0));
    CHECK(as_shipped["declared_N_per_mm"].get<double>() == Approx(40.0));
    CHECK(as_shipped["declared_by"] == "blade.stiffness");
    CHECK(as_shipped["ok"] == true);
    CHECK(loop("--set simulated.damping='5 N s/m'", 1)["ok"] == false);
}

TEST_CASE("check names every slip with file, line and column", "[slow]") {
    const Folder folder;
    struct Slip {
        std::string what, to, message;
        int line;
    };
    const Slip slips[] = {
        {"type = \"sine\"", "type = \"sin\"", "did you mean 'sine'?", 8},
        {"loud.in\"", "loud.inn\"", "did you mean 'in'?", 3},
        {"tone.signal ->", "tune.signal ->", "did you mean 'tone'?", 3},
        {"number = 0.5", "nummber = 0.5", "did you mean 'number'?", 19},
        {"number = 0.5", "number = \"0.5 N\"", "unit", 19},
        {"rate = \"1 kHz\"", "rate = \"59.94001 Hz\"", "not exact", 18},
        {"half.value -> loud.factor", "loud.out -> half.number", "gives a signal", 5},
        {"half.value -> loud.factor", "loud.out -> loud.in", "already fed", 5},
        {"  \"half", "  \"loud.out -> tone.x\", \"half", "no port 'x'", 5},
    };
    for (const Slip& slip : slips) {
        std::string text = good;
        text.replace(text.find(slip.what), slip.what.size(), slip.to);
        const std::string patch = folder.write("slip.toml", text).string();
        const Outcome bad = folder.tactus("check " + patch + " --json");
        INFO(slip.to << "\n" << bad.out << bad.err);
        CHECK(bad.code == 2);
        const json errors = json::parse(bad.out)["errors"];
        REQUIRE(errors.size() == 1);
        CHECK(errors[0]["file"] == patch);
        CHECK(errors[0]["line"] == slip.line);
        CHECK(errors[0]["column"] > 0);
        CHECK(errors[0]["message"].get<std::string>().find(slip.message) != std::string::npos);
    }
    CHECK(json::parse(folder.tactus("check " + folder.write("good.toml", good).string() + " --json").out)["ok"] ==
          true);
}

TEST_CASE("a cycle, wires inside a table, broken TOML and an empty patch are named for what they are") {
    const Folder folder;
    const auto message = [&folder](const std::string& text) {
        const Outcome bad = folder.tactus("check " + folder.write("bad.toml", text).string());
        CHECK(bad.code == 2);
        return bad.err;
    };
    using Catch::Matchers::ContainsSubstring;
    CHECK_THAT(message("wires = [\"a.out -> b.in\", \"b.out -> a.in\"]\n[nodes.a]\ntype=\"gain\"\nrate=\"48 kHz\"\n"
                       "[nodes.b]\ntype=\"gain\"\nrate=\"48 kHz\"\n"),
               ContainsSubstring("cycle"));
    CHECK_THAT(message("[nodes.a]\ntype=\"constant\"\nrate=\"1 kHz\"\nwires = [\"a.value -> a.x\"]\n"),
               ContainsSubstring("move it above"));
    CHECK_THAT(message("wires = [\n"), ContainsSubstring("bad.toml:"));
    CHECK_THAT(message(""), ContainsSubstring("no nodes"));
}

TEST_CASE("assets and settings that cannot be used end in exit code 2, say which, and write nothing", "[slow]") {
    const Folder folder;
    const fs::path out = folder.path / "out";
    const auto refused = [&](const std::string& how, const std::string& part) {
        const Outcome bad = folder.tactus("render saw-training --seconds 0.1 --out " + out.string() + " " + how);
        INFO(how << "\n" << bad.err);
        CHECK(bad.code == 2);
        CHECK(bad.err.find(part) != std::string::npos);
        CHECK_FALSE(fs::exists(out / "summary.json"));
    };
    refused("--asset bone=/nonexistent.vdb", "nonexistent.vdb");
    refused("--asset bone=" + folder.write("garbage.vdb", std::string(5000, 'x')).string(), "garbage.vdb");
    refused("--asset saw=" + folder.write("cut.wav", "RIFF....WAVEfmt ").string(), "cut.wav");
    refused("--asset bonne=x.vdb", "did you mean 'bone'?");
    refused("--set 'blade.stifness=1 N/mm'", "did you mean 'stiffness'?");
    refused("--set 'blade.stiffness=1 kg'", "unit");
    refused("--set 'blade.stiffness=900 N/mm'", "outside");
    refused("--set hand.device=replay --asset trajectory=" +
                folder.write("bad.csv", "t_s,px_mm,py_mm,pz_mm,qx,qy,qz,qw\n0,0,0,0,0,0,0,1\n0.01,nan,0,0,0,0,0,1\n")
                    .string(),
            "bad.csv");
}

TEST_CASE("a folder that cannot be made or written is refused, and an import that fails leaves nothing") {
    const Folder folder;
    const std::string patch = folder.write("good.toml", good).string();
    CHECK(folder.tactus("render " + patch + " --seconds 0.1 --out /proc/nowhere").code == 2);
    CHECK(folder.tactus("render " + patch + " --seconds 0.1 --out " + patch).code == 2);
    CHECK(folder.tactus("import " + patch + " -o " + (folder.path / "x.vdb").string()).code == 2);
    CHECK_FALSE(fs::exists(folder.path / "x.vdb"));
}

TEST_CASE("usage that makes no sense ends in exit code 2", "[slow]") {
    const Folder folder;
    for (const char* line :
         {"frobnicate", "render", "render saw-training --out o --seconds -1",
          "render saw-training --out o --seconds 1 --block 0", "run no-such-patch --seconds 1", "nodes gainn"}) {
        INFO(line);
        CHECK(folder.tactus(line).code == 2);
    }
    for (const char* line : {"--help", "nodes --json", "devices --json", "draw saw-training"})
        CHECK(folder.tactus(line).code == 0);
}

// Costly: runs of a patch with a bone.
TEST_CASE("saw-training saws: forces within limits, bone removed, the same bits on any number of threads", "[slow]") {
    const Folder folder;
    const fs::path out = folder.path / "saw";
    std::string hash;
    for (const char* how : {"--jobs 1 --block random", "--jobs 3"}) {
        const Outcome done =
            folder.tactus("render saw-training --seconds 3 --overwrite --out " + out.string() + " " + how);
        INFO(done.err);
        REQUIRE(done.code == 0);
        const json summary = json::parse(slurp(out / "summary.json"));
        CHECK(summary["contact"]["fraction"] > 0.5);
        CHECK(summary["contact"]["limited_ticks"] <= 3);
        CHECK(summary["contact"]["max_penetration_mm"] < 3.0);
        CHECK(summary["force"]["thrust_mean_N"] > 6.3);
        CHECK(summary["force"]["thrust_mean_N"] < 7.7);
        CHECK(summary["force"]["max_N"] < 15.0);
        CHECK(summary["carve"]["removed_mm3"] > 5.0);
        CHECK(summary["carve"]["severed"] == 0.0);
        CHECK(summary["carve"]["by_density"].size() == 4);
        for (const char* file : {"haptuator.wav", "handle.wav", "force.csv", "pose.csv", "removed.csv"})
            CHECK(fs::file_size(out / file) > 1000);
        // The blade slides along its kerf under a hand that strokes to and fro.
        std::istringstream force(slurp(out / "force.csv"));
        std::string line;
        std::getline(force, line);
        double most = 0.0;
        while (std::getline(force, line)) most = std::max(most, std::abs(std::stod(line.substr(line.find(',') + 1))));
        CHECK(most < 2.0);
        if (hash.empty()) hash = summary["output_hash"];
        CHECK(summary["output_hash"] == hash);
    }
}

// Costly: runs of a patch with a bone.
TEST_CASE("a live run's log repeats it to the bit", "[slow]") {
    const Folder folder;
    const std::string log = (folder.path / "timing.log").string();
    const Outcome live = folder.tactus("run saw-training --seconds 1 --dilate 2 --json --out " +
                                       (folder.path / "live").string() + " --log " + log);
    INFO(live.err);
    REQUIRE(live.code == 0);
    const Outcome again = folder.tactus("render saw-training --seconds 1 --json --out " +
                                        (folder.path / "again").string() + " --log " + log);
    INFO(again.err);
    REQUIRE(again.code == 0);
    CHECK(json::parse(live.out)["live"] == true);
    CHECK(json::parse(again.out)["output_hash"] == json::parse(live.out)["output_hash"]);
}

TEST_CASE("of very many errors the first twenty are printed, and how many more there are") {
    const Folder folder;
    std::string wires;
    for (int i = 0; i < 3020; ++i) wires += "\"nobody.out -> nothing.in\",\n";
    folder.write("wrong.toml", "wires = [" + wires + "]\n[nodes.tone]\ntype = \"sine\"\nrate = \"48 kHz\"\n");
    const std::string patch = (folder.path / "wrong.toml").string();
    for (const std::string& verb :
         {"check " + patch, "render " + patch + " --out " + folder.path.string(), "draw " + patch}) {
        const Outcome outcome = folder.tactus(verb);
        INFO(verb << "\n" << outcome.err);
        CHECK(outcome.code == 2);
        CHECK(std::ranges::count(outcome.err, '\n') == 21);
        CHECK(outcome.err.ends_with("… and 3,000 more errors\n"));
    }
    // A program reads them all.
    const Outcome all = folder.tactus("check --json " + patch);
    CHECK(all.code == 2);
    CHECK(json::parse(all.out)["errors"].size() == 3020);
}
