// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/vessel/rope_tick.hpp"

#include "assets/library/flap_plan.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/processor_time.hpp"
#include "dsp/coupling/held_contact.hpp"
#include "dsp/coupling/quasi_static.hpp"
#include "dsp/rope/attached_vessel.hpp"
#include "dsp/rope/scene_bones.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

namespace tactus::bench {

namespace {

const Quat upright{1.0, 0.0, 0.0, 0.0};

double thread_microseconds() { return 1e6 * thread_seconds(); }

struct Body {
    contact::Pointshell shell;
    contact::Voxmap map;
    Pose home;
};

Body body_of(const bone::Bone& bone) {
    Vec3 middle(0.0);
    for (const contact::SurfacePoint& p : bone.points) middle += p.position / static_cast<double>(bone.points.size());
    std::vector<contact::SurfacePoint> points = bone.points;
    for (contact::SurfacePoint& p : points) p.position -= middle;
    volume::Grid field = bone.distance;
    field.origin -= middle;
    return {contact::make_pointshell(points), contact::make_voxmap(std::move(field)), {middle, upright}};
}

}  // namespace

RopeTickCost measure_rope_tick(std::size_t ticks) {
    const library::FlapCase flap = library::make_flap();
    const library::FlapPieces pieces = library::cut_flap(flap);
    constexpr std::size_t resected = 2, held = 4;
    std::deque<Body> bodies;
    coupling::Scene scene;
    std::vector<std::vector<Vec3>> surfaces(pieces.bones.size());
    std::size_t shell_points = 0;
    for (std::size_t n = 0; n < pieces.bones.size(); ++n) {
        const Body& body = bodies.emplace_back(body_of(pieces.bones[n]));
        coupling::SceneObject& object = scene.objects[scene.count++];
        if (n != resected) object.body = {&body.shell, &body.map, nullptr, body.home, 0, n + 1};
        object.pose = pieces.planned[n] * body.home;
        object.unit = n > resected ? 1 : -1;
        shell_points += pieces.bones[n].points.size();
        if (n > resected)
            for (const contact::SurfacePoint& p : pieces.bones[n].points) surfaces[n].push_back(p.position);
    }
    const auto line_of = [](const vessel::Track& track, const Vec3& aside) {
        std::vector<Vec3> line;
        for (const vessel::Node& node : track.branches[0].nodes) line.push_back(node.position + aside);
        return rope::resampled(line, 250);
    };
    RopeTickCost cost;
    std::vector<rope::AttachedVessel> ropes;
    const std::array<Vec3, 3> sites{flap.sites[2].position, flap.sites[3].position, flap.sites[0].position};
    for (const std::vector<Vec3>& line : {line_of(flap.artery, Vec3(0.0)), line_of(flap.vein, Vec3(0.0)),
                                          line_of(flap.artery, Vec3(0.0, 4.0 * mm, 0.0))}) {
        rope::AttachedVesselSettings settings;
        settings.pedicle = 75.0 * mm;
        ropes.emplace_back(line, rope::attachments_along(line, surfaces, 15.0 * mm), pieces.planned, settings);
        cost.points += ropes.back().rope().points().size();
    }
    coupling::HeldContact touched(2 * shell_points);
    coupling::QuasiStaticCoupling coupling;
    contact::ContactLaw law;
    law.by_area = true;
    law.stiffness = 40e9;
    law.blend = 0.03 * mm;
    law.saturation = 1e6;
    const Pose place = pieces.planned[held] * bodies[held].home;
    coupling.reset(place);
    rope::SceneBones bones;
    std::vector<Pose> poses = pieces.planned;
    std::size_t unsolved = 0, contacts = 0;
    for (std::size_t n = 0; n < ticks + 500; ++n) {
        const double t = 1e-3 * static_cast<double>(n);
        const Vec3 by = Vec3(4.0 * std::sin(7.0 * t), -6.0 * (1.0 - std::cos(3.0 * t)), 4.0 * std::sin(5.0 * t)) * mm;
        const Pose hand{place.position + (n < 500 ? Vec3(0.0) : by), place.orientation};
        const double begin = thread_microseconds();
        touched.set(scene, held, Pose{}, law, false);
        coupling.settings.springs = {{1000.0, 10.0}, {1.0, 0.5}};
        coupling.settings.step = std::min(0.5 * mm, touched.safe_step());
        coupling.settings.reach = touched.reach();
        coupling.settings.gyration = touched.gyration();
        const coupling::QuasiStaticState& now = coupling.update(hand, touched);
        const Pose moved = now.proxy * place.inverse();
        bones.clear();
        for (std::size_t k = 0; k < scene.count; ++k) {
            poses[k] = k > resected ? moved * pieces.planned[k] : pieces.planned[k];
            if (scene.objects[k].body.map) bones.add(*scene.objects[k].body.map, poses[k] * scene.objects[k].body.home);
        }
        for (std::size_t r = 0; r < ropes.size(); ++r) {
            const double start = thread_microseconds();
            unsolved += !ropes[r].step(1e-3, poses, &sites[r], &bones).is_solved && n >= 500;
            if (n >= 500) cost.rope.push_back(thread_microseconds() - start);
        }
        if (n < 500) continue;
        cost.whole.push_back(thread_microseconds() - begin);
        contacts += now.contact.in_contact > 0;
    }
    std::ranges::sort(cost.whole);
    std::ranges::sort(cost.rope);
    cost.unsolved = static_cast<double>(unsolved) / static_cast<double>(cost.rope.size());
    cost.touching = static_cast<double>(contacts) / static_cast<double>(cost.whole.size());
    return cost;
}

}  // namespace tactus::bench
