// SPDX-License-Identifier: Apache-2.0
// Somebody who has never seen the window, with a mouse and a keyboard and nothing else: builds a patch from an empty
// canvas, hears it and saves it elsewhere; opens a take and finds the largest force.
#include "engine/take/take_reader.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/view/eyes.hpp"
#include "tools/view/signal/feed.hpp"

#include <sndfile.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <future>

using namespace tactus::test;
using nlohmann::json;
namespace fs = std::filesystem;

namespace {

std::future<Outcome> begin(const Display& display, const Folder& folder, const std::string& arguments) {
    return std::async(std::launch::async,
                      [&display, &folder, arguments] { return on(display, folder, arguments, 280); });
}

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

/// Adds a node through the list that a double click opens.
void add(Person& person, double x, double y, const std::string& words) {
    person.double_click(x, y);
    settle(person);
    person.type(words);
    settle(person);
    person.tap("Return");
    settle(person);
}

/// Does one thing through the list of commands.
void command(Person& person, const std::string& words) {
    person.chord({"Control_L"}, "p");
    settle(person);
    person.type(words);
    settle(person);
    person.tap("Return");
    settle(person);
}

}  // namespace

TEST_CASE("a newcomer builds the ball patch on an empty canvas, hears it and saves it elsewhere", "[display]") {
    NEEDS_PERSON(person, display)
    const Folder folder;
    fs::create_directories(folder.path / "elsewhere");
    auto done = begin(display, folder, "view --view-scale 1");
    REQUIRE(person.sees_window("Tactus", 30.0));
    Person::wait(2.0);
    keep(person, "newcomer-start");
    person.chord({"Control_L"}, "n");
    Person::wait(1.0);
    keep(person, "newcomer-empty");
    add(person, 100.0, 200.0, "device input");
    add(person, 400.0, 200.0, "sphere contact");
    add(person, 700.0, 200.0, "device output");
    keep(person, "newcomer-nodes");
    // The ports of the first row, at the edges of the boxes.
    constexpr double row = 46.5, wide = 158.0;
    person.drag(100.0 + wide, 200.0 + row, 400.0, 200.0 + row, 0.8);
    Person::wait(0.5);
    person.drag(400.0 + wide, 200.0 + row, 700.0, 200.0 + row, 0.8);
    Person::wait(0.5);
    keep(person, "newcomer-wired");
    command(person, "set device setting");
    person.type("simulated.start_z 60 mm");
    person.tap("Return");
    Person::wait(0.5);
    // Something to hear: the deeper the louder.
    command(person, "add sine");
    command(person, "add audio output");
    command(person, "wire sine.signal to audio_output.signal");
    command(person, "wire sphere_contact.penetration to sine.amplitude");
    keep(person, "newcomer-sound");
    person.chord({"Control_L", "Shift_L"}, "s");
    Person::wait(0.5);
    keep(person, "newcomer-save");
    person.type("elsewhere/ball");
    person.tap("Return");
    Person::wait(1.0);
    person.tap("F5");
    Person::wait(6.0);
    keep(person, "newcomer-runs");
    command(person, "end the run");
    Person::wait(2.0);
    person.chord({"Control_L"}, "q");
    const Outcome outcome = done.get();
    INFO(outcome.err);
    CHECK(outcome.code == 0);
    std::string text = slurp(folder.path / "elsewhere/ball.toml");
    INFO(text);
    // Arrows stand below each other.
    const auto last = std::unique(text.begin(), text.end(), [](char a, char b) { return a == ' ' && b == ' '; });
    text.erase(last, text.end());
    for (const char* wire :
         {"device_input.pose -> sphere_contact.pose", "sphere_contact.wrench -> device_output.wrench",
          "sine.signal -> audio_output.signal", "sphere_contact.penetration -> sine.amplitude"})
        CHECK(text.find(wire) != std::string::npos);
    CHECK(text.find("start_z = \"60 mm\"") != std::string::npos);
    const Outcome checked = on(display, folder, "check elsewhere/ball.toml");
    INFO(checked.err);
    CHECK(checked.code == 0);
    const json summary = json::parse(slurp(folder.path / "ball-run/summary.json"));
    CHECK(summary["force"]["max_N"].get<double>() > 0.5);
    double heard = -1.0;
    for (const auto& entry : fs::directory_iterator(folder.path / "ball-run"))
        if (entry.path().extension() == ".wav") heard = std::max(heard, loudest(entry.path()));
    CHECK(heard > 1e-4);
}

TEST_CASE("a newcomer opens a take and goes to the instant of its largest force", "[display]") {
    NEEDS_PERSON(person, display)
    const Folder folder;
    REQUIRE(on(display, folder, "render touch-sphere --seconds 3 --record monday --out out").code == 0);
    const auto take = tactus::take::Take::load(folder.path / "monday");
    const auto peak = tactus::view::TakeFeed(take).largest("hand_out.applied");
    REQUIRE(peak);
    CHECK(peak->value > 0.5);
    for (const std::string size : {"800 600", "1600 1000"}) {
        folder.write("script", fmt::format("size {}\ninstant {:.4f}\nframes 20\nscreenshot found.png\nclose\n", size,
                                           peak->when));
        auto done = begin(display, folder, "view --view-scale 1 --view-script script");
        REQUIRE(person.sees_window("Tactus", 30.0));
        Person::wait(2.5);
        keep(person, "take-start-" + size.substr(0, size.find(' ')));
        command(person, "open monday");
        Person::wait(3.0);
        keep(person, "take-open-" + size.substr(0, size.find(' ')));
        person.tap("m");
        Person::wait(1.0);
        keep(person, "take-found-" + size.substr(0, size.find(' ')));
        const Outcome outcome = done.get();
        INFO(outcome.err);
        REQUIRE(outcome.code == 0);
    }
}
