// SPDX-License-Identifier: Apache-2.0
#include "dsp/volume/outer_shell.hpp"
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

using namespace tactus;

TEST_CASE("dsp: the outer shell fills what is reached through a narrow hole and keeps the outside") {
    constexpr double outer = 12.0 * mm, inner = 9.0 * mm, hole = 1.5 * mm;
    volume::Grid ball{{45, 45, 45}, Vec3(-22.0 * mm), Vec3(1.0 * mm), {}};
    for (int k = 0; k < 45; ++k)
        for (int j = 0; j < 45; ++j)
            for (int i = 0; i < 45; ++i) {
                const Vec3 p = ball.position(i, j, k);
                const double r = glm::length(p), wall = std::max(r - outer, inner - r);
                const double bore = hole - std::hypot(p.x, p.y);
                ball.values.push_back(static_cast<float>(p.z > 0.0 ? std::max(wall, bore) : wall));
            }
    REQUIRE(ball.at(22, 22, 22) > 0.0f);
    REQUIRE(ball.at(22, 22, 32) > 0.0f);
    const volume::Grid shell = volume::outer_shell(ball, 3.0 * mm);
    CHECK(shell.at(22, 22, 22) < -10.0 * mm);
    CHECK(shell.at(22, 22, 32) < 0.0f);
    for (int k = 0; k < 45; ++k)
        for (int j = 0; j < 45; ++j)
            for (int i = 0; i < 45; ++i) {
                const Vec3 p = ball.position(i, j, k);
                const double r = glm::length(p);
                const bool is_near_hole = p.z > 0.0 && std::hypot(p.x, p.y) < 5.0 * mm;
                if (!is_near_hole && std::abs(r - outer) < 2.0 * mm)
                    CHECK(shell.at(i, j, k) == Approx(r - outer).margin(0.1 * mm));
            }
}
