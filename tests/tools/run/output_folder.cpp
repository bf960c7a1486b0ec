// SPDX-License-Identifier: Apache-2.0
// One folder, one run: results are written over only where that is asked for.
#include "tests/support/catch.hpp"
#include "tests/tools/background_run.hpp"
#include "tests/tools/outputs_patch.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

using Catch::Matchers::ContainsSubstring;
using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::recording_patch;
using tactus::test::Run;
using tactus::test::shell;
using tactus::test::slurp;
using tactus::test::wait_for;

namespace {

namespace fs = std::filesystem;

const std::string live = " --audio none --no-edits ";

}  // namespace

TEST_CASE("a folder that holds results is refused, and written over when that is asked for", "[slow]") {
    const Folder folder;
    folder.write("p.toml", recording_patch);
    for (const std::string verb : {"render", "run --audio none --no-edits"}) {
        const std::string out = verb.substr(0, 3), line = "$T " + verb + " p.toml --seconds 0.1 --out " + out;
        REQUIRE(shell(folder, line).code == 0);
        const std::string summary = slurp(folder.path / out / "summary.json");
        const Outcome again = shell(folder, line);
        CHECK(again.code == 2);
        CHECK_THAT(again.err, ContainsSubstring("already has results") && ContainsSubstring("--overwrite"));
        CHECK(slurp(folder.path / out / "summary.json") == summary);
        CHECK(shell(folder, line + " --overwrite").code == 0);
        // What a run that was killed has left is a result as well.
        fs::create_directory(folder.path / (out + "2"));
        folder.write(out + "2/table.csv.part", "t_s\n");
        CHECK(shell(folder, line + "2").code == 2);
        CHECK(slurp(folder.path / (out + "2") / "table.csv.part") == "t_s\n");
        // Other files are no results.
        fs::create_directory(folder.path / (out + "3"));
        folder.write(out + "3/notes.txt", "text");
        CHECK(shell(folder, line + "3/").code == 0);
    }
}

TEST_CASE("runs at the same time have folders of their own, and a link leads to the last one", "[slow]") {
    const Folder folder;
    folder.write("p.toml", recording_patch);
    const std::string line = "$T run p.toml --seconds 1" + live;
    const Outcome both = shell(folder, line + ">a.out & sleep 0.3; " + line + ">b.out || exit 1; wait $!");
    INFO(both.err);
    CHECK(both.code == 0);
    for (const char* name : {"p-run", "p-run-2"}) {
        INFO(name);
        const std::string table = slurp(folder.path / name / "table.csv");
        CHECK(std::ranges::count(table, '\n') >= 1000);
        CHECK(table.find('\0') == std::string::npos);
        CHECK(json::parse(slurp(folder.path / name / "summary.json"))["seconds"] == 1.0);
    }
    CHECK_THAT(slurp(folder.path / "a.out"), Catch::Matchers::EndsWith("results in p-run/\n"));
    CHECK_THAT(slurp(folder.path / "b.out"), Catch::Matchers::EndsWith("results in p-run-2/\n"));
    CHECK(fs::read_symlink(folder.path / "p-run-latest") == "p-run-2");
    CHECK(shell(folder, "$T run p.toml --seconds 0.1" + live).code == 0);
    CHECK(fs::read_symlink(folder.path / "p-run-latest") == "p-run-3");
    CHECK(fs::exists(folder.path / "p-run-latest/summary.json"));
    // A file of that name stays.
    fs::remove(folder.path / "p-run-latest");
    folder.write("p-run-latest", "mine");
    CHECK(shell(folder, "$T run p.toml --seconds 0.1" + live).code == 0);
    CHECK(slurp(folder.path / "p-run-latest") == "mine");
}

TEST_CASE("a folder that another run writes to is refused, even to be written over", "[slow]") {
    const Folder folder;
    const std::string file = folder.write("p.toml", recording_patch).string(), out = (folder.path / "out").string();
    Run run(folder, file + live + "--out " + out);
    REQUIRE(wait_for([&] { return fs::exists(out + "/table.csv.part"); }));
    for (const std::string& how : {"run" + live, std::string("render ")}) {
        const Outcome second = folder.tactus(how + " " + file + " --seconds 0.1 --overwrite --out " + out);
        CHECK(second.code == 2);
        CHECK_THAT(second.err, ContainsSubstring("another run writes to this folder"));
    }
    CHECK(run.stop(SIGINT) == 0);
    CHECK(slurp(out + "/table.csv").find('\0') == std::string::npos);
    CHECK(fs::exists(out + "/summary.json"));
}

TEST_CASE("a recording cannot have the name of a file that the run itself writes", "[slow]") {
    const Folder folder;
    for (const char* name : {"summary.json", "bone.vdb", "bone.png", "take.json", "timing.log", "events.jsonl",
                             "result.json", "patch-0.toml", "streams", "journal-1", "sound.wav.part"}) {
        std::string text = recording_patch;
        text += std::string("file = \"") + name + "\"\n";
        const std::string file = folder.write("p.toml", text).string();
        const Outcome refused =
            folder.tactus("render " + file + " --seconds 0.1 --out " + (folder.path / "out").string());
        INFO(name << "\n" << refused.err);
        CHECK(refused.code == 2);
        // The node's table in the patch.
        CHECK_THAT(refused.err, ContainsSubstring("p.toml:16:8: '" + std::string(name) + "' is the name of a file"));
        CHECK((!fs::exists(folder.path / "out") || fs::is_empty(folder.path / "out")));
    }
    const std::string file = folder.write("p.toml", std::string(recording_patch) + "file = \"table.log\"\n").string(),
                      out = (folder.path / "out").string();
    const Outcome log =
        folder.tactus("run " + file + live + "--seconds 0.1 --out " + out + " --log " + out + "/table.log");
    CHECK(log.code == 2);
    CHECK_THAT(log.err, ContainsSubstring("--log") && ContainsSubstring("the patch records to this file"));
}

TEST_CASE("a run that is refused leaves no folder, and the link to the last run as it was") {
    const Folder folder;
    folder.write("p.toml", recording_patch);
    folder.write("bad.toml",
                 "wires = []\n[devices.board]\ndriver = \"serial_board\"\nport = \"/dev/none\"\n"
                 "[nodes.hand]\ntype = \"device_input\"\nrate = \"1 kHz\"\n");
    fs::create_directory(folder.path / "kept");
    fs::create_directory(folder.path / "bad-run");
    folder.write("bad-run/summary.json", "{}");
    fs::create_symlink("bad-run", folder.path / "bad-run-latest");
    const std::string run = "$T run bad.toml --seconds 0.1" + live;
    for (const char* out : {"--out new", "--out a/b/c", "--out kept/d", "--out kept", ""}) {
        INFO(out);
        const Outcome refused = shell(folder, run + out);
        CHECK(refused.code == 2);
        CHECK_THAT(refused.err, ContainsSubstring("/dev/none"));
    }
    CHECK_FALSE(fs::exists(folder.path / "new"));
    CHECK_FALSE(fs::exists(folder.path / "a"));
    CHECK_FALSE(fs::exists(folder.path / "bad-run-2"));
    CHECK(fs::is_directory(folder.path / "kept"));
    CHECK(fs::is_empty(folder.path / "kept"));
    CHECK(fs::read_symlink(folder.path / "bad-run-latest") == "bad-run");
    CHECK(slurp(folder.path / "bad-run/summary.json") == "{}");
    fs::remove(folder.path / "bad-run-latest");
    CHECK(shell(folder, run).code == 2);
    CHECK_FALSE(fs::is_symlink(fs::symlink_status(folder.path / "bad-run-latest")));
}
