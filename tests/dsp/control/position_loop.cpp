// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/position_loop.hpp"
#include "tests/support/catch.hpp"

#include <cmath>

using namespace tactus;

namespace {

constexpr double loop_period = 1.0 / 150.0;

/// A motor that turns at 30 mm/s or not at all below that, and acts a period after it was told.
struct Coarse {
    control::PositionLoopSettings settings{75.0, 0.0, 0.0, 0.6, 0.03, 1};
    control::PositionLoop loop;
    double position = 0.0, told = 0.0;
    int moves = 0;

    double tick(double wanted) {
        const double command = loop(settings, wanted, position, 0.0, loop_period);
        const double share = std::abs(told) < 0.015 ? 0.0 : std::max(0.03, std::abs(told));
        moves += share > 0.0;
        position += std::copysign(share, told) * loop_period;
        told = command;
        return position;
    }
};

}  // namespace

TEST_CASE("a motor with a slowest speed comes within six tenths of a step and then rests") {
    Coarse motor;
    const double step = 0.03 * loop_period;  // 0.2 mm
    for (const double wanted : {0.75 * step, 1.43e-3, -0.77e-3, 0.1e-3, 5e-3}) {
        for (int n = 0; n < 150; ++n) motor.tick(wanted);
        CHECK(std::abs(motor.position - wanted) <= 0.6 * step);
        const int before = motor.moves;
        for (int n = 0; n < 150; ++n) motor.tick(wanted);
        CHECK(motor.moves == before);
    }
    Coarse plain;
    plain.settings.least_speed = 0.0;
    for (int n = 0; n < 150; ++n) plain.tick(0.75 * step);
    CHECK(plain.position == 0.0);
}

TEST_CASE("where the motor turns at any speed nothing is stepped") {
    control::PositionLoop loop;
    const control::PositionLoopSettings settings{40.0, 0.0, 0.0, 0.07, 0.0, 1};
    for (const double wanted : {1e-6, -1e-5, 1e-4})
        CHECK(loop(settings, wanted, 0.0, 0.0, loop_period) == 40.0 * wanted);
}
