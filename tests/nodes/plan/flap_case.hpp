// SPDX-License-Identifier: Apache-2.0
// A case with a flap for tests of its vessel: two segments beside which the vessel runs, and its scene.
#pragma once

#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/coupling/scene.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/vessel_asset.hpp"
#include "tests/support/node_harness.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

namespace tactus::test {

/// A rod along z.
inline bone::Bone rod(double x, double low, double high) {
    bone::Bone bone;
    volume::Grid& d = bone.distance;
    d.spacing = Vec3(0.8 * mm);
    d.origin = Vec3(x - 8.0 * mm, -8.0 * mm, low - 3.2 * mm);
    d.size = {21, 21, static_cast<int>((high - low + 6.4 * mm) / d.spacing.z) + 1};
    for (int k = 0; k < d.size[2]; ++k)
        for (int j = 0; j < d.size[1]; ++j)
            for (int i = 0; i < d.size[0]; ++i) {
                const Vec3 p = d.position(i, j, k);
                d.values.push_back(
                    static_cast<float>(std::max(std::hypot(p.x - x, p.y) - 5.0 * mm, std::max(low - p.z, p.z - high))));
            }
    bone.density = d;
    bone.points = contact::sample_surface(d, {.spacing = 0.8 * mm});
    return bone;
}

/// A jaw far away, and two segments one above the other beside which the vessel runs.
inline std::shared_ptr<const plan::CaseBones> flap() {
    static const auto made = [] {
        auto c = std::make_shared<plan::CaseBones>();
        c->bones = {rod(80.0 * mm, 0.0, 20.0 * mm), rod(-8.0 * mm, 36.0 * mm, 66.0 * mm),
                    rod(-8.0 * mm, 70.0 * mm, 100.0 * mm)};
        for (const char* name : {"jaw-1", "segment-1", "segment-2"})
            c->plan.fragments.push_back({name, name, 0, Vec3(1.0)});
        return std::shared_ptr<const plan::CaseBones>(c);
    }();
    return made;
}

inline std::shared_ptr<const vessel::Course> vessel_course() {
    auto made = std::make_shared<vessel::Course>();
    for (int n = 0; n <= 50; ++n) {
        made->points.push_back({0.0, 0.0, (200.0 - 4.0 * n) * mm});
        made->radius.push_back(1.5 * mm);
    }
    return made;
}

/// The scene of the case; the bodies live as long as this.
struct FlapScene {
    NodeHarness node{"case_scene", {.period = flicks_per_second / 1000}};
    coupling::Scene scene;
    FlapScene() {
        node.asset("plan", flap());
        node.disconnect_optional();
        node.prepare();
        node.run(1);
        scene = node.last<coupling::Scene>("scene");
    }
    /// The segments as one group, moved from where they were scanned.
    coupling::Scene moved(const Pose& by, bool as_group = true) const {
        coupling::Scene now = scene;
        for (const std::size_t n : {1u, 2u}) {
            now.objects[n].pose = by * now.objects[n].body.home;
            if (as_group) now.objects[n].unit = 7;
        }
        return now;
    }
};

}  // namespace tactus::test
