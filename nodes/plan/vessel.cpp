// SPDX-License-Identifier: Apache-2.0
#include "dsp/rope/attached_vessel.hpp"

#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/coupling/scene.hpp"
#include "dsp/rope/scene_bones.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"
#include "graph/node/vessel_asset.hpp"
#include "graph/node/visual.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::nodes {

struct Vessel {
    static constexpr auto about =
        "A vessel of a flap: attached to the pieces of bone that it runs along, free between them and in its pedicle, "
        "whose end is sewn to a site. The hand feels the pull on the piece that it holds, 'gain' times as strong as it "
        "is; 'tension' is the true one. It lies on all bones of the scene. At rest, free parts have 0.89 of their "
        "length "
        "in the leg. Research use: limits are parameters, not clinical advice.";

    In<tactus::coupling::Scene> scene{"the pieces, in the order of the plan, and all other bones"};
    In<Pose> hand{optional, "of the hand in the scene; open: torques are about the origin", "m"};
    In<double> held{optional, "place of the held piece; -1 or open: none"};
    In<Pose> pose{optional, "of the held piece, newer than in the scene: coupling.pose", "m"};
    In<double> strength{
        optional,
        "share of the force that the hand feels, 0 to 1: grasp.strength; open: 1, which comes and goes in 0.1 s"};
    In<Pose> site{optional, of_world, "where the end is sewn; open: 'plan_site', else 'site_at'", "m"};
    In<bool> sewn{optional, of_world, "the end is sewn to its site; false: it is free; open: true"};
    Out<Wrench> wrench{"on the hand: 'gain' times the vessel's pull on the held piece and its group; 0 of a vein",
                       "N, N m"};
    Out<double> tension{"true tension of the pedicle where it leaves the bone; 0 of a vein", "N"};
    Out<double> span_tension{"true tension, the largest between two pieces; 0 of a vein", "N"};
    Out<double> strain{"of the pedicle, from rest; negative: slack. While it is not sewn: of a straight one", ""};
    Out<double> slack{"rest length less length of the pedicle; 0: taut", "m"};
    Out<double> twist{"of the pedicle since it was sewn", "rad"};
    Out<double> bend{"least radius of curvature of the pedicle over that of the vessel, up to 1000", ""};
    Out<double> verdict{
        "0: reaches without tension, 1: with at most that of the leg, 2: 10 % longer, 3: does not reach"};
    Out<bool> reaches{"it is sewn, and the verdict is 0 or 1"};
    Out<bool> is_kinked{"'bend' is below 'kink'"};
    Out<bool> is_twisted{"'twist' is beyond 'twist_limit'"};
    Out<rope::RopeShape> rope{"its course, for pictures"};
    Asset<plan::CaseBones> plan{"the plan of the scene: the pieces' names, and their surfaces"};
    Asset<vessel::Course> course{
        "from the end that is sewn, in the frame of the pieces' files: a table of 'tactus vessel'"};
    Text pieces{"", "it runs along pieces whose names begin like this; empty: along any"};
    Choice kind{{"artery", "vein"}, "artery: gives forces; vein: its law is not known, so it gives reach only"};
    Text plan_site{"", "name of a site of the plan's reconstruction, where the end is sewn; empty: 'site_at'"};
    Vector site_at{"0 mm, 0 mm, 0 mm", "where the end is sewn, in the scene"};
    Param gain{"3", "0", "20", "how many times as strong as it is the hand feels the pull"};
    Param max_force{"4 N", "0 N", "30 N", "limit of the force on the hand"};
    static constexpr double min_pedicle = 20e-3;  // m
    Param pedicle{structural, "0 mm", "0 mm", "1 m",
                  "length in the leg that is kept before the first piece, at least 20 mm; 0: all"};
    Param beside{structural, "12 mm", "0.5 mm", "50 mm",
                 "it runs along a piece that is at most this far from its centre line"};
    Param stiffness{structural, "1.86 N", "0.01 N", "20 N",
                    "force per strain: 62 kPa at 12 % on 3.6 mm² (Struczewska and others 2024)"};
    Param idle_rate{structural, "200 Hz", "1 Hz", "10 kHz",
                    "how often it is solved while the hand holds no piece of it"};
    Param kink{discrete, "3", "0", "100", "a bend below so many radii of the vessel is a kink: no source"};
    Param twist_limit{discrete, "90 deg", "0 deg", "720 deg",
                      "beyond it: 3 of 8 flaps survive 180 deg (rat, Guven 2012)"};

    std::vector<Visual> visuals() const { return {{.kind = VisualKind::rope, .value = "rope", .asset = "course"}}; }

    void prepare(const Setup& setup) {
        name_ = setup.name;
        is_new_ = true;
        felt_ = -1;
        std::vector<std::vector<Vec3>> surfaces(plan->bones.size());
        const plan::PlanState state = plan::state_of(plan->plan);
        bool is_any = false;
        for (std::size_t n = 0; n < plan->bones.size(); ++n) {
            if (!plan->plan.fragments[n].name.starts_with(pieces.value)) continue;
            // Pieces of other reconstructions of the plan are cut from the same bone.
            if (!state.pieces.empty() && std::ranges::find(state.pieces, static_cast<int>(n)) == state.pieces.end())
                continue;
            is_any = true;
            for (const contact::SurfacePoint& p : plan->bones[n].points) surfaces[n].push_back(p.position);
        }
        if (!is_any)
            setup.fail("no fragment of plan '" + plan.name + "' has a name that begins with '" + pieces.value + "'");
        const std::vector<Vec3> line = fine(course->points);
        poses_.assign(plan->bones.size(), {});
        for (std::size_t n = 0; n < poses_.size(); ++n) poses_[n] = state.arrangement.pose(static_cast<int>(n));
        rope::AttachedVesselSettings settings;
        settings.material.stiffness = stiffness;
        settings.material.radius = course->median_radius();
        settings.pedicle = pedicle;
        // On its way of some centimetres a shorter one would be stretched to many times its length: no vessel, but a spring. Held
        // points move at most half a segment per substep; if it were shorter, they would lag behind a fast hand and give
        // energy.
        if (pedicle > 0.0 && pedicle < min_pedicle)
            setup.fail("a pedicle of " + fmt::format("{:.3g}", pedicle * 1e3) +
                       " mm reaches no site; give at least 20 mm, or 0 mm for all of the vessel");
        const std::vector<rope::Attachment> attached = rope::attachments_along(line, surfaces, beside);
        if (attached.empty())
            setup.fail("the vessel '" + course.name + "' runs along none of the pieces: none is within " +
                       std::to_string(std::lround(beside * 1e3)) +
                       " mm beside it. Both must be in the frame of the scan of the leg; see also 'beside'");
        try {
            vessel_.emplace(line, attached, poses_, settings);
        } catch (const Error& error) {
            setup.fail("the vessel '" + course.name + "': " + error.message());
        }
        idle_ticks_ = std::max<std::int64_t>(
            1, std::llround(rate_of(setup.period) / std::min(idle_rate.value, rate_of(setup.period))));
        // Vessels that idle take turns.
        Hash turn;
        turn.add_text(setup.name);
        phase_ = static_cast<std::int64_t>(turn.value() % static_cast<std::uint64_t>(idle_ticks_));
        shape_ = {};
        shape_.is_vein = kind.is("vein") ? 1 : 0;
        find_plan_site(setup, state);
        last_site_.reset();
        if (!site.connected) last_site_ = given_site();
        site_ = last_site_.value_or(given_site());
        publish(false);
        rope = shape_;
    }

    void process(const Tick& tick) noexcept {
        waited_ += tick.elapsed_seconds();
        const int place = held_place();
        follow(place);
        const bool is_held = holds(place);
        // A piece that is held from the start was not grasped: what follows is one closed law.
        const double part = std::exchange(is_new_, false) ? 1.0 : tick.elapsed_seconds() / fade_time;
        fade_to(is_held ? place : -1, part);
        if (!site.connected) last_site_ = given_site();
        else if (is_valid(site.get())) last_site_ = site->position;
        // A site that was never there is sewn to nothing.
        const bool is_wanted = last_site_ && (!sewn.connected || sewn.get());
        const Vec3 where = last_site_.value_or(given_site());
        if (!is_held && (tick.index + phase_) % idle_ticks_ != 0) {
            give(-1);
            if (ticks_ > 0) return;
            // The first update is pending; outputs already refer to the site.
            site_ = where;
            tell(is_wanted);
            return;
        }
        bones_.clear();
        for (std::size_t n = 0; n < scene->count && n < poses_.size(); ++n)
            if (const contact::Voxmap* map = scene->objects[n].body.map)
                bones_.add(*map, poses_[n] * scene->objects[n].body.home);
        const rope::RopeStep step = vessel_->step(waited_, poses_, is_wanted ? &where : nullptr, &bones_);
        waited_ = 0.0;
        unsolved_ += !step.is_solved;
        ++ticks_;
        residual_ = std::max(residual_, step.residual);
        give(is_held && !shape_.is_vein ? place : -1);
        site_ = where;
        publish(is_wanted);
    }

    void report(Report& report) const {
        report.set(name_, "tension_max_N", greatest_);
        report.set(name_, "felt_max_N", greatest_felt_);
        report.set(name_, "gain", gain.value);
        report.set(name_, "residual_max_N", residual_);
        report.set(name_, "unsolved", ticks_ > 0 ? static_cast<double>(unsolved_) / static_cast<double>(ticks_) : 0.0);
        report.set(name_, "verdict", static_cast<double>(rope::reach_of(vessel_->strain(&site_))));
        report.set(name_, "strain", vessel_->strain(&site_));
    }

private:
    /// About a point per millimetre, so that an attachment ends where its piece does.
    static std::vector<Vec3> fine(const std::vector<Vec3>& points) {
        const auto count = static_cast<std::size_t>(std::ceil(rope::length_of(points) / 1e-3)) + 1;
        return rope::resampled(points, std::clamp<std::size_t>(count, 2, 5000));
    }

    void find_plan_site(const Setup& setup, const plan::PlanState& state) {
        plan_site_.reset();
        if (plan_site.value.empty()) return;
        if (!state.reconstruction)
            setup.fail("plan '" + plan.name + "' has no reconstruction, hence no site '" + plan_site.value +
                       "'; clear 'plan_site' and give 'site_at'");
        std::string names;
        for (const reconstruction::RecipientSite& one : state.reconstruction->flap.sites) {
            if (one.name == plan_site.value) {
                const bool is_vein = one.kind == reconstruction::VesselKind::vein;
                if (is_vein != kind.is("vein"))
                    setup.fail("site '" + one.name + "' is that of " + (is_vein ? "a vein" : "an artery") +
                               ", and this vessel is " + (is_vein ? "an artery" : "a vein"));
                plan_site_ = one.at;
                return;
            }
            names += (names.empty() ? "" : ", ") + one.name;
        }
        setup.fail("plan '" + plan.name + "' has no site '" + plan_site.value +
                   "'; it has: " + (names.empty() ? "none" : names));
    }
    Vec3 given_site() const noexcept { return plan_site_.value_or(Vec3(site_at.value)); }

    int held_place() const noexcept {
        const double place = held.connected ? held.get() : -1.0;
        return place >= 0.0 && place < static_cast<double>(std::min(poses_.size(), scene->count))
                   ? static_cast<int>(place)
                   : -1;
    }

    /// The pieces' poses, from the frame of their files. An invalid pose keeps the previous one.
    void follow(int place) noexcept {
        for (std::size_t n = 0; n < poses_.size() && n < scene->count; ++n) {
            const coupling::SceneObject& object = scene->objects[n];
            // A hidden piece moves with its group, too.
            if (!is_valid(object.pose) || !is_valid(object.body.home)) continue;
            poses_[n] = unit(object.pose) * object.body.home.inverse();
        }
        if (place < 0 || !pose.connected || !is_valid(pose.get())) return;
        const coupling::SceneObject& object = scene->objects[static_cast<std::size_t>(place)];
        if (!is_valid(object.pose)) return;
        // The group of the held piece moves with it.
        const Pose moved = unit(pose.get()) * unit(object.pose).inverse();
        for (std::size_t n = 0; n < poses_.size() && n < scene->count; ++n)
            if (moves_with(place, n)) poses_[n] = moved * poses_[n];
    }
    static Pose unit(const Pose& given) noexcept { return {given.position, glm::normalize(given.orientation)}; }

    bool moves_with(int place, std::size_t n) const noexcept {
        const int group = scene->objects[static_cast<std::size_t>(place)].unit;
        return static_cast<int>(n) == place || (group >= 0 && scene->objects[n].unit == group);
    }
    bool holds(int place) const noexcept {
        for (std::size_t n = 0; place >= 0 && n < poses_.size() && n < scene->count; ++n)
            if (moves_with(place, n) && vessel_->is_attached_to(static_cast<int>(n))) return true;
        return false;
    }

    /// The pull of another piece begins when that of the one before has faded.
    void fade_to(int place, double part) noexcept {
        if (place == felt_) left_ = place >= 0 ? std::min(left_ + part, 1.0) : 0.0;
        else left_ = felt_ >= 0 ? std::max(left_ - part, 0.0) : 0.0;
        if (place == felt_ || left_ > 0.0) return;
        felt_ = place;
        if (part >= 1.0) left_ = 1.0;
    }
    /// The force on the hand that holds the piece `place`, -1: none. Where nothing specifies the strength, it fades in and out.
    void give(int place) noexcept {
        if (place >= 0 && (strength.connected || place == felt_)) last_ = felt(place);
        else if (strength.connected || left_ == 0.0 || (hand.connected && !is_valid(hand.get()))) last_ = {};
        wrench = last_ * (strength.connected ? std::clamp(strength.get(), 0.0, 1.0) : left_);
    }

    Wrench felt(int place) noexcept {
        if (hand.connected && !is_valid(hand.get())) return {};
        const Vec3 origin = hand.connected ? hand->position : Vec3(0.0);
        Wrench pull;
        for (std::size_t n = 0; n < poses_.size() && n < scene->count; ++n)
            if (moves_with(place, n)) pull = pull + vessel_->pull_on(static_cast<int>(n), origin);
        pull = pull * gain.value;
        const double size = glm::length(pull.force);
        if (size > max_force) pull = pull * (max_force / size);
        greatest_felt_ = std::max(greatest_felt_, std::min(size, max_force.value));
        return pull;
    }

    void tell(bool is_wanted) noexcept {
        const bool gives_force = !shape_.is_vein;
        tension = gives_force ? vessel_->tension() : 0.0;
        span_tension = gives_force ? vessel_->span_tension() : 0.0;
        const double now = vessel_->strain(&site_);
        strain = now;
        slack = std::max(0.0, -now * vessel_->pedicle_rest());
        twist = vessel_->twist();
        bend = std::min(vessel_->bend_ratio(), 1000.0);
        const rope::Reach reach = rope::reach_of(now);
        verdict = static_cast<double>(reach);
        reaches = is_wanted && vessel_->is_sewn() && reach <= rope::Reach::in_situ;
        is_kinked = bend.get() < kink;
        is_twisted = std::abs(vessel_->twist()) > twist_limit;
        greatest_ = std::max(greatest_, std::max(tension.get(), span_tension.get()));
    }

    void publish(bool is_wanted) noexcept {
        tell(is_wanted);
        vessel_->show(shape_);
        ++shape_.version;
        Hash hash;
        hash.add_bytes(shape_.points.data(), sizeof shape_.points);
        shape_.content_hash = hash.value();
        rope = shape_;
    }

    std::optional<rope::AttachedVessel> vessel_;
    rope::SceneBones bones_;
    rope::RopeShape shape_;
    std::vector<Pose> poses_;  // of each fragment, from its file's frame
    std::string name_;
    Vec3 site_{0.0};
    std::optional<Vec3> last_site_, plan_site_;
    std::int64_t idle_ticks_ = 1, phase_ = 0;
    static constexpr double fade_time = 0.1;  // s
    bool is_new_ = true;
    int felt_ = -1;  // the piece whose pull the hand has
    double left_ = 0.0;  // of the fade where nothing specifies the strength
    Wrench last_;  // of the held piece
    double waited_ = 0.0, greatest_ = 0.0, greatest_felt_ = 0.0, residual_ = 0.0;
    std::uint64_t ticks_ = 0, unsolved_ = 0;
};

TACTUS_NODE(Vessel, scene, hand, held, pose, strength, site, sewn, wrench, tension, span_tension, strain, slack, twist,
            bend, verdict, reaches, is_kinked, is_twisted, rope, plan, course, pieces, kind, plan_site, site_at, gain,
            max_force, pedicle, beside, stiffness, idle_rate, kink, twist_limit)
TACTUS_VISUALS(Vessel)

}  // namespace tactus::nodes
