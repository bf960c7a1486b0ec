// SPDX-License-Identifier: Apache-2.0
#include "assets/file/json.hpp"
#include "tools/analysis/vibration/verdict.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/vibration/verdict_cases.hpp"

#include <fmt/format.h>

#include <map>
#include <string>

namespace tactus::bench {

namespace {

struct VerdictsChoice {
    int pairs = 300, first = 1000;
    bool held_out = false, json = false;
};

int bench_verdicts(const VerdictsChoice& choice) {
    file::Json json = file::Json::array();
    if (!choice.json) fmt::print("{:<16} {:>6} {:>6} {:>10}  {}\n", "pairs", "count", "same", "by time", "reasons");
    int false_same = 0;
    for (const PairKind kind : {PairKind::copy, PairKind::take, PairKind::random_phase, PairKind::burst}) {
        int same = 0, by_time = 0;
        std::map<std::string, int> reasons;
        for (int i = 0; i < choice.pairs; ++i) {
            const VerdictCase one(static_cast<std::uint64_t>(choice.first + i), kind,
                                  choice.held_out ? PairSources::held_out : PairSources::known);
            const signal::Comparison found =
                signal::compare(signal::Take(std::span<const double>(one.reference), VerdictCase::rate),
                                signal::Take(std::span<const double>(one.output), VerdictCase::rate));
            const analysis::Verdict verdict = analysis::judge(found, 0.0, {});
            same += verdict.passed();
            for (const std::string& name : verdict.failed()) {
                ++reasons[name];
                by_time += name == "statistics" || name == "course_db";
            }
        }
        const bool alike = kind == PairKind::copy || kind == PairKind::take;
        if (!alike) false_same += same;
        std::string words;
        for (const auto& [name, count] : reasons)
            words += fmt::format("{}{} {}", words.empty() ? "" : ", ", name, count);
        const char* const name = pair_names[static_cast<std::size_t>(kind)];
        if (choice.json)
            json.push_back({{"pairs", name}, {"count", choice.pairs}, {"same", same}, {"by_time", by_time}});
        else fmt::print("{:<16} {:>6} {:>6} {:>10}  {}\n", name, choice.pairs, same, by_time, words);
    }
    if (choice.json) fmt::print("{}\n", json.dump(2));
    return false_same == 0 ? done : answer_is_no;
}

}  // namespace

Verb verdicts_verb() {
    return {"verdicts",
            "pairs of vibrations with equal mean spectra: how many that differ over time count as the same; exit code "
            "1: any does",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<VerdictsChoice>();
                verb.add("--pairs", choice->pairs, "number of pairs of each kind").shows_default().range(1, 100000);
                verb.add("--first", choice->first, "seed of the first; 0 to 99 set the thresholds")
                    .shows_default()
                    .range(0, 1000000000);
                verb.flag("--held-out", choice->held_out, "sources of kinds that set no threshold");
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_verdicts(*choice); };
            }};
}

}  // namespace tactus::bench
