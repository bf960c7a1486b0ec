// SPDX-License-Identifier: Apache-2.0
// Which thresholds tell true fits from false ones: trials with known truth, one half to set them, the other to judge.
#include "assets/file/json.hpp"
#include "dsp/core/clock.hpp"
#include "dsp/core/error.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/fit/fit_pairs.hpp"
#include "tools/bench/fit/result_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <vector>

namespace tactus::bench {

namespace {

using file::Json;

struct FitsChoice {
    int first = 0, groups = 60;
    std::string half = "both";
    std::optional<double> voxel;  // mm
    std::filesystem::path out;
    bool json = false;
};

/// Thresholds are set on one half of the broken bones and judged on the other; both halves have both bones.
bool is_to_set(int group) { return group / 2 % 2 == 0; }

bool is_chosen(const FitsChoice& choice, int group) {
    return choice.half == "both" || is_to_set(group) == (choice.half == "set");
}

/// What the trials of one half say.
struct FitsTally {
    int groups = 0, mismatches = 0, near_misses = 0, false_fits = 0, false_uncertain = 0, trials = 0, found = 0,
        kept = 0;
    int slipped = 0;  ///< starts a relief period away that do not lead to the right place
    int right = 0, right_fit = 0, right_uncertain = 0;  ///< neighbours whose best place is right
    double weakest_score = 1.0, weakest_share = 1.0, weakest_margin = 1.0, strongest_score = 0.0;
};

Json row_of(int group, const PairTrial& t) {
    return {{"group", group},
            {"kind", t.kind},
            {"mode", t.is_global ? "global" : "extended"},
            {"moving", t.moving},
            {"partner", t.partner},
            {"loose", fit::name_of(t.loose)},
            {"verdict", fit::name_of(t.verdict)},
            {"rival", t.has_rival},
            {"score", t.score},
            {"margin", t.margin},
            {"share", t.share},
            {"overlap_mm2", t.overlap * 1e6},
            {"rms_mm", t.rms * 1e3},
            {"error_mm", t.error * 1e3},
            {"verdict_error_mm", t.verdict_error * 1e3},
            {"unheld", fit::name_of(t.unheld)},
            {"held_mm", std::min(t.held * 1e3, 1e3)},
            {"far_error_mm", t.far_error * 1e3}};
}

/// Fits of neighbours that the other thresholds let pass, by how well their faces hold the far end.
struct HeldTally {
    double limit = 0.0;  ///< mm
    int right = 0, wrong = 0;  ///< that the limit keeps; wrong: far end more than the goal of long bones off
    int lost = 0, refused = 0;  ///< right and wrong ones that it refuses
};

std::vector<HeldTally> held_of(const std::vector<Json>& rows, bool to_set) {
    constexpr double wrong_mm = 0.5;
    std::vector<HeldTally> tallies{{0.5}, {0.65}, {0.8}, {1.0}};
    for (const Json& row : rows) {
        if (is_to_set(row["group"].get<int>()) != to_set || row["kind"] != "true" || row["unheld"] != "fit") continue;
        const bool is_wrong = row["far_error_mm"].get<double>() > wrong_mm;
        for (HeldTally& t : tallies) {
            const bool is_kept = row["held_mm"].get<double>() <= t.limit;
            t.right += is_kept && !is_wrong;
            t.wrong += is_kept && is_wrong;
            t.lost += !is_kept && !is_wrong;
            t.refused += !is_kept && is_wrong;
        }
    }
    return tallies;
}

FitsTally tally_of(const std::vector<Json>& rows, bool to_set) {
    constexpr double found_mm = 0.5, false_mm = 1.0, right_mm = 3.0;
    FitsTally tally;
    int last = -1;
    for (const Json& row : rows) {
        const int group = row["group"].get<int>();
        if (is_to_set(group) != to_set) continue;
        tally.groups += group != last;
        last = group;
        const bool is_true = row["kind"] == "true", fits = row["verdict"] == "fit";
        const double score = row["score"].get<double>();
        const bool is_right = is_true && row["verdict_error_mm"].get<double>() <= right_mm;
        if (row["kind"] == "slipped" && row["verdict_error_mm"].get<double>() <= right_mm) continue;
        if (!is_true) {
            ++tally.mismatches;
            tally.slipped += row["kind"] == "slipped";
            tally.near_misses += row["kind"] != "foreign";
            tally.false_fits += fits;
            tally.false_uncertain += row["verdict"] == "uncertain" && !row["rival"].get<bool>();
            if (row["loose"] == "fit") tally.strongest_score = std::max(tally.strongest_score, score);
            continue;
        }
        ++tally.trials;
        tally.right += is_right;
        tally.right_fit += is_right && fits;
        tally.right_uncertain += is_right && row["verdict"] == "uncertain";
        tally.false_fits += fits && row["verdict_error_mm"].get<double>() > false_mm;
        if (row["loose"] != "fit" || !(row["error_mm"].get<double>() < found_mm)) continue;
        ++tally.found;
        tally.kept += fits && row["verdict_error_mm"].get<double>() < found_mm;
        tally.weakest_score = std::min(tally.weakest_score, score);
        tally.weakest_share = std::min(tally.weakest_share, row["share"].get<double>());
        tally.weakest_margin = std::min(tally.weakest_margin, row["margin"].get<double>());
    }
    return tally;
}

Json json_of(const FitsTally& t, const std::vector<HeldTally>& held, bool to_set) {
    Json limits = Json::array();
    for (const HeldTally& h : held)
        limits.push_back({{"limit_mm", h.limit},
                          {"right_kept", h.right},
                          {"wrong_kept", h.wrong},
                          {"right_lost", h.lost},
                          {"wrong_refused", h.refused}});
    return {{"half", to_set ? "set" : "judge"},
            {"bones", t.groups},
            {"mismatches", t.mismatches},
            {"near_misses", t.near_misses},
            {"slipped", t.slipped},
            {"right", t.right},
            {"right_fit", t.right_fit},
            {"right_uncertain", t.right_uncertain},
            {"false_fits", t.false_fits},
            {"false_uncertain", t.false_uncertain},
            {"true_pairs", t.trials},
            {"true_fits", t.found},
            {"true_fits_kept", t.kept},
            {"weakest_true_score", t.weakest_score},
            {"weakest_true_share", t.weakest_share},
            {"weakest_true_margin", t.weakest_margin},
            {"strongest_false_score", t.strongest_score},
            {"held", limits}};
}

void print(const FitsTally& t, const std::vector<HeldTally>& held, bool to_set) {
    fmt::print(
        "{}: {} broken bones; {} mismatches, {} of them near misses, {} slipped by a relief period: {} false fits, {} "
        "uncertain without a rival; of {} right places {} fit and {} are uncertain; {} neighbours, {} "
        "found without "
        "thresholds, {} kept ({:.1f} %); weakest true fit: score {:.2f}, share {:.2f}, margin {:.2f}\n",
        to_set ? "to set" : "to judge", t.groups, t.mismatches, t.near_misses, t.slipped, t.false_fits,
        t.false_uncertain, t.right, t.right_fit, t.right_uncertain, t.trials, t.found, t.kept,
        t.found > 0 ? 100.0 * t.kept / t.found : 0.0, t.weakest_score, t.weakest_share, t.weakest_margin);
    for (const HeldTally& h : held)
        fmt::print(
            "    far end held within {:.2f} mm: {} right fits kept, {} lost; {} wrong ones (0.5 mm off) kept, {} "
            "refused\n",
            h.limit, h.right, h.lost, h.wrong, h.refused);
}

}  // namespace

int bench_fits(const FitsChoice& choice) {
    ResultLines lines(choice.out, "group");
    for (int n = choice.first; n < choice.first + choice.groups; ++n) {
        if (lines.has(n) || !is_chosen(choice, n)) continue;
        std::vector<Json> rows;
        PairGroup group = pair_group(n);
        if (choice.voxel) group.voxel = *choice.voxel * 1e-3;
        for (const PairTrial& trial : try_pairs(group)) rows.push_back(row_of(n, trial));
        lines.add(n, rows);
    }
    Json halves = Json::array();
    for (const bool to_set : {true, false}) {
        const FitsTally tally = tally_of(lines.rows(), to_set);
        if (tally.groups == 0) continue;
        const std::vector<HeldTally> held = held_of(lines.rows(), to_set);
        halves.push_back(json_of(tally, held, to_set));
        if (!choice.json) print(tally, held, to_set);
    }
    if (choice.json) fmt::print("{}\n", Json{{"version", 1}, {"halves", halves}, {"rows", lines.rows()}}.dump(2));
    return done;
}

Verb fits_verb() {
    return {
        "fits", "how well true fits are told from false ones, on broken bones with known truth",
        [](VerbOptions& verb) -> Action {
            const auto choice = std::make_shared<FitsChoice>();
            verb.add("--first", choice->first, "number of the first broken bone").shows_default().range(0, 1'000'000);
            verb.add("--groups", choice->groups, "number of broken bones").shows_default().range(0, 10'000);
            verb.add("--half", choice->half, "of the broken bones: set (thresholds), judge, or both")
                .one_of({"set", "judge", "both"})
                .shows_default();
            verb.add("--voxel", choice->voxel, "mm, of the scans (default: 0.35 and 0.5 in turn)").range(0.1, 2.0);
            verb.add("--out", choice->out, "file of results, JSON lines; what it holds is not done again");
            verb.flag("--json", choice->json, "as JSON");
            return [choice] { return bench_fits(*choice); };
        }};
}

}  // namespace tactus::bench
