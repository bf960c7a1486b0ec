// SPDX-License-Identifier: Apache-2.0
#include "dsp/coupling/scene.hpp"

#include "dsp/coupling/placement.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

#include <cmath>

namespace tactus::nodes {

struct Scene {
    static constexpr auto about =
        "Combines up to four bodies and their poses into one scene: place 0 is body 'a', place 1 body 'b', and so on. "
        "A body has the pose of its file plus its offset, unless a wire gives its pose or a hand has moved it.";

    In<coupling::Body> a{"place 0"};
    In<coupling::Body> b{optional, "place 1"};
    In<coupling::Body> c{optional, "place 2"};
    In<coupling::Body> d{optional, "place 3"};
    In<Pose> a_pose{optional, "of body a, at every tick", "m"};
    In<Pose> b_pose{optional, "of body b, at every tick", "m"};
    In<Pose> c_pose{optional, "of body c, at every tick", "m"};
    In<Pose> d_pose{optional, "of body d, at every tick", "m"};
    In<Pose> moved{optional, "pose that a hand has given the body at place 'which'; the body keeps it", "m"};
    In<double> which{optional, "place of the body that 'moved' refers to; -1: none"};
    Out<tactus::coupling::Scene> scene{"for contact, coupling and grasp nodes"};
    Param middle{discrete, "-1", "-1", "3",
                 "place of the body whose centroid is the origin of the scene; -1: origin of the files"};
    Vector a_at{"0 mm, 0 mm, 0 mm", "offset of body a"};
    Vector b_at{"0 mm, 0 mm, 0 mm", "offset of body b"};
    Vector c_at{"0 mm, 0 mm, 0 mm", "offset of body c"};
    Vector d_at{"0 mm, 0 mm, 0 mm", "offset of body d"};
    Vector a_turn{"0 deg, 0 deg, 0 deg", "rotation of body a about its own origin: about x first, then y, then z"};
    Vector b_turn{"0 deg, 0 deg, 0 deg", "rotation of body b about its own origin: about x first, then y, then z"};
    Vector c_turn{"0 deg, 0 deg, 0 deg", "rotation of body c about its own origin: about x first, then y, then z"};
    Vector d_turn{"0 deg, 0 deg, 0 deg", "rotation of body d about its own origin: about x first, then y, then z"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::scene, .value = "scene", .slots = {"a", "b", "c", "d"}}};
    }

    void process(const Tick&) noexcept {
        tactus::coupling::Scene now;
        Vec3 origin(0.0);
        const In<coupling::Body>* bodies[] = {&a, &b, &c, &d};
        const In<Pose>* poses[] = {&a_pose, &b_pose, &c_pose, &d_pose};
        const Vec3 at[] = {a_at, b_at, c_at, d_at}, turn[] = {a_turn, b_turn, c_turn, d_turn};
        const double first = middle;
        if (first >= 0.0 && bodies[static_cast<std::size_t>(first)]->connected)
            origin = bodies[static_cast<std::size_t>(first)]->get().home.position;
        // A body that is missing between others leaves an empty place.
        for (std::size_t i = 0; i < places; ++i) {
            if (!bodies[i]->connected && i > 0) continue;
            now.count = i + 1;
            coupling::SceneObject& object = now.objects[i];
            object.body = bodies[i]->get();
            // A pose that is not valid for a tick leaves the body where it is.
            if (poses[i]->connected && is_valid(poses[i]->get())) put_[i] = {true, poses[i]->get()};
            if (!put_[i].is_put) {
                const Pose& home = object.body.home;
                object.pose = {home.position - origin + at[i],
                               glm::normalize(coupling::rotation_xyz(turn[i]) * home.orientation)};
            } else object.pose = put_[i].pose;
        }
        if (moved.connected && which.connected && is_valid(moved.get())) {
            const double place = which.get();
            if (place >= 0.0 && place < static_cast<double>(now.count)) {
                const auto i = static_cast<std::size_t>(place);
                put_[i] = {true, moved.get()};
                now.objects[i].pose = moved.get();
            }
        }
        now.version = ++version_;
        now.content_hash = coupling::hash_of(now);
        scene = now;
    }

private:
    static constexpr std::size_t places = 4;
    struct Put {
        bool is_put = false;
        Pose pose;
    };
    Put put_[places];
    std::int64_t version_ = 0;
};

TACTUS_NODE(Scene, a, b, c, d, a_pose, b_pose, c_pose, d_pose, moved, which, scene, middle, a_at, b_at, c_at, d_at,
            a_turn, b_turn, c_turn, d_turn)
TACTUS_VISUALS(Scene)

}  // namespace tactus::nodes
