// SPDX-License-Identifier: Apache-2.0
// validate, and compare and exposure over folders, as scripts call them.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/run_command.hpp"

#include <sndfile.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;
namespace fs = std::filesystem;

namespace {

/// A saw of four orders, `tilt` per order.
void saw(const fs::path& path, double hz, double tilt = 0.6, double seconds = 2.0, double level = 0.3) {
    SF_INFO info{};
    info.samplerate = 48000;
    info.channels = 1;
    info.format = path.extension() == ".flac" ? SF_FORMAT_FLAC | SF_FORMAT_PCM_24 : SF_FORMAT_WAV | SF_FORMAT_FLOAT;
    fs::create_directories(path.parent_path());
    SNDFILE* file = sf_open(path.c_str(), SFM_WRITE, &info);
    REQUIRE(file != nullptr);
    std::vector<float> samples;
    std::uint64_t state = 7;
    for (int i = 0; i < static_cast<int>(seconds * 48000.0); ++i) {
        state = state * 6364136223846793005ULL + 1442695040888963407ULL;
        double y = 0.03 * (static_cast<double>(state >> 11) * 0x1.0p-53 - 0.5), amplitude = 1.0;
        for (int k = 1; k <= 4; ++k, amplitude *= tilt)
            y += amplitude * std::sin(2.0 * std::numbers::pi * k * hz * i / 48000.0 + k * k);
        samples.push_back(static_cast<float>(level * y));
    }
    sf_writef_float(file, samples.data(), static_cast<sf_count_t>(samples.size()));
    sf_close(file);
}

std::size_t lines_of(const std::string& text) {
    return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

std::string validated_set() { return (tactus::test::library_folder() / "saw/reciprocating.toml").string(); }

/// What full scale of the bundled recordings is worth.
std::string scale() {
    const std::string set = slurp(validated_set());
    const std::size_t at = set.find("full_scale = \"") + 14;
    return set.substr(at, set.find('"', at) - at);
}

/// Two of the bundled recordings.
std::string few(const Folder& folder) {
    const std::string saws = (tactus::test::library_folder() / "saw/").string();
    return folder
        .write("few.toml",
               "synthesised = true\nfull_scale = \"" + scale() + "\"\n[[recording]]\nfile = \"" + saws +
                   "free_air_233.flac\"\nstate = \"free_air\"\nrate = \"233 Hz\"\n[[recording]]\nfile = \"" + saws +
                   "cutting_150_12N.flac\"\nstate = \"cutting\"\nrate = \"150 Hz\"\nload = \"12 N\"\n")
        .string();
}

}  // namespace

TEST_CASE("validate: with its equaliser the bundled handle has the vibration of its recordings at both levels",
          "[slow]") {
    const Folder folder;
    const std::string page = (folder.path / "page.html").string(), table = (folder.path / "t.csv").string();
    const Outcome outcome =
        folder.tactus("validate saw-vibration --reference " + few(folder) +
                      " --json --from '1500 ms' --to '3.5 s' --report " + page + " --table " + table);
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json answer = json::parse(outcome.out);
    CHECK(answer["verdict"] == "pass");
    CHECK(answer["out"] == "handle:sum.out");
    CHECK(tactus::test::broken_schema(folder, "validate", answer) == "");
    CHECK(answer["stretch_of_run"] == json{{"from_s", 1.5}, {"to_s", 3.5}});
    CHECK(answer["synthesised"] == true);
    REQUIRE(answer["runs"].size() == 4);
    int free_air = 0;
    double loudest = 0.0;
    for (const json& run : answer["runs"]) {
        CAPTURE(run["state"], run["rate_hz"], run["load_N"], run["level_db"]);
        free_air += run["state"] == "free_air";
        CHECK(run["verdict"] == "pass");
        CHECK(run["lsd_db"] < 1.0);
        CHECK(run["cosine_40_500"] > 0.999);
        CHECK(run["harmonic_error_db"] < 0.5);
        CHECK(run["third_octave_max_db"] < 2.0);
        CHECK(run["drive_peak_v"] < 3.0);
        loudest = std::max(loudest, run["drive_rms_v"].get<double>());
        // 6 dB softer on the way in is 6 dB softer on the handle.
        if (run["level_db"] == -6.0)
            for (const json& other : answer["runs"])
                if (other["file"] == run["file"] && other["level_db"] == 0.0)
                    CHECK(run["gain_db"].get<double>() == Approx(other["gain_db"].get<double>() + 6.0).margin(0.05));
    }
    CHECK(free_air == 2);
    CHECK(loudest > 0.2);
    CHECK(lines_of(slurp(table)) == 5);
    const std::string html = slurp(page);
    for (const char* needed :
         {"<svg", "limit of touch", "cutting, 150 Hz, 12 N", "How the runs were made", "Methods"}) {
        INFO(needed);
        CHECK(html.find(needed) != std::string::npos);
    }
    // Pictures are in the page itself.
    for (std::size_t at = html.find("href="); at != std::string::npos; at = html.find("href=", at + 1))
        CHECK(html.substr(at, 11) == "href=\"data:");
}

TEST_CASE("validate: a second of a saw that is never steady is compared with the second that was played") {
    const char* const data = std::getenv("TACTUS_SHARED_DATA");
    if (!data) {
        tactus::test::skip("needs recordings in TACTUS_SHARED_DATA");
        return;
    }
    const Folder folder;
    const Outcome outcome =
        folder.tactus(std::string("validate saw-vibration --json --level 0 --seconds 1 --reference ") + data +
                      "/recordings/chainsaw_cutting_tree_169127b.flac");
    INFO(outcome.err);
    REQUIRE(outcome.code == 0);
    const json run = json::parse(outcome.out)["runs"][0];
    CHECK(run["lsd_db"] < 0.5);
    CHECK(run["drive_rms_v"] > 0.1);
}

TEST_CASE("validate: without its equaliser the handle fails, and one line per run says by what") {
    const Folder folder;
    const Outcome outcome = folder.tactus("validate saw-vibration --reference " + few(folder) +
                                          " --seconds 1 --level 0 --set equaliser.amount=0");
    CHECK(outcome.code == 1);
    CHECK(outcome.out.find("FAIL: 0 of 2") != std::string::npos);
    CHECK(outcome.out.find("lsd_db") != std::string::npos);
}

TEST_CASE("validate: recordings of one's own, uncalibrated, through a patch with a hand, a bone and no equaliser",
          "[slow]") {
    const Folder folder;
    saw(folder.path / "cut.flac", 200.0, 0.8);
    saw(folder.path / "idle.flac", 200.0, 0.5);
    const std::string set = folder
                                .write("set.toml",
                                       "[[recording]]\nfile = \"idle.flac\"\nstate = \"free_air\"\nrate = \"200 Hz\"\n"
                                       "[[recording]]\nfile = \"cut.flac\"\nstate = \"cutting\"\nrate = \"200 Hz\"\n"
                                       "load = \"5 N\"\n")
                                .string();
    // The actuator of 'saw-training' is not equalised: above its resonance it is flat enough for four orders.
    const Outcome outcome = folder.tactus("validate saw-training --json --level 20,10 --reference " + set);
    INFO(outcome.err);
    REQUIRE((outcome.code == 0 || outcome.code == 1));
    const json answer = json::parse(outcome.out);
    CHECK(answer["calibrated"] == false);
    CHECK(answer["out"] == "actuator.signal");
    REQUIRE(answer["runs"].size() == 4);
    for (const json& run : answer["runs"])
        CHECK(run["fundamental_hz"]["output"].get<double>() == Approx(200.0).margin(0.1));
    // Each is the vibration of its own recording, not of the other.
    CHECK(answer["runs"][0]["in_both"].size() >= 3);
}

TEST_CASE("validate says what is missing") {
    const Folder folder;
    const auto refused = [&](const std::string& arguments, const std::string& why) {
        const Outcome outcome = folder.tactus("validate " + arguments);
        INFO(arguments << ": " << outcome.err);
        CHECK(outcome.code == 2);
        CHECK(outcome.err.find(why) != std::string::npos);
    };
    refused("saw-vibration", "--reference");
    refused("saw-vibration --reference none.toml", "none.toml");
    refused("touch-sphere --reference " + validated_set(), "--saw NODE");
    refused("saw-vibration --saw equaliser --reference " + validated_set(), "type 'saw'");
    refused("saw-vibration --out handle:sum.in1 --reference " + validated_set(), "input");
    refused("saw-vibration --out load.value --reference " + validated_set(), "signal");
}

TEST_CASE("compare takes folders: files are paired by name, and one that is bad does not stop the rest", "[slow]") {
    const Folder folder;
    for (const char* name : {"a", "b", "c"}) saw(folder.path / "wanted" / (std::string(name) + ".wav"), 233.0);
    saw(folder.path / "made/a.flac", 233.0, 0.6, 2.0, 0.1);
    saw(folder.path / "made/b.wav", 150.0);
    std::ofstream(folder.path / "made/c.wav") << "no sound";
    saw(folder.path / "made/d.wav", 233.0);
    const std::string wanted = (folder.path / "wanted").string(), made = (folder.path / "made").string();
    const std::string table = (folder.path / "t.csv").string(), page = (folder.path / "p.html").string();
    const std::string figures = (folder.path / "figures").string();
    const Outcome outcome = folder.tactus("compare " + wanted + " " + made + " --json --jobs 2 --table " + table +
                                          " --report " + page + " --plot " + figures);
    CHECK(outcome.code == 2);
    CHECK(lines_of(outcome.err) == 2);
    CHECK(outcome.err.find("c.wav") != std::string::npos);
    CHECK(outcome.err.find("no reference with this name") != std::string::npos);
    const json answer = json::parse(outcome.out);
    CHECK(answer["passed"] == 1);
    CHECK(answer["failed"] == 1);
    CHECK(answer["bad"] == 2);
    REQUIRE(answer["pairs"].size() == 4);
    CHECK(answer["pairs"][0]["verdict"] == "pass");
    CHECK(answer["pairs"][0]["gain_db"].get<double>() == Approx(9.54).margin(0.05));
    CHECK(answer["pairs"][1]["verdict"] == "fail");
    CHECK(answer["pairs"][2].contains("error"));
    const std::string csv = slurp(table);
    CHECK(lines_of(csv) == 5);
    // A row for each, with as many fields as the heading has.
    std::istringstream rows(csv);
    std::string heading, row;
    std::getline(rows, heading);
    const auto fields = std::count(heading.begin(), heading.end(), ',');
    for (int n = 0; n < 2 && std::getline(rows, row); ++n) CHECK(std::count(row.begin(), row.end(), ',') == fields);
    CHECK(slurp(page).find("2 pairs") == std::string::npos);
    CHECK(slurp(page).find("1 of 4 pass") != std::string::npos);
    CHECK(fs::exists(folder.path / "figures/a.flac.svg"));
    CHECK_FALSE(fs::exists(folder.path / "figures/c.wav.svg"));

    // One reference for all, as a table for people.
    fs::remove(folder.path / "made/c.wav");
    const Outcome text = folder.tactus("compare " + wanted + "/a.wav " + made);
    CHECK(text.code == 1);
    CHECK(text.out.find("2 of 3 pass") != std::string::npos);
    fs::remove(folder.path / "made/b.wav");
    CHECK(folder.tactus("compare " + wanted + "/a.wav " + made).code == 0);
}

TEST_CASE("exposure takes folders: a row per file, and no sum over a day that would have too many hours") {
    const Folder folder;
    for (const char* name : {"a.wav", "b.wav", "c.wav", "d.wav"}) saw(folder.path / "saws" / name, 100.0);
    std::ofstream(folder.path / "saws/e.wav") << "no sound";
    const std::string saws = (folder.path / "saws").string(), table = (folder.path / "t.csv").string();
    const Outcome outcome = folder.tactus("exposure " + saws + " --full-scale '50 m/s^2' --json --table " + table);
    CHECK(outcome.code == 2);
    CHECK(lines_of(outcome.err) == 1);
    const json answer = json::parse(outcome.out);
    CHECK(answer["a8"].is_null());
    REQUIRE(answer["operations"].size() == 5);
    CHECK(answer["operations"][4].contains("error"));
    CHECK(lines_of(slurp(table)) == 6);
    fs::remove(folder.path / "saws/e.wav");
    const Outcome day = folder.tactus("exposure " + saws + " --full-scale '50 m/s^2' --json --duration 2");
    REQUIRE(day.code == 0);
    const json whole = json::parse(day.out);
    CHECK(whole["a8"].get<double>() == Approx(whole["operations"][0]["a_hw"][0].get<double>()).epsilon(1e-6));
    const Outcome text = folder.tactus("exposure " + saws + " --full-scale '50 m/s^2' --duration 2");
    // A table with a line for each file, and the verdict.
    CHECK(lines_of(text.out) == 7);
    for (const char* needed : {"a.wav", "d.wav", "A(8)"}) CHECK(text.out.find(needed) != std::string::npos);
}

TEST_CASE("spectrum --report is one page of figures, lines and bands for all files") {
    const Folder folder;
    saw(folder.path / "in/a&b.wav", 233.0);
    saw(folder.path / "in/c.wav", 150.0);
    const fs::path page = folder.path / "page.html";
    REQUIRE(folder.tactus("spectrum " + (folder.path / "in").string() + " --report " + page.string()).code == 0);
    const std::string html = slurp(page);
    for (const char* needed : {"<!doctype html>", "a&amp;b.wav", "c.wav", "order 2", "<td>fundamental</td><td>233.0",
                               "<td>fundamental</td><td>150.0", "third octave", "Methods"}) {
        INFO(needed);
        CHECK(html.find(needed) != std::string::npos);
    }
    CHECK(html.find("a&b.wav") == std::string::npos);
    CHECK(html.find("src=") == std::string::npos);
}
