// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/plan_assembly.hpp"

#include "dsp/core/rotation.hpp"
#include "dsp/fit/arrangement/assemblies.hpp"
#include "dsp/fit/joint_refinement.hpp"
#include "tools/analysis/plan/assembly_parts.hpp"
#include "tools/analysis/workers.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace tactus::analysis {

namespace {

constexpr double same_distance = 2e-3, same_angle = 0.1;  // m, rad: poses that agree on where a part goes
constexpr double same_place = 0.02e-3, same_turn = 0.02 * 3.14159265358979 / 180.0;  // already there: no step

using fit::Arrangement;

struct Edge {
    fit::FacePairFit pair;
    int a = 0, b = 0;  ///< moving and fixed fragment
    std::size_t tried_at = 0;  ///< fragments in both parts when it was refused
};

std::pair<int, int> ordered(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

bool agree(const Pose& a, const Pose& b, const Vec3& at) {
    return glm::length(a.apply(at) - b.apply(at)) < same_distance &&
           glm::length(rotation_between(a.orientation, b.orientation)) < same_angle;
}

/// All pairs of faces that may connect two fragments, the surest first.
std::vector<Edge> all_edges(const PlanMatching& matching, const fit::FragmentMatcher& matcher,
                            const AssemblyParts& parts) {
    std::vector<Edge> edges;
    for (std::size_t m = 0; m < matcher.faces(); ++m)
        for (std::size_t f = m + 1; f < matcher.faces(); ++f) {
            const int a = matcher.fragment_of(m), b = matcher.fragment_of(f);
            if (parts.part_of(a) < 0 || parts.part_of(b) < 0 || parts.part_of(a) == parts.part_of(b)) continue;
            edges.push_back({{m, f, {}, -1.0, 0.0, 0.0, {}}, a, b, 0});
        }
    if (edges.empty()) return edges;
    on_threads()(static_cast<int>(edges.size()), [&](int n) {
        Edge& edge = edges[static_cast<std::size_t>(n)];
        fit::FitEnergy energy = matcher.make_energy();
        edge.pair = matcher.fit_faces(energy, edge.pair.moving, edge.pair.fixed,
                                      parts.pose(edge.b).inverse() * parts.pose(edge.a));
    });
    // Other faces of the same fragments may still raise what a pair shows by itself.
    const double least = 0.7 * matching.settings().fit.min_score;
    std::erase_if(edges, [&](const Edge& e) { return e.pair.score < least; });
    std::ranges::stable_sort(edges, std::ranges::greater{}, [](const Edge& e) { return e.pair.worth(); });
    return edges;
}

class Assembler {
public:
    Assembler(PlanMatching& matching, const Arrangement& arrangement,
              const std::vector<std::optional<plan::PlanFit>>& fits)
        : matching_(matching),
          matcher_(matching.matcher()),
          arrangement_(arrangement),
          parts_(arrangement, [&](int n) { return surface_of(n); }),
          refused_(arrangement.size()) {
        for (std::size_t n = 0; n < refused_.size(); ++n) {
            refused_[n].match.moving = static_cast<int>(n);
            refused_[n].from = arrangement.pose(static_cast<int>(n));
            refused_[n].was_painted = matching.fragment(static_cast<int>(n)).was_painted;
        }
        for (AssemblyLink& link : parts_.links())
            if (const auto& fit = fits[static_cast<std::size_t>(link.a)]) link.match.margin = fit->margin;
    }

    PlanAssembly run() {
        edges_ = all_edges(matching_, matcher_, parts_);
        for (bool is_new = true; is_new;) {
            connect();
            if (look_at_all_openings()) connect();
            is_new = refine();
        }
        parts_.return_to(arrangement_);
        return result();
    }

private:
    double surface_of(int n) const {
        double area = 0.0;
        for (const contact::SurfacePoint& p : matching_.fragment(n).bone.points) area += p.area;
        return area;
    }

    /// Connects parts by the surest edges until none fits any more.
    void connect() {
        for (bool progress = true; progress;) {
            progress = false;
            for (Edge& edge : edges_) {
                const int p = parts_.part_of(edge.a), q = parts_.part_of(edge.b);
                if (p == q || (!parts_.can_move(p) && !parts_.can_move(q))) continue;
                const std::size_t size = parts_.members(p).size() + parts_.members(q).size();
                if (edge.tried_at == size) continue;
                if (try_edge(edge)) progress = true;
                else edge.tried_at = size;
            }
        }
    }

    /// Combines the contours of all pairs if no kerf was given. Returns whether a pair that was refused because of a
    /// possible kerf may be tried again.
    bool look_at_all_openings() {
        std::vector<fit::ContourOpening> all;
        for (const auto& [pair, opening] : openings_) all.push_back(opening);
        case_opening_ = fit::common_opening(all);
        bool is_any = false;
        for (Edge& edge : edges_) {
            const auto found = openings_.find(ordered(edge.a, edge.b));
            if (found == openings_.end() || is_settled(edge) || !case_opening_.excludes_kerf(found->second)) continue;
            edge.tried_at = 0;
            is_any = true;
        }
        return is_any;
    }

    bool try_edge(const Edge& edge) {
        const bool is_forward = parts_.goes_to(parts_.part_of(edge.a), parts_.part_of(edge.b));
        const fit::FacePairFit pair = is_forward ? edge.pair : edge.pair.inverse();
        const int moving = is_forward ? edge.a : edge.b, fixed = is_forward ? edge.b : edge.a;
        const std::vector<char> stands = parts_.mask(parts_.part_of(fixed));
        fit::FragmentMatch made = matcher_.place(pair, parts_.poses(), stands);
        if (made.verdict == fit::FitVerdict::fit || made.verdict == fit::FitVerdict::blocked) {
            made.margin = std::min(made.margin, margin_to_others(edge));
            if (made.margin < matching_.settings().fit.min_margin) made.verdict = fit::FitVerdict::ambiguous;
        }
        const PlanMatch found = judge(made, stands);
        if (found.kerf && !found.kerf->is_flat) openings_[ordered(moving, made.partner)] = found.kerf->contour;
        if (found.match.verdict != fit::FitVerdict::fit) {
            remember(found, pair.worth());
            return false;
        }
        parts_.connect({moving, made.partner, made}, made.pose);
        return true;
    }

    /// `judged` with what moves along in this assembly.
    PlanMatch judge(const fit::FragmentMatch& made, const std::vector<char>& stands) const {
        const Arrangement now = parts_.arrangement_moving(arrangement_, parts_.part_of(made.moving));
        PlanMatch found =
            matching_.judged(made, now, parts_.and_locked(stands, parts_.part_of(made.moving)), case_opening_);
        found.from = arrangement_.pose(made.moving);
        found.moved = motion_between(found.from, made.pose, middle_of(matching_.fragment(made.moving).bone.points));
        return found;
    }

    /// To the best other place for one of its faces, by another pair: 1 when there is none.
    double margin_to_others(const Edge& edge) const {
        double margin = 1.0;
        for (const Edge& other : edges_) {
            const bool shares_a = other.pair.moving == edge.pair.moving || other.pair.fixed == edge.pair.moving,
                       shares_b = other.pair.moving == edge.pair.fixed || other.pair.fixed == edge.pair.fixed;
            if (shares_a == shares_b || is_settled(other)) continue;
            if (!contradicts(edge, other, shares_a ? edge.pair.moving : edge.pair.fixed)) continue;
            const double area = std::min(1.0, other.pair.overlap / std::max(edge.pair.overlap, 1e-12));
            margin = std::min(margin, 1.0 - area * other.pair.score / edge.pair.score);
        }
        return std::max(margin, 0.0);
    }

    /// Both fragments are in one part: other faces have decided.
    bool is_settled(const Edge& edge) const { return parts_.part_of(edge.a) == parts_.part_of(edge.b); }

    /// Whether both edges put different fragments to the same place at the face that they share.
    bool contradicts(const Edge& edge, const Edge& other, std::size_t shared) const {
        const auto beside = [&](const Edge& e) {
            return e.pair.moving == shared ? std::pair(e.b, e.pair.pose.inverse()) : std::pair(e.a, e.pair.pose);
        };
        const auto [first, first_pose] = beside(edge);
        const auto [second, second_pose] = beside(other);
        if (parts_.part_of(first) == parts_.part_of(second)) {
            // Both say where the same part goes.
            const Pose as_second = first_pose * (parts_.pose(first).inverse() * parts_.pose(second));
            return !agree(as_second, second_pose, matcher_.face(shared).centre);
        }
        return matching_.lie_in_each_other(first, first_pose, second, second_pose);
    }

    void remember(const PlanMatch& found, double worth) {
        for (const int n : {found.match.moving, found.match.partner}) {
            if (n == Arrangement::none) continue;
            PlanMatch& best = refused_[static_cast<std::size_t>(n)];
            if (best.match.partner != Arrangement::none && worths_[n] >= worth) continue;
            worths_[n] = worth;
            best = found;
            if (n == found.match.moving) continue;
            // The same doubt, told of the other fragment.
            best.match.moving = n;
            best.match.partner = found.match.moving;
            if (best.inside == n) best.inside = found.match.moving;
            best.from = arrangement_.pose(n);
            best.match.pose = best.from;
            best.moved = {};
        }
    }

    /// Fits all faces of all parts together, then cuts connections that do not hold up. Returns whether one was cut.
    bool refine() {
        const std::vector<int> body = parts_.bodies();
        std::vector<fit::FacePair> within;
        for (const fit::FacePair& pair : fit::mated_faces(matcher_, parts_.poses(), body))
            if (parts_.part_of(matcher_.fragment_of(pair.first)) == parts_.part_of(matcher_.fragment_of(pair.second)))
                within.push_back(pair);
        std::vector<Pose> poses = parts_.poses();
        fit::refine_jointly(matcher_, within, body, parts_.fixed_bodies(), poses);
        parts_.set_poses(poses);
        bool is_cut = false;
        for (std::size_t n = parts_.links().size(); n-- > 0;) {
            AssemblyLink& link = parts_.links()[n];
            if (link.was_before) continue;
            const fit::FitQuality now = best_quality(link.a, link.b);
            link.match.quality = now;
            fit::FitSettings settings = matching_.settings().fit;
            if (fit::judge(now, false, link.match.margin, settings) == fit::FitVerdict::fit) continue;
            PlanMatch doubt;
            doubt.match = link.match;
            doubt.match.verdict = fit::judge(now, false, link.match.margin, settings);
            doubt.from = arrangement_.pose(link.a);
            remember(doubt, 1.0);
            forbid(link.a, link.b);
            parts_.cut(n);
            is_cut = true;
        }
        return is_cut;
    }

    void forbid(int a, int b) {
        std::erase_if(edges_, [&](const Edge& e) { return (e.a == a && e.b == b) || (e.a == b && e.b == a); });
    }

    /// Of the pair of faces of two fragments that covers most.
    fit::FitQuality best_quality(int a, int b) const {
        fit::FitQuality best;
        if (matcher_.faces() == 0) return best;
        fit::FitEnergy energy = matcher_.make_energy();
        for (std::size_t m = 0; m < matcher_.faces(); ++m)
            for (std::size_t f = 0; f < matcher_.faces(); ++f) {
                if (matcher_.fragment_of(m) != a || matcher_.fragment_of(f) != b) continue;
                const fit::FitQuality q = matcher_.quality_of(energy, m, f, parts_.poses());
                if (q.score * std::sqrt(q.overlap) > best.score * std::sqrt(best.overlap)) best = q;
            }
        return best;
    }

    std::vector<FragmentResidual> residuals() const {
        std::vector<FragmentResidual> all(arrangement_.size());
        if (matcher_.faces() == 0) return all;
        fit::FitEnergy energy = matcher_.make_energy();
        std::vector<double> squares(all.size(), 0.0);
        // Faces inside of a group, which is one body, count as well.
        std::vector<int> alone = parts_.bodies();
        for (std::size_t n = 0; n < alone.size(); ++n)
            if (alone[n] >= 0) alone[n] = static_cast<int>(n);
        for (const auto& [m, f] : fit::mated_faces(matcher_, parts_.poses(), alone)) {
            const int a = matcher_.fragment_of(m), b = matcher_.fragment_of(f);
            if (parts_.part_of(a) != parts_.part_of(b)) continue;
            const fit::FitQuality q = matcher_.quality_of(energy, m, f, parts_.poses());
            for (const int n : {a, b}) {
                FragmentResidual& r = all[static_cast<std::size_t>(n)];
                r.area += q.overlap;
                ++r.faces;
                squares[static_cast<std::size_t>(n)] += q.overlap * q.rms * q.rms;
            }
        }
        for (std::size_t n = 0; n < all.size(); ++n)
            all[n].rms = all[n].area > 0.0 ? std::sqrt(squares[n] / all[n].area) : 0.0;
        return all;
    }

    bool is_there_already(int fragment, int partner) const {
        if (arrangement_.fitted_to(fragment) != partner) return false;
        const Pose was = arrangement_.pose(partner).inverse() * arrangement_.pose(fragment);
        const Pose now = parts_.pose(partner).inverse() * parts_.pose(fragment);
        return glm::length(now.position - was.position) < same_place &&
               glm::length(rotation_between(was.orientation, now.orientation)) < same_turn;
    }

    PlanAssembly result() const {
        PlanAssembly made;
        made.poses = parts_.poses();
        made.parts = parts_.lists();
        made.residuals = residuals();
        for (const AssemblyLink& link : parts_.in_order()) {
            if (is_there_already(link.a, link.b) && agree_exactly(link.a)) continue;
            PlanMatch placed;
            placed.match = link.match;
            placed.match.moving = link.a;
            placed.match.partner = link.b;
            placed.match.verdict = fit::FitVerdict::fit;
            placed.match.pose = parts_.pose(link.a);
            placed.match.quality = best_quality(link.a, link.b);
            placed.match.faces = std::max(1, made.residuals[static_cast<std::size_t>(link.a)].faces);
            placed.from = arrangement_.pose(link.a);
            placed.was_painted = matching_.fragment(link.a).was_painted;
            placed.moved =
                motion_between(placed.from, placed.match.pose, middle_of(matching_.fragment(link.a).bone.points));
            made.placed.push_back(placed);
        }
        for (std::size_t n = 1; n < made.parts.size(); ++n) {
            made.stays.push_back(why_apart(made.parts[n]));
            made.is_locked_apart.push_back(made.stays.back().match.partner == Arrangement::none &&
                                           is_locked_apart(made.parts[n]));
        }
        for (int a = 0; a < static_cast<int>(arrangement_.size()); ++a)
            for (int b = a + 1; b < static_cast<int>(arrangement_.size()); ++b)
                if (!arrangement_.is_hidden(a) && !arrangement_.is_hidden(b) &&
                    matching_.lie_in_each_other(a, made.poses[static_cast<std::size_t>(a)], b,
                                                made.poses[static_cast<std::size_t>(b)]))
                    made.overlaps.push_back({a, b, matching_.overlap_volume(a, parts_.pose(a), b, parts_.pose(b))});
        return made;
    }

    bool agree_exactly(int fragment) const {
        const Pose &now = parts_.pose(fragment), &was = arrangement_.pose(fragment);
        return glm::length(now.position - was.position) < same_place &&
               glm::length(rotation_between(was.orientation, now.orientation)) < same_turn;
    }

    /// What was refused last between a part and the rest, told of one of its fragments.
    PlanMatch why_apart(const std::vector<int>& part) const {
        int best = part.front();
        double most = -1.0;
        for (const int n : part) {
            const PlanMatch& refused = refused_[static_cast<std::size_t>(n)];
            if (refused.match.partner == Arrangement::none ||
                parts_.part_of(refused.match.partner) == parts_.part_of(n))
                continue;
            if (const double worth = worths_.at(n); worth > most) best = n, most = worth;
        }
        PlanMatch why = refused_[static_cast<std::size_t>(best)];
        if (most < 0.0) {
            why = {};
            why.match.moving = part.front();
            why.from = arrangement_.pose(part.front());
            why.was_painted = matching_.fragment(part.front()).was_painted;
        }
        return why;
    }

    /// Whether a pair of faces between this part and another was not tried because neither can move.
    bool is_locked_apart(const std::vector<int>& part) const {
        const int mine = parts_.part_of(part.front());
        return !parts_.can_move(mine) && std::ranges::any_of(edges_, [&](const Edge& e) {
            const int p = parts_.part_of(e.a), q = parts_.part_of(e.b);
            return p != q && (p == mine || q == mine) && !parts_.can_move(p) && !parts_.can_move(q);
        });
    }

    PlanMatching& matching_;
    fit::FragmentMatcher& matcher_;
    const Arrangement& arrangement_;
    AssemblyParts parts_;
    std::vector<Edge> edges_;
    std::vector<PlanMatch> refused_;
    std::map<int, double> worths_;
    std::map<std::pair<int, int>, fit::ContourOpening> openings_;  ///< of pairs of fragments, the lower number first
    fit::CommonOpening case_opening_;
};

}  // namespace

PlanAssembly assemble(PlanMatching& matching, const fit::Arrangement& arrangement,
                      const std::vector<std::optional<plan::PlanFit>>& fits) {
    return Assembler(matching, arrangement, fits).run();
}

}  // namespace tactus::analysis
