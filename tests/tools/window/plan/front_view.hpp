// SPDX-License-Identifier: Apache-2.0
// Where a place of the jaw's case is seen in the scene.
#pragma once

#include "assets/bone/bone.hpp"
#include "assets/plan/plan_file.hpp"
#include "dsp/display/camera.hpp"
#include "tests/tools/jaw_case.hpp"
#include "tests/tools/window/eyes.hpp"

namespace tactus::test {

/// The front view, as it is fitted to all fragments at their scanned places.
inline display::OrbitCamera front_view(double aspect) {
    display::Bounds all;
    for (const auto& fragment : plan::load_case_plan(case_folder() / "case.plan.json").fragments)
        for (const contact::SurfacePoint& p : bone::load_bone((case_folder() / fragment.file).string()).points)
            all.add(p.position);
    display::OrbitCamera camera;
    camera.look_from(display::NamedView::front);
    camera.fit(all, aspect);
    return camera;
}

/// Pixel of the window, with z 0.
inline Vec3 place_in(const Spot& scene, const display::OrbitCamera& camera, const Vec3& point) {
    const double width = scene.right - scene.left, height = scene.bottom - scene.top;
    display::Bounds box;
    box.add(point - Vec3(0.2));
    box.add(point + Vec3(0.2));
    const auto seen = camera.projection(width / height, box).seen(point);
    REQUIRE(seen);
    return {scene.left + 0.5 * (seen->x + 1.0) * width, scene.top + 0.5 * (1.0 - seen->y) * height, 0.0};
}

}  // namespace tactus::test
