// SPDX-License-Identifier: Apache-2.0
// The small patches of the how-to pages: each follows the law that its comment states.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
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

    Folder folder;
};

/// Compares one component of the recorded force with a law of position and velocity, and sees that the force acts.
void check_law(const std::string& name, std::size_t component,
               const std::function<double(const Row& pose, const Row& twist)>& law) {
    const Rendered run(name);
    const auto force = run("force.csv"), pose = run("pose.csv"), twist = run("twist.csv");
    REQUIRE(force.size() == 2000);
    double largest = 0.0, off = 0.0;
    for (std::size_t k = 0; k < force.size(); ++k) {
        const double wanted = law(pose[k], twist[k]);
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
        const double mm = -1e3 * p[z];
        const double points[][2] = {{0.0, 0.0}, {2.0, 1.2}, {2.6, 0.5}, {3.5, 0.6}, {5.5, 3.0}};
        if (mm <= 0.0) return 0.0;
        for (std::size_t i = 1; i < std::size(points); ++i)
            if (mm <= points[i][0])
                return points[i - 1][1] +
                       (points[i][1] - points[i - 1][1]) * (mm - points[i - 1][0]) / (points[i][0] - points[i - 1][0]);
        return 3.0;
    });
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
    const std::string page = tactus::test::slurp(folder / "compute-with-values.md");
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "patches")) {
        const std::string text = tactus::test::slurp(entry.path());
        CAPTURE(entry.path().filename().string());
        CHECK(std::ranges::count(text, '\n') <= 25);
        CHECK(text.starts_with("# "));
        CHECK(page.find("patches/" + entry.path().filename().string()) != std::string::npos);
        const Folder scratch;
        CHECK(scratch.tactus("draw " + entry.path().string() + " -o " + scratch.path.string() + "/p.svg").code == 0);
        ++count;
    }
    CHECK(count >= 12);
}
