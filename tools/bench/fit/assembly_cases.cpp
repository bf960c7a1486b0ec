// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/fit/assembly_cases.hpp"

#include "assets/library/fibula.hpp"
#include "assets/library/mandible.hpp"
#include "tools/analysis/bone/fracture.hpp"
#include "tools/analysis/plan/plan_assembly.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numbers>

namespace tactus::bench {

namespace {

constexpr double least_common = 20e-6;  // m²
constexpr double right = 1e-3, goal = 0.3e-3;  // m

/// The paint of `a` that lies on `b` in the unbroken bone.
std::vector<const contact::SurfacePoint*> common_paint(const analysis::CaseFragment& a, const Pose& a_place,
                                                       const analysis::CaseFragment& b, const Pose& b_place) {
    const Pose into = b_place.inverse() * a_place;
    std::vector<const contact::SurfacePoint*> common;
    for (const contact::SurfacePoint& p : a.bone.points) {
        if (p.label != contact::surface_label::fracture) continue;
        const volume::Sample here = b.map.sample(into.apply(p.position));
        if (here.inside && std::abs(here.value) < 0.4e-3 && glm::dot(into.rotate(p.normal), here.gradient) < -0.7)
            common.push_back(&p);
    }
    return common;
}

struct Neighbours {
    int a = 0, b = 0;
    double area = 0.0, error = 0.0;  ///< m², and m, rms at the common face between what was made and the truth
};

std::string refusal_of(const analysis::PlanMatch& refused) {
    const fit::FragmentMatch& match = refused.match;
    if (match.partner == fit::Arrangement::none) return fmt::format("piece {}: nothing near to a fit", match.moving);
    const fit::FitQuality& q = match.quality;
    return fmt::format(
        "piece {} at {}: {}, score {:.2f}, share {:.2f}, {:.0f} mm², {:.3f} mm rms, margin {:.2f}, held {:.2f} mm{}{}",
        match.moving, match.partner, fit::name_of(match.verdict), q.score, q.share, q.overlap * 1e6, q.rms * 1e3,
        match.margin, std::min(match.precision.far * 1e3, 1e3),
        refused.kerf ? fmt::format(", kerf {:.2f} ± {:.2f} mm", refused.kerf->kerf * 1e3, refused.kerf->spread * 1e3)
                     : "",
        refused.inside != fit::Arrangement::none
            ? fmt::format(", {:.0f} mm³ in {}", refused.inside_volume * 1e9, refused.inside)
            : "");
}

double seconds_used() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

AssemblyCase assembly_case(int number) {
    AssemblyCase made;
    made.is_jaw = number % 2 == 0;
    made.pieces = made.is_jaw ? 2 + number / 2 % 11 : 2 + number / 2 % 5;
    made.seed = 90'000 + static_cast<std::uint64_t>(number);
    made.chips = 0.05 * (number / 2 % 5);
    made.missing = number % 4 == 3 || number % 8 == 6 ? 1 : 0;
    if (made.pieces < 3) made.missing = 0;
    return made;
}

AssemblyScore put_together(const AssemblyCase& one) {
    static const bone::Bone jaw = library::make_mandible(), fibula = library::make_fibula();
    analysis::FractureSettings settings;
    settings.pieces = one.pieces;
    settings.missing = one.missing;
    settings.seed = one.seed;
    settings.chips = one.chips;
    std::vector<analysis::CaseFragment> fragments;
    std::vector<Pose> truth;
    analysis::break_and_scan(one.is_jaw ? jaw : fibula, settings, [&](analysis::ScannedFragment fragment) {
        analysis::CaseFragment loaded;
        loaded.bone = std::move(fragment.bone);
        loaded.was_painted = true;
        loaded.map = contact::make_voxmap(std::exchange(loaded.bone.distance, {}));
        fragments.push_back(std::move(loaded));
        truth.push_back(fragment.place);
    });
    const auto count = static_cast<int>(fragments.size());
    std::vector<Neighbours> neighbours;
    analysis::PlanMatching matching(std::move(fragments));
    const double begin = seconds_used();
    const analysis::PlanAssembly made =
        analysis::assemble(matching, fit::Arrangement(static_cast<std::size_t>(count)),
                           std::vector<std::optional<plan::PlanFit>>(static_cast<std::size_t>(count)));
    AssemblyScore score;
    score.pieces = count;
    score.seconds = seconds_used() - begin;
    for (const analysis::PlanMatch& refused : made.stays) score.apart.push_back(refusal_of(refused));
    const auto place = [&](int n) { return truth[static_cast<std::size_t>(n)]; };
    const auto pose = [&](int n) { return made.poses[static_cast<std::size_t>(n)]; };
    for (int a = 0; a < count; ++a)
        for (int b = 0; b < count; ++b) {
            if (a == b) continue;
            Neighbours pair{a, b};
            const Pose was = place(b).inverse() * place(a), now = pose(b).inverse() * pose(a);
            for (const contact::SurfacePoint* p :
                 common_paint(matching.fragment(a), place(a), matching.fragment(b), place(b))) {
                const Vec3 off = now.apply(p->position) - was.apply(p->position);
                pair.area += p->area;
                pair.error += p->area * glm::dot(off, off);
            }
            if (pair.area < least_common) continue;
            pair.error = std::sqrt(pair.error / pair.area);
            neighbours.push_back(pair);
        }
    std::vector<int> part(static_cast<std::size_t>(count), -1);
    for (std::size_t p = 0; p < made.parts.size(); ++p)
        for (const int n : made.parts[p]) part[static_cast<std::size_t>(n)] = static_cast<int>(p);
    const auto same = [&](int a, int b) {
        return part[static_cast<std::size_t>(a)] == part[static_cast<std::size_t>(b)];
    };
    // Which pieces are neighbours in truth, and how many of those pairs were connected correctly.
    std::vector<int> whole(static_cast<std::size_t>(count)), rightly(static_cast<std::size_t>(count));
    for (int n = 0; n < count; ++n) whole[static_cast<std::size_t>(n)] = rightly[static_cast<std::size_t>(n)] = n;
    const auto unite = [](std::vector<int>& all, int a, int b) {
        const int from = all[static_cast<std::size_t>(a)], to = all[static_cast<std::size_t>(b)];
        std::ranges::replace(all, from, to);
    };
    for (const Neighbours& pair : neighbours) {
        unite(whole, pair.a, pair.b);
        if (same(pair.a, pair.b) && pair.error < right) unite(rightly, pair.a, pair.b);
    }
    for (int n = 0; n < count; ++n) {
        const auto at = static_cast<std::size_t>(n);
        const bool is_alone = std::ranges::count(whole, whole[at]) == 1;
        score.with_neighbour += !is_alone;
        const auto mine = std::ranges::count(rightly, rightly[at]);
        if (mine < 2) {
            score.falsely += std::ranges::count(part, part[at]) > 1;
            continue;
        }
        std::ptrdiff_t largest = 0;
        int largest_part = -1;
        for (int m = 0; m < count; ++m) {
            const auto other = static_cast<std::size_t>(m);
            const auto size = std::ranges::count(rightly, rightly[other]);
            if (whole[other] == whole[at] && size > largest) largest = size, largest_part = rightly[other];
        }
        // Two right parts that were connected wrongly.
        if (rightly[at] != largest_part) {
            bool is_beside = false;
            for (int m = 0; m < count; ++m)
                is_beside = is_beside || (same(n, m) && rightly[static_cast<std::size_t>(m)] == largest_part);
            score.falsely += is_beside;
            continue;
        }
        double area = 0.0, squares = 0.0;
        for (const Neighbours& pair : neighbours)
            if (pair.a == n && same(n, pair.b)) area += pair.area, squares += pair.area * pair.error * pair.error;
        const double error = std::sqrt(squares / std::max(area, 1e-12));
        ++score.placed;
        score.within += error <= goal;
        score.worst_error = std::max(score.worst_error, error);
    }
    return score;
}

}  // namespace tactus::bench
