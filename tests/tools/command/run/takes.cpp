// SPDX-License-Identifier: Apache-2.0
// Takes, replay, and changes to a patch that runs, as scripts use them.
#include "tests/support/catch.hpp"
#include "tests/tools/background_run.hpp"
#include "tests/tools/patches.hpp"

#include <fmt/format.h>
#include <sndfile.h>
#include <nlohmann/json.hpp>

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

namespace fs = std::filesystem;
using namespace tactus::test;
using nlohmann::json;

namespace {

/// Of an output in the file of its group, −1: it is not there.
int first_channel(const fs::path& take, const std::string& group, const std::string& port) {
    std::ifstream events(take / "events.jsonl");
    for (std::string line; std::getline(events, line);) {
        const json event = json::parse(line);
        if (!event.contains("stream") || event["group"] != group) continue;
        int channel = 0;
        for (const json& output : event["outputs"]) {
            if (output["port"] == port) return channel;
            channel += static_cast<int>(output["channels"].size());
        }
    }
    return -1;
}

/// A touch whose force and sound are written to files.
std::string recorded_touch() {
    std::string patch = touch;
    const std::string wire = "  \"ball.wrench -> out.wrench\",\n";
    patch.insert(patch.find(wire) + wire.size(), "  \"ball.wrench -> force.in\",\n  \"loud.out -> sound.in\",\n");
    return patch +
           "[nodes.force]\ntype = \"record\"\nrate = \"1 kHz\"\n[nodes.sound]\ntype = \"record\"\nrate = \"48 kHz\"\n";
}

void flip_byte(const fs::path& path, std::int64_t from_end) {
    std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
    file.seekg(-from_end, std::ios::end);
    const char byte = static_cast<char>(file.peek() ^ 0x10);
    file.seekp(-from_end, std::ios::end);
    file.put(byte);
}

/// As a run that nobody recorded before its end.
void drop_values(const fs::path& take) {
    std::ifstream events(take / "events.jsonl");
    std::string kept;
    std::int64_t lines = 0;
    for (std::string line; std::getline(events, line);)
        if (!json::parse(line).contains("stream")) kept += line + "\n", ++lines;
    std::ofstream(take / "events.jsonl") << kept;
    json result = json::parse(slurp(take / "result.json"));
    for (const auto& file : fs::directory_iterator(take / "streams")) {
        result["holds"].erase("streams/" + file.path().filename().string());
        fs::remove(file);
    }
    result["holds"]["events.jsonl"] = lines;
    std::ofstream(take / "result.json") << result.dump();
}

}  // namespace

TEST_CASE("a rendered take is repeated to the bit, and one whose values were changed is not") {
    Folder folder;
    folder.write("touch.toml", touch);
    const std::string take = (folder.path / "take").string();
    REQUIRE(folder
                .tactus("render " + (folder.path / "touch.toml").string() + " --seconds 0.5 --out " +
                        (folder.path / "out").string() + " --record " + take)
                .code == 0);
    const Outcome same = folder.tactus("replay " + take + " --json");
    REQUIRE(same.code == 0);
    const json report = json::parse(same.out);
    CHECK(report["identical"] == true);
    CHECK(report["first_difference"].is_null());
    CHECK(report["compared_values"] > 48000);

    SF_INFO info{};
    const std::string file = take + "/streams/1-kHz.wav";
    SNDFILE* stream = sf_open(file.c_str(), SFM_READ, &info);
    REQUIRE(stream);
    sf_close(stream);
    const int pose = first_channel(take, "1 kHz", "hand.pose");
    REQUIRE(pose >= 0);
    CHECK(info.channels >= pose + 7);
    CHECK(info.samplerate == 1000);
    CHECK(info.frames == 500);
    CHECK((info.format & SF_FORMAT_SUBMASK) == SF_FORMAT_DOUBLE);

    // Of 500 frames those from 400 on.
    flip_byte(file, 8 * (std::int64_t{100} * info.channels - pose) - 2);
    const Outcome changed = folder.tactus("replay " + take + " --json");
    CHECK(changed.code == 1);
    const json difference = json::parse(changed.out)["first_difference"];
    CHECK(difference["port"] == "hand.pose");
    CHECK(difference["tick"] == 400);
    CHECK(difference["expected"] != difference["got"]);
    const Outcome told = folder.tactus("replay " + take);
    CHECK(told.code == 1);
    CHECK(told.out.find("differs: hand.pose at tick 400") != std::string::npos);
}

TEST_CASE("a take without values is repeated to the hash of each output, and replay writes it again with all values") {
    Folder folder;
    folder.write("touch.toml", touch);
    const std::string take = (folder.path / "take").string(), whole = (folder.path / "whole").string();
    const std::string run = "render " + (folder.path / "touch.toml").string() + " --seconds 0.5 --out " +
                            (folder.path / "out").string() + " --record ";
    REQUIRE(folder.tactus(run + take).code == 0);
    drop_values(take);
    REQUIRE(folder.tactus(run + whole + " --overwrite").code == 0);
    CHECK(fs::is_empty(fs::path(take) / "streams"));
    const Outcome same = folder.tactus("replay " + take);
    CHECK(same.code == 0);
    CHECK(same.out.starts_with("identical: the hash of "));
    CHECK(same.out.find("the take has no values") != std::string::npos);

    const std::string again = (folder.path / "again").string();
    REQUIRE(folder.tactus("replay " + take + " --record " + again).code == 0);
    CHECK(slurp(fs::path(again) / "timing.log") == slurp(fs::path(take) / "timing.log"));
    const Outcome filled = folder.tactus("replay " + again);
    CHECK(filled.code == 0);
    CHECK(filled.out.starts_with("identical: "));
    // As many values as a take has that recorded them.
    CHECK(filled.out == folder.tactus("replay " + whole).out);

    // A replay that differs from the run is no source of its values.
    json result = json::parse(slurp(fs::path(take) / "result.json"));
    result["ports"]["hand.pose"] = "0000000000000000";
    std::ofstream(fs::path(take) / "result.json") << result.dump();
    const Outcome other = folder.tactus("replay " + take + " --record " + (folder.path / "other").string());
    CHECK(other.code == 1);
    CHECK(other.err.find("is not written, because the replay differs") != std::string::npos);
    CHECK_FALSE(fs::exists(folder.path / "other"));
}

TEST_CASE("a long take holds the first 30 MB of its values, and says where they end", "[slow]") {
    Folder folder;
    // 512 channels at 1 kHz.
    std::string patch;
    for (int n = 0; n < 512; ++n) patch += fmt::format("[nodes.n{}]\ntype = \"constant\"\nrate = \"1 kHz\"\n", n);
    folder.write("many.toml", patch);
    const std::string take = (folder.path / "take").string(), all = (folder.path / "all").string();
    const std::string run = "render " + (folder.path / "many.toml").string() + " --seconds 8 --overwrite --out " +
                            (folder.path / "out").string() + " --record ";
    const Outcome made = folder.tactus(run + take);
    REQUIRE(made.code == 0);
    CHECK(made.out.find("the take holds values up to 7.324 s, 30 MB") != std::string::npos);
    const Outcome same = folder.tactus("replay " + take);
    CHECK(same.code == 0);
    CHECK(same.out.find("; values up to 7.324 s, then the hash of each output") != std::string::npos);
    const Outcome whole = folder.tactus(run + all + " --values");
    REQUIRE(whole.code == 0);
    CHECK(whole.out.find("the take holds values") == std::string::npos);
    const auto size = [](const std::string& of) { return fs::file_size(fs::path(of) / "streams" / "1-kHz.wav"); };
    CHECK(size(take) < 30'100'000);
    CHECK(size(all) > 32'000'000);
    const std::string again = (folder.path / "again").string();
    REQUIRE(folder.tactus("replay " + take + " --record " + again).code == 0);
    CHECK(size(again) == size(all));
    CHECK(folder.tactus("replay " + again).out == folder.tactus("replay " + all).out);
}

TEST_CASE("a run that is refused leaves no take behind, and the next try may use its folder") {
    Folder folder;
    const std::string patch = folder.write("touch.toml", touch).string(), take = (folder.path / "take").string();
    const std::string rest = " --seconds 0.1 --record " + take + " --out " + (folder.path / "out").string();
    for (const std::string verb : {"render ", "run --audio file "}) {
        INFO(verb);
        // Found when the nodes are prepared, after the take was begun.
        const Outcome refused = folder.tactus(verb + patch + rest + " --set out.device=nobody");
        REQUIRE(refused.code == 2);
        CHECK_FALSE(fs::exists(take));
        // What the user keeps there stays.
        fs::create_directory(take);
        folder.write("take/notes.txt", "mine");
        CHECK(folder.tactus(verb + patch + rest + " --set out.device=nobody").code == 2);
        CHECK(std::distance(fs::directory_iterator(take), fs::directory_iterator()) == 1);
        const Outcome next = folder.tactus(verb + patch + rest + " --overwrite");
        INFO(next.err);
        CHECK(next.code == 0);
        CHECK(folder.tactus("replay " + take).code == 0);
        fs::remove_all(take);
    }
}

TEST_CASE("what cannot be replayed says so before it runs", "[slow]") {
    Folder folder;
    folder.write("touch.toml", touch + "[assets]\nsound = \"sound.bin\"\n");
    folder.write("sound.bin", "0123456789");
    const std::string take = (folder.path / "take").string();
    const std::string render = "render " + (folder.path / "touch.toml").string() + " --seconds 0.1 --out " +
                               (folder.path / "out").string() + " --record " + take;
    REQUIRE(folder.tactus(render).code == 0);
    const Outcome again = folder.tactus(render + " --overwrite");
    CHECK(again.code == 2);
    CHECK(again.err.find("there is a take already") != std::string::npos);

    folder.write("sound.bin", "0123456788");
    const Outcome changed = folder.tactus("replay " + take);
    CHECK(changed.code == 2);
    CHECK(changed.err.find("asset 'sound' has changed since") != std::string::npos);
    CHECK(folder.tactus("replay " + take + " --anyway").code == 0);
    folder.write("sound.bin", "0123456789");

    json about = json::parse(slurp(take + "/take.json"));
    about["build"] = "0000000000000000";
    about["cpu"] = "another";
    std::ofstream(take + "/take.json") << about.dump();
    const Outcome foreign = folder.tactus("replay " + take);
    CHECK(foreign.code == 0);
    CHECK(foreign.err.find("made by another build") != std::string::npos);
    CHECK(foreign.err.find("another kind of processor") != std::string::npos);

    CHECK(folder.tactus("replay " + (folder.path / "nothing").string()).code == 2);
    std::ofstream(take + "/take.json") << "{";
    const Outcome damaged = folder.tactus("replay " + take);
    CHECK(damaged.code == 2);
    CHECK(damaged.err.find("take.json") != std::string::npos);
}

TEST_CASE("a run that is killed leaves a take that is repeated as far as it goes", "[slow]") {
    Folder folder;
    folder.write("touch.toml", touch);
    const fs::path take = folder.path / "take";
    {
        Run run(folder, (folder.path / "touch.toml").string() + " --record " + take.string() + " --out " +
                            (folder.path / "out").string());
        REQUIRE(wait_for([&] {
            std::error_code ignored;
            const auto size = fs::file_size(take / "timing.log", ignored);
            return !ignored && size > 150'000;  // a second of device samples
        }));
        run.stop(SIGKILL);
    }
    const Outcome replay = folder.tactus("replay " + take.string() + " --json");
    INFO(replay.err);
    REQUIRE(replay.code == 0);
    const json report = json::parse(replay.out);
    CHECK(report["identical"] == false);
    CHECK(report["cut_off"] == true);
    CHECK(report["whole"] == false);
    CHECK(report["compared_values"] > 1000);
    CHECK(report["seconds"] > 0.1);
    const Outcome told = folder.tactus("replay " + take.string());
    CHECK(told.code == 0);
    CHECK(told.out.starts_with("cut off; "));
    CHECK(told.out.find("values compared, equal so far") != std::string::npos);
    CHECK(told.out.find("identical") == std::string::npos);
}

TEST_CASE("the results of a killed run are written by replay, as far as the take reaches", "[slow]") {
    Folder folder;
    const std::string patch = folder.write("recorded.toml", recorded_touch()).string();
    const fs::path take = folder.path / "take", back = folder.path / "back";
    const std::string all = "render " + patch + " --seconds 0.2 --out " + (folder.path / "all").string();
    REQUIRE(folder.tactus(all).code == 0);
    {
        Run run(folder,
                patch + " --seconds 3000 --out " + (folder.path / "out").string() + " --record " + take.string(),
                "render");
        REQUIRE(wait_for([&] {
            // A log is readable up to the progress records that follow each batch; a batch has at most 300 kB.
            std::error_code ignored;
            const auto log = fs::file_size(take / "timing.log", ignored);
            const auto values = ignored ? 0 : fs::file_size(take / "streams" / "1-kHz.wav", ignored);
            return !ignored && log > 400'000 && values > 1'000'000;
        }));
        run.stop(SIGKILL);
    }
    CHECK_FALSE(fs::exists(folder.path / "out" / "force.csv"));
    CHECK_FALSE(fs::exists(folder.path / "out" / "summary.json"));
    const Outcome replay = folder.tactus("replay " + take.string() + " --out " + back.string());
    INFO(replay.out << replay.err);
    REQUIRE(replay.code == 0);
    const json summary = json::parse(slurp(back / "summary.json"));
    const double reached = summary["cut_off"]["reaches_s"];
    CHECK(reached > 0.2);
    CHECK(reached < 3000.0);
    CHECK(summary["cut_off"]["asked_s"] == 3000.0);
    CHECK(replay.out.find("reach " + fmt::format("{:.3f} s of 3000 s", reached)) != std::string::npos);
    // The same as a run that nobody killed, and as long as is said.
    const std::string whole = slurp(folder.path / "all" / "force.csv"), part = slurp(back / "force.csv");
    REQUIRE(whole.size() > 1000);
    CHECK(part.starts_with(whole));
    CHECK(static_cast<double>(std::count(part.begin(), part.end(), '\n') - 1) == Approx(1000.0 * reached).margin(1.5));
    CHECK(fs::file_size(back / "sound.wav") > fs::file_size(folder.path / "all" / "sound.wav"));
    // Without a folder the way to them is said.
    CHECK(folder.tactus("replay " + take.string()).out.find("--out FOLDER") != std::string::npos);
}

TEST_CASE("a patch is edited and its parameters are set while it runs, and the take repeats it all", "[slow]") {
    Folder folder;
    const fs::path patch = folder.write("touch.toml", touch), take = folder.path / "take";
    Run run(folder, patch.string() + " --record " + take.string() + " --out " + (folder.path / "out").string());
    REQUIRE(wait_for([&] { return fs::exists(folder.path / "tactus") && !fs::is_empty(folder.path / "tactus"); }));
    ::setenv("XDG_RUNTIME_DIR", folder.path.c_str(), 1);
    const auto err = [&] { return slurp(folder.path / "run.err"); };

    const Outcome set = folder.tactus("set 'ball.stiffness=0.3 N/mm'");
    INFO(set.err);
    CHECK(set.code == 0);
    const Outcome wrong = folder.tactus("set 'ball.stifness=0.3 N/mm'");
    CHECK(wrong.code == 2);
    CHECK(wrong.err.find("did you mean 'stiffness'") != std::string::npos);
    CHECK(folder.tactus("set 'loud.factor=2'").err.find("driven by a wire") != std::string::npos);

    // Written beside and renamed, as editors do.
    std::string more = touch;
    more.replace(more.find("wires = [\n"), 10, "wires = [\n  \"tone.signal -> ear.in\",\n");
    fs::rename(folder.write("touch.new", more + "[nodes.ear]\ntype = \"probe\"\nrate = \"48 kHz\"\n"), patch);
    REQUIRE(wait_for([&] { return err().find("edit 1 takes effect") != std::string::npos; }));
    folder.write("touch.toml", touch + "oops");
    REQUIRE(wait_for([&] { return err().find("the edit was not made") != std::string::npos; }));
    folder.write("touch.toml", touch);
    REQUIRE(wait_for([&] { return err().find("edit 2 takes effect") != std::string::npos; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    INFO(err());
    CHECK(run.stop(SIGINT) == 0);

    const Outcome replay = folder.tactus("replay " + take.string() + " --json");
    INFO(replay.out << replay.err);
    REQUIRE(replay.code == 0);
    CHECK(json::parse(replay.out)["edits"] == 2);
    // Without --seconds it would have gone on for years.
    CHECK(json::parse(slurp(take / "take.json"))["seconds"] > 1e9);
    CHECK(folder.tactus("set 'ball.stiffness=0.3 N/mm'").err.find("no patch runs") != std::string::npos);
    ::unsetenv("XDG_RUNTIME_DIR");
}

TEST_CASE("a patch within is edited by its own file, set by what it offers, and kept in the take", "[slow]") {
    Folder folder;
    const std::string within = R"([outputs]
signal = "tone.signal"
[parameters]
pitch = "tone.frequency"
[nodes.tone]
type = "sine"
rate = "outer"
)";
    const fs::path patch = folder.write("outer.toml", R"(wires = [ "voice.signal -> loud.in" ]
[nodes.voice]
type = "patch:voice.toml"
rate = "48 kHz"
pitch = "300 Hz"
[nodes.loud]
type = "gain"
rate = "48 kHz"
)");
    const fs::path part = folder.write("voice.toml", within), take = folder.path / "take";
    Run run(folder, patch.string() + " --record " + take.string() + " --out " + (folder.path / "out").string());
    REQUIRE(wait_for([&] { return fs::exists(folder.path / "tactus") && !fs::is_empty(folder.path / "tactus"); }));
    ::setenv("XDG_RUNTIME_DIR", folder.path.c_str(), 1);
    const Outcome set = folder.tactus("set 'voice.pitch=440 Hz'");
    INFO(set.err);
    CHECK(set.code == 0);
    folder.write("voice.toml", within + "amplitude = 0.25\n");
    const auto err = [&] { return slurp(folder.path / "run.err"); };
    REQUIRE(wait_for([&] { return err().find("edit 1 takes effect") != std::string::npos; }));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    INFO(err());
    CHECK(run.stop(SIGINT) == 0);
    ::unsetenv("XDG_RUNTIME_DIR");

    fs::remove(part);
    CHECK(folder.tactus("check " + patch.string()).err.find("there is no patch") != std::string::npos);
    const Outcome replay = folder.tactus("replay " + take.string() + " --json");
    INFO(replay.out << replay.err);
    REQUIRE(replay.code == 0);
    CHECK(json::parse(replay.out)["edits"] == 1);
    CHECK(json::parse(replay.out)["identical"] == true);
}
