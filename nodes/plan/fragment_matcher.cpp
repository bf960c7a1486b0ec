// SPDX-License-Identifier: Apache-2.0
#include "dsp/fit/fragment_matcher.hpp"

#include "dsp/coupling/scene.hpp"
#include "dsp/fit/as_scanned.hpp"
#include "dsp/fit/overlap.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"
#include "graph/node/notice.hpp"
#include "graph/node/visual.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <memory>
#include <string>

namespace tactus::nodes {

struct FragmentMatcher {
    static constexpr auto about =
        "Searches in the background for a fit of the held fragment to the placed ones: from its present pose, on all "
        "faces together; if none fits nearby, each of its faces on each other face in turn. A fit that only repeats "
        "the position in the scan is reported as ambiguous, one inside of a placed fragment as blocked. The thresholds "
        "are those of the plan verbs.";

    In<tactus::coupling::Scene> scene{"case_scene.scene of the same plan"};
    In<double> held{"place of the held fragment; -1: none"};
    In<bool> engaged{optional, "search; unconnected: true"};
    Out<Pose> target{"pose of the held fragment for the fit, in the scene; its present pose while there is none", "m"};
    Out<bool> fits{"there is a fit"};
    Out<double> fragment{"place of the fragment that the target is for; -1: none"};
    Out<double> partner{"place of the fragment that it fits best; -1: none"};
    Out<double> verdict{"0 fit, 1 sliding, 2 ambiguous (or as scanned), 3 no match, 4 blocked, 5 uncertain"};
    Out<double> score{"of the best fitting faces, 0 to 1"};
    Out<double> margin{"to the second best pose, as a share of the best score"};
    Out<double> rms{"of the distances within the overlap", "m"};
    Out<double> gap{"mean signed distance within the overlap; positive: bone is missing between the faces", "m"};
    Out<double> penetration{"exceeded by 1 % of the points of both faces", "m"};
    Out<double> overlap{"area of the overlap", "m^2"};
    Out<double> faces{"number of face pairs that were fitted together"};
    Asset<plan::CaseBones> plan{"the plan that the scene shows"};
    Choice partners{{"standing", "all"}, "standing: fragments that are locked or fitted; all: every other fragment"};
    Choice reach{{"near", "anywhere"},
                 "near: search from the present pose; anywhere: also each face on each other face in turn"};
    Param min_score{"0", "0", "1", "minimum score of a match, where it is more than the 0.3 that every fit needs"};
    Param points{structural, "700", "100", "20000", "number of points per face"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::target, .scene = "scene", .place = "fragment", .pose = "target", .when = "fits"}};
    }

    void prepare(const Setup& setup) {
        std::vector<fit::FragmentSurface> surfaces;
        for (const bone::Bone& bone : plan->bones) surfaces.push_back({bone.points, &bone.distance});
        fit::MatcherSettings settings;
        settings.max_points = static_cast<std::size_t>(points);
        try {
            matcher_ = std::make_unique<tactus::fit::FragmentMatcher>(surfaces, settings);
        } catch (const Error& error) {
            setup.fail("plan '" + plan.name + "': " + error.message());
        }
        name_ = setup.name;
        lonely_notice_.attach(setup);
        nothing();
    }

    void process(const Tick&) noexcept {
        const double place = held.get();
        const bool wanted = !engaged.connected || engaged.get();
        if (!wanted || !(place >= 0.0 && place < static_cast<double>(scene->count)) ||
            scene->count != plan->bones.size()) {
            if (was_ >= 0) matcher_->begin_search();
            was_ = -1;
            is_lonely_ = false;
            nothing();
            return;
        }
        look(static_cast<int>(place));
    }

    void report(Report& report) const {
        report.set(name_, "faces", static_cast<double>(matcher_->faces()));
        report.set(name_, "looks", looks_);
        report.set(name_, "fits", fits_);
        if (lonely_ > 0.0) {
            report.set(name_, "looks_without_partner", lonely_);
            report.set(name_, "hint", std::string(nothing_stands));
        }
    }

private:
    static constexpr const char* nothing_stands =
        "nothing is locked or fitted, so there is nothing to fit to: lock a fragment ('tactus plan lock', or 'tactus "
        "trigger lock'), or set partners = \"all\"";

    void look(int place) noexcept {
        const std::size_t count = scene->count;
        const coupling::SceneObject& mine = scene->objects[static_cast<std::size_t>(place)];
        for (std::size_t n = 0; n < count; ++n) {
            const coupling::SceneObject& other = scene->objects[n];
            if (!is_valid(other.pose)) return nothing();
            poses_[n] = Pose{other.pose.position, glm::normalize(other.pose.orientation)} * other.body.home.inverse();
            stands_[n] = !goes_along(static_cast<std::size_t>(place), n) && other.body.map &&
                         ((other.stands && !hangs_on(n, static_cast<std::size_t>(place))) || partners.index == 1);
        }
        const std::span<const Pose> poses(poses_.data(), count);
        const std::span<const char> stands(stands_.data(), count);
        matcher_->settings.fit.min_score = std::max<double>(fit::Acceptance::min_score, min_score);
        fit::FragmentMatch match = judged(matcher_->near(place, poses, stands));
        if (match.verdict != fit::FitVerdict::fit && reach.index == 1) {
            if (was_ != place) matcher_->begin_search();
            const fit::FragmentMatch found = judged(matcher_->search(place, poses, stands));
            if (found.verdict == fit::FitVerdict::fit) match = found;
        }
        was_ = place;
        ++looks_;
        const bool is_lonely = partners.index == 0 && std::ranges::find(stands, 1) == stands.end();
        lonely_ += is_lonely;
        // Once, when a fragment is taken or what it could fit is gone.
        if (is_lonely && !is_lonely_) lonely_notice_.tell();
        is_lonely_ = is_lonely;
        fits_ += match.verdict == fit::FitVerdict::fit;
        const bool is_fit = match.verdict == fit::FitVerdict::fit;
        target = is_fit ? match.pose * mine.body.home : mine.pose;
        fits = is_fit;
        fragment = place;
        partner = match.partner;
        verdict = static_cast<double>(match.verdict);
        score = match.quality.score;
        margin = match.margin;
        rms = match.quality.rms;
        gap = match.quality.gap;
        penetration = match.quality.penetration;
        overlap = match.quality.overlap;
        faces = match.faces;
    }

    /// A border between two labels of one scan fits itself wherever the fragments lie.
    fit::FragmentMatch judged(fit::FragmentMatch match) const noexcept {
        if (match.verdict != fit::FitVerdict::fit && match.verdict != fit::FitVerdict::uncertain) return match;
        const auto moving = static_cast<std::size_t>(match.moving), other = static_cast<std::size_t>(match.partner);
        const coupling::Body& body = scene->objects[other].body;
        const Pose into = body.home.inverse();
        if (fit::is_as_scanned(plan->bones[moving].points, into * poses_[other].inverse() * match.pose, *body.map,
                               into))
            match.verdict = fit::FitVerdict::ambiguous;
        else if (lies_in_placed(match)) match.verdict = fit::FitVerdict::blocked;
        return match;
    }

    /// Whether what moves along would lie in a placed fragment. Those that are not at their place may be anywhere.
    bool lies_in_placed(const fit::FragmentMatch& match) const noexcept {
        const auto moving = static_cast<std::size_t>(match.moving);
        const Pose motion = match.pose * poses_[moving].inverse();
        const auto placed = [&](std::size_t n, const Pose& pose) {
            const coupling::Body& body = scene->objects[n].body;
            return fit::PlacedBone{plan->bones[n].points, body.map, pose, pose * body.home};
        };
        for (std::size_t m = 0; m < scene->count; ++m) {
            if (m != moving && !goes_along(moving, m)) continue;
            if (!scene->objects[m].body.map) continue;
            const fit::PlacedBone mine = placed(m, motion * poses_[m]);
            for (std::size_t n = 0; n < scene->count; ++n)
                if (stands_[n] &&
                    fit::lie_in_each_other(mine, placed(n, poses_[n]), matcher_->settings.fit.max_penetration))
                    return true;
        }
        return false;
    }

    /// True if an object is placed only relative to the moved one, directly or through others. A fit to it would fix
    /// nothing.
    bool hangs_on(std::size_t other, std::size_t moving) const noexcept {
        int at = scene->objects[other].hangs_on;
        for (std::size_t steps = 0; steps < scene->count && at >= 0; ++steps) {
            if (goes_along(moving, static_cast<std::size_t>(at))) return true;
            at = scene->objects[static_cast<std::size_t>(at)].hangs_on;
        }
        return false;
    }

    bool goes_along(std::size_t moving, std::size_t other) const noexcept {
        const int unit = scene->objects[moving].unit;
        return moving == other || (unit >= 0 && unit == scene->objects[other].unit);
    }

    void nothing() noexcept {
        target = Pose{};
        fits = false;
        fragment = -1.0;
        partner = -1.0;
        verdict = static_cast<double>(fit::FitVerdict::no_match);
        score = 0.0;
        margin = 0.0;
        rms = 0.0;
        gap = 0.0;
        penetration = 0.0;
        overlap = 0.0;
        faces = 0.0;
    }

    std::unique_ptr<tactus::fit::FragmentMatcher> matcher_;
    std::array<Pose, tactus::coupling::Scene::max_objects> poses_;
    std::array<char, tactus::coupling::Scene::max_objects> stands_{};
    std::string name_;
    double looks_ = 0.0, fits_ = 0.0, lonely_ = 0.0;
    Notice lonely_notice_{nothing_stands};
    int was_ = -1;
    bool is_lonely_ = false;
};

TACTUS_NODE(FragmentMatcher, scene, held, engaged, target, fits, fragment, partner, verdict, score, margin, rms, gap,
            penetration, overlap, faces, plan, partners, reach, min_score, points)
TACTUS_VISUALS(FragmentMatcher)

}  // namespace tactus::nodes
