// SPDX-License-Identifier: Apache-2.0
// The small patches of the how-to pages: each follows the law that its comment states.
#include "assets/sound/sound.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

using namespace tactus;
using tactus::test::Folder;

namespace {

using Row = std::vector<double>;

/// The rows of a table, without the time.
std::vector<Row> table(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::string line;
    std::getline(file, line);
    std::vector<Row> rows;
    while (std::getline(file, line)) {
        std::istringstream cells(line);
        Row row;
        for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
        rows.emplace_back(row.begin() + 1, row.end());
    }
    return rows;
}

std::filesystem::path patch(const std::string& name) {
    return tactus::test::source_folder() / "docs/how-to/patches" / (name + ".toml");
}

struct Rendered {
    explicit Rendered(const std::string& name) {
        const auto done =
            folder.tactus("render " + patch(name).string() + " --seconds 2 --out " + folder.path.string() + "/out");
        INFO(name << ": " << done.err);
        REQUIRE(done.code == 0);
    }
    std::vector<Row> operator()(const std::string& file) const { return table(folder.path / "out" / file); }
    std::vector<float> sound(const std::string& file) const {
        return sound::load_sound(folder.path / "out" / file).samples;
    }

    Folder folder;
};

/// A law that states no force for an instant.
constexpr double unstated = 1e300;

/// Compares one component of the recorded force with a law of position and velocity, and sees that the force acts.
void check_law(const std::string& name, std::size_t component,
               const std::function<double(const Row& pose, const Row& twist)>& law) {
    const Rendered run(name);
    const auto force = run("force.csv"), pose = run("pose.csv"), twist = run("twist.csv");
    REQUIRE(force.size() == 2000);
    double largest = 0.0, off = 0.0;
    for (std::size_t k = 0; k < force.size(); ++k) {
        const double wanted = law(pose[k], twist[k]);
        if (wanted == unstated) continue;
        largest = std::max(largest, std::abs(wanted));
        off = std::max(off, std::abs(force[k][component] - wanted));
    }
    CAPTURE(name, largest, off);
    CHECK(largest > 0.1);
    CHECK(off < 1e-6 * largest);
}

}  // namespace

TEST_CASE("small patches of forces follow their laws") {
    constexpr std::size_t x = 0, z = 2;
    check_law("virtual-wall", z,
              [](const Row& p, const Row& v) { return p[z] < 0.0 ? -800.0 * p[z] - 2.0 * v[z] : 0.0; });
    check_law("hertz-contact", z,
              [](const Row& p, const Row&) { return 0.4 * std::pow(std::max(0.0, -1e3 * p[z]), 1.5); });
    check_law("viscous-pool", z, [](const Row& p, const Row& v) { return p[z] < 0.0 ? -6.0 * v[z] : 0.0; });
    check_law("magnet-line", x,
              [](const Row& p, const Row&) { return std::hypot(p[x], p[z]) < 5e-3 ? -400.0 * p[x] : 0.0; });
    check_law("detents", x, [](const Row& p, const Row&) { return -std::sin(2.0 * std::numbers::pi * p[x] / 6e-3); });
    check_law("rolling-bump", x, [](const Row& p, const Row&) {
        const double u = p[x] / 4e-3;
        return 1.5 * u * std::exp(0.5 - 0.5 * u * u);
    });
    check_law("button-click", z, [](const Row& p, const Row&) {
        const double depth = -1e3 * p[z];
        const double points[][2] = {{0.0, 0.0}, {2.0, 1.2}, {2.6, 0.5}, {3.5, 0.6}, {5.5, 3.0}};
        if (depth <= 0.0) return 0.0;
        for (std::size_t i = 1; i < std::size(points); ++i)
            if (depth <= points[i][0])
                return points[i - 1][1] + (points[i][1] - points[i - 1][1]) * (depth - points[i - 1][0]) /
                                              (points[i][0] - points[i - 1][0]);
        return 3.0;
    });
}

TEST_CASE("small patches of guides follow their laws") {
    constexpr std::size_t x = 0, y = 1, z = 2;
    check_law("soft-wall", z, [](const Row& p, const Row& v) {
        if (p[z] >= 0.0) return 0.0;
        // The damper sets in over the first 0.2 mm.
        return std::clamp(std::min(-400.0 * p[z], 2.0) - 2.0 * std::min(-p[z] / 0.2e-3, 1.0) * v[z], 0.0, 2.0);
    });
    // The nearer one of two lines along x to (15 mm, 0, 0) and from there along y; while the pull turns to the other line,
    // 50 ms, there is no law to compare with.
    struct TwoLines {
        bool was_first = true;
        int turning = 0;
        Row operator()(const Row& p) {
            const double along = std::clamp(p[x], 0.0, 15e-3), up = std::clamp(p[y], 0.0, 20e-3);
            const double a[] = {along - p[x], -p[y], -p[z]}, b[] = {15e-3 - p[x], up - p[y], -p[z]};
            const double nearer = std::hypot(b[0], b[1], b[2]) - std::hypot(a[0], a[1], a[2]);
            const bool is_first = nearer >= 0.0;
            const double* const way = is_first ? a : b;
            // Of two places that are as near to 0.1 mm, the hand keeps the one it had.
            if (is_first != was_first && std::abs(nearer) < 0.1e-3) return {};
            if (std::exchange(was_first, is_first) != is_first) turning = 51;
            if (turning > 0 && turning-- > 0) return {};
            const double far = std::hypot(way[0], way[1], way[2]), pull = std::min(300.0 * far, 3.0);
            return {pull * way[0] / far, pull * way[1] / far, pull * way[2] / far};
        }
    };
    for (const std::size_t axis : {x, y, z}) {
        int turned = 0;
        check_law("guided-path", axis, [&, lines = TwoLines()](const Row& p, const Row&) mutable {
            const Row force = lines(p);
            turned += force.empty() ? 1 : 0;
            return force.empty() ? unstated : force[axis];
        });
        CHECK(turned >= 51);
        CHECK(turned < 80);
    }
    check_law("ruler", z, [](const Row& p, const Row& v) { return -300.0 * p[z] - 2.0 * v[z]; });
    check_law("ruler", x, [](const Row& p, const Row& v) { return -150.0 * (p[x] - p[y]) - 1.0 * (v[x] - v[y]); });
    for (const std::size_t axis : {x, y, z})
        check_law("keep-in", axis, [=](const Row& p, const Row&) {
            const auto out = [&](std::size_t k) { return p[k] - std::clamp(p[k], -10e-3, 10e-3); };
            const double far = std::hypot(out(x), out(y), out(z)), push = std::min(400.0 * far, 3.0);
            return far > 0.0 ? -push * out(axis) / far : 0.0;
        });
    check_law("magnet-point", x, [](const Row& p, const Row&) {
        const double far = std::hypot(p[x], p[y], p[z]);
        const double pull = std::max(0.0, std::min({300.0 * far, 1.0, 300.0 * (10e-3 - far)}));
        return far > 0.0 ? -pull * p[x] / far : 0.0;
    });
    check_law("notched-slider", x, [](const Row& p, const Row& v) {
        const double turn = 2.0 * std::numbers::pi;
        return -800.0 * 5e-3 / turn * std::sin(turn * p[x] / 5e-3) - 1.0 * v[x];
    });
    for (const std::size_t axis : {x, y})
        check_law("honey", axis, [=](const Row&, const Row& v) {
            const double speed = std::hypot(v[0], v[1], v[2]);
            return speed > 0.0 ? -std::min(8.0 * speed, 0.8) * v[axis] / speed : 0.0;
        });
}

TEST_CASE("the detent dial turns back by a sine of its angle") {
    const Rendered run("detent-dial");
    const auto force = run("force.csv"), pose = run("pose.csv");
    double largest = 0.0;
    for (std::size_t k = 0; k < force.size(); ++k) {
        const double angle = 2.0 * std::atan2(pose[k][6], pose[k][3]);
        const double wanted = -0.6 / 24.0 * std::sin(24.0 * angle);
        CHECK(force[k][5] == Approx(wanted).margin(1e-8));
        largest = std::max(largest, std::abs(force[k][5]));
    }
    CHECK(largest > 0.02);
}

TEST_CASE("a pen on the floor gives force and torque about the hand") {
    const Rendered run("force-on-a-lever");
    const auto force = run("force.csv"), pose = run("pose.csv"), tip = run("tip.csv");
    double largest = 0.0;
    for (std::size_t k = 0; k < force.size(); ++k) {
        const double up = std::min(400.0 * std::max(0.0, -tip[k][2]), 3.0);
        const double lever[] = {tip[k][0] - pose[k][0], tip[k][1] - pose[k][1]};
        CHECK(std::hypot(lever[0], lever[1], tip[k][2] - pose[k][2]) == Approx(0.06));
        CHECK(force[k][2] == Approx(up).margin(1e-9));
        CHECK(force[k][3] == Approx(lever[1] * up).margin(1e-9));
        CHECK(force[k][4] == Approx(-lever[0] * up).margin(1e-9));
        largest = std::max(largest, std::abs(force[k][4]));
    }
    CHECK(largest > 0.005);
}

TEST_CASE("a tap on wood rings at each touch, as strong as the hand was fast") {
    const Rendered run("tap-on-wood");
    const auto touch = run("touch.csv"), speed = run("speed.csv");
    const auto drive = run.sound("drive.wav");
    std::vector<std::pair<double, double>> taps;  // s, m/s²
    for (std::size_t k = 1; k < touch.size(); ++k)
        if (touch[k][0] != 0.0 && touch[k - 1][0] == 0.0)
            taps.emplace_back(1e-3 * static_cast<double>(k), 5.0 * std::abs(speed[k][0]));
    REQUIRE(taps.size() == 2);
    CHECK(taps[1].second > 1.1 * taps[0].second);
    // The sound's group is a fixed number of samples late: found at the first tap, kept for the second.
    std::size_t first = 0;
    while (drive[first] == 0.0f) ++first;
    const double late = static_cast<double>(first - 1) / 48000.0 - taps[0].first;
    CHECK(late >= 0.0);
    CHECK(late < 3e-3);
    double off = 0.0;
    for (std::size_t i = 0; i < drive.size(); ++i) {
        double wanted = 0.0;
        for (const auto& [when, strength] : taps) {
            const double t = static_cast<double>(i) / 48000.0 - when - late;
            if (t >= -1e-9) wanted += strength * std::exp(-t / 15e-3) * std::sin(2.0 * std::numbers::pi * 180.0 * t);
        }
        off = std::max(off, std::abs(static_cast<double>(drive[i]) - wanted));
    }
    CHECK(off < 0.01 * taps[1].second);
}

TEST_CASE("the theremin plays two octaves over 40 mm") {
    const Rendered run("theremin");
    const auto x = run("x.csv"), hz = run("hz.csv");
    for (std::size_t k = 0; k < x.size(); ++k)
        CHECK(hz[k][0] == Approx(100.0 * std::exp2(2.0 * std::clamp((x[k][0] + 0.02) / 0.04, 0.0, 1.0))));
    // Cycles at the end, where the hand rests.
    const auto tone = run.sound("tone.wav");
    int rises = 0;
    for (std::size_t i = 72000; i + 1 < 96000; ++i) rises += tone[i] < 0.0f && tone[i + 1] >= 0.0f;
    CHECK(rises / 0.5 == Approx(hz.back()[0]).epsilon(0.01));
}

TEST_CASE("the alarm has two tones in turn") {
    const Rendered run("two-tone-alarm");
    const auto hz = run("hz.csv");
    const auto sound = run.sound("alarm.wav");
    for (std::size_t part = 0; part < 8; ++part) {
        const double wanted = part % 2 == 0 ? 440.0 : 554.0;
        CHECK(hz[250 * part + 5][0] == wanted);
        int rises = 0;
        for (std::size_t i = 12000 * part + 1000; i < 12000 * part + 11000; ++i)
            rises += sound[i] < 0.0f && sound[i + 1] >= 0.0f;
        CHECK(rises / (10000.0 / 48000.0) == Approx(wanted).epsilon(0.012));
    }
}

TEST_CASE("the compressor turns a level ten times its threshold into the fourth root of ten") {
    const Rendered run("even-level");
    const auto given = run("given.csv"), gain = run("gain.csv");
    for (const std::size_t k : {480u, 980u, 1980u}) {
        const double above = std::max(given[k][0] / 0.1, 1.0);
        CHECK(gain[k][0] == Approx(std::pow(above, 1.0 / 4.0 - 1.0)).epsilon(0.01));
    }
    CHECK(given[480][0] == 0.1);
    CHECK(given[980][0] == 1.0);
}

TEST_CASE("each echo is half of the one before, 100 ms later") {
    const Rendered run("echo");
    const auto dry = run.sound("dry.wav"), wet = run.sound("echo.wav");
    double off = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < wet.size(); ++i) {
        double sum = 0.0, share = 1.0;
        for (std::size_t back = 0; back <= i; back += 4800, share *= 0.5)
            sum += share * static_cast<double>(dry[i - back]);
        off = std::max(off, std::abs(static_cast<double>(wet[i]) - sum));
        largest = std::max(largest, std::abs(sum));
    }
    CHECK(largest > 0.5);
    CHECK(off < 1e-5 * largest);
}

TEST_CASE("the weight comes in by half a cosine") {
    const Rendered run("soft-start");
    const auto force = run("force.csv");
    for (std::size_t k = 0; k < force.size(); ++k) {
        const double share = std::clamp((1e-3 * static_cast<double>(k) - 0.501) / 0.8, 0.0, 1.0);
        CHECK(force[k][2] == Approx(-0.4 * (0.5 - 0.5 * std::cos(std::numbers::pi * share))).margin(1e-9));
    }
}

TEST_CASE("the odometer reads the length of the way") {
    const Rendered run("odometer");
    const auto way = run("way.csv"), pose = run("pose.csv");
    double length = 0.0;
    for (std::size_t k = 1; k < pose.size(); ++k)
        length += std::hypot(pose[k][0] - pose[k - 1][0], pose[k][1] - pose[k - 1][1], pose[k][2] - pose[k - 1][2]);
    CHECK(length > 0.05);
    CHECK(way.back()[0] == Approx(length).epsilon(0.01));
}

TEST_CASE("two forces of a small patch are added") {
    const Rendered run("two-forces");
    const auto force = run("force.csv"), part = run("part.csv");
    double largest = 0.0;
    for (std::size_t k = 0; k < force.size(); ++k) {
        CHECK(force[k][2] == Approx(part[k][2] - 0.3).margin(1e-12));
        largest = std::max(largest, part[k][2]);
    }
    CHECK(largest > 0.5);
}

TEST_CASE("the level meter reads the level of the sound, one period late at most") {
    const Rendered run("level-meter");
    const auto level = run("level.csv"), wanted = run("wanted.csv");
    // The follower reads the mean of a rectified sine between its attack and its release; it rises and falls with it.
    double low = 1e9, high = 0.0;
    for (std::size_t k = 500; k < level.size(); ++k) {
        const double share = level[k][0] / wanted[k][0];
        if (wanted[k][0] < 0.3) continue;
        low = std::min(low, share);
        high = std::max(high, share);
    }
    CHECK(low > 0.75);
    CHECK(high < 1.05);
}

TEST_CASE("the metronome clicks twice a second") {
    const Rendered run("metronome");
    const auto beats = run("beats.csv");
    std::vector<std::size_t> when;
    for (std::size_t k = 0; k < beats.size(); ++k)
        if (beats[k][0] != 0.0) when.push_back(k);
    CHECK(when == std::vector<std::size_t>{0, 500, 1000, 1500});
}

TEST_CASE("the texture is as loud as the hand is fast") {
    const Rendered run("texture-by-speed");
    const auto speed = run("speed.csv"), level = run("level.csv");
    for (std::size_t k = 0; k < speed.size(); ++k)
        CHECK(level[k][0] == Approx(0.2 * std::min(speed[k][0] / 0.05, 1.0)).margin(1e-9));
}

TEST_CASE("touches are counted and timed") {
    const Rendered run("count-touches");
    CHECK(run("count.csv").back()[0] == 2.0);
    const auto force = run("force.csv");
    bool touches = false;
    int ticks = 0;
    for (const Row& row : force) {
        touches = row[0] > 0.2 || (touches && row[0] > 0.1);
        ticks += touches;
    }
    CHECK(run("time.csv").back()[0] == Approx(1e-3 * ticks));
}

TEST_CASE("every small patch is short, drawn without an error, and named on its page") {
    const std::filesystem::path folder = tactus::test::source_folder() / "docs/how-to";
    const std::string page = tactus::test::slurp(folder / "gallery.md");
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "patches")) {
        const std::string text = tactus::test::slurp(entry.path());
        CAPTURE(entry.path().filename().string());
        CHECK(std::ranges::count(text, '\n') <= 25);
        CHECK(text.starts_with("# "));
        CHECK(page.find("patches/" + entry.path().filename().string()) != std::string::npos);
        const std::string picture = "pictures/gallery/" + entry.path().stem().string() + ".svg";
        CHECK(page.find(picture) != std::string::npos);
        CHECK(std::filesystem::exists(folder.parent_path() / picture));
        const Folder scratch;
        CHECK(scratch.tactus("draw " + entry.path().string() + " -o " + scratch.path.string() + "/p.svg").code == 0);
        ++count;
    }
    CHECK(count >= 25);
}
