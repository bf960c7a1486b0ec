// SPDX-License-Identifier: Apache-2.0
#include "assets/sweep/sweep_file.hpp"
#include "assets/sweep/row_log.hpp"
#include "assets/sweep/sobol.hpp"
#include "assets/sweep/task_list.hpp"
#include "assets/sweep/template_word.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <array>
#include <cmath>
#include <fstream>
#include <set>
#include <string>

using namespace tactus;
using namespace tactus::sweep;
namespace fs = std::filesystem;

namespace {

struct SweepPlace {
    SweepPlace() : path(fs::temp_directory_path() / fmt::format("tactus-sweep-{}", ::getpid())) {
        fs::create_directories(path);
    }
    ~SweepPlace() { fs::remove_all(path); }
    fs::path write(const std::string& name, const std::string& text) const {
        fs::create_directories((path / name).parent_path());
        std::ofstream(path / name, std::ios::binary) << text;
        return path / name;
    }
    Sweep load(const std::string& text) const { return load_sweep(write("sweep.toml", text), {}, path / "library"); }
    std::string error(const std::string& text) const {
        try {
            load(text);
        } catch (const Error& error) {
            return error.what();
        }
        return {};
    }
    fs::path path;
};

std::uint64_t no_content(const fs::path&) { return 7; }

std::uint64_t text_content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    Hash hash;
    hash.add_text(text);
    return hash.value();
}

std::set<std::uint64_t> ids_of(const Sweep& sweep, std::uint64_t (*content)(const fs::path&) = no_content) {
    const TaskList list(sweep, content);
    std::set<std::uint64_t> ids;
    for (std::size_t i = 0; i < list.size(); ++i) ids.insert(list.id(i));
    return ids;
}

const std::string preamble = "format = 1\ntitle = \"Try\"\n";
const std::string grid = preamble + R"([axes.stiffness]
unit = "N/mm"
log_range = [0.1, 10]
count = 3
[axes.device]
values = ["touch", "omega"]
[seeds]
count = 2
[[step]]
tactus = ["render", "some", "--set", "wall.stiffness={stiffness}", "--set", "hand.device={device}", "{stiffness.number}", "{{x}}"]
values = {force = "/force/peak"}
)";

}  // namespace

TEST_CASE("a grid has every level with every other, seeds fastest") {
    const SweepPlace place;
    const Sweep sweep = place.load(grid);
    const TaskList list(sweep, no_content);
    REQUIRE(list.size() == 12);
    const auto words = [&](std::size_t i) {
        return words_of(sweep, sweep.steps[0], list.point(i), list.id(i), "/out", "/tactus");
    };
    CHECK(words(0) == std::vector<std::string>{"render", "some", "--set", "wall.stiffness=0.1 N/mm", "--set",
                                               "hand.device=touch", "0.1", "{x}"});
    CHECK(list.point(0).seed == 1);
    CHECK(list.point(1).seed == 2);
    CHECK(words(2)[5] == "hand.device=omega");
    CHECK(words(4)[3] == "wall.stiffness=1 N/mm");
    CHECK(words(11)[3] == "wall.stiffness=10 N/mm");
    for (std::size_t i = 0; i < list.size(); ++i) CHECK(list.find(list.id(i)) == i);
    CHECK_FALSE(list.find(12345));
}

TEST_CASE("a sweep with more levels or seeds keeps the points that it had") {
    const SweepPlace place;
    const std::set<std::uint64_t> before = ids_of(place.load(grid));
    REQUIRE(before.size() == 12);
    const auto replaced = [](std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    };
    for (const std::string& larger :
         {replaced(grid, "count = 3", "count = 5"), replaced(grid, "\"omega\"", "\"falcon\", \"omega\""),
          replaced(grid, "count = 2", "count = 9")}) {
        const std::set<std::uint64_t> after = ids_of(place.load(larger));
        std::size_t kept = 0;
        for (const std::uint64_t id : before) kept += after.contains(id);
        CHECK(kept == before.size());
        CHECK(after.size() > before.size());
    }
    for (const std::string& other : {replaced(grid, "render", "check"), replaced(grid, "/force/peak", "/force/rms"),
                                     replaced(grid, "[seeds]", "[seeds]\nindependent = true")}) {
        const std::set<std::uint64_t> after = ids_of(place.load(other));
        for (const std::uint64_t id : before) CHECK_FALSE(after.contains(id));
    }
}

TEST_CASE("the content of a file is part of a point, its folder is not") {
    const SweepPlace place;
    place.write("a/one.wav", "1");
    place.write("a/two.wav", "2");
    const std::string text = preamble +
                             "[axes.take]\nfiles = \"a/*.wav\"\n[inputs]\npatch = \"a/one.wav\"\n[[step]]\n"
                             "command = [\"cat\", \"{take}\", \"{take.stem}\", \"{inputs.patch}\"]\n";
    const Sweep sweep = place.load(text);
    const std::set<std::uint64_t> before = ids_of(sweep, text_content);
    const TaskList list(sweep, text_content);
    CHECK(words_of(sweep, sweep.steps[0], list.point(1), list.id(1), "/out", "") ==
          std::vector<std::string>{"cat", (place.path / "a/two.wav").string(), "two",
                                   (place.path / "a/one.wav").string()});
    place.write("a/two.wav", "3");
    const std::set<std::uint64_t> changed = ids_of(place.load(text), text_content);
    CHECK(changed != before);
    CHECK(changed.contains(list.id(0)));
    place.write("a/two.wav", "2");
    CHECK(ids_of(load_sweep(place.path / "sweep.toml", place.path, place.path), text_content) == before);
    // Moved as a whole.
    fs::create_directories(place.path / "b");
    fs::copy(place.path / "a", place.path / "b/a", fs::copy_options::recursive);
    CHECK(ids_of(load_sweep(place.path / "sweep.toml", place.path / "b", place.path), text_content) == before);
}

TEST_CASE("rows of a table are levels with a field for each column") {
    const SweepPlace place;
    place.write("subjects.csv", "name,age\nP01,31\nP02,28\n");
    const Sweep sweep = place.load(preamble +
                                   "[axes.subject]\ncsv = \"subjects.csv\"\n[[step]]\ncommand = [\"echo\", "
                                   "\"{subject.name} {subject.age}\"]\n");
    const TaskList list(sweep, no_content);
    REQUIRE(list.size() == 2);
    CHECK(words_of(sweep, sweep.steps[0], list.point(1), list.id(1), "/out", "")[1] == "P02 28");
    // A row that moves within the file is the same point.
    place.write("subjects.csv", "name,age\nP02,28\nP01,31\n");
    CHECK(ids_of(load_sweep(place.path / "sweep.toml", {}, place.path)) == std::set{list.id(0), list.id(1)});
    CHECK(place.error(preamble + "[axes.subject]\ncsv = \"subjects.csv\"\n[[step]]\ncommand = [\"{subject.nme}\"]\n")
              .find("did you mean 'subject.name'") != std::string::npos);
}

TEST_CASE("Sobol's sequence has the numbers of an independent program") {
    // scipy.stats.qmc.Sobol(16, scramble=False, bits=32), elements 3 and 13.
    const std::array<std::uint32_t, 16> third{1073741824, 3221225472, 3221225472, 3221225472, 1073741824, 1073741824,
                                              3221225472, 1073741824, 1073741824, 1073741824, 1073741824, 1073741824,
                                              3221225472, 3221225472, 1073741824, 3221225472};
    const std::array<std::uint32_t, 16> thirteenth{
        3489660928, 2952790016, 3489660928, 268435456,  1879048192, 4026531840, 2415919104, 2415919104,
        2415919104, 1879048192, 3489660928, 4026531840, 268435456,  3489660928, 805306368,  2415919104};
    for (std::size_t d = 0; d < 16; ++d) {
        CHECK(sobol(0, d) == 0);
        CHECK(sobol(1, d) == 0x80000000u);
        CHECK(sobol(3, d) == third[d]);
        CHECK(sobol(13, d) == thirteenth[d]);
    }
}

TEST_CASE("a shifted Sobol design of 2^k samples has one sample in each of 2^k intervals") {
    for (std::size_t d = 0; d < max_sobol_dimensions; ++d) {
        std::set<int> intervals;
        for (std::uint64_t i = 0; i < 64; ++i) {
            const double x = shifted_sobol(i, d, 5);
            REQUIRE((x > 0.0 && x < 1.0));
            intervals.insert(static_cast<int>(64.0 * x));
        }
        CHECK(intervals.size() == 64);
    }
    CHECK(shifted_sobol(0, 0, 1) != shifted_sobol(0, 0, 2));
}

TEST_CASE("axes of a design are drawn together, and more samples keep the first") {
    const SweepPlace place;
    const auto text = [&](int samples, const std::string& more) {
        return preamble +
               fmt::format(
                   "samples = {}\n[axes.mass]\nunit = \"g\"\nlog_random = [10, 1000]\n[axes.level]\nsobol = [0, 1]\n{}"
                   "[[step]]\ncommand = [\"echo\", \"{{mass}} {{level}}\"]\n",
                   samples, more);
    };
    const Sweep few = place.load(text(8, ""));
    REQUIRE(few.point_count() == 8);
    const std::set<std::uint64_t> first = ids_of(few), more = ids_of(place.load(text(16, "")));
    for (const std::uint64_t id : first) CHECK(more.contains(id));
    for (const Level& level : few.axes[0].levels) CHECK((level.number >= 10.0 && level.number <= 1000.0));
    // With a grid beside: each sample with each level.
    CHECK(place.load(text(8, "[axes.other]\nvalues = [1, 2, 3]\n")).point_count() == 24);
    // Another axis does not change what is drawn.
    const Sweep beside = place.load(text(8, "[axes.third]\nrandom = [0, 1]\n"));
    for (std::size_t i = 0; i < 8; ++i) CHECK(beside.axes[0].levels[i].text == few.axes[0].levels[i].text);
}

TEST_CASE("levels of a range are written as a person writes them") {
    const SweepPlace place;
    const Sweep sweep =
        place.load(preamble + "[axes.a]\nrange = [0.1, 0.5]\ncount = 5\n[[step]]\ncommand = [\"{a}\"]\n");
    std::string all;
    for (const Level& level : sweep.axes[0].levels) all += level.text + " ";
    CHECK(all == "0.1 0.2 0.3 0.4 0.5 ");
}

TEST_CASE("seeds are common to all levels unless they are independent") {
    const SweepPlace place;
    const std::string text = preamble + "[axes.a]\nvalues = [1, 2]\n[seeds]\ncount = 3\nfirst = 100\n";
    const Sweep common = place.load(text), own = place.load(text + "independent = true\n");
    const TaskList a(common, no_content), b(own, no_content);
    std::set<std::uint64_t> seeds;
    for (std::size_t i = 0; i < 6; ++i) {
        CHECK(a.point(i).seed == 100 + i % 3);
        seeds.insert(b.point(i).seed);
        CHECK(b.point(i).seed < (std::uint64_t{1} << 53));
    }
    CHECK(seeds.size() == 6);
}

TEST_CASE("a sweep file is refused with the place and the remedy") {
    const SweepPlace place;
    const std::string step = "[[step]]\ntactus = [\"render\"]\n";
    const std::pair<std::string, std::string> wrong[] = {
        {"title = \"x\"\n", "begins with format = 1"},
        {preamble + "[axes.a]\nvalues = [1]\nrange = [1, 2]\n", "exactly one of values"},
        {preamble + "[axes.a]\nvalues = [1, 1]\n", "has the level '1' twice"},
        {preamble + "[axes.seed]\nvalues = [1]\n", "a column that every sweep has"},
        {preamble + "[axes.State]\nvalues = [1]\n", "a column that every sweep has"},
        {preamble + "[axes.rate]\nvalues = [1]\n[axes.Rate]\nvalues = [1]\n", "used twice"},
        {preamble + "[axes.a]\nrange = [2, 1]\ncount = 3\n", "first bound must be below"},
        {preamble + "[axes.a]\nlog_range = [0, 1]\ncount = 3\n", "number from"},
        {preamble + "[axes.a]\nrandom = [0, 1]\n", "samples = 256"},
        {preamble + "[axes.a]\nunit = \"N\"\nvalues = [\"1 N\"]\n", "write numbers"},
        {preamble + "[axes.a]\nfiles = \"none/*.wav\"\n", "no file matches"},
        {preamble + "[inputs]\npatch = \"none.toml\"\n", "there is no file"},
        {preamble + "[[step]]\ntactus = [\"render\"]\ncommand = [\"x\"]\n", "a step is either"},
        {preamble + "[[step]]\ntactus = [\"bench\"]\n", "{tactus}"},
        {preamble + "[[step]]\ntactus = [\"sweep\", \"run\"]\n", "cannot be a step"},
        {preamble + "[[step]]\ncommand = [\"{nothing}\"]\n", "no axis, input"},
        {preamble + "[[step]]\ncommand = [\"{out\"]\n", "without partner"},
        {preamble + "[[step]]\ncommand = [\"x\"]\nvalues = {a = \"b\"}\n", "no JSON pointer"},
        {preamble + "[[step]]\ncommand = [\"x\"]\nfiles = [\"../x\"]\n", "below {out}"},
        {preamble + step + "[limits]\nmemory = \"5 kB\"\n", "memory"},
        {preamble + step + "[limits]\ntime = \"5 m\"\n", "5 m"},
        {preamble + step + "[[figure]]\nname = \"f\"\nvalue = \"none\"\nx = \"a\"\n", "no step has a value"},
        {preamble + "unknown = 1\n", "unknown"},
        {preamble + "[axes.a]\nrange = [0, 1]\ncount = 5000\n[seeds]\ncount = 5000\n", "points"},
    };
    for (const auto& [text, message] : wrong) {
        CAPTURE(text, message);
        const std::string error = place.error(text);
        CHECK(error.find(message) != std::string::npos);
        CHECK(error.find("sweep.toml:") != std::string::npos);
    }
}

TEST_CASE("a figure that contradicts itself is refused") {
    const SweepPlace place;
    const std::string text = preamble +
                             "[axes.a]\nvalues = [1, 2]\n[axes.b]\nvalues = [1, 2]\n[[step]]\ncommand = "
                             "[\"x\"]\nvalues = {u = \"/u\", v = \"/v\"}\n[[figure]]\nname = \"f\"\n";
    const std::pair<std::string, std::string> wrong[] = {
        {"value = \"u\"\nx = \"c\"\n", "there is no axis 'c'"},
        {"value = \"u\"\nx = \"a\"\nunless = \"w\"\n", "no step has a value 'w'"},
        {"value = \"u\"\nx = \"a\"\nseries = \"a\"\n", "each axis once"},
        {"value = \"u\"\nx = \"a\"\nkind = \"heat\"\n", "needs 'y'"},
        {"value = \"u\"\nx = \"a\"\ny = \"b\"\n", "belongs to a heat map"},
        {"value = [\"u\", \"v\"]\nx = \"a\"\ny = \"b\"\nkind = \"heat\"\n", "shows one value"},
        {"value = [\"u\", \"v\"]\nx = \"a\"\nseries = \"b\"\n", "a line each"},
        {"value = [\"u\", \"v\"]\nminus = \"u\"\nx = \"a\"\n", "a column for each value: 1 of 2"},
        {"value = \"u\"\nx = \"a\"\nstatistic = \"mode\"\n", "median"},
        {"value = \"u\"\nminus = \"v\"\nx = \"a\"\nlog = true\n", "no logarithmic axis"},
    };
    for (const auto& [figure, message] : wrong) {
        CAPTURE(figure, message);
        CHECK(place.error(text + figure).find(message) != std::string::npos);
    }
    const Sweep sweep = place.load(text + "value = [\"u\", \"v\"]\nx = \"a\"\npanel = \"b\"\n");
    CHECK(sweep.figures.at(0).values == std::vector<std::string>{"u", "v"});
}

TEST_CASE("two points with the same inputs are refused") {
    const SweepPlace place;
    place.write("a.csv", "x\n1\n1\n");
    const Sweep sweep = place.load(preamble + "[axes.a]\ncsv = \"a.csv\"\n");
    CHECK_THROWS_WITH(TaskList(sweep, no_content),
                      Catch::Matchers::ContainsSubstring("points 1 and 2 have the same inputs"));
}

TEST_CASE("a row is read as it was written, and half a row is none") {
    const SweepPlace place;
    Row row;
    row.point = 0x0123456789abcdefu;
    row.output = 0xfedcba9876543210u;
    row.is_ok = true;
    row.seconds = 0.1;
    row.peak = 12e6;
    row.attempt = 2;
    row.values = {{"force", 1.0 / 3.0}, {"name", "a\"b\nc"}, {"none", nullptr}};
    row.files = {{"force.csv", "00"}};
    const std::string line = row_line(row);
    CHECK(line.find('\n') == line.size() - 1);
    const Row read = read_row(std::string_view(line).substr(0, line.size() - 1));
    CHECK(read.point == row.point);
    CHECK(read.output == row.output);
    CHECK(read.values == row.values);
    CHECK(read.files == row.files);
    CHECK(read.attempt == 2);
    Row failed = row;
    failed.is_ok = false;
    failed.reason = "why";
    failed.step = 2;
    failed.exit_code = 3;
    failed.signal = 15;
    fs::create_directories(place.path / "log");
    // Pages that were never written: between two rows, and over the end of one and the begin of the next.
    const std::string zeros(5000, '\0'), hole = line.substr(0, 64) + zeros + line.substr(80);
    place.write("log/a.jsonl", "{\"worker\":{\"machine\":\"here\"}}\n" + line + zeros + "\n" + hole + row_line(failed) +
                                   "no row\n" + line.substr(0, line.size() - 5));
    const auto files = log_files(place.path);
    REQUIRE(files.size() == 1);
    const LogReader log(files[0]);
    CHECK(log.worker().value("machine", std::string()) == "here");
    std::vector<bool> ok;
    const std::size_t damaged = log.scan([&](const RowHead& head, std::uint64_t at, std::uint32_t length) {
        ok.push_back(head.is_ok);
        CHECK(head.point == row.point);
        const Row found = read_row(log.line(at, length));
        CHECK(found.reason == (head.is_ok ? "" : "why"));
        CHECK(found.step == (head.is_ok ? 0 : 2));
        CHECK(found.exit_code == (head.is_ok ? 0 : 3));
        CHECK(found.signal == (head.is_ok ? 0 : 15));
    });
    CHECK(ok == std::vector<bool>{true, false});
    CHECK(damaged == 3);
}

TEST_CASE("a log is read in blocks, also across their borders") {
    const SweepPlace place;
    std::string text = "{\"worker\":{}}\n";
    for (std::uint64_t i = 0; i < 9000; ++i) {
        Row row;
        row.point = i;
        row.is_ok = true;
        row.values["pad"] = std::string(i % 700, 'x');
        text += row_line(row);
    }
    REQUIRE(text.size() > (3u << 20));
    const LogReader log(place.write("a.jsonl", text));
    std::uint64_t next = 0;
    CHECK(log.scan([&](const RowHead& head, std::uint64_t, std::uint32_t) { next += head.point == next; }) == 0);
    CHECK(next == 9000);
}
