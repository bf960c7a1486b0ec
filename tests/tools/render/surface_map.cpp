// SPDX-License-Identifier: Apache-2.0
#include "tools/render/surface_map.hpp"

#include "assets/plan/plan_file.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/fit/gap.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/box_stl.hpp"
#include "tests/tools/run_command.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/render/body_surface.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tactus;
using namespace tactus::render;
using namespace tactus::test;

namespace {

/// Two boxes with 1 mm between them, as a run shows them: each in a frame of its own.
struct Boxes {
    Folder folder;
    std::string plan = (folder.path / "case.plan.json").string();
    std::vector<std::shared_ptr<const observe::SeenBody>> bodies;
    std::vector<std::vector<Vec3>> vertices;  ///< in the frame of the file

    Boxes() {
        folder.write("a.stl", box_stl(Vec3(0.0), Vec3(10.0, 12.0, 14.0), false));
        folder.write("b.stl", box_stl(Vec3(11.0, 0.0, 0.0), Vec3(20.0, 12.0, 14.0), false));
        REQUIRE(folder
                    .tactus("plan new " + plan + " " + (folder.path / "a.stl").string() + " " +
                            (folder.path / "b.stl").string())
                    .code == 0);
        const auto fragments = analysis::load_fragments(plan::load_case_plan(plan), folder.path);
        for (std::size_t n = 0; n < fragments.size(); ++n) {
            auto body = std::make_shared<observe::SeenBody>();
            body->content_hash = 100 + n;
            body->home.position = Vec3(5.0 * mm, -3.0 * mm, 40.0 * mm * static_cast<double>(n));
            body->distance = fragments[n].map.grid;
            body->distance.origin -= body->home.position;
            const BodySurface surface =
                make_body_surface(*body, contact::make_voxmap(body->distance), Vec3(0.0), Vec3(0.0));
            vertices.emplace_back();
            for (const auto& v : surface.patch.vertices)
                vertices.back().push_back(
                    body->home.apply(Vec3(static_cast<double>(v.position[0]), static_cast<double>(v.position[1]),
                                          static_cast<double>(v.position[2]))));
            bodies.push_back(body);
        }
    }
    SurfaceMap map(SurfaceMap::Kind kind) const {
        return make_surface_map(kind, plan::load_case_plan(plan), folder.path, bodies);
    }
    /// m, on the middle of the face of the first box at `x`: least and greatest.
    std::pair<double, double> on_first(const SurfaceMap& map, double x) const {
        double low = INFINITY, high = -INFINITY;
        const std::vector<float>& distance = map.distance.at(100);
        REQUIRE(distance.size() == vertices[0].size());
        for (std::size_t n = 0; n < distance.size(); ++n) {
            const Vec3& at = vertices[0][n];
            if (std::abs(at.x - x) > 0.1 * mm || std::abs(at.y - 6.0 * mm) > 3.0 * mm ||
                std::abs(at.z - 7.0 * mm) > 3.0 * mm)
                continue;
            low = std::min(low, static_cast<double>(distance[n]));
            high = std::max(high, static_cast<double>(distance[n]));
        }
        return {low, high};
    }
    double told() const {
        const auto gaps = analysis::plan_gaps(plan::load_case_plan(plan), folder.path, std::pair{0, 1});
        REQUIRE(gaps.size() == 1);
        return gaps[0].gap.median;
    }
};

}  // namespace

TEST_CASE("faces that nearly touch overlap nowhere, and those that lie in each other do") {
    Boxes boxes;
    for (const double gap : {0.05, -0.3}) {
        INFO(gap << " mm");
        REQUIRE(
            boxes.folder.tactus("plan move " + boxes.plan + " b --pose " + std::to_string(gap - 1.0) + ",0,0,1,0,0,0")
                .code == 0);
        const auto gaps = analysis::plan_gaps(plan::load_case_plan(boxes.plan), boxes.folder.path, std::pair{0, 1});
        REQUIRE(gaps.size() == 1);
        CHECK((gaps[0].overlap > 0.0) == (gap < 0.0));
        CHECK((gaps[0].gap.deepest > 0.1 * mm) == (gap < 0.0));
    }
}

TEST_CASE("a map of gaps has on a face what the plan's gap says, and nothing where nothing faces it") {
    Boxes boxes;
    for (const double gap : {1.0, 0.5, -0.2}) {
        INFO(gap << " mm");
        REQUIRE(
            boxes.folder.tactus("plan move " + boxes.plan + " b --pose " + std::to_string(gap - 1.0) + ",0,0,1,0,0,0")
                .code == 0);
        const SurfaceMap map = boxes.map(SurfaceMap::Kind::gaps);
        const auto [low, high] = boxes.on_first(map, 10.0 * mm);
        CHECK(low == Approx(boxes.told()).margin(0.02 * mm));
        CHECK(high == Approx(boxes.told()).margin(0.02 * mm));
        CHECK(low == Approx(gap * mm).margin(0.03 * mm));
        const auto [away, farthest] = boxes.on_first(map, 0.0);
        CHECK(std::isinf(away));
        CHECK(std::isinf(farthest));
    }
    // What is hidden faces nothing.
    REQUIRE(boxes.folder.tactus("plan hide " + boxes.plan + " b").code == 0);
    CHECK(std::isinf(boxes.on_first(boxes.map(SurfaceMap::Kind::gaps), 10.0 * mm).first));
    CHECK_THROWS_AS(boxes.map(SurfaceMap::Kind::healthy), Error);
}

TEST_CASE("of several neighbours an overlap is shown, the deepest one, and without one the smallest gap") {
    const Folder folder;
    // The face of the first box at x = 10 is 2 mm inside the second and 0.5 mm before the third; that at x = 0 is
    // 1 mm from the fourth and 0.4 mm from the fifth; those of the others are as the formula says.
    const std::pair<Vec3, Vec3> all[] = {{Vec3(0.0), Vec3(10.0, 12.0, 14.0)},
                                         {Vec3(8.0, 0.0, 0.0), Vec3(20.0, 12.0, 14.0)},
                                         {Vec3(10.5, 0.0, 0.0), Vec3(22.0, 12.0, 14.0)},
                                         {Vec3(-9.0, 0.0, 0.0), Vec3(-1.0, 12.0, 14.0)},
                                         {Vec3(-7.0, 0.0, 0.0), Vec3(-0.4, 12.0, 14.0)}};
    std::string files;
    for (std::size_t n = 0; n < std::size(all); ++n) {
        folder.write(std::string(1, static_cast<char>('a' + n)) + ".stl", box_stl(all[n].first, all[n].second));
        files += " " + (folder.path / (std::string(1, static_cast<char>('a' + n)) + ".stl")).string();
    }
    const std::string plan_file = (folder.path / "case.plan.json").string();
    REQUIRE(folder.tactus("plan new " + plan_file + files).code == 0);
    const plan::CasePlan plan = plan::load_case_plan(plan_file);
    const auto fragments = analysis::load_fragments(plan, folder.path);
    std::vector<std::shared_ptr<const observe::SeenBody>> bodies;
    for (std::size_t n = 0; n < fragments.size(); ++n) {
        auto body = std::make_shared<observe::SeenBody>();
        body->content_hash = 100 + n;
        body->distance = fragments[n].map.grid;
        bodies.push_back(body);
    }
    const SurfaceMap map = make_surface_map(SurfaceMap::Kind::gaps, plan, folder.path, bodies);
    const SurfaceMapper mapper(SurfaceMap::Kind::gaps, plan, folder.path);
    const std::vector<std::optional<Pose>> here(fragments.size(), Pose{});
    CHECK(mapper.map(bodies, here).distance == map.distance);
    std::vector<std::optional<Pose>> without = here;
    without[1].reset();  // hidden
    const SurfaceMap other = mapper.map(bodies, without);
    std::size_t on_right = 0, on_left = 0, seen = 0;
    for (std::size_t i = 0; i < fragments.size(); ++i) {
        const auto surface =
            make_body_surface(*bodies[i], contact::make_voxmap(bodies[i]->distance), Vec3(0.0), Vec3(0.0));
        const auto& vertices = surface.patch.vertices;
        const std::vector<float>& distance = map.distance.at(100 + i);
        REQUIRE(distance.size() == vertices.size());
        for (std::size_t n = 0; n < vertices.size(); ++n) {
            // By brute force: each neighbour by itself.
            contact::SurfacePoint point;
            for (int axis = 0; axis < 3; ++axis) {
                point.position[axis] = static_cast<double>(vertices[n].position[static_cast<std::size_t>(axis)]);
                point.normal[axis] = static_cast<double>(vertices[n].normal[axis]);
            }
            point.normal = glm::normalize(point.normal);
            std::vector<float> overlaps, gaps;
            for (std::size_t j = 0; j < fragments.size(); ++j) {
                if (j == i) continue;
                const float d = fit::gap_between(std::span(&point, 1), {}, fragments[j].map, {}).distance[0];
                (d < 0.0f ? overlaps : gaps).push_back(d);
            }
            std::ranges::sort(overlaps);
            std::ranges::sort(gaps);
            const float wanted = overlaps.empty() ? gaps.front() : overlaps.front();
            ++seen;
            if (distance[n] != wanted) FAIL(distance[n] << " but by brute force " << wanted);
            if (i != 0 || std::abs(point.position.y - 6.0 * mm) > 3.0 * mm ||
                std::abs(point.position.z - 7.0 * mm) > 3.0 * mm)
                continue;
            if (std::abs(point.position.x - 10.0 * mm) < 0.1 * mm) {
                ++on_right;
                CHECK(static_cast<double>(distance[n]) == Approx(-2.0 * mm).margin(0.05 * mm));
                CHECK(static_cast<double>(other.distance.at(100)[n]) == Approx(0.5 * mm).margin(0.05 * mm));
            }
            if (std::abs(point.position.x) < 0.1 * mm) {
                ++on_left;
                CHECK(static_cast<double>(distance[n]) == Approx(0.4 * mm).margin(0.05 * mm));
            }
        }
    }
    CHECK(on_right > 50);
    CHECK(on_left > 50);
    CHECK(seen > 5000);
}

TEST_CASE("colours of a map are full at its range, red for gaps and blue for overlaps, and so says its legend") {
    const Vec3 none = map_colour(0.0, mm), wide = map_colour(mm, mm), inside = map_colour(-mm, mm);
    CHECK(map_colour(9.0, mm) == wide);
    CHECK(map_colour(-9.0, mm) == inside);
    CHECK(glm::length(map_colour(0.5 * mm, mm) - 0.5 * (none + wide)) < 1e-12);
    CHECK((wide.x > 0.7 && wide.z < 0.3));
    CHECK((inside.z > 0.6 && inside.x < 0.3));
    const auto scales = map_scales(SurfaceMap::Kind::gaps, 1.5 * mm);
    REQUIRE(scales.size() == 2);
    CHECK((scales[0].low == none && scales[0].high == wide && scales[0].high_text == "1.5"));
    CHECK((scales[1].low == none && scales[1].high == inside));
    CHECK(map_scales(SurfaceMap::Kind::healthy, mm).size() == 1);
}
