// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/step_row.hpp"
#include "dsp/planning/arrangement.hpp"
#include "dsp/snap/fit.hpp"
#include "graph/assets.hpp"
#include "graph/node.hpp"
#include "nodes/contact/body_parts.hpp"
#include "nodes/planning/step_record.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace tactus::nodes {

struct CaseScene {
    static constexpr auto about =
        "The fragments of a plan as one scene. The one in the hand goes where the coupling has it, with all that is "
        "grouped with it; letting go, settling, joining, splitting and locking are steps that can be undone, and every "
        "step is recorded as it is done.";

    In<Pose> moved{optional, "where the coupling has the body at place 'which'", "m"};
    In<double> which{optional, "place of the body in the hand, -1 without one"};
    In<bool> holding{optional, "it is held; once it is not, it stays where it was last"};
    In<Pose> target{optional, "where the body in the hand would fit: fragment_matcher.target", "m"};
    In<bool> fits{optional, "there is such a place"};
    In<double> target_of{optional, "place of the body that it is of: fragment_matcher.fragment, which may lag behind"};
    In<double> partner{optional, "place of the body that it fits"};
    In<double> score{optional, "of that fit"};
    In<double> margin{optional, "of that fit, to the second best"};
    In<double> rms{optional, "of that fit", "m"};
    In<bool> settle{optional, "pressed: what is held is put where it fits, and stays there"};
    In<bool> join{optional, "pressed: what is held moves with its partner from now on"};
    In<bool> split{optional, "pressed: what is held leaves all groups"};
    In<bool> lock{optional, "pressed: what is held is locked, or unlocked"};
    In<bool> undo{optional, "pressed: one step back"};
    In<bool> redo{optional, "pressed: one step on"};
    Out<tactus::Scene> scene{"for grasp, coupling and fragment_matcher"};
    Out<double> steps{"done so far, without those that were undone"};
    Out<bool> settled{"the body in the hand has been put where it fits"};
    Asset<CaseBones> plan{"the plan with its fragments; new steps follow where it stands"};
    Text file{"plan-steps.csv", "name of the record of steps within the folder of the run"};
    Param loose{"8 mm", "0.1 mm", "100 mm",
                "a settled body that the hand takes farther than this from where it had it is free again"};

    void prepare(const Setup& setup) {
        if (plan->bones.size() > tactus::Scene::most_objects)
            setup.fail("plan '" + plan.name + "' has more than 16 fragments; hide none, but plan them in parts");
        name_ = setup.name;
        parts_.clear();
        for (const Bone& bone : plan->bones) parts_.push_back(body_of(bone));
        const PlanState state = state_of(plan->plan);
        base_fitted_.clear();
        base_ = std::make_unique<Arrangement>(state.arrangement);
        now_ = std::make_unique<Arrangement>(state.arrangement);
        for (std::size_t n = 0; n < parts_.size(); ++n) base_fitted_.push_back(state.fits[n].has_value());
        fitted_ = base_fitted_;
        log_ = std::make_unique<StepLog>(parts_.size());
        if (!file.value.empty())
            stream_ = &setup.outside->record({file.value, "", &step_row_type, setup.period}, setup.where);
        tell();
    }

    void process(const Tick& tick) noexcept {
        const bool was_holding = holding_;
        follow();
        press(tick);
        if (was_holding && !holding_) keep_last(tick);
        if (!holding_) settled_ = false;
        tell();
    }

    void report(Report& report) const {
        report.set(name_, "steps", static_cast<double>(log_->count()));
        if (log_->overflowed()) report.set(name_, "steps_not_kept", 1.0);
        const auto done = std::make_shared<CasePlan>(plan->plan);
        try {
            apply_steps(*done, log_->rows(), log_->seconds());
        } catch (const Error& error) {
            // What was done before it is kept all the same.
            report.set(name_, "error", std::string(error.what()));
        }
        report.results[name_] = std::shared_ptr<const CasePlan>(done);
    }

private:
    static std::shared_ptr<const BodyParts> body_of(const Bone& bone) {
        std::vector<SurfacePoint> points = bone.points;
        Vec3 middle(0.0);
        for (const SurfacePoint& p : points) middle += p.position / static_cast<double>(points.size());
        for (SurfacePoint& p : points) p.position -= middle;
        Grid field = bone.distance;
        field.origin -= middle;
        return std::make_shared<const BodyParts>(make_pointshell(points), make_voxmap(std::move(field)),
                                                 Pose{middle, {1.0, 0.0, 0.0, 0.0}}, false);
    }

    int held() const noexcept {
        if (!which.connected || !moved.connected) return -1;
        const double place = which.get();
        return place >= 0.0 && place < static_cast<double>(parts_.size()) ? static_cast<int>(place) : -1;
    }
    Pose file_pose(int fragment, const Pose& body) const noexcept {
        return body * parts_[static_cast<std::size_t>(fragment)]->home.inverse();
    }

    /// The body in the hand, and its group, where the coupling has it.
    void follow() noexcept {
        const int place = held();
        const bool wanted = place >= 0 && (!holding.connected || holding.get());
        if (wanted && (place != last_ || !holding_)) settled_ = false;
        holding_ = wanted;
        if (!wanted) return;
        last_ = place;
        if (!is_valid(moved.get())) return;
        const Pose here = file_pose(place, {moved->position, glm::normalize(moved->orientation)});
        if (settled_) {
            const Vec3& middle = parts_[static_cast<std::size_t>(place)]->home.position;
            // What was in the way of the hand when it settled counts for nothing.
            if (!(glm::length(here.apply(middle) - let_at_) > loose)) return;
            settled_ = false;
        }
        now_->move(place, here);
        fitted_[static_cast<std::size_t>(place)] = 0;
    }

    void press(const Tick& tick) noexcept {
        if (edge(settle, 0) && holding_ && has_fit() && moved.connected && is_valid(moved.get())) {
            if (now_->move(last_, file_pose(last_, {target->position, glm::normalize(target->orientation)}))) {
                settled_ = true;
                const Vec3& middle = parts_[static_cast<std::size_t>(last_)]->home.position;
                let_at_ = file_pose(last_, {moved->position, glm::normalize(moved->orientation)}).apply(middle);
                fitted_[static_cast<std::size_t>(last_)] = 1;
                placed(tick, last_, 1.0);
            }
        }
        if (edge(join, 1) && last_ >= 0) {
            const int other = partner_place();
            const int both[] = {last_, other};
            keep_held(tick);
            if (other >= 0 && now_->join(both) != Arrangement::none) arranged(tick, StepKind::group, other);
        }
        if (edge(split, 2) && last_ >= 0 && now_->remove(last_)) arranged(tick, StepKind::remove, -1);
        if (edge(lock, 3) && last_ >= 0) {
            keep_held(tick);
            now_->lock(last_, !now_->is_locked(last_));
            arranged(tick, now_->is_locked(last_) ? StepKind::lock : StepKind::unlock, -1);
        }
        const bool back = edge(undo, 4), on = edge(redo, 5);
        if (!holding_ && back != on && (back ? log_->undo() : log_->redo())) {
            restore();
            StepRow row;
            row.step = static_cast<double>(log_->count());
            row.after = static_cast<double>(log_->head());
            row.kind = row_goes_to;
            write(tick, row);
        }
    }

    /// Where the body in the hand would fit, and it is that body.
    bool has_fit() const noexcept {
        return fits.connected && fits.get() && target.connected && is_valid(target.get()) &&
               (!target_of.connected || target_of.get() == static_cast<double>(last_));
    }

    /// Where the hand has brought a body is a step before what is done to it there.
    void keep_held(const Tick& tick) noexcept {
        if (holding_) keep_last(tick);
    }
    void keep_last(const Tick& tick) noexcept {
        if (!settled_ && last_ >= 0 && now_->can_move(last_)) placed(tick, last_, 0.0);
    }

    int partner_place() const noexcept {
        const double place = partner.connected ? partner.get() : -1.0;
        return place >= 0.0 && place < static_cast<double>(parts_.size()) ? static_cast<int>(place) : -1;
    }

    bool edge(const In<bool>& button, std::size_t n) noexcept {
        const bool now = button.connected && button.get(), pressed = now && !was_[n];
        was_[n] = now;
        return pressed;
    }

    /// A fragment and all that moves with it stand where they are now.
    void placed(const Tick& tick, int fragment, double by) noexcept {
        StepRow row = log_->next(StepKind::place);
        row.by = by;
        if (by > 0.0) {
            row.other = partner_place();
            row.verdict = static_cast<double>(FitVerdict::fit);
            row.score = score.connected ? score.get() : 0.0;
            row.margin = margin.connected ? margin.get() : 0.0;
            row.rms = rms.connected ? rms.get() : 0.0;
        }
        for (int n = -1; n < static_cast<int>(parts_.size()); ++n) {
            const int one = n < 0 ? fragment : n;
            if (n == fragment || !now_->move_together(fragment, one)) continue;
            row.fragment = one;
            row.set(now_->pose(one));
            write(tick, row);
        }
        log_->done();
    }

    void arranged(const Tick& tick, StepKind kind, int other) noexcept {
        StepRow row = log_->next(kind);
        row.fragment = last_;
        row.other = other;
        write(tick, row);
        log_->done();
    }

    void write(const Tick& tick, const StepRow& row) noexcept {
        log_->add(row, tick.time_seconds());
        if (stream_) stream_->write(tick.index, &row, 1, sizeof row);
    }

    /// What the steps up to the head come to.
    void restore() noexcept {
        *now_ = *base_;
        std::ranges::copy(base_fitted_, fitted_.begin());
        for (const StepRow& row : log_->rows_to_head()) {
            const auto fragment = static_cast<int>(row.fragment);
            const int both[] = {fragment, static_cast<int>(row.other)};
            switch (static_cast<StepKind>(static_cast<int>(row.kind))) {
                case StepKind::place:
                    now_->place(fragment, row.pose());
                    fitted_[static_cast<std::size_t>(fragment)] = row.verdict >= 0.0;
                    break;
                case StepKind::group: now_->join(both); break;
                case StepKind::remove: now_->remove(fragment); break;
                case StepKind::lock: now_->lock(fragment, true); break;
                case StepKind::unlock: now_->lock(fragment, false); break;
                default: break;
            }
        }
    }

    void tell() noexcept {
        tactus::Scene out;
        out.count = parts_.size();
        for (std::size_t n = 0; n < parts_.size(); ++n) {
            const int fragment = static_cast<int>(n);
            const BodyParts& part = *parts_[n];
            const bool is_there = !now_->is_hidden(fragment);
            out.objects[n] = {is_there ? part.body() : Body{}, now_->pose(fragment) * part.home,
                              now_->outermost(fragment), now_->is_locked(fragment) || fitted_[n] != 0};
            out.objects[n].body.home = part.home;
        }
        out.version = ++version_;
        out.content_hash = hash_of(out);
        scene = out;
        steps = static_cast<double>(log_->done_to_head());
        settled = settled_;
    }

    std::vector<std::shared_ptr<const BodyParts>> parts_;
    std::unique_ptr<Arrangement> base_, now_;
    std::vector<char> base_fitted_, fitted_;
    std::unique_ptr<StepLog> log_;
    RecordStream* stream_ = nullptr;
    std::string name_;
    std::int64_t version_ = 0;
    int last_ = -1;
    Vec3 let_at_{0.0};  // where the hand had the middle of a body when it was settled
    bool holding_ = false, settled_ = false;
    bool was_[6] = {};
};

TACTUS_NODE(CaseScene, moved, which, holding, target, fits, target_of, partner, score, margin, rms, settle, join, split,
            lock, undo, redo, scene, steps, settled, plan, file, loose)

}  // namespace tactus::nodes
