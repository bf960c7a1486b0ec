// SPDX-License-Identifier: Apache-2.0
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/contact/sample_surface.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/reconstruction/margin_wall.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"
#include "nodes/guide/guide_parameters.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace tactus::nodes {

struct TumourMargin {
    static constexpr auto about =
        "The safety margin of a tumour, as walls that stop the hand: one for each plane at which the plan cuts the "
        "jaw, parallel to it, where the margin ends. A wall holds the hand that comes through it from the side of the "
        "stump; a hand that came another way is free. The walls are there as long as the piece with the tumour lies "
        "where it was scanned and is not held. Research use: the margin is a parameter, not clinical advice.";

    In<tactus::coupling::Scene> scene{"the pieces, in the order of the plan"};
    In<Pose> pose{"of the hand in the scene", "m"};
    In<Twist> twist{optional, "of the hand; open: no damping", "m/s, rad/s"};
    In<Pose> frame{optional, of_world,
                   "the frame of the scans; open: the world. A frame that moves does work on the hand", "m"};
    In<double> held{optional, "place of the held piece; -1 or open: none"};
    Out<Wrench> wrench{"on the hand, about its origin", "N, N m"};
    Out<double> distance{"of the hand from the nearest wall, to the side of the stump; behind it negative", "m"};
    Out<bool> holds{"a wall holds the hand"};
    Out<bool> is_there{"the piece with the tumour lies where it was scanned"};
    Out<Pose> tumour_at{"of the tumour from its file: it goes with its piece", "m"};
    Asset<plan::CaseBones> plan{"the plan, whose reconstruction has the planes of the jaw and the margin"};
    Asset<bone::Bone> tumour{"its surface, in the frame of the jaw's scan"};
    Text piece{"",
               "name of the piece that the tumour lies in; empty: the first of the reconstruction, which 'plan "
               "reconstruct' resects"};
    Param margin{structural, "0 mm", "0 mm", "100 mm", "between tumour and walls; 0: that of the plan"};
    Param radius{"25 mm", "1 mm", "200 mm", "a hand that passes the plane farther from the limb's axis is free"};
    Param moved{"2 mm", "0.1 mm", "100 mm", "a piece that has moved so far is out"};
    GuideParameters guide;

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::asset_bone, .pose = "tumour_at", .asset = "tumour"}};
    }

    void prepare(const Setup& setup) {
        const auto& fragments = plan->plan.fragments;
        const plan::PlanState state = plan::state_of(plan->plan);
        if (!state.reconstruction)
            setup.fail("plan '" + plan.name + "' has no reconstruction: 'tactus plan reconstruct' makes one");
        // Other alternatives have pieces of their own.
        const int first = state.pieces.empty() ? 0 : state.pieces.front();
        const auto found = piece.value.empty() ? fragments.begin() + first
                                               : std::ranges::find(fragments, piece.value, &plan::PlanFragment::name);
        if (found == fragments.end())
            setup.fail("plan '" + plan.name + "' has no piece '" + piece.value + "', in which the tumour would lie");
        piece_ = static_cast<std::size_t>(found - fragments.begin());
        std::vector<Vec3> surface;
        const std::vector<contact::SurfacePoint> sampled =
            tumour->points.empty() ? contact::sample_surface(tumour->distance, {}) : tumour->points;
        for (const contact::SurfacePoint& p : sampled) surface.push_back(p.position);
        if (surface.empty()) setup.fail("the tumour '" + tumour.name + "' has no surface");
        const reconstruction::Reconstruction& all = *state.reconstruction;
        walls_.clear();
        for (const reconstruction::Plane& wall :
             reconstruction::margin_walls(all.inputs, surface, margin > 0.0 ? margin.value : all.flap.margin)) {
            reconstruction::OneWayWall& added = walls_.emplace_back();
            added.plane = wall;
        }
        if (walls_.empty()) setup.fail("plan '" + plan.name + "' cuts nothing of the jaw, so there is no margin");
        middle_ = Vec3(0.0);
        for (const Vec3& p : surface) middle_ += p / static_cast<double>(surface.size());
        share_ = 0.0;
        tumour_at = Pose{};
        is_there = true;
    }

    void process(const Tick& tick) noexcept {
        follow();
        const GuidedHand hand(pose, twist, frame);
        wrench = Wrench{};
        holds = false;
        if (!hand.is_known) {
            for (reconstruction::OneWayWall& wall : walls_) wall.release();
            return;
        }
        // What goes away fades to the end, also when the piece is back before; what comes begins at a depth of 0.
        const double fades = tick.elapsed_seconds() / fade;
        const bool goes =
            !is_there.get() || (share_ < 1.0 && std::ranges::any_of(walls_, &reconstruction::OneWayWall::holds));
        share_ = goes ? std::max(0.0, share_ - fades) : std::min(1.0, share_ + fades);
        double nearest = std::numeric_limits<double>::infinity();
        Vec3 force(0.0);
        for (reconstruction::OneWayWall& wall : walls_) {
            wall.radius = radius;
            const bool held_before = wall.holds();
            const double depth = wall.depth(hand.position, is_there.get() && share_ == 1.0);
            if (held_before && share_ == 0.0) wall.release();
            force += share_ * guide.law().repel(depth, wall.plane.normal, hand.velocity);
            holds = holds.get() || wall.holds();
            const double height = glm::dot(wall.plane.normal, hand.position - wall.plane.origin);
            if (std::abs(height) < std::abs(nearest)) nearest = height;
        }
        distance = nearest;
        wrench = {frame->orientation * force, {}};
    }

private:
    static constexpr double fade = 0.05;  // s

    void follow() noexcept {
        if (piece_ >= scene->count) return;
        const coupling::SceneObject& object = scene->objects[piece_];
        if (!is_valid(object.pose) || !is_valid(object.body.home)) return;
        const Pose now =
            Pose{object.pose.position, glm::normalize(object.pose.orientation)} * object.body.home.inverse();
        tumour_at = now;
        const bool is_held = held.connected && held.get() == static_cast<double>(piece_);
        is_there = !is_held && object.body.map && glm::length(now.apply(middle_) - middle_) <= moved;
    }

    std::vector<reconstruction::OneWayWall> walls_;
    Vec3 middle_{0.0};
    std::size_t piece_ = 0;
    double share_ = 0.0;
};

TACTUS_NODE(TumourMargin, scene, pose, twist, frame, held, wrench, distance, holds, is_there, tumour_at, plan, tumour,
            piece, margin, radius, moved, guide)
TACTUS_VISUALS(TumourMargin)

}  // namespace tactus::nodes
