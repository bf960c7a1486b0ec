// SPDX-License-Identifier: Apache-2.0
// Whether what the actuator plays is what the saw did: for two files, or for folders of them.
#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tools/command/batch.hpp"
#include "tools/picture/report/comparison_figure.hpp"
#include "tools/picture/report/comparison_page.hpp"
#include "tools/picture/report/comparison_rows.hpp"
#include "tools/picture/report/html_report.hpp"
#include "tools/study/vibration/record.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace tactus {

namespace {

namespace fs = std::filesystem;

int compare_one(const CompareChoice& choice, const Thresholds& thresholds) {
    if (!choice.plot.empty() && !choice.plot.ends_with(".svg") && !choice.plot.ends_with(".png"))
        throw Error(choice.plot + ": a figure is written as .svg or .png");
    const ComparedPair pair = compare_files(choice, thresholds, !choice.plot.empty() || !choice.report.empty());
    if (!choice.plot.empty()) write_figure(draw_comparison(pair), choice.plot);
    if (!choice.report.empty()) write_whole_file(choice.report, comparison_page(pair));
    if (!choice.table.empty()) write_whole_file(choice.table, comparison_table(std::span(&pair, 1), {}));
    if (choice.json) fmt::print("{}", comparison_json(pair));
    else print(pair);
    return pair.verdict.passed() ? done : answer_is_no;
}

struct Names {
    fs::path reference, output;  ///< one is empty when a folder has no partner for the other
};

/// Every output with the reference of its name, or with the only one; and the other way round.
std::vector<Names> pairs_of(const CompareChoice& choice) {
    const bool references = fs::is_directory(choice.reference), outputs = fs::is_directory(choice.output);
    std::vector<Names> pairs;
    if (!references || !outputs) {
        for (const fs::path& file : expand_folders({references ? choice.reference : choice.output}))
            pairs.push_back(references ? Names{file, choice.output} : Names{choice.reference, file});
        return pairs;
    }
    std::vector<fs::path> wanted = expand_folders({choice.reference});
    for (const fs::path& output : expand_folders({choice.output})) {
        const auto found =
            std::ranges::find_if(wanted, [&](const fs::path& file) { return file.stem() == output.stem(); });
        pairs.push_back({found == wanted.end() ? fs::path() : *found, output});
    }
    for (const fs::path& reference : wanted)
        if (std::ranges::none_of(pairs, [&](const Names& pair) { return pair.reference == reference; }))
            pairs.push_back({reference, {}});
    return pairs;
}

int compare_many(const CompareChoice& choice, const Thresholds& thresholds) {
    const std::vector<Names> names = pairs_of(choice);
    if (!choice.plot.empty()) fs::create_directories(choice.plot);
    std::vector<ComparedPair> pairs(names.size());
    const std::vector<std::string> failures =
        run_batch(names.size(), choice.jobs, "pairs", [&](std::size_t i, const std::function<void(double)>&) {
            pairs[i].reference = names[i].reference;
            pairs[i].output = names[i].output;
            if (names[i].reference.empty())
                throw Error(fmt::format("{}: there is no reference of that name in {}", names[i].output.string(),
                                        choice.reference.string()));
            if (names[i].output.empty())
                throw Error(fmt::format("{}: there is no output of that name in {}", names[i].reference.string(),
                                        choice.output.string()));
            CompareChoice one = choice;
            one.reference = names[i].reference;
            one.output = names[i].output;
            pairs[i] = compare_files(one, thresholds, !choice.plot.empty() || !choice.report.empty());
            if (choice.plot.empty()) return;
            const fs::path varied = fs::is_directory(choice.output) ? one.output : one.reference;
            write_figure(draw_comparison(pairs[i]), fs::path(choice.plot) / (varied.filename().string() + ".svg"));
        });
    const std::size_t bad = tell_failures(failures);
    std::size_t passed = 0;
    for (std::size_t i = 0; i < pairs.size(); ++i) passed += failures[i].empty() && pairs[i].verdict.passed();
    const std::size_t failed = pairs.size() - passed - bad;
    if (!choice.table.empty()) write_whole_file(choice.table, comparison_table(pairs, failures));
    if (!choice.report.empty()) {
        std::string body =
            fmt::format("<p>{} of {} pass.</p>\n", passed, pairs.size()) + comparison_summary(pairs, failures);
        const ComparedPair* last = nullptr;
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            if (!failures[i].empty()) continue;
            last = &pairs[i];
            body += fmt::format("<h2 id=\"p{}\">{}</h2>\n", i, html::escaped(pair_name(pairs[i], pairs))) +
                    comparison_section(pairs[i], fmt::format("p{}x", i));
        }
        if (last) body += comparison_method(*last);
        write_whole_file(choice.report, html::page(fmt::format("{} pairs of vibrations", pairs.size()), body));
    }
    if (choice.json) {
        nlohmann::ordered_json json{
            {"verdict", bad + failed == 0 ? "pass" : "fail"}, {"passed", passed}, {"failed", failed}, {"bad", bad}};
        json["pairs"] = nlohmann::ordered_json::array();
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            nlohmann::ordered_json row{{"reference", pairs[i].reference.string()},
                                       {"output", pairs[i].output.string()}};
            if (failures[i].empty()) row.update(nlohmann::ordered_json::parse(comparison_json(pairs[i])));
            else row["error"] = failures[i];
            json["pairs"].push_back(std::move(row));
        }
        fmt::print("{}\n", json.dump(2));
    } else {
        fmt::print("{}{} of {} pass\n", comparison_rows(pairs, failures), passed, pairs.size());
    }
    return bad > 0 ? bad_input : failed > 0 ? answer_is_no : done;
}

}  // namespace

int compare_verb(const CompareChoice& choice) {
    const Thresholds thresholds = choice.thresholds.empty() ? Thresholds{} : load_thresholds(choice.thresholds);
    if (fs::is_directory(choice.reference) || fs::is_directory(choice.output)) return compare_many(choice, thresholds);
    return compare_one(choice, thresholds);
}

}  // namespace tactus
