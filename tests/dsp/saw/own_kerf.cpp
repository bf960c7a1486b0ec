// SPDX-License-Identifier: Apache-2.0
// The body of a blade is free in the kerf that the blade cuts, wherever the voxels of the bone lie.
#include "tests/dsp/saw/sawing.hpp"
#include "tests/support/catch.hpp"

#include <algorithm>
#include <cmath>

using namespace tactus;
using namespace tactus::test;

TEST_CASE("a blade that saws and slides in its own kerf feels its teeth only, at any offset and angle of the voxels") {
    for (const double voxel : {0.2e-3, 0.33e-3})
        for (const double offset : {0.0, 0.25, 0.5})
            for (const double angle : {0.0, 0.35, 0.7854}) {
                const auto bone =
                    bone_block({.low = {-0.006, -0.006, -0.008}, .high = {0.006, 0.006, 0.0}, .voxel = voxel});
                saw::SawShape shape;
                Sawing sawing(*bone, 1000.0, 40e3, shape);
                sawing.law = saw::CuttingLaw{}.sharpened(4.0);
                const Quat attitude = glm::angleAxis(angle, Vec3(0.0, 0.0, 1.0)) * teeth_down;
                const Vec3 along = attitude * Vec3(1.0, 0.0, 0.0), across = attitude * Vec3(0.0, 0.0, 1.0);
                double depth = -0.3e-3, most = 0.0;
                for (int n = 0; n < 2600 && depth < 6e-3; ++n) {
                    const double slide = 2e-3 * std::sin(2.0 * std::numbers::pi * 1.5 * n * 1e-3);
                    const saw::SawContact contact =
                        sawing.step({along * slide + across * (offset * voxel) - Vec3(0.0, 0.0, depth), attitude});
                    depth += (8.0 - contact.thrust) / 300.0 * 1e-3;
                    for (const saw::BodyPoint& ball : sawing.blade.body().points())
                        most = std::max(most, glm::length(ball.target - ball.at));
                }
                CAPTURE(voxel, offset, angle, depth);
                CHECK(depth > 1.8e-3);
                CHECK(most < 0.3e-3);
            }
}
