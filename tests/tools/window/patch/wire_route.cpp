// SPDX-License-Identifier: Apache-2.0
#include "tools/window/document/wire_route.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus::window;

namespace {

//   a ─┐        ┌─ d
//      b   c    b, c: boxes between
//   e           f
const std::vector<Box> boxes{{0, 0, 100, 60},    {200, 0, 300, 60},    {400, 0, 500, 60},    {600, 0, 700, 60},
                             {0, 100, 100, 160}, {600, 100, 700, 160}, {200, 100, 300, 160}, {400, 100, 500, 160}};
const std::vector<double> levels{180.0};

bool is_hidden(const std::vector<BezierCurve>& way) {
    for (const BezierCurve& piece : way)
        for (int i = 0; i <= 40; ++i) {
            const Point at = on_curve(piece, i / 40.0);
            for (const Box& box : boxes)
                if (Box{box.left + 0.5, box.top + 0.5, box.right - 0.5, box.bottom - 0.5}.contains(at)) return true;
        }
    return false;
}

bool is_whole(const std::vector<BezierCurve>& way, Point from, Point to) {
    const auto same = [](Point a, Point b) { return std::hypot(a.x - b.x, a.y - b.y) < 1e-9; };
    for (std::size_t i = 1; i < way.size(); ++i)
        if (!same(way[i - 1].back(), way[i].front())) return false;
    return same(way.front().front(), from) && same(way.back().back(), to);
}

}  // namespace

TEST_CASE("a wire with nothing between its ends is one curve") {
    WireRouter router(boxes, levels);
    const auto way = router.way({100, 30}, {200, 40}, 0);
    REQUIRE(way.size() == 1);
    CHECK(is_whole(way, {100, 30}, {200, 40}));
    CHECK(WireRouter({}, {}).way({100, 30}, {600, 40}, 0).size() == 1);
}

TEST_CASE("a wire goes around the boxes between its ends, forward and back, and arrives from the left") {
    WireRouter router(boxes, levels);
    for (const auto& [from, to] : {std::pair{Point{100, 30}, Point{600, 30}},
                                   {Point{100, 130}, Point{600, 40}},
                                   {Point{500, 30}, Point{200, 20}},
                                   {Point{300, 120}, Point{200, 140}},
                                   {Point{700, 130}, Point{0, 30}}}) {
        const auto way = router.way(from, to, 0);
        INFO("from " << from.x << ", " << from.y << " to " << to.x << ", " << to.y);
        CHECK(is_whole(way, from, to));
        CHECK_FALSE(is_hidden(way));
        CHECK(on_curve(way.front(), 0.05).x > from.x);
        CHECK(on_curve(way.back(), 0.95).x < to.x);
    }
}

TEST_CASE("wires of one output run together, those of others beside them") {
    WireRouter router(boxes, levels);
    const auto level = [](const std::vector<BezierCurve>& way) { return on_curve(way[1], 0.5).y; };
    const auto first = router.way({100, 30}, {600, 30}, 1), branch = router.way({100, 30}, {400, 30}, 1),
               other = router.way({100, 40}, {600, 40}, 2);
    REQUIRE((first.size() == 3 && branch.size() == 3 && other.size() == 3));
    CHECK(level(first) == Approx(level(branch)));
    CHECK(std::abs(level(first) - level(other)) >= 3.0);
    CHECK_FALSE(is_hidden(other));
}
