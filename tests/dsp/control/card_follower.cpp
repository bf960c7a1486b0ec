// SPDX-License-Identifier: Apache-2.0
// A simulated card with a clock of its own and an engine that follows it, hours in a second.
#include "dsp/control/card_follower.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"

#include <cmath>
#include <functional>

using namespace tactus;

namespace {

struct Simulation {
    double rate = 48000.0;
    double ppm = 0.0;                 // the card runs faster than its name by so much
    double margin_s = 0.005;
    double callback_jitter_s = 2e-4;  // callbacks come late by up to this
    double engine_jitter_s = 5e-4;
    std::function<std::int64_t(std::uint64_t)> frames = [](std::uint64_t) { return 64; };  // of the n-th callback
    std::function<double(double)> ppm_at = [](double) { return 0.0; };                     // on top, over seconds
    double card_stalls_every_s = 0.0, card_stall_s = 0.0;      // an xrun: the card itself stands still
    double engine_stalls_every_s = 0.0, engine_stall_s = 0.0;  // the engine's thread does
    double settle_s = 60.0;                                    // what follows is measured

    // What came of it.
    std::int64_t underflows = 0, silent_frames = 0, left_out = 0, late_underflows = 0;
    std::int64_t lowest = 1 << 30, highest = 0;  // ring after a callback, once settled
    double steepest = 0.0;                       // deviation of the clock's slope, once settled
    double bend = 0.0;                           // largest change of it from one look to the next
    std::int64_t backwards = 0;
    double rate_error_ppm = 0.0, excess_s = 0.0;
    std::int64_t target = 0;

    void run(double hours) {
        const Random random{11};
        const double end_ns = hours * 3600e9;
        control::CardFollower follower;
        follower.prepare(rate, margin_s);
        control::TrimmedClock clock{0, 20'000'000, 1.0};
        const Flicks frame = std::llround(static_cast<double>(flicks_per_second) / rate);
        const std::int64_t quantum = 48;
        control::CardView card;
        std::int64_t made = 0, left_to_skip = 0;
        bool playing = false;
        double card_ns = 0.0, next_look = 0.0;
        double engine_free_ns = 0.0, next_card_stall = card_stalls_every_s * 1e9,
               next_engine_stall = engine_stalls_every_s * 1e9;
        std::int64_t last_when = 0;
        double last_slope = 1.0;
        std::int64_t due = clock.when(0);
        for (std::uint64_t n = 0; card_ns < end_ns; ++n) {
            const std::int64_t wanted = frames(n);
            const double true_rate = rate * (1.0 + (ppm + ppm_at(card_ns * 1e-9)) * 1e-6);
            card_ns += static_cast<double>(wanted) * 1e9 / true_rate;
            if (card_stall_s > 0.0 && card_ns > next_card_stall) {
                card_ns += card_stall_s * 1e9;
                next_card_stall += card_stalls_every_s * 1e9;
            }
            const double now = card_ns + callback_jitter_s * 1e9 * random.uniform(2 * n);
            // The engine up to now.
            for (;;) {
                const double jitter = engine_jitter_s * 1e9 * random.uniform(2 * static_cast<std::uint64_t>(made) + 1);
                const double at = std::max(static_cast<double>(due) + jitter, engine_free_ns);
                if (at > now) break;
                if (engine_stall_s > 0.0 && at > next_engine_stall) {
                    engine_free_ns = at + engine_stall_s * 1e9;
                    next_engine_stall += engine_stalls_every_s * 1e9;
                    continue;
                }
                made += quantum;
                due = clock.when(made * frame);
                backwards += due <= last_when;
                last_when = due;
            }
            const bool settled = now > settle_s * 1e9;
            const std::int64_t waiting = made - card.next;
            playing = playing || waiting >= static_cast<std::int64_t>(margin_s * rate) + wanted;
            card.asked += wanted;
            card.steady_ns = static_cast<std::int64_t>(now);
            card.largest = std::max(card.largest, wanted);
            if (playing) {
                const std::int64_t skipped = std::min(left_to_skip, waiting);
                left_to_skip -= skipped;
                const std::int64_t got = std::min(wanted, waiting - skipped);
                card.next += skipped + got;
                if (got < wanted) {
                    ++underflows;
                    late_underflows += settled;
                    silent_frames += wanted - got;
                }
                if (settled) {
                    lowest = std::min(lowest, made - card.next);
                    highest = std::max(highest, made - card.next);
                }
            }
            if (now < next_look || !playing) continue;
            next_look = now + 20e6;
            control::CardView seen = card;
            seen.next += left_to_skip;
            const std::int64_t skip = follower.follow(seen, static_cast<std::int64_t>(now), clock);
            left_out += skip;
            left_to_skip += skip;
            // The target grows with the largest callback, so early changes of slope are not jitter.
            if (settled) {
                steepest = std::max(steepest, std::abs(clock.slope - 1.0));
                bend = std::max(bend, std::abs(clock.slope - last_slope));
            }
            last_slope = clock.slope;
        }
        rate_error_ppm = follower.loop().rate_error() * 1e6;
        excess_s = follower.excess_s();
        target = follower.target();
    }
};

}  // namespace

TEST_CASE("a clock that follows a card 200 ppm off holds the ring at its level for hours", "[slow]") {
    for (const double ppm : {-200.0, 0.0, 200.0})
        for (const int frames : {16, 64, 100, 256, 1024}) {
            Simulation s;
            s.ppm = ppm;
            s.frames = [frames](std::uint64_t) { return frames; };
            s.run(frames == 64 ? 3.0 : 1.0);
            INFO(ppm << " ppm, " << frames << " frames: ring " << s.lowest << " … " << s.highest << ", target "
                     << s.target << ", rate error " << s.rate_error_ppm << " ppm");
            CHECK(s.underflows == 0);
            CHECK(s.left_out == 0);
            CHECK(s.backwards == 0);
            CHECK(s.rate_error_ppm == Approx(ppm).margin(5.0));
            // Without following, 200 ppm would be 35 000 frames in an hour.
            CHECK(std::abs(s.excess_s) < 2e-4);
            CHECK(s.lowest > s.target - 48 - 60);
            CHECK(s.highest < s.target + 48 + 60);
            CHECK(s.bend < 20e-6);
        }
}

TEST_CASE("card buffers that are odd and change from callback to callback never run dry") {
    const Random sizes{5};
    for (const double ppm : {-200.0, 200.0}) {
        Simulation s;
        s.ppm = ppm;
        s.frames = [&](std::uint64_t n) { return 16 + static_cast<std::int64_t>(sizes.uniform(n) * 1009.0); };
        s.run(2.0);
        INFO("ring " << s.lowest << " … " << s.highest << ", target " << s.target);
        CHECK(s.late_underflows == 0);
        CHECK(s.left_out == 0);
        CHECK(s.backwards == 0);
        CHECK(s.highest < s.target + 1024 + 48 + 200);
        CHECK(s.rate_error_ppm == Approx(ppm).margin(60.0));
    }
}

TEST_CASE("a card that warms up is followed without an under- or overflow") {
    Simulation s;
    s.ppm_at = [](double t) { return 150.0 * (1.0 - std::exp(-t / 600.0)) + 20.0 * std::sin(t / 100.0); };
    s.run(2.0);
    CHECK(s.underflows == 0);
    CHECK(s.left_out == 0);
    CHECK(s.lowest > s.target - 120);
    CHECK(s.highest < s.target + 120);
}

TEST_CASE("a card that stands still now and then is followed, and the ring comes back to its level") {
    Simulation s;
    s.ppm = 100.0;
    s.margin_s = 0.01;
    s.card_stalls_every_s = 120.0;
    s.card_stall_s = 0.004;  // within the margin: the clock takes it back
    s.run(1.0);
    INFO("ring " << s.lowest << " … " << s.highest << ", target " << s.target);
    CHECK(s.underflows == 0);
    CHECK(s.left_out == 0);
    CHECK(s.highest < s.target + 48 + 192 + 60);
    CHECK(std::abs(s.excess_s) < 1e-3);
}

TEST_CASE("what gathers while a card stands still for long is left out, once") {
    Simulation s;
    s.margin_s = 0.005;
    s.card_stalls_every_s = 1200.0;
    s.card_stall_s = 0.05;
    s.run(0.5);  // one stall
    INFO("left out " << s.left_out);
    CHECK(s.underflows == 0);
    CHECK(s.left_out == Approx(0.05 * 48000.0).margin(300.0));
    CHECK(std::abs(s.excess_s) < 1e-3);
    CHECK(s.backwards == 0);
}

TEST_CASE("frames that come too late because the engine stood still are left out after the silence") {
    Simulation s;
    s.engine_stalls_every_s = 1200.0;
    s.engine_stall_s = 0.03;
    s.run(0.5);
    INFO("silent " << s.silent_frames << ", left out " << s.left_out);
    CHECK(s.silent_frames > 0);
    CHECK(s.left_out == Approx(static_cast<double>(s.silent_frames)).margin(300.0));
    CHECK(std::abs(s.excess_s) < 1e-3);
}

TEST_CASE("single callbacks that come very late move the clock by less than 100 ppm") {
    const Random random{3};
    // Each hundredth callback is late by up to 20 ms, the card itself is not.
    control::DelayLockedLoop loop;
    loop.prepare(48000.0);
    double worst = 0.0, furthest_ns = 0.0;
    for (std::int64_t n = 1; n < 3'600'000; ++n) {
        const auto k = static_cast<std::uint64_t>(n);
        const double ideal = static_cast<double>(n) * 64e9 / 48000.0;
        const double late = random.uniform(2 * k) < 0.01 ? 20e6 * random.uniform(2 * k + 1) : 0.0;
        loop.update(64 * n, static_cast<std::int64_t>(ideal + late));
        if (n < 60 * 750) continue;
        worst = std::max(worst, std::abs(loop.rate_error()));
        furthest_ns = std::max(furthest_ns, std::abs(loop.time_ns(64 * n) - ideal));
    }
    INFO("rate " << worst * 1e6 << " ppm, time " << furthest_ns * 1e-3 << " µs");
    CHECK(worst < 100e-6);
    CHECK(furthest_ns < 0.5e6);
    CHECK(loop.jumps() == 0);
}

TEST_CASE("a clock that jumps is found again with the rate it had") {
    control::DelayLockedLoop loop;
    loop.prepare(48000.0);
    const auto at = [](std::int64_t n) { return static_cast<double>(n) * 256e9 / (48000.0 * (1.0 + 150e-6)); };
    std::int64_t n = 1;
    for (; n < 187 * 300; ++n) loop.update(256 * n, static_cast<std::int64_t>(at(n)));
    CHECK(loop.rate_error() * 1e6 == Approx(150.0).margin(1.0));
    for (; n < 187 * 420; ++n) loop.update(256 * n, static_cast<std::int64_t>(at(n) + 50e6));
    CHECK(loop.jumps() == 1);
    CHECK(loop.time_ns(256 * (n - 1)) == Approx(at(n - 1) + 50e6).margin(1e5));
    CHECK(loop.rate_error() * 1e6 == Approx(150.0).margin(30.0));
}

TEST_CASE("frames and times that do not rise, and a rate that cannot be, leave the loop in order") {
    control::DelayLockedLoop loop;
    loop.prepare(48000.0);
    loop.update(0, 1'000'000'000);
    loop.update(0, 5'000'000'000);
    loop.update(-5, 6'000'000'000);
    CHECK(loop.time_ns(0) == 1e9);
    // A hundred times too fast, as in freewheel.
    for (std::int64_t n = 1; n < 100'000; ++n) loop.update(64 * n, 1'000'000'000 + n * 13'333);
    CHECK(std::abs(loop.rate_error()) <= control::DelayLockedLoop::largest_rate_error * 1.001);
    CHECK(std::isfinite(loop.time_ns(0)));
}

TEST_CASE("a trimmed clock is continuous where it bends and never steeper than it may be") {
    control::TrimmedClock clock{0, 1'000, 1.0};
    const Random random{1};
    std::int64_t last = clock.when(0);
    Flicks at = 0;
    for (std::uint64_t i = 0; i < 10'000; ++i) {
        at += 14'112'000;  // 20 ms
        const std::int64_t before = clock.when(at);
        clock.trim(before, 1.0 + 1e-2 * (random.uniform(2 * i) - 0.5), 1e9 * (random.uniform(2 * i + 1) - 0.5));
        CHECK(std::abs(clock.when(at) - before) <= 1);
        const double slope = static_cast<double>(before - last) / 20e6;
        CHECK(std::abs(slope - 1.0) <= control::TrimmedClock::furthest + 1e-6);
        last = before;
    }
}
