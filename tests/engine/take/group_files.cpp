// SPDX-License-Identifier: Apache-2.0
// A take keeps the outputs of a group in one file.
#include "tests/engine/chaos.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>
#include <malloc.h>
#include <sndfile.h>
#include <sys/resource.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>

namespace fs = std::filesystem;
using namespace tactus;
using namespace tactus::test;
using Json = nlohmann::ordered_json;

namespace {

/// Renders 0.2 s into a take; each text after the first takes over a while after the one before.
run::Engine::PortHashes rendered(const fs::path& folder, const std::vector<std::string>& texts,
                                 std::uint64_t max_bytes = 0) {
    take::TakeWriter take(folder, {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 0.2, .live = false});
    take.limit_values(max_bytes);
    run::EngineOptions options;
    options.seconds = 0.2;
    options.take = &take;
    run::Engine engine(compile_text(texts.front()), options);
    for (std::size_t i = 1; i < texts.size(); ++i) {
        const Flicks when = static_cast<Flicks>(i) * flicks_per_second / 20;
        const compile::Schedule plan = compile_text(texts[i]);
        take.edit(static_cast<std::int64_t>(i), when, plan.patch, take::TakeWriter::describe_assets(plan.patch));
        engine.schedule(compile_text(texts[i]), when);
    }
    engine.render(2);
    engine.finish();
    return engine.port_hashes();
}

std::string constants(int count, const std::string& more = "") {
    std::string text;
    for (int i = 0; i < count; ++i) text += fmt::format("[nodes.n{}]\ntype = \"chaos\"\nrate = \"1 kHz\"\n", i);
    return "seed = 7\n" + text + more;
}

std::set<std::string> files_of(const take::Take& take) {
    std::set<std::string> files;
    for (const take::TakeStreamInfo& info : take.streams) files.insert(info.file);
    return files;
}

/// The same take as format 2 has it: a file for each output.
void make_older(const fs::path& folder) {
    const take::Take take = take::Take::load(folder);
    const auto sizes = [](const take::TakeStreamInfo& info) { return static_cast<std::size_t>(info.channels); };
    std::map<std::string, std::int64_t> holds;
    std::vector<std::string> lines;
    std::ifstream events(folder / "events.jsonl");
    for (std::string line; std::getline(events, line);)
        if (!Json::parse(line).contains("stream")) lines.push_back(line);
    for (const take::TakeStreamInfo& info : take.streams) {
        const std::string file = fmt::format("streams/{}.wav", info.port);
        take::TakeStreamReader reader(folder / info.file, info);
        SF_INFO format{};
        format.channels = info.channels;
        format.samplerate = 1000;
        format.format = SF_FORMAT_RF64 | SF_FORMAT_DOUBLE;
        SNDFILE* out = sf_open((folder / file).c_str(), SFM_WRITE, &format);
        REQUIRE(out);
        for (std::int64_t tick = info.start; const double* frame = reader.frame(tick); ++tick)
            REQUIRE(sf_writef_double(out, frame, 1) == 1);
        sf_close(out);
        holds[file] = reader.frames();
        lines.push_back(Json{{"stream", file},
                             {"port", info.port},
                             {"group", info.group},
                             {"group_number", info.group_number},
                             {"type", info.type},
                             {"period_flicks", info.period},
                             {"rate_hz", rate_of(info.period)},
                             {"start", info.start},
                             {"channels", std::vector<std::string>(sizes(info), "value")}}
                            .dump());
    }
    for (const std::string& file : files_of(take)) fs::remove(folder / file);
    std::ofstream written(folder / "events.jsonl");
    for (const std::string& line : lines) written << line << "\n";
    Json about = Json::parse(std::ifstream(folder / "take.json"));
    about["format"] = 2;
    std::ofstream(folder / "take.json") << about.dump();
    Json result = Json::parse(std::ifstream(folder / "result.json"));
    holds["timing.log"] = result["holds"]["timing.log"];
    holds["events.jsonl"] = static_cast<std::int64_t>(lines.size());
    result["holds"] = holds;
    std::ofstream(folder / "result.json") << result.dump();
}

}  // namespace

TEST_CASE("a take has one file for each group, and a new one where an edit changes its outputs") {
    const auto folder = scratch("files");
    const std::string more = "[nodes.slow]\ntype = \"chaos\"\nrate = \"60 Hz\"\n";
    // The second edit changes a parameter only.
    rendered(folder, {constants(3, more), constants(4, more), constants(4, more + "gain = 0.5\n")});
    const take::Take take = take::Take::load(folder);
    CHECK(files_of(take) == std::set<std::string>{"streams/1-kHz.wav", "streams/1-kHz-2.wav", "streams/60-Hz.wav"});
    CHECK(take.damages().empty());
    std::int64_t values = 0;
    for (const take::TakeStreamInfo& info : take.streams) {
        CHECK(info.start == (info.file == "streams/1-kHz-2.wav" ? 50 : 0));
        values += take::TakeStreamReader(folder / info.file, info).frames();
    }
    CHECK(values == 2 * (3 * 50 + 4 * 150 + 12));
    fs::remove_all(folder);
}

TEST_CASE("values end where all files have the bytes that they may have, and the take repeats the rest to its hash") {
    const auto folder = scratch("limit");
    const std::string more = "[nodes.slow]\ntype = \"chaos\"\nrate = \"60 Hz\"\n";
    // Eight channels of 8 bytes for each of three nodes at 1 kHz and one at 60 Hz: 195.84 kB/s.
    const auto hashes = rendered(folder, {constants(3, more)}, 19'584);
    const take::Take take = take::Take::load(folder);
    REQUIRE(take.values_end_s);
    CHECK(*take.values_end_s == Approx(0.1));
    CHECK(take.is_complete);
    CHECK(take.damages().empty());
    for (const take::TakeStreamInfo& info : take.streams)
        CHECK(take::TakeStreamReader(folder / info.file, info).frames() == (info.group == "60 Hz" ? 6 : 100));
    const Repetition again = repeat(folder, 2);
    CHECK_FALSE(again.difference);
    CHECK(again.compared == 2 * (3 * 100 + 6));
    CHECK(again.hashes == hashes);
    CHECK_THROWS_AS(take.require_values(), Error);
    fs::remove_all(folder);

    // Edits at 0.05 s and 0.1 s, of 192, 384 and 576 kB/s: 9.6 kB, 19.2 kB, and 28.8 kB up to 0.15 s.
    rendered(folder, {constants(3), constants(6), constants(9)}, 57'600);
    const take::Take edited = take::Take::load(folder);
    REQUIRE(edited.values_end_s);
    CHECK(*edited.values_end_s == Approx(0.15));
    std::map<std::string, std::int64_t> frames;
    for (const take::TakeStreamInfo& info : edited.streams)
        frames[info.file] = take::TakeStreamReader(folder / info.file, info).frames();
    CHECK(frames == std::map<std::string, std::int64_t>{
                        {"streams/1-kHz.wav", 50}, {"streams/1-kHz-2.wav", 50}, {"streams/1-kHz-3.wav", 50}});
    CHECK_FALSE(repeat(folder, 1).difference);
    fs::remove_all(folder);

    // Of two outputs the one that ends first: 84.5 frames at 1 kHz, 5.07 at 60 Hz.
    rendered(folder, {constants(3, more)}, 16'548);
    CHECK(take::Take::load(folder).values_end_s == Approx(5.0 / 60.0));
    fs::remove_all(folder);

    rendered(folder, {constants(3)}, 1'000'000);
    CHECK_FALSE(take::Take::load(folder).values_end_s);
    CHECK_NOTHROW(take::Take::load(folder).require_values());
    fs::remove_all(folder);
}

TEST_CASE("outputs of more channels than a file has go to several, none of them divided") {
    const auto folder = scratch("wide");
    rendered(folder, {constants(150)});
    const take::Take take = take::Take::load(folder);
    // A pose of seven channels and a number for each of 150 nodes.
    CHECK(take.streams.size() == 300);
    CHECK(files_of(take) == std::set<std::string>{"streams/1-kHz.wav", "streams/1-kHz-2.wav"});
    for (const take::TakeStreamInfo& info : take.streams) CHECK(info.channel + info.channels <= 1024);
    const Repetition again = repeat(folder, 1);
    CHECK_FALSE(again.difference);
    CHECK(again.compared == 300 * 200);
    fs::remove_all(folder);
}

TEST_CASE("a file of a thousand channels can be read, whatever the names of its outputs") {
    const auto folder = scratch("names");
    std::string text = "seed = 7\n";
    for (int i = 0; i < 1000; ++i)
        text +=
            fmt::format("[nodes.a-constant-with-a-rather-long-name-{}]\ntype = \"constant\"\nrate = \"1 kHz\"\n", i);
    rendered(folder, {text});
    const take::Take take = take::Take::load(folder);
    CHECK(files_of(take).size() == 1);
    CHECK(take.damages().empty());
    CHECK(repeat(folder, 1).compared == 1000 * 200);
    fs::remove_all(folder);
}

TEST_CASE("recording a thousand trivial nodes at 48 kHz takes less than 300 MB of memory") {
    const auto folder = scratch("memory");
    std::string text;
    for (int i = 0; i < 1000; ++i) text += fmt::format("[nodes.n{}]\ntype = \"sine\"\nrate = \"48 kHz\"\n", i);
    take::TakeWriter take(folder,
                          {.patch_file = "p.toml", .overrides = {}, .seed = {}, .seconds = 0.01, .live = false});
    const auto allocated = [] { return mallinfo2().uordblks + mallinfo2().hblkhd; };
    const std::size_t before = allocated();
    run::EngineOptions options;
    options.seconds = 0.01;
    options.take = &take;
    run::Engine engine(compile_text(text), options);
    engine.render(1);
    CHECK(allocated() - before < 300'000'000);
    engine.finish();
    fs::remove_all(folder);
}

TEST_CASE("300 outputs are recorded where a process may open 64 files") {
    rlimit before{};
    REQUIRE(getrlimit(RLIMIT_NOFILE, &before) == 0);
    const rlimit few{64, before.rlim_max};
    REQUIRE(setrlimit(RLIMIT_NOFILE, &few) == 0);
    const auto folder = scratch("few");
    std::string said;
    try {
        rendered(folder, {constants(150)});
    } catch (const Error& error) {
        said = error.message();
    }
    setrlimit(RLIMIT_NOFILE, &before);
    CHECK(said == "");
    CHECK(take::Take::load(folder).is_complete);
    fs::remove_all(folder);
}

TEST_CASE("a take of the format before, with a file for each output, is repeated and compared") {
    const auto folder = scratch("older");
    const auto hashes = rendered(folder, {constants(3, "[nodes.slow]\ntype = \"chaos\"\nrate = \"60 Hz\"\n")});
    make_older(folder);
    CHECK(files_of(take::Take::load(folder)).size() == 8);
    CHECK(take::Take::load(folder).damages().empty());
    const Repetition again = repeat(folder, 1);
    CHECK_FALSE(again.difference);
    CHECK(again.compared == 2 * (3 * 200 + 12));
    CHECK(again.hashes == hashes);
    fs::remove_all(folder);
}
