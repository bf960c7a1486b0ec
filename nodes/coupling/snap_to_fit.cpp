// SPDX-License-Identifier: Apache-2.0
#include "dsp/core/quantile.hpp"
#include "dsp/coupling/quasi_static.hpp"
#include "dsp/fit/fit.hpp"
#include "dsp/fit/held_fit.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"
#include "nodes/contact/contact_parameters.hpp"
#include "nodes/coupling/held_body.hpp"
#include "nodes/coupling/lead.hpp"
#include "nodes/coupling/solver_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace tactus::nodes {

struct SnapToFit {
    static constexpr auto about =
        "Snap-to-fit: quasi-static coupling of a held fragment whose painted fracture surface is pulled to that of "
        "another fragment. Each tick solves for the balance of pull, contact and springs; the hand can always overcome "
        "the pull. Without paint on both fragments there is no pull.";

    In<Pose> device{"pose of the hand in the scene", "m"};
    In<tactus::coupling::Scene> scene{"the fragments and all other bodies"};
    In<Pose> grip{optional, "pose of the held body in the frame of the hand; unconnected: its own frame", "m"};
    In<bool> holding{optional, "false: the body stays where it was released; unconnected: true"};
    In<double> strength{
        optional,
        "share of the force that the hand feels, 0 to 1; unconnected: 1, and 0 from 0.1 s after 'holding' ended"};
    In<bool> engaged{optional, "pull the fragment; unconnected: true"};
    In<bool> settle{optional, "the springs to the hand yield to the pull, so that the hand adds no bias"};
    Out<Wrench> wrench{"on the hand, about its origin", "N, N m"};
    Out<Pose> pose{"of the held body: the proxy", "m"};
    Out<double> place{"place of the held body in the scene; -1: none"};
    Out<double> score{"of the fit, 0 to 1: how much of both painted surfaces coincides; updated every 100 ticks"};
    Out<double> pull{"force of the pull", "N"};
    Out<double> penetration{"of the deepest point", "m"};
    Out<double> residual{"of the force balance", "N"};
    Out<bool> in_contact{"at least one point exerts a force"};
    Asset<bone::Bone> moving{"the held fragment, with painted points"};
    Asset<bone::Bone> fixed{"the other fragment, with painted points"};
    Param held{discrete, "1", "-1", "15", "place of the held body in the scene; connect grasp.held"};
    Param target{discrete, "0", "0", "15", "place of the other fragment"};
    Choice mode{{"extended", "baseline", "thesis"},
                "extended: robust two-sided energy with a narrowing scale; baseline: constant pull of the held "
                "fragment's points (thesis: its old name)"};
    Param force{"10 N", "0 N", "100 N", "limit of the pull of all painted points together"};
    Param reach{"4 mm", "0.1 mm", "12 mm", "maximum distance of the pull"};
    LeadParameters led;
    SolverParameters solver;
    ContactParameters contact;

    std::vector<Visual> visuals() const { return {held_visual(held)}; }

    void prepare(const Setup& setup) {
        contact_.emplace(contact.make(setup));
        moving_paint_ = surface_of(*moving);
        fixed_paint_ = surface_of(*fixed);
        energy_.reset();
        if (moving_paint_ && fixed_paint_) energy_.emplace(*moving_paint_, *fixed_paint_);
        fit_.emplace(*contact_, energy_ ? &*energy_ : nullptr);
        place = -1.0;
    }

    void process(const Tick& tick) noexcept {
        hold_.update(scene, held, holding, strength, tick.elapsed_seconds());
        const Pose in_hand = grip.connected && is_valid(grip.get()) ? grip.get() : Pose{};
        contact.set(*contact_, scene, hold_.place, in_hand);
        if (hold_.taken) take();
        lead_.update(led, device, has_pull() && force > 0.0 && (!engaged.connected || engaged.get()),
                     hold_.holds && settle.connected && settle.get(), solver_.state().balanced, tick.elapsed_seconds());
        solver.set(solver_.settings, *contact_, lead_.springs());
        solver_.settings.slip = lead_.slip();
        SolverParameters::slow_down(solver_.settings, solver_.state().proxy, device, tick.elapsed_seconds());
        if (hold_.holds) solve(in_hand, tick.elapsed_seconds());
        else let_go();
        place = hold_.place;
    }

    void report(Report& report) const {
        report.set("snap", "painted_points",
                   energy_ ? static_cast<double>(moving_paint_->position.size() + fixed_paint_->position.size()) : 0.0);
        report.set("snap", "score", score_);
        report.set("snap", "pull_max_N", max_pull_);
        report.set("snap", "residual_p99_N", residuals_.quantile(0.99));
        report.set("snap", "penetration_max_mm", deepest_ * 1e3);
    }

private:
    static std::optional<fit::FitSurface> surface_of(const bone::Bone& bone) {
        const auto painted = std::ranges::count_if(
            bone.points, [](const contact::SurfacePoint& p) { return p.label == contact::surface_label::fracture; });
        if (painted < 30) return std::nullopt;
        return fit::make_live_fit_surface(bone.points, bone.distance);
    }

    void take() noexcept {
        solver_.reset(device);
        fit_->forget();
        lead_.take();
        scale_ = 0.5 * reach;
    }

    void set_law() noexcept {
        fit::FitLaw& law = energy_->law;
        law.reach = reach;
        law.two_sided = law.gated = mode.index == 0;
        law.kernel = mode.index == 0 ? fit::FitKernel::robust : fit::FitKernel::steady;
        law.outline = mode.index == 0 ? 0.3 : 0.0;
        law.scale = scale_;
        // The robust kernel's force has its maximum at scale / √3: 0.325 of strength × scale, on each side.
        law.strength = mode.index == 0 ? force / (0.65 * scale_) : force.value;
    }

    bool has_pull() const noexcept {
        const auto other = static_cast<std::size_t>(target);
        return hold_.holds && energy_ && other < scene->count && other != static_cast<std::size_t>(hold_.place) &&
               is_valid(scene->objects[other].pose);
    }

    void solve(const Pose& in_hand, double elapsed) noexcept {
        const auto other = static_cast<std::size_t>(target);
        const bool pulls = has_pull();
        if (!pulls) fit_->forget();
        Pose moving_file, fixed_file;
        if (pulls) {
            set_law();
            const auto file_of = [](const coupling::SceneObject& o) { return o.body.home.inverse(); };
            moving_file = in_hand * file_of(scene->objects[static_cast<std::size_t>(hold_.place)]);
            fixed_file = scene->objects[other].pose * file_of(scene->objects[other]);
            fit_->look(solver_.state().proxy, moving_file, fixed_file, lead_.share());
            narrow(elapsed);
        }
        const coupling::QuasiStaticState& now = solver_.update(device, *fit_);
        const double drawing = fit_->force();
        last_ = felt_of(now);
        wrench = last_ * hold_.strength;
        pose = now.proxy * in_hand;
        pull = drawing;
        penetration = now.contact.penetration;
        residual = now.residual;
        in_contact = now.contact.in_contact > 0;
        if (!now.is_slowed) residuals_.add(now.residual);
        deepest_ = std::max(deepest_, now.contact.penetration);
        max_pull_ = std::max(max_pull_, drawing);
        if (pulls && ticks_++ % score_every == 0) {
            energy_->law.stride = std::max<std::size_t>(1, moving_paint_->position.size() / 300);
            score_ = energy_
                         ->quality(fit::between_centres(*moving_paint_, *fixed_paint_,
                                                        fixed_file.inverse() * (now.proxy * moving_file)),
                                   0.2e-3)
                         .score;
            energy_->law.stride = 1;
        }
        score = score_;
    }

    /// The scale follows the distance of the painted surfaces: as they meet, points without a counterpart lose weight.
    void narrow(double elapsed) noexcept {
        // Without a pull the energy contains no distance.
        const double strength = lead_.share() * energy_->law.strength;
        const double distance = strength > 0.0 ? std::sqrt(fit_->energy() / strength) : reach;
        const double wanted = std::clamp(2.0 * distance, 0.25e-3, std::max(0.25e-3, 0.5 * reach));
        scale_ += (wanted - scale_) * std::min(1.0, elapsed / 0.05);
    }

    /// Keeps the body where it is; its last force fades with the strength.
    void let_go() noexcept {
        wrench = last_ * hold_.strength;
        pull = 0.0;
        penetration = 0.0;
        residual = 0.0;
        in_contact = false;
        if (hold_.strength == 0.0) last_ = {};
    }

    static constexpr std::uint64_t score_every = 100;
    std::optional<coupling::HeldContact> contact_;
    std::optional<fit::FitSurface> moving_paint_, fixed_paint_;
    std::optional<fit::FitEnergy> energy_;
    std::optional<fit::HeldFit> fit_;
    tactus::coupling::QuasiStaticCoupling solver_;
    Hold hold_;
    Wrench last_;
    SizeCounts residuals_;
    Lead lead_;
    double scale_ = 2e-3, score_ = 0.0, deepest_ = 0.0, max_pull_ = 0.0;
    std::uint64_t ticks_ = 0;
};

TACTUS_NODE(SnapToFit, device, scene, grip, holding, strength, engaged, settle, wrench, pose, place, score, pull,
            penetration, residual, in_contact, moving, fixed, held, target, mode, force, reach, led, solver, contact)
TACTUS_VISUALS(SnapToFit)

}  // namespace tactus::nodes
