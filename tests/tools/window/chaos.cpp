// SPDX-License-Identifier: Apache-2.0
// A window to which everything happens at random, by mouse and keys only. TACTUS_CHAOS names the seconds ('./dev chaos
// window'), TACTUS_SEED the seed.
#include "tests/support/places.hpp"
#include "tests/tools/window/eyes.hpp"

#include <chrono>
#include <cstdlib>
#include <future>
#include <iostream>
#include <random>
#include <set>

using namespace tactus::test;
namespace fs = std::filesystem;

namespace {

class Monkey {
public:
    Monkey(Person& person, const Eyes& eyes, unsigned seed, int width, int height)
        : person_(person), eyes_(eyes), random_(seed), width_(width), height_(height) {}

    void act() {
        switch (upto(10)) {
            case 0: person_.click(x(), y()); break;
            case 1: person_.drag(x(), y(), x(), y(), 0.1, 1 + upto(3)); break;
            case 2: person_.double_click(x(), y()); break;
            case 3: person_.tap(one_of(keys)); break;
            case 4: person_.chord({"Control_L"}, one_of(letters)); break;
            case 5: wheel(); break;
            case 6: click_at(x(), y(), 3); break;
            case 7: command(); break;
            default: control();
        }
    }

private:
    int upto(int most) { return static_cast<int>(random_() % static_cast<unsigned>(most)); }
    double x() { return upto(width_); }
    double y() { return upto(height_); }
    const std::string& one_of(const std::vector<std::string>& all) {
        return all[static_cast<std::size_t>(upto(static_cast<int>(all.size())))];
    }
    void click_at(double at_x, double at_y, int button) {
        person_.move(at_x, at_y);
        person_.button(button, true);
        person_.button(button, false);
    }
    void wheel() {
        const int which = 4 + upto(2);
        person_.move(x(), y());
        person_.button(which, true);
        person_.button(which, false);
    }
    void command() {
        person_.chord({"Control_L"}, "p");
        person_.type(one_of(words));
        person_.tap("Return");
    }
    /// A control that is there, pressed or dragged to another.
    void control() {
        const auto spots = eyes_.spots();
        if (spots.empty()) return;
        const auto any = [&] {
            auto at = spots.begin();
            std::advance(at, upto(static_cast<int>(spots.size())));
            return at;
        };
        const auto from = any(), to = any();
        // Other places of the disk are none of the test's.
        if (from->first.starts_with("place ") || from->first == "folder up") return;
        const auto middle_x = [](const Spot& spot) { return 0.5 * (spot.left + spot.right); };
        const auto middle_y = [](const Spot& spot) { return 0.5 * (spot.top + spot.bottom); };
        if (upto(3) > 0) click_at(middle_x(from->second), middle_y(from->second), 1 + 2 * (upto(5) == 0));
        else
            person_.drag(middle_x(from->second), middle_y(from->second), middle_x(to->second), middle_y(to->second),
                         0.1);
    }

    static inline const std::vector<std::string> keys{
        "Tab", "Return", "Escape", "Delete", "Up", "Down", "Left",  "Right",     "a",    "f",   "1",       "7",
        "h",   "t",      "m",      "F1",     "F5", "F10",  "space", "BackSpace", "Home", "End", "Page_Up", "Page_Down"};
    static inline const std::vector<std::string> letters{"z", "y", "x", "c", "v", "d", "a",    "g",
                                                         "1", "2", "3", "n", "r", "p", "Right"};
    static inline const std::vector<std::string> words{
        "add sine",    "add constant",      "wire",        "undo",
        "end the run", "run the patch",     "record",      "look at the take",
        "start page",  "back to the patch", "layout plan", "set",
        "go to hand",  "duplicate",         "comment",     "sub-patch"};

    Person& person_;
    const Eyes& eyes_;
    std::mt19937 random_;
    int width_, height_;
};

/// The library, with patches that may be written over.
void copy_library(const fs::path& into) {
    for (const auto& entry : fs::directory_iterator(library_folder()))
        if (entry.path().filename() != "patches") fs::create_symlink(entry.path(), into / entry.path().filename());
    fs::copy(library_folder() / "patches", into / "patches", fs::copy_options::recursive);
}

/// Texts of the patches in a folder.
std::set<std::string> texts_in(const fs::path& folder, const std::string& name = {}) {
    std::set<std::string> texts;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".toml" && (name.empty() || entry.path().filename() == name))
            texts.insert(slurp(entry.path()));
    return texts;
}

struct Round {
    std::string patch, layout;
    int width, height;
};

void play(const VirtualDisplay& display, Person& person, const Round& round, unsigned seed, double seconds) {
    const Folder folder;
    copy_library(folder.path);
    // What can be opened: a patch of the library, also where it was written over, a new one, and the patch of a take.
    std::set<std::string> first_texts = texts_in(folder.path / "patches");
    first_texts.insert("");
    const double starts_s = 5.0, freed_s = seconds < 10.0 ? 6.0 : 50.0;
    std::string script =
        watching_script(fmt::format("size {} {}\n", round.width, round.height), starts_s + seconds + freed_s);
    script.replace(script.rfind("close\n"), 6, "undo all\ntext after.toml\nclose\n");
    folder.write("script", script);
    auto done = std::async(std::launch::async, [&] {
        return on(display, folder,
                  fmt::format("view patches/{}.toml --layout {} --view-scale 1 --view-script script", round.patch,
                              round.layout),
                  static_cast<int>(seconds) + 150);
    });
    const auto is_over = [&] { return done.wait_for(std::chrono::seconds(0)) == std::future_status::ready; };
    REQUIRE(person.sees_window("Tactus", 30.0));
    const Eyes eyes{folder.path};
    sees([&] { return !eyes.spots().empty(); });
    Monkey monkey(person, eyes, seed, round.width, round.height);
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    while (std::chrono::steady_clock::now() < end && !is_over()) monkey.act();
    // Slow pictures of large scenes are behind with what was done: an edge of a button takes one.
    if (seconds >= 10.0) Person::wait(12.0);
    // Nothing is stuck: whatever is open can be left, and the list of commands comes.
    bool is_free = is_over();
    for (int i = 0; i < 5 && !is_free; ++i) {
        for (int n = 0; n < 3; ++n) person.tap("Escape");
        if (i > 1) {
            // A question without a way out is answered.
            person.tap("Right");
            person.tap("Return");
        }
        person.chord({"Control_L"}, "p");
        for (int n = 0; n < 25 && !is_free; ++n) {
            Person::wait(0.2);
            is_free = is_over() || eyes.spots().contains("command");
        }
    }
    keep(person, fmt::format("chaos-{}-{}", round.patch, round.layout));
    const Outcome outcome = done.get();
    INFO(outcome.out << outcome.err);
    CHECK(outcome.code == 0);
    CHECK(is_free);
    // Who closed the window has nothing to undo.
    if (!fs::exists(folder.path / "after.toml")) return;
    const std::string after = slurp(folder.path / "after.toml");
    INFO(after);
    first_texts.merge(texts_in(folder.path, "patch-0.toml"));
    CHECK(first_texts.contains(after));
}

}  // namespace

TEST_CASE(
    "whatever mouse and keys do at random, the window lives, is never stuck, and undo leads back to the first byte",
    "[display]") {
    NEEDS_PERSON(person, display)
    const char* const wanted = std::getenv("TACTUS_CHAOS");
    const char* const given = std::getenv("TACTUS_SEED");
    double seconds = wanted ? std::atof(wanted) : 6.0;
    const unsigned seed = given    ? static_cast<unsigned>(std::atol(given))
                          : wanted ? static_cast<unsigned>(std::time(nullptr))
                                   : 7u;
    std::mt19937 random(seed);
    static const std::vector<std::string> patches{"touch-sphere", "saw-training", "planning-trauma", "saw-task"},
        layouts{"patch", "plan", "train"};
    static const std::vector<std::pair<int, int>> sizes{{1000, 700}, {800, 600}, {1600, 1000}};
    constexpr double round_s = 40.0;
    for (std::size_t n = 0; seconds > 0.0; ++n, seconds -= round_s) {
        const auto [width, height] = sizes[random() % sizes.size()];
        // Every patch in every layout, one after the other.
        const Round round{patches[n % patches.size()], layouts[(n + n / patches.size()) % layouts.size()], width,
                          height};
        const auto own = static_cast<unsigned>(random());
        if (wanted)
            std::cout << fmt::format("seed {}, round {}: {}, {}, {} by {}\n", seed, n, round.patch, round.layout, width,
                                     height)
                      << std::flush;
        INFO(fmt::format("TACTUS_SEED={}, round {}: {}, layout {}, {} by {}", seed, n, round.patch, round.layout, width,
                         height));
        play(display, person, round, own, std::min(seconds, round_s));
    }
}
