// SPDX-License-Identifier: Apache-2.0
#include "dsp/control/switched_loop.hpp"

#include "dsp/control/controller.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

using namespace tactus;
using control::ControllerSettings;

namespace {

/// A finger of 3 N/mm on an object of 1 N/mm and 20 g that begins at 3 mm.
ControllerSettings one_sided_mass() {
    ControllerSettings settings;
    settings.object = {.stiffness = 1000.0, .mass = 0.02, .one_sided = true, .rest = 3e-3};
    settings.loop.gain = 0.0;
    settings.loop.motor_lag = 2e-3;
    settings.max_speed = 0.07;
    settings.stuck_speed = 1e9;
    return settings;
}

/// The finger under AdmittanceControl, pressed to `squeeze` m; how far it still moves to and fro after 40 s.
double left_over(const ControllerSettings& settings, control::AdmittanceControl& control, double squeeze) {
    const double period = settings.loop.period;
    double x = 0.0, speed = 0.0, low = 1e9, high = -1e9;
    std::array<double, 9> under_way{};
    const int ticks = static_cast<int>(40.0 / period);
    for (int n = 0; n < ticks; ++n) {
        const double hand = n * period < 0.5 ? 0.0 : squeeze;
        std::shift_right(under_way.begin(), under_way.end(), 1);
        under_way[0] = control.tick(settings.loop.hand_stiffness * (hand - x), x, control::Fault::none, 1);
        const double command = under_way[static_cast<std::size_t>(settings.loop.delay)];
        // The motor in 50 steps of a period.
        for (int i = 0; i < 50; ++i) {
            const double h = period / 50.0,
                         gained = settings.loop.motor_lag > 0.0 ? -std::expm1(-h / settings.loop.motor_lag) : 1.0;
            speed += gained * (command - speed);
            x += speed * h;
        }
        if (n < ticks * 3 / 4) continue;
        low = std::min(low, x);
        high = std::max(high, x);
    }
    return control.fault() == control::Fault::none ? high - low : 1.0;
}

}  // namespace

TEST_CASE("a one-sided object with a mass is rendered with a gain at which a stiff finger comes to rest") {
    ControllerSettings settings = one_sided_mass();
    // What two linear limits alone accept oscillates by a tenth of a millimetre and more, for ever.
    settings.loop.gain = 0.5 * control::gain_limit(settings.loop, settings.object);
    control::AdmittanceControl blind;
    CHECK_FALSE(blind.set(settings));
    settings.allow_unstable = true;
    REQUIRE(blind.set(settings));
    double most = 0.0;
    for (const double squeeze : {3.02e-3, 3.1e-3, 3.2e-3, 3.5e-3, 5e-3, 8e-3}) {
        control::AdmittanceControl fresh;
        REQUIRE(fresh.set(settings));
        most = std::max(most, left_over(settings, fresh, squeeze));
    }
    CHECK(most > 1e-4);
    settings.allow_unstable = false;
    settings.loop.gain = 0.0;
    control::AdmittanceControl judged;
    REQUIRE(judged.set(settings));
    CHECK(judged.gain() > 1.0);
    CHECK(left_over(settings, judged, 3.5e-3) < 1e-5);
}

TEST_CASE("no accepted one-sided object oscillates at its edge") {
    const Random random{41};
    int judged = 0;
    std::vector<std::uint64_t> numbers(40);
    std::iota(numbers.begin(), numbers.end(), 0);
    // Of the first 1600 those that a loop without a largest speed calls still: the motor saturates and they swing by 1.6 mm.
    numbers.insert(numbers.end(), {492, 1191});
    for (const std::uint64_t i : numbers) {
        const auto between = [&](std::uint64_t which, double low, double high) {
            return low * std::pow(high / low, random.uniform(16 * i + which));
        };
        ControllerSettings settings = one_sided_mass();
        settings.object.stiffness = between(0, 100.0, 5000.0);
        settings.object.mass = random.uniform(16 * i + 1) < 0.3 ? 0.0 : between(2, 2e-3, 0.5);
        settings.object.damping = random.uniform(16 * i + 3) < 0.5 ? 0.0 : between(4, 1.0, 50.0);
        settings.object.free_damping = between(5, 20.0, 300.0);
        settings.loop.hand_stiffness = between(6, 200.0, 3000.0);
        settings.loop.motor_lag = between(7, 1e-3, 10e-3);
        control::AdmittanceControl control;
        if (!control.set(settings)) continue;
        ++judged;
        for (const double squeeze : {3.2e-3, 5e-3}) {
            control::AdmittanceControl fresh;
            REQUIRE(fresh.set(settings));
            const double moves = left_over(settings, fresh, squeeze);
            INFO(i << ": " << settings.object.stiffness << " N/m, " << settings.object.mass << " kg, "
                   << settings.object.damping << " and " << settings.object.free_damping << " N s/m, finger "
                   << settings.loop.hand_stiffness << " N/m, gain " << fresh.gain() << ", " << squeeze);
            CHECK(moves < 0.1 * squeeze);
        }
    }
    CHECK(judged > 20);
}

TEST_CASE("an object with two sides keeps the limit of its linear loop") {
    control::LoopModel loop;
    control::ObjectSettings object;
    CHECK(control::switched_gain_limit(loop, object) == control::gain_limit(loop, object));
}
