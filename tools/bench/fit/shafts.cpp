// SPDX-License-Identifier: Apache-2.0
// How straight the two halves of a long bone are put together: a small error of the face is a large one at the far end.
#include "assets/file/json.hpp"
#include "assets/library/fibula.hpp"
#include "assets/plan/case_bones.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "dsp/core/rotation.hpp"
#include "tools/analysis/bone/fracture.hpp"
#include "tools/analysis/plan/plan_matching.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/fit/shaft_shapes.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
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
    double voxel = 0.35;  // mm, of the scans
    int shapes = 0;  // of the bones; 0: the library's fibula alone
    std::optional<double> given_kerf;  // mm
    bool given = false, json = false;
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

std::optional<double> given_kerf(const ShaftsChoice& choice) {
    if (choice.given_kerf) return *choice.given_kerf * 1e-3;
    if (choice.given) return choice.kerf * 1e-3;
    return std::nullopt;
}

Shaft fit_shaft(const bone::Bone& bone, const ShaftsChoice& choice, int number) {
    analysis::FractureSettings settings;
    settings.seed = 7001 + static_cast<std::uint64_t>(number);
    settings.chips = choice.chips;
    settings.kerf = choice.kerf * 1e-3;
    settings.roughness = choice.roughness * 1e-3;
    settings.voxel = choice.voxel * 1e-3;
    settings.spacing = std::max(settings.spacing, settings.voxel);
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
    analysis::PlanMatching matching(std::move(fragments), analysis::FitWay{given_kerf(choice)});
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

/// The kerf that the contour indicates; empty if the faces do not fit.
std::string words_of(const std::optional<fit::KerfEstimate>& kerf) {
    if (!kerf) return "";
    if (kerf->given == 0.0) return ", kerf not checked";
    if (kerf->contour.strips == 0) return ", no contour found";
    return fmt::format(", kerf estimated at {:.2f} ± {:.2f} mm", kerf->kerf * 1e3, kerf->spread * 1e3);
}

double part_of(std::vector<double> values, double share) {
    std::ranges::sort(values);
    return values.empty() ? 0.0
                          : values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

/// How often the bounds of fits and uncertain fits hold, and how wide they are.
struct BoundTally {
    static constexpr std::size_t quantities = 3;  // turn, face, far end
    static constexpr std::array<const char*, quantities> names{"turn_deg", "face_mm", "end_mm"};

    int placed = 0, uncertain = 0, refused_right = 0, uncertain_wrong = 0;
    std::vector<std::pair<int, double>> covered;  ///< shape, and 1 or 0: all three are within the bound
    std::array<std::vector<double>, quantities> bounds, errors;  ///< degrees, mm, mm
};

/// Right means at most 5° and 3 mm at the face.
void count(BoundTally& tally, const Shaft& shaft, int shape) {
    const bool is_placed = shaft.verdict == "fit" || shaft.verdict == "uncertain",
               is_right = shaft.angle <= 5.0 && shaft.face_error <= 3e-3;
    tally.refused_right += !is_placed && is_right;
    if (!is_placed) return;
    ++tally.placed;
    tally.uncertain += shaft.verdict == "uncertain";
    tally.uncertain_wrong += shaft.verdict == "uncertain" && !is_right && !shaft.bound.has_rival;
    const std::array<double, BoundTally::quantities> bound{shaft.bound.turn / degree, shaft.bound.face * 1e3,
                                                           std::min(shaft.bound.far * 1e3, 1e3)},
        error{shaft.angle, shaft.face_error * 1e3, shaft.end_error * 1e3};
    bool is_covered = true;
    for (std::size_t n = 0; n < BoundTally::quantities; ++n) {
        is_covered = is_covered && error[n] <= bound[n];
        tally.bounds[n].push_back(bound[n]);
        tally.errors[n].push_back(error[n]);
    }
    tally.covered.emplace_back(shape, is_covered ? 1.0 : 0.0);
}

double mean_of(const std::vector<std::pair<int, double>>& values) {
    double sum = 0.0;
    for (const auto& [shape, value] : values) sum += value / static_cast<double>(values.size());
    return sum;
}

/// The 2.5 and 97.5 % quantiles of the coverage, by a bootstrap over shapes: shafts of one shape are not independent.
std::pair<double, double> coverage_range(const std::vector<std::pair<int, double>>& covered) {
    constexpr int draws = 2000;
    const Random random{20261};
    std::map<int, std::pair<double, double>> shapes;  // sum and count
    for (const auto& [shape, value] : covered) {
        shapes[shape].first += value;
        shapes[shape].second += 1.0;
    }
    std::vector<std::pair<double, double>> sums;
    for (const auto& [shape, sum] : shapes) sums.push_back(sum);
    std::vector<double> means;
    for (int d = 0; d < draws && !sums.empty(); ++d) {
        double sum = 0.0, all = 0.0;
        for (std::size_t n = 0; n < sums.size(); ++n) {
            const double u = random.uniform(static_cast<std::uint64_t>(d) * sums.size() + n);
            const auto& one =
                sums[std::min(sums.size() - 1, static_cast<std::size_t>(u * static_cast<double>(sums.size())))];
            sum += one.first;
            all += one.second;
        }
        means.push_back(sum / all);
    }
    return {part_of(means, 0.025), part_of(means, 0.975)};
}

Json bounds_json(const BoundTally& tally) {
    Json json = Json::object();
    for (std::size_t n = 0; n < BoundTally::quantities; ++n)
        json[BoundTally::names[n]] =
            Json{{"bound_median", part_of(tally.bounds[n], 0.5)}, {"error_median", part_of(tally.errors[n], 0.5)}};
    return json;
}

int bench_shafts(const ShaftsChoice& choice) {
    if (choice.shapes > 0 && !choice.bone.empty()) throw Error("--shapes replaces the bone: leave out --bone");
    bone::Bone bone;
    if (choice.shapes == 0)
        bone = resized(choice.bone.empty() ? library::make_fibula() : plan::bone_from_file(choice.bone), choice.size);
    std::vector<double> angles, errors;
    int fits = 0, good = 0;
    BoundTally tally;
    Json rows = Json::array();
    for (int n = choice.first; n < choice.first + choice.count; ++n) {
        if (choice.shapes > 0) bone = resized(shaft_shape(n % choice.shapes), choice.size);
        const Shaft shaft = fit_shaft(bone, choice, n);
        // Without shapes every shaft is a sample of its own.
        const int shape = choice.shapes > 0 ? n % choice.shapes : n;
        count(tally, shaft, shape);
        fits += shaft.verdict == "fit";
        good += shaft.verdict == "fit" && shaft.angle <= goal_angle && shaft.error <= goal_error;
        if (shaft.verdict == "fit") {
            angles.push_back(shaft.angle);
            errors.push_back(shaft.error * 1e3);
        }
        rows.push_back({{"shaft", n},
                        {"shape", shape},
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
                     {"wrong_uncertain_without_rival", tally.uncertain_wrong},
                     {"bounds", bounds_json(tally)},
                     {"shafts", choice.count},
                     {"fits", fits},
                     {"within_goal", good},
                     {"angle_median_deg", part_of(angles, 0.5)},
                     {"angle_p90_deg", part_of(angles, 0.9)},
                     {"angle_max_deg", part_of(angles, 1.0)},
                     {"error_median_mm", part_of(errors, 0.5)},
                     {"error_p90_mm", part_of(errors, 0.9)},
                     {"error_max_mm", part_of(errors, 1.0)}};
    if (!choice.json) {
        fmt::print(
            "{} placed, {} of them uncertain ({} at a wrong place without a rival); {} right ones refused; the bound "
            "of "
            "95 % holds for {:.1f} % ({:.1f} to {:.1f} %, bootstrap by shape)\n",
            tally.placed, tally.uncertain, tally.uncertain_wrong, tally.refused_right, 100.0 * mean_of(tally.covered),
            100.0 * low, 100.0 * high);
        constexpr std::array<const char*, BoundTally::quantities> words{"degrees", "mm at the face",
                                                                        "mm at the far end"};
        for (std::size_t n = 0; n < BoundTally::quantities; ++n)
            fmt::print("    median bound {:.3f}, median error {:.3f} {}\n", part_of(tally.bounds[n], 0.5),
                       part_of(tally.errors[n], 0.5), words[n]);
    }
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
            verb.flag("--given", choice->given, "give the true kerf to the fit");
            verb.add("--given-kerf", choice->given_kerf, "mm of kerf that is given to the fit, true or false")
                .range(0.0, 4.0);
            verb.add("--size", choice->size, "of the bone, as a share: small bones have small faces")
                .shows_default()
                .range(0.2, 2.0);
            verb.add("--voxel", choice->voxel, "mm, of the scans").shows_default().range(0.1, 2.0);
            verb.add("--shapes", choice->shapes,
                     "number of bones of different shapes, in turn; 0: the library's fibula")
                .shows_default()
                .range(0, 10'000);
            verb.add("--bone", choice->bone, "file of the long bone (default: the library's fibula)");
            verb.flag("--json", choice->json, "as JSON");
            return [choice] { return bench_shafts(*choice); };
        }};
}

}  // namespace tactus::bench
