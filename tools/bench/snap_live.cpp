// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/snap_live.hpp"

#include "assets/library/fragments.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/rotation.hpp"
#include "dsp/coupling/quasi_static.hpp"
#include "dsp/fit/fit.hpp"
#include "dsp/fit/held_fit.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

namespace tactus::bench {

namespace {

constexpr int all_ticks = 3000;

/// Motion within 2 mm and 2 degrees of the fitted pose, at up to 1.1 Hz, of a handle `arm` from the fragment's centre.
Pose wandering_hand(const Vec3& arm, double t) {
    const double w = 2.0 * std::numbers::pi * t;
    return {arm + mm * Vec3(0.5 + 1.5 * std::sin(0.7 * w), std::sin(0.9 * w), std::sin(1.1 * w)),
            rotation_by(degree * Vec3(2.0 * std::sin(0.8 * w), 2.0 * std::sin(w), std::sin(0.5 * w)))};
}

/// The settings of the node snap_to_fit near a fit.
fit::FitLaw law_of(fit::FitMode mode) {
    fit::FitLaw law;
    law.reach = 4.0 * mm;
    law.scale = 0.4 * mm;
    if (mode == fit::FitMode::extended) {
        law.outline = 0.3;
        law.strength = 10.0 / (0.65 * law.scale);
        return law;
    }
    law.two_sided = law.gated = false;
    law.kernel = fit::FitKernel::steady;
    law.strength = 10.0;
    return law;
}

}  // namespace

std::vector<LiveTicks> bench_snap_live() {
    library::FractureOptions options;
    options.spacing *= 0.82;  // about 5,000 painted points in total
    const std::vector<bone::Bone> bones = library::make_fragments(options);
    const fit::FitSurface moving = fit::make_live_fit_surface(bones[1].points, bones[1].distance),
                          fixed = fit::make_live_fit_surface(bones[0].points, bones[0].distance);
    const contact::Pointshell shells[] = {contact::make_pointshell(bones[0].points),
                                          contact::make_pointshell(bones[1].points)};
    const contact::Voxmap maps[] = {contact::make_voxmap(bones[0].distance), contact::make_voxmap(bones[1].distance)};
    coupling::Scene scene;
    scene.count = 2;
    for (std::size_t i = 0; i < 2; ++i) scene.objects[i].body = {&shells[i], &maps[i], nullptr, {}, 1, i + 1};
    const Vec3 arm(10.0 * mm, 0.0, 0.0);
    const Pose grip{-arm, {1, 0, 0, 0}};
    coupling::HeldContact contact(shells[0].size() + shells[1].size());
    contact.set(scene, 1, grip, contact::ContactLaw{}, false);
    fit::FitEnergy energy(moving, fixed);
    std::vector<LiveTicks> rows;
    for (const fit::FitMode mode : {fit::FitMode::extended, fit::FitMode::thesis}) {
        energy.law = law_of(mode);
        fit::HeldFit fit(contact, &energy);
        coupling::QuasiStaticCoupling coupling;
        coupling.settings.springs = {{1e3, 10.0}, {1.0, 0.5}};
        coupling.settings.reach = contact.reach();
        coupling.settings.gyration = contact.gyration();
        coupling.reset({arm, {1, 0, 0, 0}});
        std::vector<double> seconds;
        double evaluations = 0.0;
        for (int n = 0; n < all_ticks; ++n) {
            const Pose hand = wandering_hand(arm, n * 1e-3);
            const std::int64_t begin = thread_ns();
            fit.look(coupling.state().proxy, grip, {}, 1.0);
            evaluations += coupling.update(hand, fit).evaluations;
            seconds.push_back(1e-9 * static_cast<double>(thread_ns() - begin));
        }
        std::ranges::sort(seconds);
        const auto at = [&](double share) { return seconds[static_cast<std::size_t>(share * (all_ticks - 1))] * 1e3; };
        const auto in_time = std::ranges::count_if(seconds, [](double s) { return s < 0.5e-3; });
        rows.push_back({mode == fit::FitMode::extended ? "extended" : "baseline",
                        moving.position.size() + fixed.position.size(), all_ticks,
                        static_cast<double>(in_time) / all_ticks, at(0.5), at(0.99), evaluations / all_ticks});
    }
    return rows;
}

}  // namespace tactus::bench
