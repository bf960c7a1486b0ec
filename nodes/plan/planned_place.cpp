// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/rotation.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/geometry/point_tree.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace tactus::nodes {

struct PlannedPlace {
    static constexpr auto about =
        "Where the held piece goes in the plan. Near that place there is a fit, to which a coupling can pull the "
        "piece: wire it like fragment_matcher. The place is that beside the piece where it is nearest; another piece "
        "must be nearer by 1 mm. While 'led' is true it stays with that piece, as long as it fits there. Planned "
        "places come from the last step of an alternative of the plan.";

    In<tactus::coupling::Scene> scene{"the pieces, in the order of the plan"};
    In<double> held{"place of the held piece; -1: none"};
    In<Pose> pose{optional, "of the held piece, newer than in the scene: coupling.pose", "m"};
    In<bool> led{optional, "the coupling pulls the piece to the target: as its 'guided'; open: false"};
    Out<Pose> target{"of the held piece at its planned place", "m"};
    Out<bool> fits{"the held piece is near its planned place"};
    Out<double> fragment{"place of the piece that the target is for; -1: none"};
    Out<double> partner{"place of the piece beside which that is; -1: none"};
    Out<double> distance{"of the held piece's middle from its planned place", "m"};
    Out<double> angle{"between the held piece and its planned attitude", "rad"};
    Out<double> gap{"root mean square distance of the held piece's points from their planned places", "m"};
    Asset<plan::CaseBones> plan{"the plan of the scene"};
    Text alternative{"", "alternative of the plan whose last step has the planned places; empty: its first one"};
    Param reach{"15 mm", "0.1 mm", "1 m", "how far from its place a piece fits"};
    Param turn{"40 deg", "1 deg", "180 deg", "how far it may be turned"};
    Param meets{structural, "3 mm", "0.1 mm", "50 mm", "pieces that come as near as this in the plan meet"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::target, .scene = "scene", .place = "fragment", .pose = "target", .when = "fits"}};
    }

    void prepare(const Setup& setup) {
        const auto& all = plan->plan.alternatives;
        const auto named = std::ranges::find(all, alternative.value, &plan::PlanAlternative::name);
        const auto from = alternative.value.empty() ? all.begin() : named;
        if (from == all.end()) {
            std::string names;
            for (const plan::PlanAlternative& one : all) names += (names.empty() ? "" : ", ") + one.name;
            setup.fail("plan '" + plan.name + "' has no alternative '" + alternative.value + "'; it has: " + names);
        }
        const fit::Arrangement planned = plan::state_of(plan->plan, from->place.tip).arrangement;
        places_.assign(plan->bones.size(), {});
        for (std::size_t n = 0; n < places_.size(); ++n) {
            places_[n].pose = planned.pose(static_cast<int>(n));
            measure(places_[n], plan->bones[n]);
        }
        find_neighbours(planned);
        target = Pose{};
        fits = false;
        fragment = -1.0;
        partner = -1.0;
        beside_ = none;
    }

    void process(const Tick&) noexcept {
        fits = false;
        partner = -1.0;
        const double place = held.get();
        if (!(place >= 0.0 && place < static_cast<double>(std::min(places_.size(), scene->count)))) {
            fragment = -1.0;
            beside_ = none;
            return;
        }
        const auto n = static_cast<std::size_t>(place);
        if (fragment.get() != place) beside_ = none;
        const coupling::SceneObject& object = scene->objects[n];
        const Pose& seen = pose.connected ? pose.get() : object.pose;
        fragment = static_cast<double>(n);
        if (!is_valid(seen) || !is_valid(object.body.home)) return;
        const Pose now = Pose{seen.position, glm::normalize(seen.orientation)} * object.body.home.inverse();
        double least = std::numeric_limits<double>::infinity();
        std::size_t found = none;
        const bool is_led = led.connected && led.get();
        for (std::size_t other = 0; other < places_.size() && other < scene->count; ++other) {
            if (!may_meet(n, other)) continue;
            const coupling::SceneObject& beside = scene->objects[other];
            const Pose there = Pose{beside.pose.position, glm::normalize(beside.pose.orientation)} *
                               beside.body.home.inverse() * places_[other].pose.inverse() * places_[n].pose;
            const double away = glm::length(there.apply(places_[n].middle) - now.apply(places_[n].middle));
            const double by = glm::length(rotation_between(now.orientation, there.orientation));
            // Of points spread about the middle with this radius of gyration, a turn moves two thirds.
            const double off = std::hypot(away, std::sqrt(2.0 / 3.0) * 2.0 * std::sin(0.5 * by) * places_[n].gyration);
            // The piece beside which it was so far keeps it, unless another one is nearer by more than that.
            const bool is_near = away <= reach && by <= turn;
            const bool stays = other == beside_ && is_led && is_near;
            const double held_back = stays ? -1.0 : off - (other == beside_ ? stays_with : 0.0);
            if (!(held_back < least)) continue;
            least = held_back;
            found = other;
            target = there * object.body.home;
            distance = away;
            angle = by;
            gap = off;
            fits = is_near;
            partner = static_cast<double>(other);
        }
        if (!fits.get()) partner = -1.0;
        beside_ = found;
    }

private:
    /// `other` does not move with piece n, and meets it in the plan, or what moves with it.
    bool may_meet(std::size_t n, std::size_t other) const noexcept {
        const coupling::SceneObject& object = scene->objects[other];
        if (other == n || !object.body.map || !is_valid(object.pose) || !is_valid(object.body.home)) return false;
        const int unit = scene->objects[n].unit;
        if (unit >= 0 && object.unit == unit) return false;
        for (std::size_t one = 0; one < places_.size() && one < scene->count; ++one) {
            const bool is_along = one == n || (unit >= 0 && scene->objects[one].unit == unit);
            if (is_along && std::ranges::find(places_[one].neighbours, other) != places_[one].neighbours.end())
                return true;
        }
        return false;
    }

    struct Place {
        Pose pose;  // from the frame of the file
        Vec3 middle{0.0};
        double gyration = 0.0;  // m
        std::vector<std::size_t> neighbours;
    };

    static void measure(Place& place, const bone::Bone& bone) {
        const auto count = static_cast<double>(std::max<std::size_t>(bone.points.size(), 1));
        for (const contact::SurfacePoint& p : bone.points) place.middle += p.position / count;
        double sum = 0.0;
        for (const contact::SurfacePoint& p : bone.points) {
            const Vec3 d = p.position - place.middle;
            sum += glm::dot(d, d) / count;
        }
        place.gyration = std::sqrt(sum);
    }

    void find_neighbours(const fit::Arrangement& planned) {
        for (std::size_t a = 0; a < places_.size(); ++a) {
            if (planned.is_hidden(static_cast<int>(a)) || plan->bones[a].points.empty()) continue;
            std::vector<Vec3> points;
            for (const contact::SurfacePoint& p : plan->bones[a].points)
                points.push_back(places_[a].pose.apply(p.position));
            const geometry::PointTree tree(points);
            for (std::size_t b = 0; b < places_.size(); ++b) {
                if (b == a || planned.is_hidden(static_cast<int>(b))) continue;
                const auto& others = plan->bones[b].points;
                const bool meet = std::ranges::any_of(others, [&](const contact::SurfacePoint& p) {
                    const Vec3 at = places_[b].pose.apply(p.position);
                    return glm::length(points[tree.nearest(at)] - at) <= meets;
                });
                if (meet) places_[b].neighbours.push_back(a);
            }
        }
    }

    static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    static constexpr double stays_with = 1e-3;  // m: the target does not jump to and fro between two pieces

    std::vector<Place> places_;
    std::size_t beside_ = none;
};

TACTUS_NODE(PlannedPlace, scene, held, pose, led, target, fits, fragment, partner, distance, angle, gap, plan,
            alternative, reach, turn, meets)
TACTUS_VISUALS(PlannedPlace)

}  // namespace tactus::nodes
