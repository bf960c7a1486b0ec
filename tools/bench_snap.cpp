// SPDX-License-Identifier: Apache-2.0
// How often snap-to-fit finds the place of a fragment, beside ICP in its usual forms, on the same simulated fractures.
#include "assets/library/mandible.hpp"
#include "dsp/core/error.hpp"
#include "dsp/operator/hand.hpp"
#include "dsp/snap/fit.hpp"
#include "tools/bench_snap_case.hpp"
#include "tools/bench_snap_cases.hpp"
#include "tools/bench_snap_live.hpp"
#include "tools/bench_snap_peers.hpp"
#include "tools/fragment_file.hpp"
#include "tools/snap_options.hpp"
#include "tools/verbs.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <time.h>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace tactus {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* live_case = "live";
constexpr double degree = std::numbers::pi / 180.0, success = 0.5e-3;

struct Start {
    double offset_mm, angle_deg;
};

struct Case {
    FractureKind kind;
    std::vector<Start> starts;
};

const std::vector<Case>& all_cases() {
    static const std::vector<Case> cases{
        {{"clean", 0.8e-3, 0.0, 0.0, 0.03}, {{4, 12}, {8, 20}, {10, 30}}},
        {{"chipped25", 0.8e-3, 0.25, 0.0, 0.03}, {{4, 12}, {8, 20}, {10, 30}, {12, 45}}},
        {{"chipped30", 0.8e-3, 0.30, 0.0, 0.03}, {{4, 12}, {8, 20}}},
        {{"spilled", 0.8e-3, 0.0, 2e-3, 0.03}, {{4, 12}, {8, 20}, {10, 30}, {12, 45}}},
        {{"both", 0.8e-3, 0.25, 2e-3, 0.03}, {{4, 12}, {8, 20}, {10, 30}, {12, 45}}},
        {{"fine", 0.4e-3, 0.0, 0.0, 0.06}, {{4, 12}}},
    };
    return cases;
}

double thread_seconds() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// What a method did over all trials of a case and start.
struct Tally {
    std::vector<double> error, angle, time;
    int failures_flagged = 0, failures = 0, alarms = 0, judged = 0;

    void add(const FracturePair& pair, const Pose& pose, double seconds) {
        error.push_back(pair.error(pose));
        angle.push_back(glm::length(rotation_between(pair.truth.orientation, pose.orientation)) / degree);
        time.push_back(seconds);
    }
    void judge(FitVerdict verdict) {
        ++judged;
        const bool failed = !(error.back() < success), flagged = verdict != FitVerdict::fit;
        failures += failed;
        failures_flagged += failed && flagged;
        alarms += !failed && flagged;
    }
    double share() const {
        const auto good = std::ranges::count_if(error, [](double e) { return e < success; });
        return error.empty() ? 0.0 : static_cast<double>(good) / static_cast<double>(error.size());
    }
};

using Tallies = std::map<std::string, Tally>;

void try_all(const FracturePair& pair, const IcpTarget& target, const Pose& start, Tallies& tallies) {
    const std::pair<const char*, FitMode> modes[] = {
        {"extended", FitMode::extended}, {"global", FitMode::global}, {"thesis", FitMode::thesis}};
    for (const auto& [name, mode] : modes) {
        const double begin = thread_seconds();
        const Fit fit = find_fit(pair.moving, pair.fixed, start, mode);
        tallies[name].add(pair, fit.pose, thread_seconds() - begin);
        tallies[name].judge(fit.verdict);
    }
    const Pose centres = between_centres(pair.moving, pair.fixed, start);
    for (const IcpKind kind : {IcpKind::point, IcpKind::plane, IcpKind::generalised})
        for (const IcpSchedule schedule : {IcpSchedule::unlimited, IcpSchedule::trimmed, IcpSchedule::annealed}) {
            const double begin = thread_seconds();
            const Pose pose = run_icp(pair.moving, target, centres, kind, schedule);
            tallies[fmt::format("{} {}", name_of(kind), name_of(schedule))].add(
                pair, between_bodies(pair.moving, pair.fixed, pose), thread_seconds() - begin);
        }
}

Json row_of(const Case& c, const Start& start, const std::string& method, const std::string& schedule,
            const Tally& tally) {
    Json row{{"case", c.kind.name},
             {"method", method},
             {"start_mm", start.offset_mm},
             {"start_deg", start.angle_deg},
             {"trials", tally.error.size()},
             {"success", tally.share()},
             {"median_tre_mm", median(tally.error) * 1e3},
             {"median_deg", median(tally.angle)},
             {"median_ms", median(tally.time) * 1e3}};
    if (!schedule.empty()) row["schedule"] = schedule;
    if (tally.judged > 0) {
        row["failures"] = tally.failures;
        row["failures_flagged"] = tally.failures_flagged;
        row["false_alarms"] = tally.alarms;
    }
    return row;
}

/// Our modes as they are, each peer by the schedule that served it best.
void add_rows(Json& rows, const Case& c, const Start& start, const Tallies& tallies) {
    for (const char* mode : {"extended", "global", "thesis"})
        rows.push_back(row_of(c, start, mode, "", tallies.at(mode)));
    for (const IcpKind kind : {IcpKind::point, IcpKind::plane, IcpKind::generalised}) {
        const Tally* best = nullptr;
        std::string_view best_schedule;
        for (const IcpSchedule schedule : {IcpSchedule::unlimited, IcpSchedule::trimmed, IcpSchedule::annealed}) {
            const Tally& tally = tallies.at(fmt::format("{} {}", name_of(kind), name_of(schedule)));
            const bool better = !best || tally.share() > best->share() ||
                                (tally.share() == best->share() && median(tally.error) < median(best->error));
            if (better) best = &tally, best_schedule = name_of(schedule);
        }
        rows.push_back(row_of(c, start, std::string(name_of(kind)), std::string(best_schedule), *best));
    }
}

void print_row(const Json& row) {
    const std::string method =
        row["method"].get<std::string>() + (row.contains("schedule") ? " " + row["schedule"].get<std::string>() : "");
    fmt::print("{:10} {:>4.0f}/{:<4.0f} {:22} {:>6} {:>8.1f} {:>9.3f} {:>7.2f} {:>7.0f}",
               row["case"].get<std::string>(), row["start_mm"].get<double>(), row["start_deg"].get<double>(), method,
               row["trials"].get<int>(), 100.0 * row["success"].get<double>(), row["median_tre_mm"].get<double>(),
               row["median_deg"].get<double>(), row["median_ms"].get<double>());
    if (row.contains("failures"))
        fmt::print(" {:>5}/{} {:>5}", row["failures_flagged"].get<int>(), row["failures"].get<int>(),
                   row["false_alarms"].get<int>());
    fmt::print("\n");
}

Json live_rows() {
    Json rows = Json::array();
    for (const LiveTicks& row : bench_snap_live())
        rows.push_back({{"case", live_case},
                        {"method", row.method},
                        {"painted_points", row.painted_points},
                        {"trials", row.ticks},
                        {"success", row.in_time},
                        {"median_ms", row.median_ms},
                        {"p99_ms", row.p99_ms},
                        {"evaluations_mean", row.evaluations}});
    return rows;
}

void print_live(const Json& rows) {
    for (const Json& row : rows)
        fmt::print("live, {} painted points, {}: a tick takes {:.2f} ms, p99 {:.2f}; under 0.5 ms: {:.1f} %\n",
                   row["painted_points"].get<int>(), row["method"].get<std::string>(), row["median_ms"].get<double>(),
                   row["p99_ms"].get<double>(), 100.0 * row["success"].get<double>());
}

/// What an outlier of a chain of pieces is must be seen: the worst beside the median.
Json whole_case_row(const Bone& bone, const WholeCase& kind, const SnapBenchChoice& choice) {
    const WholeCaseResult r = put_together(bone, kind, choice.seed, choice.seeds);
    return {{"case", kind.name},
            {"method", "matcher"},
            {"start_mm", 5.0},
            {"start_deg", 10.0},
            {"trials", r.error.size()},
            {"success", static_cast<double>(r.within) / static_cast<double>(std::max<std::size_t>(r.error.size(), 1))},
            {"median_tre_mm", median(r.error) * 1e3},
            {"median_deg", median(r.angle)},
            {"median_ms", median(r.seconds) * 1e3},
            {"worst_mm", r.worst_error() * 1e3},
            {"worst_deg", r.worst_angle()},
            {"fitted", r.fitted},
            {"without_neighbours", r.alone},
            {"kerf_mm", kind.kerf * 1e3},
            {"median_gap_mm", median(r.gap) * 1e3}};
}

void print_whole_case(const Json& row) {
    fmt::print(
        "{}: {} of {} pieces fit, {:.1f} % within 0.3 mm and 0.5°; error {:.3f} mm and {:.2f}° (median), {:.3f} mm and "
        "{:.2f}° (worst); gap left {:.3f} mm; {} without neighbours; {:.0f} ms for a look\n",
        row["case"].get<std::string>(), row["fitted"].get<int>(), row["trials"].get<int>(),
        100.0 * row["success"].get<double>(), row["median_tre_mm"].get<double>(), row["median_deg"].get<double>(),
        row["worst_mm"].get<double>(), row["worst_deg"].get<double>(), row["median_gap_mm"].get<double>(),
        row["without_neighbours"].get<int>(), row["median_ms"].get<double>());
}

/// The whole cases that are asked for by name.
Json whole_case_rows(const SnapBenchChoice& choice, const Bone& bone) {
    Json rows = Json::array();
    for (const WholeCase& kind : whole_cases()) {
        if (std::ranges::count(choice.cases, kind.name) == 0) continue;
        rows.push_back(whole_case_row(bone, kind, choice));
        if (choice.json) continue;
        print_whole_case(rows.back());
        std::fflush(stdout);
    }
    return rows;
}

std::vector<Case> chosen_cases(const std::vector<std::string>& names) {
    if (names.empty()) return all_cases();
    std::vector<Case> chosen;
    std::vector<std::string> known;
    for (const Case& c : all_cases()) known.emplace_back(c.kind.name);
    known.emplace_back(live_case);
    for (const WholeCase& c : whole_cases()) known.emplace_back(c.name);
    for (const std::string& name : names) {
        if (name == live_case || std::ranges::count(whole_cases(), name, &WholeCase::name) > 0) continue;
        const auto found = std::ranges::find_if(all_cases(), [&](const Case& c) { return c.kind.name == name; });
        if (found == all_cases().end())
            throw Error(fmt::format("there is no case '{}'{}", name, did_you_mean(name, known)));
        chosen.push_back(*found);
    }
    return chosen;
}

}  // namespace

int bench_snap_verb(const SnapBenchChoice& choice) {
    const std::vector<Case> cases = chosen_cases(choice.cases);
    const bool live = choice.cases.empty() || std::ranges::count(choice.cases, live_case) > 0;
    const Bone bone = choice.bone.empty() ? make_mandible() : bone_of_file(choice.bone);
    Json rows = whole_case_rows(choice, bone);
    if (!choice.json && !cases.empty())
        fmt::print(
            "{} broken in two, scanned and painted; success: under 0.5 mm rms over the whole fragment; processor "
            "time; seeds {} to {}\n{:10} {:>9} {:22} {:>6} {:>8} {:>9} {:>7} {:>7} {}\n",
            bone.name, choice.seed, choice.seed + static_cast<std::uint64_t>(choice.seeds) - 1, "case", "mm/deg",
            "method", "trials", "success%", "tre mm", "deg", "ms", "failures named, false alarms");
    for (const Case& c : cases) {
        std::vector<Tallies> tallies(c.starts.size());
        for (std::uint64_t n = 0; n < static_cast<std::uint64_t>(choice.seeds); ++n) {
            const std::uint64_t seed = choice.seed + n;
            const FracturePair pair = make_fracture_pair(bone.distance, c.kind, seed);
            const IcpTarget target(pair.fixed);
            for (std::size_t s = 0; s < c.starts.size(); ++s)
                for (std::uint64_t trial = 0; trial < static_cast<std::uint64_t>(choice.trials); ++trial) {
                    const Pose start = start_beside(pair, c.starts[s].offset_mm * 1e-3, c.starts[s].angle_deg * degree,
                                                    choice.pushed, seed * 1000 + trial);
                    try_all(pair, target, start, tallies[s]);
                }
        }
        for (std::size_t s = 0; s < c.starts.size(); ++s) {
            const std::size_t first = rows.size();
            add_rows(rows, c, c.starts[s], tallies[s]);
            for (std::size_t n = first; !choice.json && n < rows.size(); ++n) print_row(rows[n]);
            std::fflush(stdout);
        }
    }
    if (live) {
        const Json more = live_rows();
        if (!choice.json) print_live(more);
        rows.insert(rows.end(), more.begin(), more.end());
    }
    if (choice.json) fmt::print("{}\n", rows.dump(2));
    return done;
}

}  // namespace tactus
