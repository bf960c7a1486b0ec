// SPDX-License-Identifier: Apache-2.0
// How straight the two halves of a long bone are put together: a small error of the face is a large one at the far end.
#include "assets/file/json.hpp"
#include "assets/library/fibula.hpp"
#include "assets/plan/case_bones.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "tools/analysis/bone/fracture.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/bench/bench.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <optional>
#include <vector>

namespace tactus::bench {

namespace {

using file::Json;

constexpr double far_from_face = 0.15;  // m
constexpr double goal_angle = 0.25, goal_error = 0.5e-3;  // degrees, m

struct ShaftsChoice {
    int first = 0, count = 20;
    double chips = 0.2, kerf = 0.0, roughness = 0.8;  // share, mm, mm
    double size = 1.0;  // of the bone
    std::optional<double> told_kerf;  // mm
    bool told = false, json = false;
    std::filesystem::path bone;
};

struct Shaft {
    int number = 0;
    std::string verdict;
    double area = 0.0, angle = 0.0, error = 0.0;  ///< m², degrees, m on the axis, 150 mm from the face
    double end_error = 0.0;  ///< m, where the fragment is farthest from the face
    double face_error = 0.0;  ///< m, at the middle of the face
    fit::FitPrecision precision;
    fit::PoseBound bound;
    double score = 0.0;
    double open = 0.0;  ///< m, how far apart the faces stay that a blade has parted
    std::optional<fit::KerfEstimate> kerf;
};

bone::Bone resized(bone::Bone bone, double size) {
    for (volume::Grid* grid : {&bone.distance, &bone.density}) {
        grid->origin *= size;
        grid->spacing *= size;
    }
    for (auto& distance : bone.distance.values) distance = static_cast<float>(distance * size);
    bone.points.clear();
    return bone;
}

/// The middle of a fragment's paint and its area.
std::pair<Vec3, double> middle_of_paint(const analysis::CaseFragment& fragment) {
    Vec3 sum(0.0);
    double area = 0.0;
    for (const contact::SurfacePoint& p : fragment.bone.points)
        if (p.label == contact::surface_label::fracture) sum += p.area * p.position, area += p.area;
    return {area > 0.0 ? sum / area : Vec3(0.0), area};
}

std::optional<double> told_kerf(const ShaftsChoice& choice) {
    if (choice.told_kerf) return *choice.told_kerf * 1e-3;
    if (choice.told) return choice.kerf * 1e-3;
    return std::nullopt;
}

Shaft fit_shaft(const bone::Bone& bone, const ShaftsChoice& choice, int number) {
    analysis::FractureSettings settings;
    settings.seed = 7001 + static_cast<std::uint64_t>(number);
    settings.chips = choice.chips;
    settings.kerf = choice.kerf * 1e-3;
    settings.roughness = choice.roughness * 1e-3;
    std::vector<analysis::CaseFragment> fragments;
    std::vector<Pose> place;
    analysis::break_and_scan(bone, settings, [&](analysis::ScannedFragment one) {
        analysis::CaseFragment loaded;
        loaded.bone = std::move(one.bone);
        loaded.was_painted = true;
        loaded.map = contact::make_voxmap(std::exchange(loaded.bone.distance, {}));
        fragments.push_back(std::move(loaded));
        place.push_back(one.place);
    });
    analysis::PlanMatching matching(std::move(fragments), analysis::FitWay{told_kerf(choice)});
    const analysis::CaseFragment& moving = matching.fragment(1);
    const std::pair<Vec3, double> paint = middle_of_paint(moving);
    const Vec3& face = paint.first;
    const Pose truth = place[0].inverse() * place[1];
    const Random random{settings.seed + 999};
    const auto way = [&](std::uint64_t n) {
        return glm::normalize(Vec3(random.normal(n), random.normal(n + 1), random.normal(n + 2)));
    };
    const Quat turned = glm::normalize(rotation_by(8.0 * degree * way(0)) * truth.orientation);
    fit::Arrangement arrangement(2);
    arrangement.move(1, {truth.apply(face) + 3e-3 * way(3) - turned * face, turned});
    analysis::PlanMatch found = matching.near(arrangement, 1, analysis::Partners::all);
    if (found.match.verdict == fit::FitVerdict::fit) {
        arrangement.move(1, found.match.pose);
        found = matching.near(arrangement, 1, analysis::Partners::all);
    }
    const Pose& pose = found.match.pose;
    Shaft shaft;
    shaft.number = number;
    shaft.verdict = fit::name_of(found.match.verdict);
    shaft.area = paint.second;
    shaft.precision = found.match.precision;
    shaft.bound = found.match.bound;
    shaft.face_error = glm::length(pose.apply(face) - truth.apply(face));
    shaft.score = found.match.quality.score;
    shaft.open = found.match.quality.gap;
    shaft.kerf = found.kerf;
    shaft.angle = glm::length(rotation_between(truth.orientation, pose.orientation)) / degree;
    const Vec3 end = face + far_from_face * glm::normalize(analysis::middle_of(moving.bone.points) - face);
    shaft.error = glm::length(pose.apply(end) - truth.apply(end));
    const Vec3 last = std::ranges::max_element(moving.bone.points, {}, [&face](const contact::SurfacePoint& p) {
                          return glm::length(p.position - face);
                      })->position;
    shaft.end_error = glm::length(pose.apply(last) - truth.apply(last));
    return shaft;
}

/// Of what the contour said of a kerf; nothing of a shaft that was not judged so far.
std::string words_of(const std::optional<fit::KerfEstimate>& kerf) {
    if (!kerf) return "";
    if (kerf->told == 0.0) return ", no kerf looked for";
    if (kerf->contour.strips == 0) return ", no contour seen";
    return fmt::format(", kerf seen {:.2f} ± {:.2f} mm", kerf->kerf * 1e3, kerf->spread * 1e3);
}

double part_of(std::vector<double> values, double share) {
    std::ranges::sort(values);
    return values.empty() ? 0.0
                          : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

/// How often the bounds of fits and uncertain fits hold, and what the rest was.
struct BoundTally {
    int placed = 0, uncertain = 0, refused_right = 0;
    std::vector<double> covered;  ///< 1 or 0 per placed shaft: turn, face and far end are all within the bound
    std::vector<double> bounds, errors;  ///< mm, at the far end
};

/// Right means at most 5° and 3 mm at the face.
void count(BoundTally& tally, const Shaft& shaft) {
    const bool is_placed = shaft.verdict == "fit" || shaft.verdict == "uncertain";
    tally.refused_right += !is_placed && shaft.angle <= 5.0 && shaft.face_error <= 3e-3;
    if (!is_placed) return;
    ++tally.placed;
    tally.uncertain += shaft.verdict == "uncertain";
    tally.covered.push_back(shaft.angle * degree <= shaft.bound.turn && shaft.face_error <= shaft.bound.face &&
                            shaft.end_error <= shaft.bound.far);
    tally.bounds.push_back(std::min(shaft.bound.far * 1e3, 1e3));
    tally.errors.push_back(shaft.end_error * 1e3);
}

double mean_of(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double v : values) sum += v / static_cast<double>(values.size());
    return sum;
}

/// The 2.5 and 97.5 % quantiles of the coverage, by a bootstrap over shafts.
std::pair<double, double> coverage_range(const std::vector<double>& covered) {
    constexpr int draws = 2000;
    const Random random{20261};
    std::vector<double> means;
    for (int d = 0; d < draws && !covered.empty(); ++d) {
        double sum = 0.0;
        for (std::size_t n = 0; n < covered.size(); ++n) {
            const double u = random.uniform(static_cast<std::uint64_t>(d) * covered.size() + n);
            sum += covered[std::min(covered.size() - 1,
                                    static_cast<std::size_t>(u * static_cast<double>(covered.size())))];
        }
        means.push_back(sum / static_cast<double>(covered.size()));
    }
    return {part_of(means, 0.025), part_of(means, 0.975)};
}

int bench_shafts(const ShaftsChoice& choice) {
    const bone::Bone bone =
        resized(choice.bone.empty() ? library::make_fibula() : plan::bone_from_file(choice.bone), choice.size);
    std::vector<double> angles, errors;
    int fits = 0, good = 0;
    BoundTally tally;
    Json rows = Json::array();
    for (int n = choice.first; n < choice.first + choice.count; ++n) {
        const Shaft shaft = fit_shaft(bone, choice, n);
        count(tally, shaft);
        fits += shaft.verdict == "fit";
        good += shaft.verdict == "fit" && shaft.angle <= goal_angle && shaft.error <= goal_error;
        if (shaft.verdict == "fit") {
            angles.push_back(shaft.angle);
            errors.push_back(shaft.error * 1e3);
        }
        rows.push_back({{"shaft", n},
                        {"verdict", shaft.verdict},
                        {"face_mm2", shaft.area * 1e6},
                        {"angle_deg", shaft.angle},
                        {"error_mm", shaft.error * 1e3},
                        {"end_error_mm", shaft.end_error * 1e3},
                        {"face_error_mm", shaft.face_error * 1e3},
                        {"score", shaft.score},
                        {"bound_mm", std::min(shaft.bound.far * 1e3, 1e3)},
                        {"bound_face_mm", std::min(shaft.bound.face * 1e3, 1e3)},
                        {"bound_deg", std::min(shaft.bound.turn / degree, 180.0)},
                        {"rival", shaft.bound.has_rival},
                        {"held_mm", std::min(shaft.precision.far * 1e3, 1e3)},
                        {"held_deg", std::min(shaft.precision.turn / degree, 180.0)},
                        {"gap_mm", shaft.open * 1e3}});
        if (shaft.kerf && shaft.kerf->contour.strips > 0) {
            rows.back()["kerf_seen_mm"] = shaft.kerf->kerf * 1e3;
            rows.back()["kerf_spread_mm"] = shaft.kerf->spread * 1e3;
        }
        if (choice.json) continue;
        fmt::print("shaft {}: {}, face {:.0f} mm²: {:.3f}°, {:.3f} mm at 150 mm, gap {:.3f} mm{}\n", n, shaft.verdict,
                   shaft.area * 1e6, shaft.angle, shaft.error * 1e3, shaft.open * 1e3, words_of(shaft.kerf));
        std::fflush(stdout);
    }
    const auto [low, high] = coverage_range(tally.covered);
    const Json total{{"placed", tally.placed},
                     {"uncertain", tally.uncertain},
                     {"right_but_refused", tally.refused_right},
                     {"bound_coverage", mean_of(tally.covered)},
                     {"bound_coverage_low", low},
                     {"bound_coverage_high", high},
                     {"bound_median_mm", part_of(tally.bounds, 0.5)},
                     {"end_error_median_mm", part_of(tally.errors, 0.5)},
                     {"shafts", choice.count},
                     {"fits", fits},
                     {"within_goal", good},
                     {"angle_median_deg", part_of(angles, 0.5)},
                     {"angle_p90_deg", part_of(angles, 0.9)},
                     {"angle_max_deg", part_of(angles, 1.0)},
                     {"error_median_mm", part_of(errors, 0.5)},
                     {"error_p90_mm", part_of(errors, 0.9)},
                     {"error_max_mm", part_of(errors, 1.0)}};
    if (!choice.json)
        fmt::print(
            "{} placed, {} of them uncertain; {} right ones refused; the bound of 95 % holds for {:.0f} % ({:.0f} to "
            "{:.0f} %, bootstrap by shaft); at the far end its median is {:.2f} mm, that of the errors {:.2f} mm\n",
            tally.placed, tally.uncertain, tally.refused_right, 100.0 * mean_of(tally.covered), 100.0 * low,
            100.0 * high, part_of(tally.bounds, 0.5), part_of(tally.errors, 0.5));
    if (choice.json) fmt::print("{}\n", Json{{"version", 1}, {"total", total}, {"rows", rows}}.dump(2));
    else
        fmt::print(
            "{} of {} fit, {} within 0.25° and 0.5 mm at 150 mm; median {:.3f}° and {:.3f} mm, 90 % {:.3f}° and {:.3f} "
            "mm, all "
            "{:.3f}° and {:.3f} mm\n",
            fits, choice.count, good, part_of(angles, 0.5), part_of(errors, 0.5), part_of(angles, 0.9),
            part_of(errors, 0.9), part_of(angles, 1.0), part_of(errors, 1.0));
    return done;
}

}  // namespace

Verb shafts_verb() {
    return {
        "shafts", "how straight two halves of a long bone are put together, chipped and sawn",
        [](VerbOptions& verb) -> Action {
            const auto choice = std::make_shared<ShaftsChoice>();
            verb.add("--first", choice->first, "number of the first shaft").shows_default().range(0, 1'000'000);
            verb.add("--count", choice->count, "number of shafts").shows_default().range(1, 10'000);
            verb.add("--chips", choice->chips, "share of the faces that is chipped").shows_default().range(0.0, 0.9);
            verb.add("--kerf", choice->kerf, "mm of bone lost along the faces").shows_default().range(0.0, 4.0);
            verb.add("--roughness", choice->roughness, "mm rms of the faces' relief; 0.1 is a saw cut")
                .shows_default()
                .range(0.0, 4.0);
            verb.flag("--told", choice->told, "the fit knows the kerf");
            verb.add("--told-kerf", choice->told_kerf, "mm of kerf that the fit is told, right or wrong")
                .range(0.0, 4.0);
            verb.add("--size", choice->size, "of the bone, as a share: small bones have small faces")
                .shows_default()
                .range(0.2, 2.0);
            verb.add("--bone", choice->bone, "file of the long bone (default: the library's fibula)");
            verb.flag("--json", choice->json, "as JSON");
            return [choice] { return bench_shafts(*choice); };
        }};
}

}  // namespace tactus::bench
