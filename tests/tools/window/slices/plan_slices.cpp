// SPDX-License-Identifier: Apache-2.0
// Slices beside the scene of a plan: their scan and the outlines in them.
#include "assets/plan/plan_file.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/rotation.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/window/files/window_memory.hpp"
#include "tools/window/slices/plan_outlines.hpp"
#include "tools/window/slices/plan_scan.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>

using namespace tactus;
using namespace tactus::window;
using tactus::test::Folder;

namespace {

/// Distances of a ball about the origin; `hollow`: the radius of a cavity.
volume::Grid ball(double radius, double hollow = 0.0) {
    volume::Grid grid{{61, 61, 61}, Vec3(-15.0 * mm), Vec3(0.5 * mm), {}};
    for (int k = 0; k < 61; ++k)
        for (int j = 0; j < 61; ++j)
            for (int i = 0; i < 61; ++i) {
                const double r = glm::length(grid.position(i, j, k));
                grid.values.push_back(static_cast<float>(std::max(r - radius, hollow - r)));
            }
    return grid;
}

double length_of(const Outline& line) {
    double length = 0.0;
    for (std::size_t n = 1; n < line.size(); ++n) length += glm::length(line[n] - line[n - 1]);
    return length;
}

}  // namespace

TEST_CASE("a slice cuts a ball in a circle, wherever it lies, and a hollow one in two") {
    const geometry::TriangleSurface surface = geometry::iso_surface(ball(10.0 * mm), 0.0f, false);
    const Pose pose{Vec3(31.0, -7.0, 52.0) * mm, rotation_by({0.4, -1.1, 0.7})};
    for (const Slice slice : {Slice::axial, Slice::coronal, Slice::sagittal}) {
        const int normal = axes_of(slice).normal;
        const double off = 4.0 * mm, at = pose.position[normal] + off;
        const auto lines = cut_outlines(surface, pose, slice, at);
        REQUIRE(lines.size() == 1);
        CHECK(lines[0].front() == lines[0].back());
        const double radius = std::sqrt(100.0 - 16.0) * mm;
        Vec3 middle = pose.position;
        middle[normal] = at;
        for (const Vec3& p : lines[0]) {
            CHECK(std::abs(p[normal] - at) < 1e-12);
            CHECK(glm::length(p - middle) == Approx(radius).margin(0.05 * mm));
        }
        CHECK(length_of(lines[0]) == Approx(2.0 * std::numbers::pi * radius).epsilon(0.01));
        CHECK(cut_outlines(surface, pose, slice, pose.position[normal] + 10.5 * mm).empty());
    }
    const auto both =
        cut_outlines(geometry::iso_surface(ball(10.0 * mm, 5.0 * mm), 0.0f, false), {}, Slice::axial, 0.0);
    REQUIRE(both.size() == 2);
    CHECK(length_of(both[0]) + length_of(both[1]) == Approx(2.0 * std::numbers::pi * 15.0 * mm).epsilon(0.01));
}

TEST_CASE("a fragment that was moved has an outline where it is and a second one where it was scanned") {
    auto body = std::make_shared<observe::SeenBody>();
    body->content_hash = 7;
    body->home = {Vec3(10.0, 0.0, 0.0) * mm, {1.0, 0.0, 0.0, 0.0}};
    body->distance = ball(6.0 * mm);
    PlanOutlines outlines;
    std::map<std::size_t, render::SceneModel::PlanPiece> pieces;
    pieces[3] = {body, Vec3(1.0, 0.0, 0.0), body->home, true};
    for (int n = 0; n < 2000 && outlines.cut(pieces, Slice::axial, 0.0).empty(); ++n)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    REQUIRE(outlines.cut(pieces, Slice::axial, 0.0).size() == 1);
    CHECK_FALSE(outlines.cut(pieces, Slice::axial, 0.0)[0].is_scanned);
    pieces[3].pose.position = Vec3(40.0, 5.0, 2.0) * mm;
    const auto& two = outlines.cut(pieces, Slice::axial, 0.0);
    REQUIRE(two.size() == 2);
    for (const PlanOutlines::Piece& piece : two) {
        const Vec3 middle = piece.is_scanned ? body->home.position : Vec3(40.0, 5.0, 0.0) * mm;
        const double radius = piece.is_scanned ? 6.0 * mm : std::sqrt(36.0 - 4.0) * mm;
        CHECK(piece.is_chosen == !piece.is_scanned);
        for (const Vec3& p : (*piece.lines)[0]) CHECK(glm::length(p - middle) == Approx(radius).margin(0.05 * mm));
    }
    // Turned about its own middle it is elsewhere, too; hidden it is nowhere.
    pieces[3].pose = {body->home.position, rotation_by({0.0, 0.0, 0.5})};
    CHECK(outlines.cut(pieces, Slice::axial, 0.0).size() == 2);
    pieces.clear();
    CHECK(outlines.cut(pieces, Slice::axial, 0.0).empty());
}

TEST_CASE("grids of fragments are joined as each sample's nearest neighbours say") {
    const auto made = [](std::array<int, 3> size, const Vec3& origin, double spacing, float first) {
        volume::Grid grid{size, origin, Vec3(spacing), {}};
        for (std::size_t n = 0; n < grid.count(); ++n)
            grid.values.push_back(first + static_cast<float>((n * 37) % 101));
        return grid;
    };
    const std::vector<volume::Grid> grids{made({7, 5, 6}, Vec3(-3.0, 2.0, 1.0) * mm, 0.5 * mm, 1.0f),
                                          {},
                                          made({4, 6, 5}, Vec3(-1.8, 2.7, 1.9) * mm, 0.8 * mm, 60.0f)};
    const volume::Grid joined = joined_grids(grids, 1'000'000);
    CHECK(joined.spacing == Vec3(0.5 * mm));
    CHECK(joined.origin == Vec3(-3.0, 2.0, 1.0) * mm);
    int inside_of_both = 0;
    for (int k = 0; k < joined.size[2]; ++k)
        for (int j = 0; j < joined.size[1]; ++j)
            for (int i = 0; i < joined.size[0]; ++i) {
                float most = 0.0f;
                int of = 0;
                bool is_at_border = false;
                for (const volume::Grid& grid : grids) {
                    if (grid.values.empty()) continue;
                    const Vec3 u = (joined.position(i, j, k) - grid.origin) / grid.spacing;
                    bool is_inside = true;
                    for (int a = 0; a < 3; ++a) {
                        const double last = grid.size[static_cast<std::size_t>(a)] - 0.5;
                        is_inside = is_inside && u[a] > -0.5 && u[a] < last;
                        // Halfway between two samples either one is the nearest.
                        is_at_border = is_at_border || std::abs(u[a] - std::floor(u[a]) - 0.5) < 1e-6;
                    }
                    if (!is_inside) continue;
                    ++of;
                    most =
                        std::max(most, grid.at(static_cast<int>(std::lround(u.x)), static_cast<int>(std::lround(u.y)),
                                               static_cast<int>(std::lround(u.z))));
                }
                if (is_at_border) continue;
                inside_of_both += of == 2;
                CHECK(joined.at(i, j, k) == most);
            }
    CHECK(inside_of_both > 5);
    CHECK(joined_grids(grids, 100).values.empty());
    CHECK(joined_grids({}, 100).values.empty());
    CHECK(joined_grids({volume::Grid{}}, 100).values.empty());
}

TEST_CASE("a scan is read beside the pictures, and one that is none is refused") {
    const Folder folder;
    volume::Grid grid{{8, 9, 10}, Vec3(1.0, 2.0, 3.0) * mm, Vec3(2.0 * mm), {}};
    for (std::size_t n = 0; n < grid.count(); ++n) grid.values.push_back(n % 2 ? 1000.0f : -1000.0f);
    volume::write_volume(grid, volume::WrittenType::int16, folder.path / "ct.nrrd");
    PlanScan scan;
    CHECK_FALSE(scan.tend());
    const auto wait = [&] {
        for (int n = 0; n < 2000 && scan.is_reading(); ++n) {
            if (scan.tend()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        return false;
    };
    scan.read(folder.path / "ct.nrrd");
    REQUIRE(wait());
    CHECK(scan.now()->name == "ct.nrrd");
    CHECK(scan.now()->grid.size == grid.size);
    CHECK(glm::length(scan.now()->grid.origin - grid.origin) < 1e-9);
    CHECK(scan.now()->grid.at(1, 0, 0) == 1000.0f);
    CHECK(scan.now()->window.high > scan.now()->window.low);
    scan.read(folder.write("broken.nrrd", "NRRD0004\ntype: short\n"));
    CHECK_THROWS_AS(wait(), Error);
    // What was read before stays.
    CHECK(scan.now()->name == "ct.nrrd");
    CHECK_FALSE(scan.is_reading());
    const std::vector<std::uint8_t> labels(grid.count(), 1);
    const std::vector<volume::Segment> segments{{1, "bone"}};
    volume::write_labels(grid, labels, segments, folder.path / "labels.nrrd");
    CHECK_THROWS_AS(read_plan_scan(folder.path / "labels.nrrd"), Error);
}

TEST_CASE("plans are of one case when they share the bytes of a fragment, not its name") {
    const Folder folder;
    const auto plan_of = [&](const std::string& name, std::vector<std::uint64_t> hashes) {
        plan::CasePlan plan;
        for (const std::uint64_t hash : hashes) {
            const std::string fragment = "fragment_0" + std::to_string(plan.fragments.size() + 1);
            plan.fragments.push_back({fragment, fragment + ".vdb", hash});
        }
        plan::save_case_plan(plan, folder.path / name);
        return folder.path / name;
    };
    const auto mine = plan_of("mine.plan.json", {11, 12}), changed = plan_of("changed-1.plan.json", {12, 13, 14}),
               another = plan_of("another.plan.json", {21, 22});
    CHECK(are_of_one_case(mine, mine));
    CHECK(are_of_one_case(mine, changed));
    CHECK_FALSE(are_of_one_case(mine, another));
    CHECK_FALSE(are_of_one_case(mine, folder.path / "gone.plan.json"));
    CHECK_FALSE(are_of_one_case(folder.write("cut.plan.json", "{"), mine));
}

TEST_CASE("the window remembers the scan of a plan") {
    const Folder folder;
    const auto file = folder.path / "state/window.json";
    WindowMemory(file).keep_scan(folder.path / "case.plan.json", folder.path / "ct.nrrd");
    CHECK(WindowMemory(file).scan_of(folder.path / "case.plan.json").filename() == "ct.nrrd");
    CHECK(WindowMemory(file).scan_of(folder.path / "other.plan.json").empty());
}
