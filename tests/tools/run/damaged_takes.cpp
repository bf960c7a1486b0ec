// SPDX-License-Identifier: Apache-2.0
// Takes that lost something since they were made, and what a run that was killed can still give.
#include "tests/support/catch.hpp"
#include "tests/tools/background_run.hpp"
#include "tests/tools/patches.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

namespace fs = std::filesystem;
using namespace tactus::test;
using nlohmann::json;

namespace {

/// `touch` with files to write: a sound and a trace.
const std::string heard = [] {
    std::string patch = touch;
    patch.replace(patch.find("wires = [\n"), 10,
                  "wires = [\n  \"loud.out -> ear.signal\",\n  \"hand.pose -> trace.in\",\n");
    return patch +
           "[nodes.ear]\ntype = \"audio_output\"\nrate = \"48 kHz\"\n"
           "[nodes.trace]\ntype = \"record\"\nrate = \"1 kHz\"\n";
}();

fs::path render(const Folder& folder, const std::string& options = {}) {
    folder.write("touch.toml", heard);
    const fs::path take = folder.path / "take";
    const Outcome done = folder.tactus("render " + (folder.path / "touch.toml").string() + " --seconds 0.5 --out " +
                                       (folder.path / "out").string() + " --record " + take.string() + " " + options);
    INFO(done.err);
    REQUIRE(done.code == 0);
    return take;
}

void halve(const fs::path& file) { fs::resize_file(file, fs::file_size(file) / 2); }

}  // namespace

TEST_CASE("a take that lost a part of any file differs, and replay names the file", "[slow]") {
    const Folder folder;
    const fs::path whole = render(folder), take = folder.path / "damaged";
    const auto check = [&](const std::string& file, const std::function<void(const fs::path&)>& damage) {
        fs::remove_all(take);
        fs::copy(whole, take, fs::copy_options::recursive);
        damage(take / file);
        const Outcome told = folder.tactus("replay " + take.string());
        INFO(file << ": " << told.out << told.err);
        CHECK(told.code == 1);
        CHECK(told.out.find("identical") == std::string::npos);
        CHECK(told.out.find("differs: " + file + " has ") != std::string::npos);
        const Outcome outcome = folder.tactus("replay " + take.string() + " --json");
        CHECK(outcome.code == 1);
        const json report = json::parse(outcome.out);
        CHECK(report["identical"] == false);
        CHECK(report["damaged_files"][0]["file"] == file);
        CHECK(report["damaged_files"][0]["holds"] < report["damaged_files"][0]["written"]);
    };
    check("streams/1-kHz.wav", halve);
    check("streams/48-kHz.wav", [](const fs::path& file) { fs::resize_file(file, fs::file_size(file) - 1); });
    check("streams/60-Hz.wav", [](const fs::path& file) { fs::remove(file); });
    check("streams/48-kHz.wav", [](const fs::path& file) { fs::resize_file(file, 0); });
    check("timing.log", halve);
    check("timing.log", [](const fs::path& file) { fs::resize_file(file, fs::file_size(file) - 1); });
    check("events.jsonl", [](const fs::path& file) {
        const std::string text = slurp(file);
        std::ofstream(file) << text.substr(0, text.rfind('\n', text.size() - 2) + 1);
    });
    // A chunk out of the middle: both ends are as they were.
    check("timing.log", [](const fs::path& file) {
        const std::string log = slurp(file);
        std::vector<std::size_t> chunks;
        for (std::size_t at = 24; at + 8 <= log.size();) {
            chunks.push_back(at);
            std::uint32_t length = 0;
            std::memcpy(&length, log.data() + at, sizeof length);
            at += 8 + length;
        }
        REQUIRE(chunks.size() > 4);
        const std::size_t n = chunks.size() / 2;
        std::ofstream(file, std::ios::binary) << log.substr(0, chunks[n]) << log.substr(chunks[n + 1]);
    });
    const Outcome same = folder.tactus("replay " + whole.string());
    CHECK(same.code == 0);
    CHECK(same.out.starts_with("identical: "));
}

TEST_CASE("a take without result.json is cut off, and one without values is never identical") {
    const Folder folder;
    const fs::path take = render(folder);
    fs::remove(take / "result.json");
    const Outcome cut = folder.tactus("replay " + take.string());
    CHECK(cut.code == 0);
    CHECK(cut.out.starts_with("cut off; "));
    halve(take / "timing.log");
    CHECK(folder.tactus("replay " + take.string()).out.starts_with("cut off; "));
    fs::remove_all(take / "streams");
    const Outcome empty = folder.tactus("replay " + take.string());
    CHECK(empty.code == 1);
    CHECK(empty.out.starts_with("cut off; 0 values compared"));
    CHECK(empty.out.find("equal") == std::string::npos);
}

TEST_CASE("a take of a format that is too old is refused with one message") {
    const Folder folder;
    const fs::path take = render(folder);
    json about = json::parse(slurp(take / "take.json"));
    about["format"] = 1;
    std::ofstream(take / "take.json") << about.dump();
    const Outcome refused = folder.tactus("replay " + take.string());
    CHECK(refused.code == 2);
    CHECK(refused.err.find("it has format 1, and this tactus reads formats 2 and 3") != std::string::npos);
    CHECK(std::count(refused.err.begin(), refused.err.end(), '\n') == 1);
}

TEST_CASE("a replayed take writes the files that its run wrote, to the byte") {
    const Folder folder;
    const fs::path take = render(folder), again = folder.path / "again";
    const Outcome replay = folder.tactus("replay " + take.string() + " --out " + again.string());
    INFO(replay.err);
    REQUIRE(replay.code == 0);
    for (const char* file : {"ear.wav", "trace.csv"}) {
        INFO(file);
        CHECK(slurp(again / file).size() > 1000);
        CHECK(slurp(again / file) == slurp(folder.path / "out" / file));
    }
    CHECK(json::parse(slurp(again / "summary.json"))["output_hash"] ==
          json::parse(slurp(folder.path / "out/summary.json"))["output_hash"]);
}

TEST_CASE("the take of a run that was killed writes the results that the run did not", "[slow]") {
    const Folder folder;
    folder.write("touch.toml", heard);
    const fs::path take = folder.path / "take", out = folder.path / "out";
    {
        Run run(folder, (folder.path / "touch.toml").string() + " --audio file --record " + take.string() + " --out " +
                            out.string());
        REQUIRE(wait_for([&] {
            std::error_code ignored;
            const auto size = fs::file_size(take / "timing.log", ignored);
            return !ignored && size > 150'000;
        }));
        run.stop(SIGKILL);
    }
    REQUIRE_FALSE(fs::exists(out / "summary.json"));
    const Outcome replay = folder.tactus("replay " + take.string() + " --overwrite --out " + out.string() + " --json");
    INFO(replay.err);
    REQUIRE(replay.code == 0);
    const double covered = json::parse(replay.out)["seconds"];
    CHECK(covered > 0.1);
    // A float each, and a row each.
    CHECK(static_cast<double>(fs::file_size(out / "ear.wav")) >= 4.0 * 48000.0 * covered);
    const json summary = json::parse(slurp(out / "summary.json"));
    const json& groups = summary["groups"];
    const auto hand = std::ranges::find_if(groups, [](const json& group) { return group["rate_hz"] == 1000.0; });
    REQUIRE(hand != groups.end());
    // A busy machine makes ticks of a hand late, and they are left out.
    const double ran = 1000.0 * covered - (*hand)["skipped"].get<double>();
    const std::string trace = slurp(out / "trace.csv");
    CHECK(static_cast<double>(std::count(trace.begin(), trace.end(), '\n')) >= ran);
    CHECK(summary["seconds"] == covered);
    CHECK(std::ranges::count(summary["files"], "ear.wav") == 1);
}
