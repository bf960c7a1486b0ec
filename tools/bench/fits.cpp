// SPDX-License-Identifier: Apache-2.0
// Which thresholds tell true fits from false ones: trials with known truth, one half to set them, the other to judge.
#include "dsp/core/error.hpp"
#include "engine/run/clock.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/fit_pairs.hpp"
#include "tools/bench/result_lines.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <map>

namespace tactus::bench {

namespace {

using Json = nlohmann::ordered_json;

struct FitsChoice {
    int first = 0, groups = 60;
    std::filesystem::path out;
    bool json = false;
};

Json row_of(int group, const PairTrial& t) {
    return {{"group", group},
            {"kind", t.kind},
            {"mode", t.is_global ? "global" : "extended"},
            {"moving", t.moving},
            {"partner", t.partner},
            {"loose", fit::name_of(t.loose)},
            {"verdict", fit::name_of(t.verdict)},
            {"score", t.score},
            {"margin", t.margin},
            {"share", t.share},
            {"overlap_mm2", t.overlap * 1e6},
            {"rms_mm", t.rms * 1e3},
            {"error_mm", t.error * 1e3},
            {"verdict_error_mm", t.verdict_error * 1e3}};
}

}  // namespace

int bench_fits(const FitsChoice& choice) {
    ResultLines lines(choice.out, "group");
    for (int n = choice.first; n < choice.first + choice.groups; ++n) {
        if (lines.has(n)) continue;
        std::vector<Json> rows;
        for (const PairTrial& trial : try_pairs(pair_group(n))) rows.push_back(row_of(n, trial));
        lines.add(n, rows);
    }
    fmt::print("{} rows\n", lines.rows().size());
    return done;
}

Verb fits_verb() {
    return {"fits", "how well true fits are told from false ones, on broken bones with known truth",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<FitsChoice>();
                verb.add("--first", choice->first, "number of the first broken bone").shows_default().range(0, 1'000'000);
                verb.add("--groups", choice->groups, "number of broken bones").shows_default().range(0, 10'000);
                verb.add("--out", choice->out, "file of results, JSON lines; what it holds is not done again");
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_fits(*choice); };
            }};
}

}  // namespace tactus::bench
