// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/match_reason.hpp"

#include "dsp/fit/faces.hpp"
#include "tools/analysis/bone/kerf_doubt.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <limits>
#include <numbers>
#include <optional>

namespace tactus::analysis {

namespace {

constexpr double min_facing = -0.2;  // as FragmentMatcher::near requires of the cosine between normals

struct Face {
    int fragment = 0;
    Vec3 centre{0.0}, normal{0.0};  // in the case
    double area = 0.0;
};

std::vector<Face> faces_of(const PlanMatching& matching, const fit::Arrangement& arrangement, int fragment) {
    const auto& points = matching.fragment(fragment).bone.points;
    const Pose& pose = arrangement.pose(fragment);
    std::vector<Face> faces;
    for (const auto& indices : fit::split_faces(points)) {
        Face face{fragment, Vec3(0.0), Vec3(0.0), 0.0};
        for (const std::size_t n : indices) {
            face.centre += points[n].area * points[n].position;
            face.normal += points[n].area * points[n].normal;
            face.area += points[n].area;
        }
        if (!(face.area > 0.0) || !(glm::length(face.normal) > 0.0)) continue;
        face.centre = pose.apply(face.centre / face.area);
        face.normal = pose.rotate(glm::normalize(face.normal));
        faces.push_back(face);
    }
    return faces;
}

struct Facing {
    Face mine, other;
    double distance = std::numeric_limits<double>::infinity();
};

/// The nearest pair of faces, of all or of those that look towards each other.
std::optional<Facing> nearest(const std::vector<Face>& mine, const std::vector<Face>& others, bool must_face) {
    Facing best;
    for (const Face& a : mine)
        for (const Face& b : others) {
            const double away = glm::length(a.centre - b.centre);
            if ((must_face && !(glm::dot(a.normal, b.normal) < min_facing)) || !(away < best.distance)) continue;
            best = {a, b, away};
        }
    return best.distance < std::numeric_limits<double>::infinity() ? std::optional(best) : std::nullopt;
}

/// Of the fragments that could be partners, m².
double as_scanned_area(const PlanMatching& matching, const std::vector<int>& fragments) {
    double area = 0.0;
    for (const int n : fragments) area += matching.as_scanned_area(n);
    return area;
}

std::string not_found(const plan::CasePlan& plan, const PlanMatching& matching, const fit::Arrangement& arrangement,
                      int moving, int only, MatchWay way) {
    const auto name = [&plan](int n) { return plan.fragments[static_cast<std::size_t>(n)].name; };
    std::vector<Face> others;
    std::vector<int> partners;
    for (int n = 0; n < static_cast<int>(arrangement.size()); ++n) {
        if (arrangement.move_together(moving, n) ||
            (only == fit::Arrangement::none ? arrangement.is_hidden(n) : n != only))
            continue;
        partners.push_back(n);
        for (const Face& face : faces_of(matching, arrangement, n)) others.push_back(face);
    }
    if (partners.empty())
        return "there is no other shown fragment that does not move along; see 'tactus plan unhide' and 'tactus plan "
               "remove'";
    if (others.empty())
        return fmt::format("{}: {}",
                           only == fit::Arrangement::none ? "the other shown fragments" : "'" + name(only) + "'",
                           no_fracture_words(as_scanned_area(matching, partners)));
    const std::vector<Face> mine = faces_of(matching, arrangement, moving);
    if (way == MatchWay::anywhere)
        return fmt::format("none of its {} painted faces fits one of the {} others; check the paint", mine.size(),
                           others.size());
    const fit::MatcherSettings& settings = matching.settings();
    const double turn = settings.max_turn * 180.0 / std::numbers::pi;
    const auto facing = nearest(mine, others, true);
    if (!facing) {
        const auto close = nearest(mine, others, false);
        return fmt::format(
            "none of its painted faces looks towards another one; the nearest is {:.0f} mm away, on "
            "'{}'; turn it towards that ('tactus plan move'), or use --mode global",
            close ? close->distance * 1e3 : 0.0, close ? name(close->other.fragment) : "");
    }
    if (!(facing->distance < settings.near))
        return fmt::format(
            "it is too far away: the nearest painted face that it looks towards is {:.0f} mm away, on "
            "'{}', and this mode searches within {:.0f} mm; bring it nearer ('tactus plan move'), or "
            "use --mode global",
            facing->distance * 1e3, name(facing->other.fragment), settings.near * 1e3);
    return fmt::format(
        "its face of {:.0f} mm² and the one of {:.0f} mm² of '{}' look at each other from {:.1f} mm, "
        "but no pose within {:.0f} mm and {:.0f}° of the present one fits; use --mode global, or "
        "correct the paint",
        facing->mine.area * 1e6, facing->other.area * 1e6, name(facing->other.fragment), facing->distance * 1e3,
        settings.near * 1e3, turn);
}

/// The next step where paint is in doubt. What the program has proposed is often only a part of the fracture.
std::string correct_the_paint(const plan::CasePlan& plan, const PlanMatching& matching,
                              const fit::FragmentMatch& match) {
    std::string proposed;
    for (const int n : {match.moving, match.partner})
        if (!matching.fragment(n).was_painted)
            proposed += (proposed.empty() ? "'" : " and '") + plan.fragments[static_cast<std::size_t>(n)].name + "'";
    return "correct the paint" +
           (proposed.empty() ? std::string() : fmt::format(", which is only proposed on {}", proposed)) +
           " ('tactus fracture-surface', then 'tactus plan repaint')";
}

std::string no_match(const fit::FitQuality& q, const fit::FitSettings& settings) {
    if (q.score < settings.min_uncertain_score())
        return fmt::format("the faces do not match: the score is below {:.2f}", settings.min_uncertain_score());
    if (q.overlap < settings.min_overlap)
        return fmt::format("the faces lie on each other on less than {:.0f} mm², which any two surfaces do",
                           settings.min_overlap * 1e6);
    if (q.share < settings.min_share)
        return fmt::format("the faces lie on each other on {:.0f} % of the smaller one, which any two surfaces do",
                           q.share * 100.0);
    if (q.rms < settings.max_rms * settings.sigma)
        return fmt::format("only {:.0f} mm² of the painted fracture fit, which is chance", q.overlap * 1e6);
    return fmt::format("the faces do not match: their distances are spread over more than {:.2f} mm",
                       settings.max_rms * settings.sigma * 1e3);
}

std::string kerf_reason(const fit::KerfEstimate& kerf) {
    return kerf_doubt(kerf) + (kerf.is_open ? ", or put it there with 'tactus plan snap --uncertain' and settle it with "
                                              "'tactus plan accept'"
                                            : "");
}

}  // namespace

std::string no_fracture_words(double as_scanned) {
    if (!(as_scanned > 0.0)) return "no painted fracture; paint it, see 'tactus fracture-surface'";
    return fmt::format(
        "no painted fracture beside {:.0f} mm² that touch in the scan, which fits leave out; paint what does not touch "
        "('tactus fracture-surface'), or compare with the healthy side ('tactus plan mirror')",
        as_scanned * 1e6);
}

std::string why_not_placed(const plan::CasePlan& plan, const PlanMatching& matching,
                           const fit::Arrangement& arrangement, const PlanMatch& found, int only, MatchWay way) {
    const fit::FragmentMatch& match = found.match;
    if (match.verdict == fit::FitVerdict::fit || found.as_scanned) return "";
    if (match.partner == fit::Arrangement::none) return not_found(plan, matching, arrangement, match.moving, only, way);
    const fit::FitSettings& settings = matching.settings().fit;
    const std::string correct = correct_the_paint(plan, matching, match);
    const std::string next = way == MatchWay::near ? "bring it nearer to its place, use --mode global, or " + correct
                             : only == fit::Arrangement::none ? "name its partner at 'tactus plan snap', or " + correct
                                                              : correct;
    if (found.kerf && found.kerf->is_doubtful()) return kerf_reason(*found.kerf);
    if (found.inside != fit::Arrangement::none) {
        const std::string& other = plan.fragments[static_cast<std::size_t>(found.inside)].name;
        return fmt::format(
            "it would lie in '{}' with {:.0f} mm³; when '{}' is not at its place yet, place it first or "
            "hide it ('tactus plan hide')",
            other, found.inside_volume * 1e9, other);
    }
    switch (match.verdict) {
        case fit::FitVerdict::sliding:
            return "the faces are too smooth to hold it in one place; paint more of the fracture, or place it by hand";
        case fit::FitVerdict::ambiguous:
            return fmt::format("another pose fits as well: the margin is below {:.2f}; {}", settings.min_margin,
                               only == fit::Arrangement::none
                                   ? "name its partner at 'tactus plan snap', or paint more of the fracture"
                                   : "paint more of the fracture");
        case fit::FitVerdict::uncertain:
            return fmt::format(
                "{}; compare with the healthy side (--healthy), paint more of the fracture, or put it there with "
                "'tactus plan snap --uncertain' and settle it with 'tactus plan accept'",
                match.precision.far > settings.max_far
                    ? fmt::format("the {} of {:.0f} mm² {} the far end to ±{:.2f} mm only, and ±{:.2f} mm is needed",
                                  match.faces == 1 ? "face" : "faces, the best", match.quality.overlap * 1e6,
                                  match.faces == 1 ? "holds" : "hold", match.precision.far * 1e3,
                                  settings.max_far * 1e3)
                    : fmt::format("the faces agree on {:.0f} mm² only, as chipped ones do",
                                  match.quality.overlap * 1e6));
        case fit::FitVerdict::blocked: return fmt::format("the bones would lie in each other; {}", next);
        default: return fmt::format("{}; {}", no_match(match.quality, settings), next);
    }
}

}  // namespace tactus::analysis
