// SPDX-License-Identifier: Apache-2.0
// Results: one tree in text, JSON, HTML and PDF has the same digits, and outputs follow their schemas.
#include "tests/support/catch.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/pdf_text.hpp"
#include "tests/tools/record_folder.hpp"
#include "tools/report/blocks/pages.hpp"
#include "tools/report/result/fields.hpp"
#include "tools/report/result/printers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;
using report::NumberFormat;
using report::Result;
using report::ResultEntry;
using test::broken_rule;

namespace {

/// A tree of named numbers, tables and sections. `shown` collects the digits that each printed format must contain.
Result random_result(std::mt19937& random, int depth, std::vector<std::string>& shown) {
    const auto number = [&](const std::string& key) {
        std::uniform_real_distribution<double> exponent(-4.0, 5.0), sign(-1.0, 1.0);
        const double value = sign(random) * std::pow(10.0, exponent(random));
        const std::vector<NumberFormat> formats{report::fixed(2, "dB"),      report::significant(4, "N"),
                                                report::fixed(1, "ms", "s"), report::significant(6),
                                                report::fixed(0, "%", "1"),  report::fixed(3, "N").with_sign()};
        report::Number of(value);
        const NumberFormat& format = formats[random() % formats.size()];
        if (random() % 4 == 0) of.uncertainty = 0.01 * std::abs(value);
        return ResultEntry{key, "value " + key, false, report::Severity::none, ResultEntry::Quantity{of, format}};
    };
    Result result{fmt::format("section {}", random() % 1000), {}};
    for (int n = 0; n < 4; ++n) {
        result.entries.push_back(number(fmt::format("n{}", n)));
        shown.push_back(report::shown(result.entries.back()));
    }
    const auto vector = [&](const std::string& key) {
        std::uniform_real_distribution<double> any(-5000.0, 5000.0);
        std::vector<std::optional<double>> values{any(random), any(random)};
        if (random() % 2 == 0) values.push_back(std::nullopt);
        const char* between = random() % 2 == 0 ? " " : " to ";
        return ResultEntry{key, "vector " + key, false, report::Severity::none,
                           ResultEntry::Numbers{values, report::fixed(1, "ms", "s"), between}};
    };
    for (int n = 0; n < 2; ++n) {
        result.entries.push_back(vector(fmt::format("v{}", n)));
        shown.push_back(report::shown(result.entries.back()));
    }
    result.entries.push_back({"groups", "group", false, report::Severity::none,
                              ResultEntry::Groups{{{"α", "б"}, {fmt::format("fragment {}", random() % 1000)}}}});
    for (const auto& group : std::get<ResultEntry::Groups>(result.entries.back().value).groups)
        shown.push_back(fmt::format("{}", fmt::join(group, ", ")));
    ResultEntry::Rows rows{{}, {{"a", "value a"}, {"b", "value b"}}};
    for (int n = 0; n < 3; ++n) rows.rows.push_back({"", {number("a"), number("b")}});
    for (const Result& row : rows.rows)
        for (const ResultEntry& entry : row.entries) {
            // The unit of a column may be in its head.
            const std::string digits = report::shown(entry);
            shown.push_back(digits.substr(0, digits.find(' ')));
        }
    result.entries.push_back({"rows", "table", false, report::Severity::none, std::move(rows)});
    result.entries.push_back(
        {"w", "warning", false, report::Severity::warning, ResultEntry::Texts{{"too few <turns>"}}});
    if (depth > 0)
        result.entries.push_back({"below", "below", false, report::Severity::none,
                                  ResultEntry::Children{{random_result(random, depth - 1, shown)}, false}});
    return result;
}

std::string without_spaces(std::string text) {
    std::erase(text, ' ');
    return text;
}

/// The JSON value of an entry, printed as the entry is.
void check_json(const Result& result, const json& printed) {
    for (const ResultEntry& entry : result.entries) {
        CAPTURE(entry.key);
        REQUIRE(printed.contains(entry.key));
        const json& value = printed[entry.key];
        if (const auto* quantity = std::get_if<ResultEntry::Quantity>(&entry.value)) {
            ResultEntry again = entry;
            report::Number number(value.get<double>());
            number.uncertainty = quantity->number.uncertainty;
            again.value = ResultEntry::Quantity{number, quantity->format};
            CHECK(report::shown(again) == report::shown(entry));
        } else if (const auto* vector = std::get_if<ResultEntry::Numbers>(&entry.value)) {
            ResultEntry::Numbers again{std::vector<std::optional<double>>(), vector->format, vector->between};
            for (const json& one : value)
                again.values->push_back(one.is_null() ? std::nullopt : std::optional(one.get<double>()));
            CHECK(report::shown({"", "", false, report::Severity::none, again}) == report::shown(entry));
        } else if (const auto* groups = std::get_if<ResultEntry::Groups>(&entry.value)) {
            CHECK(value == json(groups->groups));
        } else if (const auto* rows = std::get_if<ResultEntry::Rows>(&entry.value)) {
            REQUIRE(value.size() == rows->rows.size());
            for (std::size_t n = 0; n < value.size(); ++n) check_json(rows->rows[n], value[n]);
        } else if (const auto* children = std::get_if<ResultEntry::Children>(&entry.value)) {
            check_json(children->results.front(), value);
        }
    }
}

/// The cells of a CSV file by the first one.
std::map<std::string, std::vector<std::string>> csv_rows(const std::string& csv) {
    std::map<std::string, std::vector<std::string>> rows;
    std::istringstream lines(csv);
    for (std::string line; std::getline(lines, line);) {
        std::vector<std::string> cells(1);
        bool is_quoted = false;
        for (const char c : line)
            if (c == '"') is_quoted = !is_quoted;
            else if (c == ',' && !is_quoted) cells.emplace_back();
            else cells.back() += c;
        CHECK(rows.emplace(cells.front(), cells).second);
    }
    return rows;
}

/// The CSV value of each number, printed as the entry is, beside its unit.
void check_csv(const Result& result, const std::map<std::string, std::vector<std::string>>& rows,
               const std::string& above) {
    for (const ResultEntry& entry : result.entries) {
        const std::string path = above + entry.key;
        CAPTURE(path);
        if (const auto* quantity = std::get_if<ResultEntry::Quantity>(&entry.value)) {
            REQUIRE(rows.contains(path));
            REQUIRE(rows.at(path).size() == 3);
            ResultEntry again = entry;
            report::Number number(std::stod(rows.at(path)[1]));
            number.uncertainty = quantity->number.uncertainty;
            again.value = ResultEntry::Quantity{number, quantity->format};
            CHECK(report::shown(again) == report::shown(entry));
            // Values are in s where ms are shown, and fractions where % are.
            const std::string& shown = quantity->format.unit;
            CHECK(rows.at(path)[2] == (shown == "ms" ? "s" : shown == "%" ? "" : shown));
        } else if (const auto* vector = std::get_if<ResultEntry::Numbers>(&entry.value)) {
            for (std::size_t n = 0; n < vector->values->size(); ++n) {
                const std::string element = fmt::format("{}.{}", path, n);
                REQUIRE(rows.contains(element));
                const std::string& cell = rows.at(element)[1];
                const std::optional<double>& value = (*vector->values)[n];
                CHECK((value ? std::stod(cell) == *value : cell.empty()));
                CHECK(rows.at(element)[2] == "s");
            }
        } else if (const auto* table = std::get_if<ResultEntry::Rows>(&entry.value)) {
            for (std::size_t n = 0; n < table->rows.size(); ++n)
                check_csv(table->rows[n], rows, fmt::format("{}.{}.", path, n));
        } else if (const auto* children = std::get_if<ResultEntry::Children>(&entry.value)) {
            check_csv(children->results.front(), rows, path + ".");
        }
    }
}

}  // namespace

TEST_CASE("random results have equal digits in text, JSON, HTML and PDF") {
    const test::Folder folder;
    std::mt19937 random(7);
    for (int n = 0; n < 20; ++n) {
        std::vector<std::string> shown;
        const Result result = random_result(random, 2, shown);
        const std::string text = report::text_of(result), html = report::html_of(result);
        for (const std::string& digits : shown) {
            CAPTURE(digits);
            CHECK_THAT(text, ContainsSubstring(digits));
            CHECK_THAT(html, ContainsSubstring(digits));
        }
        check_json(result, json::parse(report::json_of(result).dump()));
        check_csv(result, csv_rows(report::csv_of(result)), "");
        if (n > 2) continue;
        const std::string pdf = report::pdf_of(report::title_of(result), report::blocks_of(result)).bytes;
        const std::optional<std::string> extracted = test::pdf_text(folder, folder.write("a.pdf", pdf));
        if (!extracted) continue;
        // Which gaps are spaces is a guess of the program that extracts.
        const std::string dense = without_spaces(*extracted);
        for (const std::string& digits : shown) {
            CAPTURE(digits);
            CHECK_THAT(dense, ContainsSubstring(without_spaces(digits)));
        }
    }
}

TEST_CASE("warnings are before all values of a result, and markup in them is text") {
    std::mt19937 random(3);
    std::vector<std::string> shown;
    const Result result = random_result(random, 0, shown);
    const std::string text = report::text_of(result), html = report::html_of(result);
    CHECK(text.find("warning: too few <turns>") < text.find("value n0"));
    CHECK(html.find("too few &lt;turns&gt;") < html.find("value n0"));
}

TEST_CASE("numbers that are missing or not finite are dashes in print and null in JSON") {
    const double inf = std::numeric_limits<double>::infinity();
    for (const report::Number& number : {report::Number(), report::Number(inf), report::Number(-inf)}) {
        const ResultEntry entry{"k", "name", false, report::Severity::none,
                                ResultEntry::Quantity{number, report::fixed(1, "dB")}};
        CHECK(report::shown(entry) == "–");
        CHECK(json::parse(report::json_of({"", {entry}}).dump())["k"].is_null());
    }
    const ResultEntry zero{"k", "name", false, report::Severity::none,
                           ResultEntry::Quantity{report::Number(-0.001), report::fixed(1, "dB")}};
    CHECK(report::shown(zero) == "0.0 dB");
}

TEST_CASE("fields in SI have the unit of their key in JSON and in print, and lists of points are lists of lists") {
    struct Placed {
        double length;
        std::optional<double> angle;
        Vec3 at;
        std::vector<Vec3> path;
    };
    const report::Fields<Placed> fields =
        report::Fields<Placed>("placed")
            .number("length_mm", "length", report::from_si(2, "mm"), &Placed::length)
            .number("angle_deg", "angle", report::from_si(1, "°"), &Placed::angle)
            .vector("at_mm", "at", report::from_si(1, "mm"), &Placed::at)
            .points("path_mm", [](const Placed& p) { return report::series_of(p.path, 1e-3); });
    const Placed placed{0.01234, std::nullopt, Vec3(0.001, -0.002, 0.0), {Vec3(0.001, 0.002, 0.003), Vec3(0.0)}};
    const Result result = fields.of(placed);
    const json printed = json::parse(report::json_of(result).dump());
    CHECK(printed["length_mm"].get<double>() == Approx(12.34));
    CHECK(printed["angle_deg"].is_null());
    CHECK(printed["at_mm"][1].get<double>() == Approx(-2.0));
    REQUIRE(printed["path_mm"].size() == 2);
    CHECK(printed["path_mm"][0][2].get<double>() == Approx(3.0));
    const std::string text = report::text_of(result), csv = report::csv_of(result);
    CHECK_THAT(text, ContainsSubstring("12.34 mm") && ContainsSubstring("1.0 -2.0 0.0 mm"));
    CHECK_THAT(csv, ContainsSubstring("path_mm.0.2,3") && ContainsSubstring("length_mm,12.34,mm"));
    CHECK(broken_rule(json::parse(fields.schema().dump()), printed, "placed") == "");
}

TEST_CASE("the JSON of orders follows its schema, and its files have one content in each format") {
    const test::RecordFolder folder;
    std::vector<double> x;
    for (int n = 0; n < 16000; ++n) x.push_back(0.1 * std::sin(2.0 * std::numbers::pi * 100.0 * n / 8000.0));
    folder.sound("tone.wav", x, 1, 8000);
    REQUIRE(folder.tactus("generate schema schemas").code == 0);
    const json schema = json::parse(test::slurp(folder.path / "schemas/orders.schema.json"));
    for (const char* options : {"", " --orders 60", " --waterfall w.csv", " --from 0.5"}) {
        const test::RecordOutcome outcome = folder.tactus(std::string("orders --json --rate 100 tone.wav") + options);
        CAPTURE(options, outcome.err);
        REQUIRE(outcome.code == 0);
        const json answer = json::parse(outcome.out);
        CHECK(answer["version"] == 1);
        CHECK(broken_rule(schema, answer, "orders").empty());
    }
    json wrong = folder.tactus("orders --json --rate 100 tone.wav").answer();
    wrong["channels"][0]["turns"] = "many";
    CHECK_THAT(broken_rule(schema, wrong, "orders"), ContainsSubstring("channels.0.turns"));

    const test::RecordOutcome quiet =
        folder.tactus("orders --rate 100 tone.wav --quiet -o a.txt -o a.json -o a.html -o a.csv -o a.pdf");
    REQUIRE(quiet.code == 0);
    CHECK(quiet.out.empty());
    const std::string text = folder.tactus("orders --rate 100 tone.wav").out;
    CHECK(test::slurp(folder.path / "a.txt") == text);
    CHECK_THAT(text, ContainsSubstring("0.0707"));
    CHECK_THAT(test::slurp(folder.path / "a.html"), ContainsSubstring("0.0707"));
    CHECK_THAT(test::slurp(folder.path / "a.csv"), ContainsSubstring("path,value,unit\n"));
    CHECK_THAT(test::slurp(folder.path / "a.csv"), ContainsSubstring("channels.0.orders.0.rms,0.0707"));
    CHECK_THAT(test::slurp(folder.path / "a.csv"), ContainsSubstring("\nduration_s,2,s\n"));
    CHECK(test::slurp(folder.path / "a.pdf").starts_with("%PDF-"));
    CHECK_THAT(folder.tactus("orders --rate 100 --orders 60 tone.wav").out,
               ContainsSubstring("warning: channel 1: order"));
    const test::RecordOutcome none = folder.tactus("orders --rate 100 tone.wav -o a.svg");
    CHECK(none.code == 2);
    CHECK_THAT(none.err, ContainsSubstring("no figure"));
    CHECK(folder.tactus("orders --rate 100 tone.wav -o a.xls").code == 2);
}

TEST_CASE("the JSON of analyses of records follows their schemas") {
    const test::RecordFolder folder;
    std::vector<double> x;
    for (int n = 0; n < 12000; ++n)
        for (const double phase : {0.0, 0.4, 1.1})
            x.push_back(0.1 * std::sin(2.0 * std::numbers::pi * 100.0 * n / 4000.0 + phase) + 0.02 * std::sin(1e4 * n));
    folder.sound("a.wav", x, 3, 4000);
    folder.text("bad.wav", "no sound");
    REQUIRE(folder.tactus("generate schema schemas").code == 0);
    struct Case {
        const char *verb, *options;
        int code = 0;
    };
    for (const Case& one : {Case{"spectrum", "a.wav"},
                            {"spectrum", "a.wav --psd-only"},
                            {"spectrum", "a.wav bad.wav --mark 100:saw:3 --envelope 200:800 --octave-filters third", 2},
                            {"spectrum", "a.wav --calibration '9 m/s^2' --integrate velocity --mark 100:saw"},
                            {"exposure", "a.wav --full-scale '100 m/s^2'"},
                            {"exposure", "a.wav bad.wav --full-scale '100 m/s^2'", 2},
                            {"exposure", "a.wav --full-scale '100 m/s^2' --body whole"},
                            {"exposure", "a.wav --full-scale '100 m/s^2' --body rail"},
                            {"response", "a.wav --channel 1,2 -o r.csv"},
                            {"compare", "a.wav a.wav"},
                            {"compare", "a.wav bad.wav", 2},
                            {"equalise", "r.csv -o e.toml --band 80:800 --signal a.wav"}}) {
        const test::RecordOutcome outcome = folder.tactus(fmt::format("{} {} --json", one.verb, one.options));
        CAPTURE(one.verb, one.options, outcome.err);
        REQUIRE(outcome.code == one.code);
        if (outcome.code == 2 && outcome.out.empty()) continue;
        const json schema = json::parse(test::slurp(folder.path / fmt::format("schemas/{}.schema.json", one.verb)));
        CHECK(broken_rule(schema, outcome.answer(), one.verb) == "");
    }
}

TEST_CASE("a list of integers is written without decimals, and its schema says so") {
    struct Grid {
        std::array<int, 3> size;
    };
    const auto fields = report::Fields<Grid>("grid").integers("size", "voxels", &Grid::size);
    const Result result = fields.of({{512, 512, 300}});
    CHECK(report::json_of(result).dump() == R"({"size":[512,512,300]})");
    CHECK(report::text_of(result) == "voxels  512 512 300\n");
    CHECK_THAT(fields.schema().dump(), ContainsSubstring(R"("items":{"type":"integer"})"));
}

TEST_CASE("a value that is known to be none is null or empty in JSON, one that is not known is left out") {
    struct Search {
        bool is_done;
    };
    const auto is_done = [](const Search& s) { return s.is_done; };
    const auto fields = report::Fields<Search>("search")
                            .text("found", "found", [](const Search&) { return std::optional<std::string>(); })
                            .omitted(is_done)
                            .texts("others", "others", [](const Search&) { return std::vector<std::string>(); })
                            .omitted(is_done);
    CHECK(report::json_of(fields.of({true})).dump() == R"({"found":null,"others":[]})");
    CHECK(report::json_of(fields.of({false})).dump() == "{}");
}

TEST_CASE("a table does not repeat the heading of its section") {
    struct Row {
        int n;
    };
    struct Section {
        std::vector<Row> rows;
    };
    static const auto row = report::Fields<Row>("row").integer("n", "number", &Row::n);
    static const auto section = report::Fields<Section>("section").rows("pairs", "gaps", row, &Section::rows);
    const auto whole = report::Fields<Section>("whole").child("", "gaps", section, [](const Section& s) { return s; });
    CHECK(report::text_of(whole.of({{{1}, {2}}})) == "gaps\n  number\n       1\n       2\n");
}
