// SPDX-License-Identifier: Apache-2.0
#include "assets/training/warnings.hpp"
#include "dsp/contact/contact_switch.hpp"
#include "dsp/training/attempt_row.hpp"
#include "graph/node/node.hpp"
#include "graph/node/task_asset.hpp"
#include "graph/node/visual.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <new>

namespace tactus::nodes {

namespace {

const ValueType attempt_row_type{
    .name = "attempt",
    .size = sizeof(training::AttemptRow),
    .columns = training::attempt_column_names,
    .hash = [](Hash& hash, const void* p) { hash.add_bytes(p, sizeof(training::AttemptRow)); },
    .interpolate = nullptr,
    .to_columns = [](const void* p, double* out) { std::memcpy(out, p, sizeof(training::AttemptRow)); },
    .make_default = [](void* out) { new (out) training::AttemptRow{}; },
    .version = nullptr,
    .load_asset = nullptr,
};

constexpr double stop_ahead = 2e-3;    // m above the depth stop, and
constexpr double margin_ahead = 1e-3;  // m outside of a margin, where the cue begins

double finite(double v) noexcept { return std::isfinite(v) ? std::clamp(v, -1e9, 1e9) : 0.0; }

}  // namespace

struct Task {
    static constexpr auto about =
        "What a trainee is to do: where the blade is against the nearest planned cut, what is over its limit, a cue "
        "for it, "
        "and "
        "the record task.csv that 'tactus score' reads. The scores are not validated.";
    static constexpr NodeRole role = NodeRole::file_sink;

    In<Pose> pose{"of the blade: x along the stroke, y into the bone, origin in the middle of the tooth edge"};
    In<Wrench> force{optional, "on the hand, after all limits: device_output.applied", "N, N m"};
    In<bool> contact{optional,
                     "the blade touches the bone; unconnected: a force passed 0.05 N and has not fallen below 0.02 N"};
    In<double> removed{optional, "volume removed since the start", "m^3"};
    In<double> heat{optional, "time that bone was above the temperature that harms it", "s"};
    Out<double> distance{"of the middle of the tooth edge from the planned plane, along its normal", "m"};
    Out<double> angle{"between the blade and the planned plane", "rad"};
    Out<double> depth_left{"to the depth stop, along the planned feed; negative beyond it", "m"};
    Out<double> clearance{"from the blade to the nearest structure to spare; 1 m without any", "m"};
    Out<double> elapsed{"since the first touch of the bone", "s"};
    Out<bool> off_plan{"beyond the tolerance of distance or angle, near or in the bone"};
    Out<bool> too_deep{"beyond the depth stop and its tolerance"};
    Out<bool> too_near{"within the margin of a structure to spare"};
    Out<bool> over_force{"the force on the hand is above its limit"};
    Out<bool> over_time{"the time since the first touch is above its limit"};
    Out<bool> over_heat{"the time of harmful heat is above its limit"};
    Out<double> cue{"0: well within all tolerances and limits, rising to 1 where one of them is reached"};
    Asset<training::Task> task{"the task"};
    Text file{"task.csv", "record of the attempt, in the run's folder; empty: none"};

    std::vector<Visual> visuals() const { return {{.kind = VisualKind::task, .asset = "task"}}; }

    void prepare(const Setup& setup) {
        task_ = task.shared();
        row_ = {};
        touch_ = {};
        touched_ = 0;
        over_limit_ = deepest_ = worst_distance_ = worst_angle_ = 0.0;
        min_clearance_ = std::numeric_limits<double>::infinity();
        stream_ = nullptr;
        if (!file.value.empty())
            stream_ = &setup.host->record({file.value, "", &attempt_row_type, setup.period}, setup.where);
        distance = 0.0;
        angle = 0.0;
        depth_left = task_->cuts.front().depth;
        clearance = 1.0;
    }

    void process(const Tick& tick) noexcept {
        const training::Task& t = *task_;
        if (is_valid(pose.get()) && glm::length(pose->position) < 1e3) at_ = pose.get();
        const training::PlannedCut& cut = t.cuts[training::nearest_cut(t.cuts, at_)];
        const training::CutDeviation now = training::deviation_of(cut, t.blade, at_);
        double least = 1.0, margin_left = 1.0;
        for (const training::SparedStructure& s : t.spared) {
            const double c = training::clearance_of(s, t.blade, at_);
            least = std::min(least, c);
            margin_left = std::min(margin_left, c - s.margin);
        }
        const Wrench hand = force.connected && is_finite(force.get()) ? force.get() : Wrench{};
        const double pressed = std::min(glm::length(hand.force), 1e9);
        const bool touches = contact.connected ? contact.get() : touch_.update(pressed);
        const double hot = heat.connected ? finite(heat.get()) : -1.0;

        const training::TaskLimits& limits = t.limits;
        const bool is_near = now.depth > -training::near_bone;
        const double left = cut.depth - now.depth;
        const double aside = std::abs(now.distance) / cut.tolerance, turned = now.angle / cut.angle_tolerance;
        const double push = limits.force ? pressed / *limits.force : 0.0;
        distance = now.distance;
        angle = now.angle;
        depth_left = left;
        clearance = least;
        const double shares = std::max({is_near ? std::max(aside, turned) : 0.0, push,
                                        is_near ? 1.0 - 0.5 * (left + cut.depth_tolerance) / stop_ahead : 0.0,
                                        1.0 - 0.5 * margin_left / margin_ahead});
        cue = std::clamp(2.0 * shares - 1.0, 0.0, 1.0);

        row_ = {at_.position.x,
                at_.position.y,
                at_.position.z,
                at_.orientation.w,
                at_.orientation.x,
                at_.orientation.y,
                at_.orientation.z,
                finite(hand.force.x),
                finite(hand.force.y),
                finite(hand.force.z),
                touches ? 1.0 : 0.0,
                removed.connected ? finite(removed.get()) : 0.0,
                hot};
        const double step = seconds(tick.period);
        for (int i = 0; i < tick.frames; ++i) {
            if (touches || touched_ > 0) ++touched_;
            if (limits.force) over_limit_ += std::max(0.0, pressed - *limits.force) * step;
        }
        if (stream_) stream_->write(tick.index, &row_, static_cast<std::size_t>(tick.frames), 0);
        elapsed = static_cast<double>(std::max<std::int64_t>(0, touched_ - 1)) * step;
        const auto stands = training::warnings_of(t, cut, {now, margin_left, pressed, elapsed.get(), hot});
        const auto is = [&](training::Warning which) { return stands[static_cast<std::size_t>(which)]; };
        off_plan = is(training::Warning::off_plan);
        too_deep = is(training::Warning::too_deep);
        too_near = is(training::Warning::too_near);
        over_force = is(training::Warning::over_force);
        over_time = is(training::Warning::over_time);
        over_heat = is(training::Warning::over_heat);
        min_clearance_ = std::min(min_clearance_, least);
        deepest_ = std::max(deepest_, now.depth);
        if (!touches) return;
        worst_distance_ = std::max(worst_distance_, std::abs(now.distance));
        worst_angle_ = std::max(worst_angle_, now.angle);
    }

    void report(Report& report) const {
        report.set("task", "title", task_->title);
        report.set("task", "file", task_->file.string());
        report.set("task", "hash", fmt::format("{:016x}", task_->hash));
        report.set("task", "bone", task_->bone.string());
        report.set("task", "record", file.value);
        report.set("task", "force", std::string(force.connected ? "recorded" : "not recorded"));
        report.set("task", "scores", std::string("not validated"));
        report.set("task", "deepest_mm", deepest_ * 1e3);
        report.set("task", "largest_distance_mm", worst_distance_ * 1e3);
        report.set("task", "largest_angle_deg", worst_angle_ * 57.29577951308232);
        report.set("task", "over_limit_Ns", over_limit_);
        if (!task_->spared.empty()) report.set("task", "closest_mm", min_clearance_ * 1e3);
    }

private:
    contact::ContactSwitch touch_;
    std::shared_ptr<const training::Task> task_;
    RecordStream* stream_ = nullptr;
    training::AttemptRow row_;
    Pose at_;
    std::int64_t touched_ = 0;  // activations since the first touch
    double over_limit_ = 0.0, deepest_ = 0.0, worst_distance_ = 0.0, worst_angle_ = 0.0, min_clearance_ = 0.0;
};

TACTUS_NODE(Task, pose, force, contact, removed, heat, distance, angle, depth_left, clearance, elapsed, off_plan,
            too_deep, too_near, over_force, over_time, over_heat, cue, task, file)
TACTUS_VISUALS(Task)

}  // namespace tactus::nodes
