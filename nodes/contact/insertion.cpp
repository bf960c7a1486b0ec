// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace tactus::nodes {

struct Insertion {
    static constexpr auto about =
        "Measures a peg-in-hole task: depth, force and straightness. z is the axis of both; the peg's tip is its "
        "origin, and the hole extends along -z from its origin.";

    In<Pose> peg{"pose of the peg's tip", "m"};
    In<Pose> hole{optional, "pose of the middle of the hole's mouth; unconnected: the origin", "m"};
    In<Wrench> wrench{"on the hand", "N, N m"};
    Out<double> depth{"of the tip below the hole's mouth", "m"};
    Out<bool> inserted{"the goal depth was reached"};
    Param goal{"20 mm", "0 mm", "1 m", "depth that counts as inserted"};
    Param tolerance{"0.1 mm", "0 mm", "10 mm", "accepted shortfall of the depth"};
    Param guided{"2 mm", "0 mm", "1 m", "depth from which the hole guides the peg; errors are measured from there on"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::line,
                 .force = "wrench",
                 .frame = "hole",
                 .direction = {0.0, 0.0, -1.0},
                 .length = goal}};
    }

    void process(const Tick&) noexcept {
        const Pose tip = hole.connected ? hole.get().inverse() * peg.get() : peg.get();
        depth = -tip.position.z;
        if (!is_valid(tip) || !is_finite(wrench.get())) return;
        last_ = -tip.position.z;
        deepest_ = started_ ? std::max(deepest_, last_) : last_;
        started_ = true;
        if (last_ >= goal - tolerance) inserted_ = true;
        inserted = inserted_;
        const Vec3 axis = hole.connected ? hole->rotate(Vec3(0.0, 0.0, 1.0)) : Vec3(0.0, 0.0, 1.0);
        axial_ = std::max(axial_, std::abs(glm::dot(wrench->force, axis)));
        if (last_ > guided) lateral_ = std::max(lateral_, std::hypot(tip.position.x, tip.position.y));
    }

    void report(Report& report) const {
        report.set("peg", "inserted", inserted_ ? 1.0 : 0.0);
        report.set("peg", "depth_mm", deepest_ * 1e3);
        report.set("peg", "depth_at_end_mm", last_ * 1e3);
        report.set("peg", "axial_force_N", axial_);
        report.set("peg", "lateral_error_mm", lateral_ * 1e3);
    }

private:
    double deepest_ = 0.0, last_ = 0.0, axial_ = 0.0, lateral_ = 0.0;
    bool inserted_ = false, started_ = false;
};

TACTUS_NODE(Insertion, peg, hole, wrench, depth, inserted, goal, tolerance, guided)
TACTUS_VISUALS(Insertion)

}  // namespace tactus::nodes
