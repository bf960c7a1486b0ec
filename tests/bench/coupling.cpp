// SPDX-License-Identifier: Apache-2.0
// Cost of one frame of the quasi-static coupling: two halves of a broken bone rubbed against each other, a new pose of
// the hand in each frame.
#include "assets/library/fragments.hpp"
#include "dsp/core/quantile.hpp"
#include "dsp/coupling/held_contact.hpp"
#include "dsp/coupling/quasi_static.hpp"

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <vector>

namespace {

using namespace tactus;

struct Half {
    contact::Pointshell shell;
    contact::Voxmap map;
    Pose at;

    explicit Half(bone::Bone bone) {
        for (const contact::SurfacePoint& p : bone.points) at.position += p.position;
        at.position /= static_cast<double>(bone.points.size());
        for (contact::SurfacePoint& p : bone.points) p.position -= at.position;
        bone.distance.origin -= at.position;
        shell = contact::make_pointshell(bone.points);
        map = contact::make_voxmap(std::move(bone.distance));
    }
};

/// spacing of the points in µm, most iterations.
void coupled_fragments(benchmark::State& state) {
    const std::vector<bone::Bone> bones =
        library::make_fragments({.spacing = 1e-6 * static_cast<double>(state.range(0))});
    const Half left(bones[0]), right(bones[1]);
    coupling::Scene scene;
    scene.count = 2;
    scene.objects[0] = {{&left.shell, &left.map, nullptr, {}, 1, 1}, left.at};
    scene.objects[1] = {{&right.shell, &right.map, nullptr, {}, 1, 2}, right.at};
    coupling::HeldContact contact(1000000);
    contact.set(scene, 1, {}, {}, false);
    coupling::QuasiStaticCoupling coupling;
    coupling.settings.iterations = static_cast<int>(state.range(1));
    coupling.settings.reach = contact.reach();
    coupling.settings.gyration = contact.gyration();
    coupling.settings.springs = {{1000.0, 40.0}, {1.0, 4.0}};
    coupling.reset(right.at);
    SizeCounts times;
    double iterations = 0.0, balanced = 0.0, touching = 0.0;
    std::int64_t frame = 0;
    for (auto _ : state) {
        const double t = 1e-3 * static_cast<double>(frame++);
        const Vec3 at = 1e-3 * Vec3(-2.0 + std::sin(4.0 * t), 2.0 * std::sin(5.0 * t), 2.0 * std::sin(6.0 * t));
        const Pose hand{right.at.position + at, rotation_by(0.03 * Vec3(std::sin(3.0 * t), std::sin(7.0 * t), 0.0))};
        const auto begin = std::chrono::steady_clock::now();
        const coupling::QuasiStaticState& now = coupling.update(hand, contact);
        times.add(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
        iterations += now.iterations;
        balanced += now.balanced ? 1.0 : 0.0;
        touching += static_cast<double>(now.contact.in_contact);
    }
    const auto frames = static_cast<double>(state.iterations());
    state.counters["points"] = static_cast<double>(right.shell.size());
    state.counters["in_contact"] = touching / frames;
    state.counters["us_p50"] = times.quantile(0.5);
    state.counters["us_p99"] = times.quantile(0.99);
    state.counters["iterations"] = iterations / frames;
    state.counters["balanced"] = balanced / frames;
}
BENCHMARK(coupled_fragments)
    ->ArgNames({"spacing_um", "max_iterations"})
    ->Args({420, 4})
    ->Args({130, 4})
    ->Iterations(4000);

}  // namespace
