// SPDX-License-Identifier: Apache-2.0
// Success rate of snap-to-fit on simulated fractures, compared with common variants of ICP.
#include "assets/file/json.hpp"
#include "assets/library/mandible.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/units.hpp"
#include "dsp/fit/fit.hpp"
#include "tools/analysis/bone/fragment_file.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/snap_cases.hpp"
#include "tools/bench/snap_live.hpp"
#include "tools/bench/snap_peers.hpp"
#include "tools/bench/snap_tally.hpp"
#include "tools/bench/snap_whole_case.hpp"
#include "tools/command/old_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>

namespace tactus::bench {

namespace {

using file::Json;

struct SnapBenchChoice {
    std::uint64_t seed = 1001;
    int seeds = 8, trials = 1;
    std::vector<std::string> cases, methods;
    std::optional<double> chips;  ///< percent of the fracture's surface
    std::vector<std::string> starts;
    std::filesystem::path bone;
    bool pushed = false, json = false;
};

constexpr const char* live_case = "live";
constexpr std::pair<const char*, fit::FitMode> modes[] = {
    {"extended", fit::FitMode::extended}, {"global", fit::FitMode::global}, {"baseline", fit::FitMode::thesis}};
constexpr IcpKind peers[] = {IcpKind::point, IcpKind::plane, IcpKind::generalised};
constexpr IcpSchedule schedules[] = {IcpSchedule::unlimited, IcpSchedule::trimmed, IcpSchedule::annealed};

bool is_chosen(const SnapBenchChoice& choice, std::string_view method) {
    return choice.methods.empty() || std::ranges::count(choice.methods, method) > 0;
}

/// `anywhere`: the cached result of the global fit, which does not depend on the start.
void try_all(const FracturePair& pair, const IcpTarget& target, const Pose& start, const SnapBenchChoice& choice,
             std::optional<TimedFit>& anywhere, Tallies& tallies) {
    for (const auto& [name, mode] : modes) {
        if (!is_chosen(choice, name)) continue;
        const bool is_known = mode == fit::FitMode::global && anywhere;
        const TimedFit found = is_known ? *anywhere : TimedFit(pair, start, mode);
        if (mode == fit::FitMode::global) anywhere = found;
        tallies[name].add(pair, found.fit.pose, found.seconds);
        tallies[name].judge(found.fit.verdict);
    }
    const Pose centres = fit::between_centres(pair.moving, pair.fixed, start);
    for (const IcpKind kind : peers)
        for (const IcpSchedule schedule : schedules) {
            if (!is_chosen(choice, name_of(kind))) continue;
            const std::int64_t begin = thread_ns();
            const Pose pose = run_icp(pair.moving, target, centres, kind, schedule);
            tallies[fmt::format("{} {}", name_of(kind), name_of(schedule))].add(
                pair, fit::between_bodies(pair.moving, pair.fixed, pose),
                1e-9 * static_cast<double>(thread_ns() - begin));
        }
}

Json row_of(const FractureCase& c, const FractureStart& start, const std::string& method, const std::string& schedule,
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

/// All own modes, and each peer with its best schedule.
void add_rows(Json& rows, const FractureCase& c, const FractureStart& start, const SnapBenchChoice& choice,
              const Tallies& tallies) {
    for (const auto& [name, mode] : modes)
        if (is_chosen(choice, name)) rows.push_back(row_of(c, start, name, "", tallies.at(name)));
    for (const IcpKind kind : peers) {
        if (!is_chosen(choice, name_of(kind))) continue;
        const Tally* best = nullptr;
        std::string_view best_schedule;
        for (const IcpSchedule schedule : schedules) {
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

/// Reports the worst piece beside the median, because errors add up along a chain of pieces.
Json whole_case_row(const bone::Bone& bone, const WholeCase& kind, const SnapBenchChoice& choice) {
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
            {"islands", r.islands},
            {"without_neighbours", r.alone},
            {"kerf_mm", kind.kerf * 1e3},
            {"median_gap_mm", median(r.gap) * 1e3}};
}

void print_whole_case(const Json& row) {
    fmt::print(
        "{}: {} of {} pieces fit, {:.1f} % within 0.3 mm and 0.5°; error {:.3f} mm and {:.2f}° (median), {:.3f} mm and "
        "{:.2f}° (worst); gap left {:.3f} mm; {} parts cut off, {} without neighbours; {:.0f} ms for a look\n",
        row["case"].get<std::string>(), row["fitted"].get<int>(), row["trials"].get<int>(),
        100.0 * row["success"].get<double>(), row["median_tre_mm"].get<double>(), row["median_deg"].get<double>(),
        row["worst_mm"].get<double>(), row["worst_deg"].get<double>(), row["median_gap_mm"].get<double>(),
        row["islands"].get<int>(), row["without_neighbours"].get<int>(), row["median_ms"].get<double>());
}

/// The whole cases selected by name.
Json whole_case_rows(const SnapBenchChoice& choice, const bone::Bone& bone) {
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

/// "8 mm 20 deg".
FractureStart parse_start(const std::string& text) {
    const std::size_t first = text.find(" mm "), last = text.find(" deg");
    if (first == std::string::npos || last == std::string::npos || last + 4 != text.size() || last < first + 4)
        throw Error(fmt::format("--start must be a distance and an angle, as in '8 mm 20 deg', not '{}'", text));
    return {parse_as(text.substr(0, first + 3), "m") * 1e3, parse_as(text.substr(first + 4), "rad") / degree};
}

std::vector<FractureCase> chosen_cases(const std::vector<std::string>& names) {
    if (names.empty()) return fracture_cases();
    std::vector<FractureCase> chosen;
    std::vector<std::string> known;
    for (const FractureCase& c : fracture_cases()) known.emplace_back(c.kind.name);
    known.emplace_back(live_case);
    for (const WholeCase& c : whole_cases()) known.emplace_back(c.name);
    for (const std::string& name : names) {
        if (name == live_case || std::ranges::count(whole_cases(), name, &WholeCase::name) > 0) continue;
        const auto found =
            std::ranges::find_if(fracture_cases(), [&](const FractureCase& c) { return c.kind.name == name; });
        if (found == fracture_cases().end())
            throw Error(fmt::format("there is no case '{}'{}", name, did_you_mean(name, known)));
        chosen.push_back(*found);
    }
    return chosen;
}

}  // namespace

int bench_snap(const SnapBenchChoice& choice) {
    std::vector<FractureCase> cases = chosen_cases(choice.cases);
    const bool is_own = choice.chips || !choice.starts.empty();
    if (is_own) {
        if (!choice.cases.empty()) throw Error("--chips and --start make a case of their own; leave out --case");
        FractureCase own = fracture_cases().front();
        own.kind.name = "own";
        if (choice.chips) own.kind.chips = 0.01 * *choice.chips;
        if (!choice.starts.empty()) own.starts.clear();
        for (const std::string& start : choice.starts) own.starts.push_back(parse_start(start));
        cases = {own};
    }
    const bool live = (choice.cases.empty() && !is_own) || std::ranges::count(choice.cases, live_case) > 0;
    const bone::Bone bone = choice.bone.empty() ? library::make_mandible() : analysis::bone_of_file(choice.bone);
    Json rows = whole_case_rows(choice, bone);
    if (!choice.json && !cases.empty())
        fmt::print(
            "{} broken in two, scanned and painted; success: under 0.5 mm rms over the whole fragment; processor "
            "time; seeds {} to {}\n{:10} {:>9} {:22} {:>6} {:>8} {:>9} {:>7} {:>7} {}\n",
            bone.name, choice.seed, choice.seed + static_cast<std::uint64_t>(choice.seeds) - 1, "case", "mm/deg",
            "method", "trials", "success%", "tre mm", "deg", "ms", "failures named, false alarms");
    for (const FractureCase& c : cases) {
        std::vector<Tallies> tallies(c.starts.size());
        for (std::uint64_t n = 0; n < static_cast<std::uint64_t>(choice.seeds); ++n) {
            const std::uint64_t seed = choice.seed + n;
            const FracturePair pair = make_fracture_pair(bone.distance, c.kind, seed);
            const IcpTarget target(pair.fixed);
            std::optional<TimedFit> anywhere;
            for (std::size_t s = 0; s < c.starts.size(); ++s)
                for (std::uint64_t trial = 0; trial < static_cast<std::uint64_t>(choice.trials); ++trial) {
                    const Pose start = start_beside(pair, c.starts[s].offset_mm * 1e-3, c.starts[s].angle_deg * degree,
                                                    choice.pushed, seed * 1000 + trial);
                    try_all(pair, target, start, choice, anywhere, tallies[s]);
                }
        }
        for (std::size_t s = 0; s < c.starts.size(); ++s) {
            const std::size_t first = rows.size();
            add_rows(rows, c, c.starts[s], choice, tallies[s]);
            for (std::size_t n = first; !choice.json && n < rows.size(); ++n) print_row(rows[n]);
            std::fflush(stdout);
        }
    }
    if (live) {
        const Json more = live_rows();
        if (!choice.json) print_live(more);
        for (const Json& row : more) rows.push_back(row);
    }
    if (choice.json) fmt::print("{}\n", Json{{"version", 1}, {"rows", rows}}.dump(2));
    return done;
}

Verb snap_verb() {
    return {"snap", "success of snap-to-fit on simulated fractures, beside ICP", [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<SnapBenchChoice>();
                const std::vector<std::string> methods{"extended",  "global",    "baseline",
                                                       "icp_point", "icp_plane", "gicp"};
                verb.add("--seed", choice->seed, "of the first fracture").shows_default();
                verb.add("--seeds", choice->seeds, "number of fractures of each kind").shows_default().range(1, 10'000);
                verb.add("--trials", choice->trials, "starts for each fracture and distance")
                    .shows_default()
                    .range(1, 1000);
                verb.add("--case", choice->cases,
                         "clean, chipped25, chipped30, spilled, both, fine or live (default: all of these); twelve, "
                         "twelve-kerf, twelve-missing: a jaw in twelve pieces, by the matcher")
                    .separated_by(',');
                verb.add("--chips", choice->chips,
                         "a case of its own: clean, with this percentage of the fracture's surface missing")
                    .range(0.0, 60.0);
                verb.add("--start", choice->starts, "a case of its own: its starts, as in '4 mm 12 deg,8 mm 20 deg'")
                    .separated_by(',');
                verb.add("--method", choice->methods,
                         "extended, global, baseline, icp_point, icp_plane, gicp (default: all)")
                    .separated_by(',')
                    .one_of(methods);
                verb.add("--bone", choice->bone, "bone to break (default: the bundled jaw)");
                verb.flag("--pushed", choice->pushed, "move the starts apart until the bones do not overlap");
                verb.flag("--json", choice->json, "as JSON");
                verb.old([](std::vector<std::string>& words) {
                    command::rename_value(words, "--method", "thesis", "baseline");
                });
                return [choice] { return bench_snap(*choice); };
            }};
}

}  // namespace tactus::bench
