// SPDX-License-Identifier: Apache-2.0
#include "graph/node/node.hpp"
#include "graph/node/task_asset.hpp"
#include "graph/node/visual.hpp"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

namespace tactus::nodes {

struct PlanFrame {
    static constexpr auto about =
        "Puts a scene in front of the planned cut of a task: a blade that rests at the origin of the scene and cuts "
        "towards its -z, with its stroke along x, then stands before the planned entry. Behind 'workspace'.";

    In<Pose> pose{"of the blade: workspace.pose", "m"};
    In<Pose> frame{"device axes at the handle: workspace.frame", "m"};
    Out<Pose> placed{"pose of the blade at the bone", "m"};
    Out<Pose> placed_frame{"device axes at the handle, at the bone; for device_wrench", "m"};
    Asset<training::Task> task{"the task"};
    Param cut{structural, "1", "1", "32", "of the task: the first, the second, ..."};
    Param clearance{structural, "5 mm", "0 mm", "100 mm", "from the resting blade to the planned entry"};

    // The frame of the workspace goes on to `place`.
    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::workspace, .place = "placed_frame", .frame = "frame"}};
    }

    void prepare(const Setup& setup) {
        const auto index = static_cast<std::size_t>(cut.value);
        if (index > task->cuts.size())
            setup.fail(fmt::format("the task has {} cuts; there is no cut {}", task->cuts.size(), index));
        const training::PlannedCut& planned = task->cuts[index - 1];
        at_ = {planned.point - clearance.value * planned.feed,
               glm::normalize(glm::quat_cast(Mat3(planned.stroke, planned.normal, -planned.feed)))};
        placed = at_ * Pose{};
        placed_frame = at_ * Pose{};
    }
    void process(const Tick&) noexcept {
        placed = at_ * pose.get();
        placed_frame = at_ * frame.get();
    }

private:
    Pose at_;
};

TACTUS_NODE(PlanFrame, pose, frame, placed, placed_frame, task, cut, clearance)
TACTUS_VISUALS(PlanFrame)

}  // namespace tactus::nodes
