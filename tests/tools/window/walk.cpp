// SPDX-License-Identifier: Apache-2.0
#include "tests/tools/window/walk.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>

namespace tactus::test {

std::string WalkWindow::name() const { return fmt::format("{}x{}", width, height); }

std::vector<WalkWindow> walk_windows() {
    const char* const asked = std::getenv("TACTUS_WALKS");
    if (!asked) return {small_window};
    std::vector<WalkWindow> wanted;
    for (const WalkWindow& window : {small_window, usual_window, dense_window})
        if (asked == std::string("all") || asked == window.name()) wanted.push_back(window);
    if (wanted.empty()) FAIL("TACTUS_WALKS is all, 800x600, 1600x1000 or 2560x1600, not " << asked);
    return wanted;
}

Walk::Walk(const WalkWindow& its_window, std::string what)
    : window(its_window),
      display(std::max(1800, its_window.width), std::max(1200, its_window.height)),
      person(display),
      eyes{folder.path},
      what_(std::move(what)) {}

Walk::~Walk() {
    if (done_.valid()) interrupt(folder.path);
}

bool Walk::is_possible() const {
    if (!display.is_there()) skip("Xvfb is not installed (apt install xvfb)");
    else if (!person.is_there()) skip("libXtst is not installed (apt install libxtst6)");
    return display.is_there() && person.is_there();
}

void Walk::start(const std::string& arguments, double seconds) {
    std::string script;
    for (int i = 0; i < static_cast<int>(10.0 * seconds); ++i) {
        script += "wait 0.1\nspots spots.txt\n";
        if (i % 4 == 3) script += "text shown.toml\n";
    }
    start_script(arguments, script + "close\n", seconds);
}

void Walk::start_script(const std::string& arguments, const std::string& script, double seconds) {
    folder.write("script", fmt::format("size {} {}\n", window.width, window.height) + script);
    done_ = std::async(std::launch::async, [this, arguments, seconds] {
        return on(display, folder, fmt::format("{} --view-scale {} --view-script script", arguments, window.scale),
                  static_cast<int>(seconds) + 30);
    });
    REQUIRE(person.sees_window("Tactus", 60.0));
}

Outcome Walk::end(double max_s) {
    if (done_.wait_for(std::chrono::duration<double>(max_s)) != std::future_status::ready) interrupt(folder.path);
    return done_.get();
}

Outcome Walk::stop() {
    interrupt(folder.path);
    return done_.get();
}

void Walk::kill() {
    interrupt(folder.path, SIGKILL);
    done_.get();
}

bool Walk::shows(const std::string& control) const { return eyes.spots().contains(control); }

bool Walk::waits_for(const std::string& control, const std::string& panel) {
    if (panel.empty()) return sees([&] { return shows(control); }) || sees([&] { return shows(control); });
    for (int i = 0; i < 4; ++i)
        if (scroll_to(control, panel)) return true;
    return false;
}

bool Walk::waits_while(const std::string& control) const {
    return sees([&] { return !shows(control); });
}

bool Walk::scroll_to(const std::string& control, const std::string& panel) {
    // First down to the end of the panel, then up to its beginning.
    constexpr int max_turns = 40;
    for (int turn = 0; turn < max_turns && !shows(control); ++turn) {
        const Spot over = eyes.spot(panel);
        person.move(0.5 * (over.left + over.right), 0.5 * (over.top + over.bottom));
        const int wheel = turn < max_turns / 2 ? 5 : 4;
        person.button(wheel, true);
        person.button(wheel, false);
        eyes.look_again();
    }
    return shows(control);
}

void Walk::press(const std::string& control, const std::string& panel) {
    if (!panel.empty()) scroll_to(control, panel);
    test::press(person, eyes, control);
}

void Walk::measure() {
    press("measure");
    const Spot scene = eyes.spot("scene picture"), tree = eyes.spot("panel tree");
    const double x = 0.5 * (scene.left + scene.right), y = 0.5 * (scene.top + scene.bottom);
    for (int n = 0; n < 36 && !shows("keep measurement"); ++n) {
        person.click(x + 14.0 * (n % 6) - 35.0, y + 24.0 * (n / 6) - 60.0);
        // In a small window the list is longer than its room.
        person.move(0.5 * (tree.left + tree.right), 0.5 * (tree.top + tree.bottom));
        for (int turn = 0; turn < 5; ++turn) {
            person.button(5, true);
            person.button(5, false);
        }
        eyes.look_again();
    }
    REQUIRE(shows("keep measurement"));
}

void Walk::command(const std::string& words) {
    person.chord({"Control_L"}, "p");
    REQUIRE(waits_for("command"));
    person.type(words);
    person.tap("Return");
    CHECK(waits_while("command"));
    eyes.look_again();
}

bool Walk::until(const std::function<bool()>& is_seen, const std::function<void()>& act) {
    for (int i = 0; i < 4; ++i) {
        act();
        for (int n = 0; n < 25; ++n) {
            if (is_seen()) return true;
            Person::wait(0.2);
        }
    }
    return false;
}

bool Walk::shows_text(const std::string& part) const {
    std::string text = slurp(folder.path / "shown.toml");
    // Arrows stand below each other.
    text.erase(std::unique(text.begin(), text.end(), [](char a, char b) { return a == ' ' && b == ' '; }), text.end());
    return text.find(part) != std::string::npos;
}

void Walk::keep(const std::string& name) {
    if (!std::getenv("TACTUS_KEEP_PICTURES")) return;
    Person::wait(0.6);
    test::keep(person, fmt::format("{}-{}-{}-{}", what_, window.name(), ++pictures_, name));
}

}  // namespace tactus::test
