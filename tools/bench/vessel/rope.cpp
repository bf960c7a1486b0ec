// SPDX-License-Identifier: Apache-2.0
// Ropes: energy over many random pulls, residuals, and the cost of a tick.
#include "dsp/rope/rope.hpp"

#include "assets/file/json.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/processor_time.hpp"
#include "dsp/core/random.hpp"
#include "dsp/rope/banded.hpp"
#include "dsp/rope/measure.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/vessel/rope_tick.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::bench {

namespace {

using rope::Rope;
using rope::RopeMaterial;

constexpr double tick = 1e-3;
constexpr std::uint64_t pulls_per_rope = 50, ticks_per_pull = 20;

struct RopeBenchChoice {
    int pulls = 100'000;
    int ticks = 10'000;
    bool json = false;
};

struct Tally {
    double moved = 0.0;  // J that hands and ropes have exchanged
    double worst = 0.0;  // J: least of what hands have put in minus what is stored
    double residual = 0.0;  // N
    std::size_t ticks = 0, unsolved = 0;
    std::vector<double> microseconds;
};

/// One rope round a ball, held at one end and pulled to random places at the other.
void pull_one(std::uint64_t seed, std::size_t points, std::uint64_t pulls, Tally& tally) {
    const Random random{seed};
    const rope::Ball bone(Vec3(0.0, 0.0, -12.0 * mm), 10.0 * mm);
    RopeMaterial material = rope::artery();
    material.friction = 0.3 * random.uniform(1'000'000);
    const Vec3 fixed(-30.0 * mm, 0.0, 0.0);
    Vec3 hand(30.0 * mm, 0.0, 0.0), goal = hand, velocity(0.0);
    Rope rope(rope::resampled(std::vector<Vec3>{fixed, hand}, points),
              std::vector<double>(points - 1, 60.0 * mm / static_cast<double>(points - 1)), material);
    rope.hold(0, fixed);
    rope.hold(points - 1, hand);
    for (int n = 0; n < 5; ++n) rope.step(1.0, &bone);
    double work = -rope.energy();
    for (std::uint64_t n = 0; n < pulls * ticks_per_pull; ++n) {
        if (n % ticks_per_pull == 0)
            goal = Vec3(20.0 + 30.0 * random.uniform(3 * n), 40.0 * (random.uniform(3 * n + 1) - 0.5),
                        40.0 * (random.uniform(3 * n + 2) - 0.7)) *
                   mm;
        velocity = 0.9 * velocity + 4.0 * (goal - hand);
        hand += tick * velocity;
        rope.hold(points - 1, hand);
        const Vec3 before = rope.points()[points - 1];
        const double begin = thread_seconds();
        const rope::RopeStep step = rope.step(tick, &bone);
        tally.microseconds.push_back(1e6 * (thread_seconds() - begin));
        const double done = -glm::dot(rope.pull_on(points - 1), rope.points()[points - 1] - before);
        work += done;
        tally.moved += std::abs(done);
        tally.worst = std::min(tally.worst, work - rope.energy());
        tally.residual = std::max(tally.residual, step.residual);
        tally.unsolved += !step.is_solved;
        ++tally.ticks;
    }
}

/// µs of one solve of the system of 65 points: the same calculation each time, by which the others are judged on a machine
/// of unknown speed.
double solve_microseconds() {
    constexpr std::size_t points = 65;
    constexpr int solves = 5000;
    rope::BlockBand matrix(points), band(points);
    matrix.clear();
    for (std::size_t n = 0; n < points; ++n) {
        matrix.add(n, n, 8.0);
        if (n > 0) matrix.add(n, n - 1, -2.0);
        if (n > 1) matrix.add(n, n - 2, 1.0);
    }
    std::vector<Vec3> x(points, Vec3(1.0));
    const double begin = thread_seconds();
    for (int n = 0; n < solves; ++n) {
        band.copy(matrix);
        band.solve(x);
    }
    return 1e6 * (thread_seconds() - begin) / solves;
}

int bench_rope(const RopeBenchChoice& choice) {
    Tally small, large;
    const auto ropes = static_cast<std::uint64_t>(std::ceil(choice.pulls / static_cast<double>(pulls_per_rope)));
    for (std::uint64_t seed = 1; seed <= ropes; ++seed) pull_one(seed, 33, pulls_per_rope, small);
    for (std::uint64_t seed = 1; seed <= 4; ++seed) pull_one(seed, 65, pulls_per_rope, large);
    std::ranges::sort(large.microseconds);
    const auto of_sorted = [](const std::vector<double>& sorted, double q) {
        return sorted[static_cast<std::size_t>(q * static_cast<double>(sorted.size() - 1))];
    };
    const auto quantile = [&](double q) { return of_sorted(large.microseconds, q); };
    const RopeTickCost tick_cost = measure_rope_tick(static_cast<std::size_t>(choice.ticks));
    const double solve = solve_microseconds(), whole_p99 = of_sorted(tick_cost.whole, 0.99);
    const double share = static_cast<double>(small.unsolved) / static_cast<double>(small.ticks);
    if (choice.json) {
        const file::Json json{{"pulls", ropes * pulls_per_rope},
                              {"worst_energy_j", small.worst},
                              {"moved_j", small.moved},
                              {"unsolved_share", share},
                              {"largest_residual_n", small.residual},
                              {"tick_64_us", {{"median", quantile(0.5)}, {"p99", quantile(0.99)}}},
                              {"force_tick_us",
                               {{"median", of_sorted(tick_cost.whole, 0.5)},
                                {"p99", whole_p99},
                                {"solve_65", solve},
                                {"greatest", tick_cost.whole.back()},
                                {"rope_median", of_sorted(tick_cost.rope, 0.5)},
                                {"rope_p99", of_sorted(tick_cost.rope, 0.99)}}},
                              {"force_tick_rope_points", tick_cost.points},
                              {"force_tick_unsolved_share", tick_cost.unsolved},
                              {"force_tick_touching_share", tick_cost.touching}};
        fmt::print("{}\n", json.dump(2));
        return done;
    }
    fmt::print(
        "{} random pulls of 20 ms on ropes of 32 segments over bone: energy {:.1e} J given at most, of {:.3g} J "
        "moved\n",
        ropes * pulls_per_rope, std::abs(small.worst), small.moved);
    fmt::print("{:.2f} % of ticks end above the tolerance; largest residual {:.1e} N\n", 100.0 * share, small.residual);
    fmt::print("a tick of 64 segments: median {:.0f} µs, p99 {:.0f} µs\n", quantile(0.5), quantile(0.99));
    fmt::print("one solve of the system of 65 points, the same each time: {:.2f} µs\n", solve);
    fmt::print(
        "a force tick of the bundled reconstruction, a held group of three segments between two stumps and three ropes "
        "of "
        "{} points together:\n  median {:.0f} µs, p99 {:.0f} µs ({:.0f} solves), greatest {:.0f} µs; each rope median "
        "{:.0f} µs, p99 "
        "{:.0f} "
        "µs, {:.2f} % end above the tolerance; pieces touch in {:.0f} % of the ticks\n",
        tick_cost.points, of_sorted(tick_cost.whole, 0.5), whole_p99, whole_p99 / solve, tick_cost.whole.back(),
        of_sorted(tick_cost.rope, 0.5), of_sorted(tick_cost.rope, 0.99), 100.0 * tick_cost.unsolved,
        100.0 * tick_cost.touching);
    return done;
}

Action add(VerbOptions& verb) {
    const auto choice = std::make_shared<RopeBenchChoice>();
    verb.add("--pulls", choice->pulls, "random pulls").shows_default().range(1, 10'000'000);
    verb.add("--ticks", choice->ticks, "force ticks of the bundled reconstruction")
        .shows_default()
        .range(100, 1'000'000);
    verb.flag("--json", choice->json, "as JSON");
    return [choice] { return bench_rope(*choice); };
}

}  // namespace

Verb rope_verb() { return {"rope", "energy of ropes over many random pulls, and the cost of a tick", add}; }

}  // namespace tactus::bench
