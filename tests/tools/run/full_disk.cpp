// SPDX-License-Identifier: Apache-2.0
// A disk that gets full or goes away during a run: what was written stays, the rest of the run is kept.
#include "assets/sound/sound.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/outputs_patch.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>

using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::recording_patch;
using tactus::test::sanitized;
using tactus::test::shell;
using tactus::test::skip;
using tactus::test::slurp;

namespace {

namespace fs = std::filesystem;

/// The command on a disk that fails as `how` says, see tests/preload/failing_disk.cpp.
Outcome on_failing_disk(const Folder& folder, const std::string& how, const std::string& arguments) {
    return shell(folder, "env " + how + " LD_PRELOAD=" + tactus::test::failing_disk() + " $T " + arguments + "\n");
}

/// Rows of a table, each of them whole.
std::size_t whole_rows(const fs::path& path) {
    const std::string text = slurp(path);
    REQUIRE_FALSE(text.empty());
    CHECK(text.back() == '\n');
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    const auto columns = std::ranges::count(line, ',');
    std::size_t rows = 0;
    for (; std::getline(lines, line); ++rows) {
        INFO("row " << rows << ": " << line);
        REQUIRE(std::ranges::count(line, ',') == columns);
        REQUIRE(line.size() >= 9);
    }
    return rows;
}

void no_parts(const fs::path& folder) {
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        INFO(entry.path());
        CHECK(entry.path().extension() != ".part");
    }
}

bool is_sanitized() {
    if (sanitized) skip("a sanitizer must be loaded first, so no disk can be made to fail here");
    return sanitized;
}

}  // namespace

TEST_CASE("on a disk that gets full, a render and a run keep every whole row and sample and go on to their end",
          "[slow]") {
    if (is_sanitized()) return;
    const Folder folder;
    folder.write("p.toml", recording_patch);
    for (const std::string verb : {"render", "run --audio none --no-edits"}) {
        const std::string out = verb.substr(0, 3);
        // A table of 2 s is some 26 kB, a sound 384 kB.
        const Outcome full = on_failing_disk(folder, "FAILING_DISK_FROM=3 FAILING_DISK_PATH=table.csv:sound.wav",
                                             verb + " p.toml --seconds 2 --json --out " + out);
        INFO(verb << "\n" << full.out << full.err);
        CHECK(full.code == 3);
        CHECK(full.err.find("sound.wav") != std::string::npos);
        CHECK(full.err.find("table.csv") != std::string::npos);
        CHECK(full.err.find("No space left on device") != std::string::npos);
        const json summary = json::parse(slurp(folder.path / out / "summary.json"));
        CHECK(json::parse(full.out) == summary);
        CHECK(summary["seconds"] == 2.0);
        CHECK(summary["lost"].size() == 2);
        CHECK(summary["files"] == json::array({"summary.json"}));
        CHECK(summary["signals"].empty());
        CHECK(summary["groups"].size() == 2);
        // What there was no room for at all leaves no file.
        if (fs::exists(folder.path / out / "sound.wav")) {
            const tactus::sound::Sound sound = tactus::sound::load_sound(folder.path / out / "sound.wav");
            CHECK(sound.frames < 96000);
        }
        if (fs::exists(folder.path / out / "table.csv")) CHECK(whole_rows(folder.path / out / "table.csv") < 2000);
        no_parts(folder.path / out);
    }
}

TEST_CASE("one output that finds no room ends whole, the others are whole to the end") {
    if (is_sanitized()) return;
    const Folder folder;
    folder.write("p.toml", recording_patch);
    REQUIRE(folder
                .tactus("render " + (folder.path / "p.toml").string() + " --seconds 2 --out " +
                        (folder.path / "good").string())
                .code == 0);
    const Outcome sound = on_failing_disk(folder, "FAILING_DISK_FROM=20 FAILING_DISK_PATH=sound.wav",
                                          "render p.toml --seconds 2 --out a");
    INFO(sound.out << sound.err);
    CHECK(sound.code == 3);
    CHECK(slurp(folder.path / "a/table.csv") == slurp(folder.path / "good/table.csv"));
    const tactus::sound::Sound whole = tactus::sound::load_sound(folder.path / "good/sound.wav"),
                               cut = tactus::sound::load_sound(folder.path / "a/sound.wav");
    CHECK(cut.frames > 0);
    CHECK(cut.frames < whole.frames);
    CHECK(std::equal(cut.samples.begin(), cut.samples.end(), whole.samples.begin()));

    const Outcome table =
        on_failing_disk(folder, "FAILING_DISK_FROM=2 FAILING_DISK_PATH=table.csv", "render p.toml --seconds 2 --out b");
    INFO(table.out << table.err);
    CHECK(table.code == 3);
    CHECK(table.out.find("note: not written to its end: ") != std::string::npos);
    CHECK(slurp(folder.path / "b/sound.wav") == slurp(folder.path / "good/sound.wav"));
    CHECK(whole_rows(folder.path / "b/table.csv") > 100);
    CHECK(slurp(folder.path / "good/table.csv").starts_with(slurp(folder.path / "b/table.csv")));
}

TEST_CASE("a disk that cannot be written to any more loses nothing that was there, and the answer is still given") {
    if (is_sanitized()) return;
    const Folder folder;
    folder.write("p.toml", recording_patch);
    const Outcome gone = on_failing_disk(
        folder,
        "FAILING_DISK_ERRNO=EROFS FAILING_DISK_CALLS=write,open,rename FAILING_DISK_FROM=12 FAILING_DISK_PATH=out/",
        "render p.toml --seconds 2 --json --out out/");
    INFO(gone.out << gone.err);
    CHECK(gone.code == 3);
    CHECK(json::parse(gone.out)["seconds"] == 2.0);
    CHECK(gone.err.find("Read-only file system") != std::string::npos);
    // They cannot even be renamed.
    CHECK(fs::file_size(folder.path / "out/sound.wav.part") > 0);
}

TEST_CASE("a sound whose header cannot be completed does not get its name") {
    if (is_sanitized()) return;
    const Folder folder;
    folder.write("p.toml", recording_patch);
    // All writes fail, renaming does not.
    const Outcome gone =
        on_failing_disk(folder, "FAILING_DISK_ERRNO=EIO FAILING_DISK_FROM=12 FAILING_DISK_PATH=sound.wav",
                        "render p.toml --seconds 2 --out out");
    INFO(gone.out << gone.err);
    CHECK(gone.code == 3);
    CHECK_FALSE(fs::exists(folder.path / "out/sound.wav"));
    CHECK(fs::file_size(folder.path / "out/sound.wav.part") > 0);
    CHECK(gone.err.find("sound.wav.part") != std::string::npos);
}

TEST_CASE("a take that finds no room repeats the run as far as it goes", "[kernel]") {
    if (is_sanitized()) return;
    const Folder folder;
    folder.write("p.toml", recording_patch);
    // The beginning of the log is written before the run.
    for (const auto& [what, from] : {std::pair{"timing.log", "3"},
                                     {"events.jsonl", "2"},
                                     {"streams/", "2"},
                                     {"streams/", "30"},
                                     {"take/", "12"},
                                     {"result.json", "1"}}) {
        fs::remove_all(folder.path / "take");
        fs::remove_all(folder.path / "out");
        const Outcome full =
            on_failing_disk(folder, std::string("FAILING_DISK_FROM=") + from + " FAILING_DISK_PATH=" + what,
                            "run p.toml --audio none --no-edits --seconds 1 --out out --record take");
        INFO(what << " from " << from << "\n" << full.out << full.err);
        CHECK(full.code == 3);
        CHECK(full.err.find("take/") != std::string::npos);
        CHECK(whole_rows(folder.path / "out/table.csv") > 900);
        CHECK(fs::exists(folder.path / "out/summary.json"));
        CHECK_FALSE(fs::exists(folder.path / "take/result.json"));
        const Outcome again = shell(folder, "$T replay take --json\n");
        INFO(again.out << again.err);
        const auto said = json::parse(again.out);
        // Streams that hold nothing show nothing; the log alone repeats the run.
        CHECK(again.code == (said["compared_values"] > 0 ? 0 : 1));
        CHECK(said["cut_off"] == true);
        CHECK(said["identical"] == false);
        CHECK(said["first_difference"].is_null());
        CHECK(said["damaged_files"].empty());
        CHECK(said["differing_hashes"].empty());
        if (std::string_view(what) == "streams/") CHECK(said["seconds"] == 1.0);
    }
}

TEST_CASE("a run with 300 outputs is recorded whole where it may open 256 files", "[slow]") {
    const Folder folder;
    std::string patch = "title = \"many\"\n";
    for (int i = 0; i < 300; ++i)
        patch += "[nodes.n" + std::to_string(i) + "]\ntype = \"constant\"\nrate = \"100 Hz\"\n";
    folder.write("p.toml", patch);
    const Outcome run =
        shell(folder, "ulimit -n 256\n$T run p.toml --no-edits --seconds 0.3 --out out --record take\n");
    INFO(run.out << run.err);
    CHECK(run.code == 0);
    CHECK(fs::exists(folder.path / "take/result.json"));
}

TEST_CASE("a timing log that finds no room keeps whole records and its name", "[kernel]") {
    if (is_sanitized()) return;
    const Folder folder;
    folder.write("p.toml", recording_patch);
    const Outcome full = on_failing_disk(folder, "FAILING_DISK_PATH=run.log",
                                         "run p.toml --audio none --no-edits --seconds 0.5 --out out --log run.log");
    INFO(full.out << full.err);
    CHECK(full.code == 3);
    CHECK(full.err.find("run.log: cannot be written: No space left on device") != std::string::npos);
    CHECK(fs::exists(folder.path / "run.log"));
    CHECK_FALSE(fs::exists(folder.path / "run.log.part"));
    CHECK(whole_rows(folder.path / "out/table.csv") > 450);
}

// Costly: whole runs of the command.
TEST_CASE("bones and pictures that find no room are named, and the rest of the results is there", "[slow]") {
    if (is_sanitized()) return;
    const Folder folder;
    for (const std::string what : {".vdb", ".png"}) {
        const std::string out = "out-" + what.substr(1);
        const Outcome full =
            on_failing_disk(folder, "FAILING_DISK_PATH=" + out + "/bone" + what + ":" + out + "/frame_0001",
                            "render saw-training --seconds 0.2 --frames 2 --size 200x120 --json --out " + out);
        INFO(full.out << full.err);
        CHECK(full.code == 3);
        CHECK(full.err.find("bone" + what) != std::string::npos);
        const json summary = json::parse(slurp(folder.path / out / "summary.json"));
        CHECK(summary["lost"].size() == 2);
        CHECK(fs::exists(folder.path / out / (what == ".vdb" ? "bone.png" : "bone.vdb")));
        CHECK(fs::exists(folder.path / out / "frame_0002.png"));
        CHECK_FALSE(fs::exists(folder.path / out / ("bone" + what)));
        CHECK_FALSE(fs::exists(folder.path / out / "frame_0001.png"));
        no_parts(folder.path / out);
    }
}

TEST_CASE("a folder without room for the summary is refused before anything runs") {
    if (is_sanitized()) return;
    const Folder folder;
    folder.write("p.toml", recording_patch);
    const Outcome full =
        on_failing_disk(folder, "FAILING_DISK_PATH=summary.json", "render p.toml --seconds 0.1 --out out");
    INFO(full.err);
    CHECK(full.code == 2);
    CHECK(full.err.find("there is no room for results") != std::string::npos);
    CHECK_FALSE(fs::exists(folder.path / "out"));
}
