// SPDX-License-Identifier: Apache-2.0
// Assets for tests, made in memory: a ball of bone, a saw of two recordings and a short equaliser.
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/task_asset.hpp"
#include "graph/node/vessel_asset.hpp"
#include "tests/support/node_harness.hpp"

#include <cmath>
#include <numbers>

namespace tactus::test {

namespace {

bone::Bone ball(int side = 84) {
    bone::Bone bone;
    bone.name = "ball";
    volume::Grid& d = bone.distance;
    d.size = {side, side, side};
    d.spacing = Vec3(84.0 / 3200.0 / side);
    d.origin = -0.5 * (side - 1.0) * d.spacing;
    d.values.resize(d.count());
    bone.density = d;
    for (int k = 0; k < d.size[2]; ++k)
        for (int j = 0; j < d.size[1]; ++j)
            for (int i = 0; i < d.size[0]; ++i) {
                const double distance = glm::length(d.position(i, j, k)) - 10e-3;
                d.at(i, j, k) = static_cast<float>(distance);
                bone.density.at(i, j, k) = distance < 0.0 ? 1600.0f : 0.0f;
            }
    return bone;
}

sound::Recording tone(bool cutting, double rate, double load) {
    sound::Recording r;
    r.cutting = cutting;
    r.rate = rate;
    r.load = load;
    r.full_scale = 100.0;
    r.sample_rate = 48000;
    for (int i = 0; i < 9600; ++i) {
        const double phase = 2.0 * std::numbers::pi * rate * i / r.sample_rate;
        r.samples.push_back(
            static_cast<float>((cutting ? 0.5 : 0.2) * (std::sin(phase) + 0.3 * std::sin(2.0 * phase))));
    }
    return r;
}

}  // namespace

std::shared_ptr<const void> coarse_ball() { return std::make_shared<const bone::Bone>(ball(28)); }

std::shared_ptr<const void> sample_asset(std::string_view type_name) {
    if (type_name == AssetLoader<bone::Bone>::name) return std::make_shared<const bone::Bone>(ball());
    if (type_name == AssetLoader<plan::CaseBones>::name) {
        plan::CaseBones made;
        for (const char* name : {"ball", "other"}) {
            made.plan.fragments.push_back({name, name, 0, Vec3(1.0)});
            made.bones.push_back(ball());
            made.bones.back().points = contact::sample_surface(made.bones.back().distance, {.spacing = 1.5e-3});
        }
        auto all = std::make_shared<reconstruction::Reconstruction>();
        all->inputs.planes = {{Vec3(-0.04, 0.0, 0.0), Vec3(1.0, 0.0, 0.0), {}},
                              {Vec3(0.04, 0.0, 0.0), Vec3(1.0, 0.0, 0.0), {}}};
        all->donor.file = "donor.stl";
        plan::PlanStep step;
        step.kind = plan::StepKind::reconstruct;
        step.by = "command";
        step.fragments = {0, 1};
        step.reconstruction = std::move(all);
        plan::add_step(made.plan, step);
        return std::make_shared<const plan::CaseBones>(std::move(made));
    }
    if (type_name == AssetLoader<sound::RecordingSet>::name) {
        sound::RecordingSet set;
        set.recordings = {tone(false, 200.0, 0.0), tone(true, 200.0, 7.0)};
        return std::make_shared<const sound::RecordingSet>(std::move(set));
    }
    if (type_name == AssetLoader<sound::Sound>::name) {
        sound::Sound click{48000, 2, 600, {}};
        for (std::size_t k = 0; k < 2 * click.frames; ++k)
            click.samples.push_back(static_cast<float>(std::sin(0.05 * static_cast<double>(k / 2))));
        return std::make_shared<const sound::Sound>(std::move(click));
    }
    if (type_name == AssetLoader<vibration::Equaliser>::name) {
        vibration::Equaliser equaliser;
        equaliser.taps = {0.5f, -0.25f, 0.125f};
        equaliser.delay = 1.0 / 48000.0;
        return std::make_shared<const vibration::Equaliser>(std::move(equaliser));
    }
    if (type_name == AssetLoader<control::DeflectionTable>::name)
        return std::make_shared<const control::DeflectionTable>(
            control::DeflectionTable{{-1.0, 0.0, 1.0, 5.0}, {-1e-3, 0.0, 2e-3, 4e-3}, {-0.5e-3, 1e-3, 3e-3, 4e-3}});
    if (type_name == AssetLoader<training::Task>::name) {
        training::Task task;
        task.title = "through the ball";
        task.cuts[0].point = {0.0, 0.0, 10e-3};
        task.limits = {5.0, 1.0, 0.5};
        task.spared.push_back({"ball", 1e-3, ball().distance});
        return std::make_shared<const training::Task>(std::move(task));
    }
    // Beside the ball of bone: past it, and on beyond it.
    if (type_name == AssetLoader<vessel::Course>::name) {
        vessel::Course course;
        for (int n = 0; n <= 60; ++n) {
            course.points.push_back(Vec3(13e-3, 0.0, (50.0 - n) * 1e-3));
            course.radius.push_back(1.5e-3);
        }
        return std::make_shared<const vessel::Course>(std::move(course));
    }
    throw Error("no sample of a " + std::string(type_name));
}

}  // namespace tactus::test
