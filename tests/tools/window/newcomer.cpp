// SPDX-License-Identifier: Apache-2.0
// Somebody who has never seen the window, with a mouse and a keyboard and nothing else: builds the patch of the README on an
// empty canvas, hears it and saves it elsewhere; opens a take and finds the largest force.
#include "engine/take/take_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/window/walk.hpp"
#include "tools/window/signal/feed.hpp"

#include <sndfile.h>

#include <algorithm>
#include <cmath>

using namespace tactus::test;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

double loudest(const fs::path& sound) {
    SF_INFO info{};
    SNDFILE* file = sf_open(sound.c_str(), SFM_READ, &info);
    if (!file) return -1.0;
    std::vector<float> samples(static_cast<std::size_t>(info.frames * info.channels));
    sf_readf_float(file, samples.data(), info.frames);
    sf_close(file);
    double most = 0.0;
    for (const float sample : samples) most = std::max(most, std::abs(static_cast<double>(sample)));
    return most;
}

/// Adds a node through the list that a double click on the canvas opens; `share`: across the canvas.
void add(Walk& walk, const std::string& words, const std::string& node, double share) {
    const bool is_there =
        walk.until([&] { return walk.shows(node); },
                   [&] {
                       if (!walk.shows("palette")) {
                           const Spot canvas = walk.eyes.spot("panel patch");
                           walk.person.double_click(canvas.left + share * (canvas.right - canvas.left),
                                                    canvas.top + 0.35 * (canvas.bottom - canvas.top));
                       }
                       if (!walk.waits_for("palette")) return;
                       walk.person.type(words);
                       walk.person.tap("Return");
                   });
    REQUIRE(is_there);
}

/// Draws a wire from port to port, or from a port to a node.
void wire(Walk& walk, const std::string& from, const std::string& to) {
    // Not while the view still moves.
    const Spot a = walk.eyes.resting_spot(from), b = walk.eyes.resting_spot(to);
    walk.person.drag(a.left, a.top, b.left, b.top, 0.5);
}

double largest_force(const Walk& walk, const std::string& patch) {
    const Outcome rendered =
        on(walk.display, walk.folder, "render " + patch + " --seconds 2 --json --overwrite --out rendered");
    INFO(rendered.err);
    REQUIRE(rendered.code == 0);
    return json::parse(rendered.out)["force"]["max_N"].get<double>();
}

/// The block of a page that is written to that file.
std::string block_of(const fs::path& page, const std::string& file) {
    const std::string text = slurp(page), mark = "<!-- file: " + file + " -->\n```toml\n";
    const std::size_t begin = text.find(mark);
    REQUIRE(begin != std::string::npos);
    return text.substr(begin + mark.size(), text.find("```", begin + mark.size()) - begin - mark.size());
}

}  // namespace

// Costly: a window is drawn in software while somebody works in it.
TEST_CASE("a newcomer builds the ball patch of the README on an empty canvas, hears it and saves it elsewhere",
          "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "ball");
        if (!walk.is_possible()) return;
        Person& person = walk.person;
        fs::create_directories(walk.folder.path / "elsewhere");
        walk.start("view", 480.0);
        REQUIRE(walk.waits_for("New patch"));
        walk.keep("start");
        walk.press("New patch");
        REQUIRE(walk.waits_while("New patch"));
        walk.keep("empty");
        add(walk, "device input", "device_input", 0.03);
        add(walk, "ball", "sphere_contact", 0.36);
        add(walk, "device output", "device_output", 0.69);
        walk.keep("nodes");
        CHECK(walk.until([&] { return walk.shows_text("device_input.pose -> sphere_contact.pose"); },
                         [&] { wire(walk, "device_input.pose", "sphere_contact.pose"); }));
        CHECK(walk.until([&] { return walk.shows_text("sphere_contact.wrench -> device_output.wrench"); },
                         [&] { wire(walk, "sphere_contact.wrench", "device_output.wrench"); }));
        walk.keep("wired");
        // As the tutorial says: choose the node, then type the setting and its value.
        const Spot hand = walk.eyes.spot("device_input");
        person.click(hand.left, hand.top);
        CHECK(walk.until([&] { return walk.shows_text("start_z = \"60 mm\""); },
                         [&] {
                             walk.press("device setting", "panel node");
                             person.chord({"Control_L"}, "a");
                             person.type("start_z");
                             walk.press("device value", "panel node");
                             person.chord({"Control_L"}, "a");
                             person.type("60 mm");
                             person.tap("Return");
                         }));
        const Spot ball = walk.eyes.spot("sphere_contact");
        person.click(ball.left, ball.top);
        CHECK(walk.until([&] { return walk.shows_text("stiffness = \"0.8 N/mm\""); },
                         [&] {
                             walk.command("set sphere_contact stiffness");
                             if (!walk.waits_for("value")) return;
                             person.type("0.8 N/mm");
                             person.tap("Return");
                         }));
        walk.keep("set");
        // Something to hear: the deeper the louder.
        walk.command("add sine");
        REQUIRE(walk.waits_for("sine"));
        walk.command("add audio output");
        REQUIRE(walk.waits_for("audio_output"));
        walk.command("show the whole patch");
        Person::wait(1.0);
        CHECK(walk.until([&] { return walk.shows_text("sine.signal -> audio_output.signal"); },
                         [&] { wire(walk, "sine.signal", "audio_output.signal"); }));
        CHECK(walk.until([&] { return walk.shows_text("sphere_contact.penetration -> sine.amplitude"); },
                         [&] {
                             if (!walk.shows("drive amplitude")) wire(walk, "sphere_contact.penetration", "sine");
                             if (walk.waits_for("drive amplitude")) walk.press("drive amplitude");
                         }));
        walk.keep("sound");
        person.chord({"Control_L", "Shift_L"}, "s");
        REQUIRE(walk.waits_for("file name"));
        person.type("elsewhere/ball");
        walk.keep("save");
        person.tap("Return");
        CHECK(sees([&] { return fs::exists(walk.folder.path / "elsewhere/ball.toml"); }));
        // Late ticks of a busy machine take the force away: a person waits until it is back, or runs the patch again.
        json summary;
        fs::path results;
        for (int attempt = 0; attempt < 4; ++attempt) {
            // A key that comes while a question still closes is lost.
            REQUIRE(walk.until([&] { return walk.shows("stop"); }, [&] { person.tap("F5"); }));
            Person::wait(6.0);
            if (walk.shows("state of forces") && walk.waits_while("state of forces")) Person::wait(2.0);
            if (attempt == 0) walk.keep("runs");
            walk.press("stop");
            REQUIRE(walk.waits_for("run"));
            results = fs::canonical(walk.folder.path / "ball-run-latest");
            summary = json::parse(slurp(results / "summary.json"));
            if (summary["force"]["max_N"].get<double>() > 0.5) break;
        }
        person.chord({"Control_L"}, "q");
        const Outcome outcome = walk.end();
        INFO(outcome.err);
        CHECK(outcome.code == 0);
        INFO(slurp(walk.folder.path / "elsewhere/ball.toml"));
        const Outcome checked = on(walk.display, walk.folder, "check elsewhere/ball.toml");
        INFO(checked.err);
        CHECK(checked.code == 0);
        CHECK(summary["force"]["max_N"].get<double>() > 0.5);
        double heard = -1.0;
        for (const auto& entry : fs::directory_iterator(results))
            if (entry.path().extension() == ".wav") heard = std::max(heard, loudest(entry.path()));
        CHECK(heard > 1e-4);
        // It is that of the README.
        walk.folder.write("readme.toml", block_of(source_folder() / "README.md", "touch.toml"));
        CHECK(largest_force(walk, "elsewhere/ball.toml") == largest_force(walk, "readme.toml"));
    }
}

TEST_CASE("a newcomer opens a take and goes to the instant of its largest force", "[display]") {
    for (const WalkWindow& window : walk_windows()) {
        Walk walk(window, "take");
        if (!walk.is_possible()) return;
        REQUIRE(on(walk.display, walk.folder, "render touch-sphere --seconds 3 --record monday --out out").code == 0);
        const auto take = tactus::take::Take::load(walk.folder.path / "monday");
        const auto peak = tactus::window::TakeFeed(take).largest("hand_out.applied");
        REQUIRE(peak);
        CHECK(peak->value > 0.5);
        std::string script;
        for (int i = 0; i < 10; ++i) script += "frames 3\nspots spots.txt\n";
        walk.start_script("view",
                          script + fmt::format("instant {:.4f}\nframes 20\nspots spots.txt\nscreenshot found.png\n"
                                               "wait 3\nclose\n",
                                               peak->when),
                          200.0);
        REQUIRE(walk.waits_for("takes here monday"));
        walk.keep("start");
        walk.press("takes here monday");
        REQUIRE(walk.person.sees_window("Touch", 60.0));
        Person::wait(2.0);
        walk.keep("open");
        walk.person.tap("m");
        REQUIRE(walk.waits_for("scope 0 plot"));
        walk.keep("found");
        const Outcome outcome = walk.end(180.0);
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
        CHECK(walk.shows("scope 0 plot"));
        check_picture(walk.folder.path / "found.png", window.width, window.height);
    }
}
