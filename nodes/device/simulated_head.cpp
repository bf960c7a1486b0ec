// SPDX-License-Identifier: Apache-2.0
#include "dsp/display/camera.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

#include <cmath>
#include <numbers>

namespace tactus::nodes {

struct SimulatedHead {
    static constexpr auto about =
        "A simulated head tracker for 'run --view --head' and 'render --head': the head sways about a position and "
        "looks at a point.";

    Out<Pose> pose{"point between the eyes; x leads to the right eye, y up, z away from the target", "m"};
    Vector position{"0 mm, -450 mm, 400 mm", "centre of the sway, in the viewer's world"};
    Vector look_at{"0 mm, 0 mm, 0 mm", "target of the eyes, in the viewer's world"};
    Vector sway{"100 mm, 30 mm, 40 mm", "amplitude along x, y and z"};
    Param frequency{"0.2 Hz", "0 Hz", "5 Hz", "of the sway along x; 1.3 times as fast along y, 0.7 times along z"};

    std::vector<Visual> visuals() const { return {{.kind = VisualKind::handle, .pose = "pose"}}; }

    void prepare(const Setup&) {
        turns_ = 0.0;
        look();
    }
    void process(const Tick& tick) noexcept {
        turns_ += frequency * tick.elapsed_seconds();
        look();
    }

private:
    void look() noexcept {
        const double angle = 2.0 * std::numbers::pi * turns_;
        const Vec3 middle = position, reach = sway, towards = look_at;
        display::OrbitCamera eyes;
        const Vec3 at = middle + reach * Vec3(std::sin(angle), std::sin(1.3 * angle), std::sin(0.7 * angle));
        eyes.look_along(towards - at);
        pose = Pose{at, eyes.orientation};
    }

    double turns_ = 0.0;
};

TACTUS_NODE(SimulatedHead, pose, position, look_at, sway, frequency)
TACTUS_VISUALS(SimulatedHead)

}  // namespace tactus::nodes
