// SPDX-License-Identifier: Apache-2.0
// How much of a broken bone `plan assemble` puts together rightly, over cases with known truth.
#include "assets/file/json.hpp"
#include "tools/bench/bench.hpp"
#include "tools/bench/fit/assembly_cases.hpp"
#include "tools/bench/fit/result_lines.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tactus::bench {

namespace {

using file::Json;

struct AssemblyChoice {
    int first = 0, cases = 40;
    std::filesystem::path out;
    bool json = false;
};

Json row_of(int number) {
    const AssemblyCase one = assembly_case(number);
    const AssemblyScore s = put_together(one);
    return {{"case", number},
            {"bone", one.is_jaw ? "jaw" : "fibula"},
            {"pieces", one.pieces},
            {"missing", one.missing},
            {"seed", one.seed},
            {"chips", one.chips},
            {"with_neighbour", s.with_neighbour},
            {"placed", s.placed},
            {"within_0.3_mm", s.within},
            {"falsely_placed", s.falsely},
            {"worst_error_mm", s.worst_error * 1e3},
            {"seconds", s.seconds},
            {"apart", s.apart}};
}

void print(const Json& row) {
    fmt::print(
        "case {}: {} in {} pieces, {} missing, chips {:.0f} %: {} of {} placed, {} within 0.3 mm, {} falsely; "
        "worst {:.3f} mm; {:.1f} s\n",
        row["case"].get<int>(), row["bone"].get<std::string>(), row["pieces"].get<int>(), row["missing"].get<int>(),
        row["chips"].get<double>() * 100.0, row["placed"].get<int>(), row["with_neighbour"].get<int>(),
        row["within_0.3_mm"].get<int>(), row["falsely_placed"].get<int>(), row["worst_error_mm"].get<double>(),
        row["seconds"].get<double>());
    for (const Json& refusal : row["apart"]) fmt::print("    {}\n", refusal.get<std::string>());
    std::fflush(stdout);
}

Json total_of(const std::vector<Json>& rows) {
    int with = 0, placed = 0, within = 0, falsely = 0;
    double worst = 0.0;
    for (const Json& row : rows) {
        with += row["with_neighbour"].get<int>();
        placed += row["placed"].get<int>();
        within += row["within_0.3_mm"].get<int>();
        falsely += row["falsely_placed"].get<int>();
        worst = std::max(worst, row["worst_error_mm"].get<double>());
    }
    return {{"cases", rows.size()},    {"with_neighbour", with},    {"placed", placed},
            {"within_0.3_mm", within}, {"falsely_placed", falsely}, {"worst_error_mm", worst}};
}

int bench_assembly(const AssemblyChoice& choice) {
    ResultLines lines(choice.out, "case");
    for (int n = choice.first; n < choice.first + choice.cases; ++n) {
        if (lines.has(n)) continue;
        const Json row = row_of(n);
        lines.add(n, {row});
        if (!choice.json) print(row);
    }
    const Json total = total_of(lines.rows());
    if (choice.json) fmt::print("{}\n", Json{{"version", 1}, {"total", total}, {"rows", lines.rows()}}.dump(2));
    else
        fmt::print("{} cases: {} of {} pieces with a neighbour placed, {} within 0.3 mm, {} falsely; worst {:.3f} mm\n",
                   total["cases"].get<int>(), total["placed"].get<int>(), total["with_neighbour"].get<int>(),
                   total["within_0.3_mm"].get<int>(), total["falsely_placed"].get<int>(),
                   total["worst_error_mm"].get<double>());
    return done;
}

}  // namespace

Verb assembly_verb() {
    return {"assembly", "how much of a broken bone is put together rightly, over cases with known truth",
            [](VerbOptions& verb) -> Action {
                const auto choice = std::make_shared<AssemblyChoice>();
                verb.add("--first", choice->first, "number of the first case").shows_default().range(0, 1'000'000);
                verb.add("--cases", choice->cases, "number of cases").shows_default().range(0, 10'000);
                verb.add("--out", choice->out, "file of results, JSON lines; what it holds is not done again");
                verb.flag("--json", choice->json, "as JSON");
                return [choice] { return bench_assembly(*choice); };
            }};
}

}  // namespace tactus::bench
