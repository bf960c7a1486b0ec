// SPDX-License-Identifier: Apache-2.0
// tactus sweep on this machine, as scripts call it.
#include "tests/support/sanitized.hpp"
#include "tests/tools/background_run.hpp"
#include "tests/tools/command/sweep/sweep_tests.hpp"

#include <sqlite3.h>

#include <csignal>
#include <fstream>

using namespace tactus::test;

namespace {

/// What `sqlite3 FILE QUERY` would print.
std::string query(const fs::path& file, const std::string& text) {
    sqlite3* base = nullptr;
    REQUIRE(::sqlite3_open_v2(file.c_str(), &base, SQLITE_OPEN_READONLY, nullptr) == SQLITE_OK);
    std::string out;
    const auto add = [](void* to, int columns, char** values, char**) {
        for (int c = 0; c < columns; ++c)
            *static_cast<std::string*>(to) += std::string(c > 0 ? "|" : "") + (values[c] ? values[c] : "");
        *static_cast<std::string*>(to) += "\n";
        return 0;
    };
    char* message = nullptr;
    const int code = ::sqlite3_exec(base, text.c_str(), add, &out, &message);
    CAPTURE(message ? message : "");
    CHECK(code == SQLITE_OK);
    ::sqlite3_close(base);
    return out;
}

std::string in(const Folder& folder, const std::string& name) { return (folder.path / name).string(); }

}  // namespace

TEST_CASE("a sweep runs every point once, and its table has levels, values and provenance", "[kernel]") {
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", two_hundred_points());
    const Outcome run = folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a") + " --jobs 2");
    CAPTURE(run.out, run.err);
    REQUIRE(run.code == 0);
    CHECK(run.out.find("200 of 200 points done, 0 failed, 0 to run") != std::string::npos);
    CHECK(rows_in(folder.path / "a") == 200);
    CHECK(query(folder.path / "a/results.sqlite", "select count(*), sum(value), sum(drawn) from results") ==
          "200|2100|1100\n");
    CHECK(query(folder.path / "a/results.sqlite",
                "select level, seed, value, state from results where \"index\" = 200") == "20.0|10|20|done\n");
    CHECK(query(folder.path / "a/results.sqlite",
                "select count(*) from results join workers on worker = id where runner = 'local' and length(build) = "
                "16 and "
                "libc <> '' and vector <> '' and length(features) = 16") == "200\n");
    CHECK(query(folder.path / "a/results.sqlite", "select unit from axes") == "N\n");
    const std::string csv = slurp(folder.path / "a/results.csv");
    CHECK(csv.starts_with("index,point,level [N],seed,state,value,drawn,output,reason,seconds [s],peak_mb"));
    CHECK(std::ranges::count(csv, '\n') == 201);
    // Kept files, by point.
    std::size_t kept = 0;
    for (const auto& entry : fs::recursive_directory_iterator(folder.path / "a/files"))
        kept += entry.path().filename() == "kept.txt";
    CHECK(kept == 200);
    // Nothing is run again.
    const Outcome again = folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a") + " --json");
    CHECK(nlohmann::json::parse(again.out)["done"] == 200);
    CHECK(rows_in(folder.path / "a") == 200);
    // Points that another runner ran, too.
    CHECK(folder.tactus("sweep run " + file.string() + " -o " + in(folder, "b") + " --jobs 1").code == 0);
    CHECK(status_of(folder, "b").hash == status_of(folder, "a").hash);
    CHECK(results_of(folder, "b") == results_of(folder, "a"));
}

TEST_CASE("a killed run continues where it was, and half a row counts for nothing", "[kernel]") {
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", two_hundred_points("sleep 0.01; "));
    {
        Run run(folder, file.string() + " -o " + in(folder, "a") + " --jobs 2", "sweep run");
        REQUIRE(wait_for([&] { return rows_in(folder.path / "a") >= 20; }));
    }  // SIGKILL
    const std::size_t before = rows_in(folder.path / "a");
    REQUIRE(before < 200);
    for (const auto& entry : fs::directory_iterator(folder.path / "a/log"))
        std::ofstream(entry.path(), std::ios::app) << "{\"point\":\"0123";
    const Outcome run = folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a") + " --jobs 2");
    CAPTURE(run.out, run.err);
    CHECK(run.code == 0);
    CHECK(status_of(folder, "a").done == 200);
    CHECK(rows_in(folder.path / "a") == 200);
}

TEST_CASE("a worker that is killed is replaced, and its point is tried again", "[kernel]") {
    const Folder folder;
    // The first attempt of a point in ten kills its whole process group, the worker's.
    const fs::path marks = folder.path / "marks";
    fs::create_directories(marks);
    const std::string kill = fmt::format(
        "if [ $(($1 % 10)) = 0 ] && mkdir {}/$1-$2 2>/dev/null; then kill -KILL $PPID; fi; ", marks.string());
    std::string text = two_hundred_points(kill);
    text.replace(text.find("retries = 0"), 11, "retries = 1");
    const fs::path file = folder.write("sweep.toml", text);
    const Outcome run = folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a") + " --jobs 2");
    CAPTURE(run.out, run.err);
    CHECK(run.code == 0);
    CHECK(query(folder.path / "a/results.sqlite", "select attempt, count(*) from results group by attempt") ==
          "1|180\n2|20\n");
    // Without a second attempt they are failures, with the reason.
    fs::remove_all(marks);
    fs::create_directories(marks);
    const fs::path once = folder.write("once.toml", two_hundred_points(kill));
    const Outcome failed = folder.tactus("sweep run " + once.string() + " -o " + in(folder, "b") + " --jobs 2");
    CHECK(failed.code == 1);
    CHECK(failed.out.find("failed: 20 points: the worker was killed by signal 9") != std::string::npos);
    CHECK(status_of(folder, "b").failed == 20);
    // Run again, they succeed.
    CHECK(folder.tactus("sweep run " + once.string() + " -o " + in(folder, "b") + " --jobs 2").code == 0);
    CHECK(results_of(folder, "b") == results_of(folder, "a"));
}

TEST_CASE("a signal that reaches a worker alone ends its point, and no later one", "[kernel]") {
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", R"(format = 1
title = "Touch"
[inputs]
patch = "library:patches/touch-sphere.toml"
[seeds]
count = 4
[[step]]
tactus = ["render", "{inputs.patch}", "--seed", "{seed}", "--seconds", "5", "-o", "{out}/run", "--json"]
values = {simulated = "/seconds"}
accept = [0, 1]
[limits]
retries = 1
)");
    const std::string words = "sweep run " + file.string() + " -o " + in(folder, "a") + " --jobs 1";
    Run run(folder, file.string() + " -o " + in(folder, "a") + " --jobs 1", "sweep run");
    // The worker is the only child of the runner.
    const auto workers = [&] {
        std::vector<pid_t> found;
        for (const auto& entry : fs::directory_iterator("/proc")) {
            const std::string line = slurp(entry.path() / "cmdline");
            if (line.find(file.string()) == std::string::npos || line.starts_with("sh")) continue;
            std::istringstream status(slurp(entry.path() / "stat"));
            std::string id, name, state;
            pid_t parent = 0;
            status >> id >> name >> state >> parent;
            if (slurp("/proc/" + std::to_string(parent) + "/cmdline") == line) found.push_back(std::atoi(id.c_str()));
        }
        return found;
    };
    REQUIRE(wait_for([&] { return rows_in(folder.path / "a") >= 1 && !workers().empty(); }));
    ::kill(workers().front(), SIGTERM);
    CHECK(wait_for([&] { return status_of(folder, "a").done == 4; }));
    // No truncated run counts, though exit code 1 is accepted.
    CHECK(folder.tactus(words).code == 0);
    CHECK(query(folder.path / "a/results.sqlite", "select simulated, count(*) from results group by simulated") ==
          "5.0|4\n");
}

TEST_CASE("a point beyond its time or memory is ended, and the others go on", "[kernel]") {
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", R"(format = 1
title = "Limits"
[axes.what]
values = ["sleep 60", "true", "head -c 400M /dev/zero | tail"]
[[step]]
command = ["sh", "-c", "{what}"]
[limits]
time = "10 s"
memory = "100 MB"
retries = 0
)");
    const Outcome run = folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a") + " --jobs 1");
    CAPTURE(run.out, run.err);
    CHECK(run.code == 1);
    CHECK(run.out.find("took longer than 10 s") != std::string::npos);
    CHECK(run.out.find("used more than 100 MB") != std::string::npos);
    CHECK(run.out.find("1 of 3 points done, 2 failed") != std::string::npos);
}

TEST_CASE("a verb that rejects its input is not tried again, and a program's exit code 2 is", "[kernel]") {
    const Folder folder;
    const std::string more = "[limits]\nretries = 2\n";
    const fs::path verb =
        folder.write("verb.toml",
                     "format = 1\ntitle = \"Verb\"\n[[step]]\ntactus = [\"render\", \"no-such-patch\", \"-o\", "
                     "\"{out}/run\"]\n" +
                         more);
    CHECK(folder.tactus("sweep run " + verb.string() + " -o " + in(folder, "a")).code == 1);
    CHECK(query(folder.path / "a/results.sqlite", "select attempt, state from results") == "1|failed\n");
    // Its words look like those of a verb.
    const fs::path program = folder.write("program.toml",
                                          "format = 1\ntitle = \"Program\"\n[[step]]\ncommand = [\"sh\", \"-c\", "
                                          "\"echo exit code 2: signal 15 >&2; exit 2\"]\n" +
                                              more);
    CHECK(folder.tactus("sweep run " + program.string() + " -o " + in(folder, "b")).code == 1);
    CHECK(query(folder.path / "b/results.sqlite", "select attempt, state from results") == "3|failed\n");
}

TEST_CASE("a failure is shown with the step that failed, and where its JSON ends", "[kernel]") {
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", R"(format = 1
title = "Steps"
[[step]]
command = ["true"]
[[step]]
command = ["echo", '{{"rows": [{{"hz": 60, "db": 1}}]}}']
values = {hz = "/rows/0/frequency"}
[limits]
retries = 0
)");
    const Outcome run = folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a"));
    CHECK(run.code == 1);
    CHECK_THAT(run.out,
               Catch::Matchers::ContainsSubstring("failed: 1 point: step 2: the JSON has no /rows/0/frequency for 'hz': "
                                                  "/rows/0 has hz, db; such as point 1: echo "));
}

TEST_CASE("the sweeps of the library and of the how-to can be run", "[kernel]") {
    const Folder folder;
    for (const auto& entry : fs::directory_iterator(source_folder() / "assets/library/sweeps")) {
        if (entry.path().extension() != ".toml") continue;
        CAPTURE(entry.path());
        const std::string name = entry.path().stem().string();
        const Outcome run = folder.tactus("sweep run " + name + " -o " + in(folder, name) + " --dry-run");
        CHECK(run.err.empty());
        CHECK(run.code == 0);
    }
    const std::string page = slurp(source_folder() / "docs/how-to/sweep.md"), fence = "```toml\n";
    const std::size_t begin = page.find(fence) + fence.size();
    const fs::path file = folder.write("depth.toml", page.substr(begin, page.find("```", begin) - begin));
    const Outcome run = folder.tactus("sweep run " + file.string() + " -o " + in(folder, "how-to") + " --dry-run");
    CAPTURE(run.err);
    CHECK(run.code == 0);
}

TEST_CASE("verify ends a point that hangs, and standard input is empty", "[kernel]") {
    const Folder folder;
    // The first run of the point leaves a mark; the second one waits for ever.
    const fs::path file = folder.write(
        "sweep.toml",
        fmt::format("format = 1\ntitle = \"Hang\"\n[[step]]\ncommand = [\"sh\", \"-c\", \"cat; mkdir {} || sleep "
                    "1000\"]\n[limits]\ntime = \"0.5 s\"\n",
                    in(folder, "mark")));
    REQUIRE(folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a")).code == 0);
    const Outcome verify = folder.tactus("sweep verify " + in(folder, "a"));
    CHECK(verify.code == 1);
    CHECK(verify.err.find("took longer than 0.5 s") != std::string::npos);
}

TEST_CASE("a full disk fails the points that met it, and a run with room completes the table", "[kernel]") {
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", two_hundred_points());
    CHECK(folder.tactus("sweep run " + file.string() + " -o " + in(folder, "good") + " --jobs 1").code == 0);
    for (const char* where : {"/files/", "/log/"}) {
        CAPTURE(where);
        const std::string name = where[1] == 'f' ? "points" : "log";
        const std::string command = fmt::format(
            "LD_PRELOAD={} FAILING_DISK_PATH={} FAILING_DISK_CALLS=write,open FAILING_DISK_FROM=30 {} sweep run {} -o "
            "{} "
            "--jobs 1 >{} 2>{}",
            failing_disk(), where, tactus::test::command(), file.string(), in(folder, name), in(folder, "out"),
            in(folder, "err"));
        const int status = std::system(command.c_str());
        CAPTURE(slurp(folder.path / "out"), slurp(folder.path / "err"));
        REQUIRE(WIFEXITED(status));
        CHECK(WEXITSTATUS(status) == (name == "log" ? 3 : 1));
        const SweepStatus before = status_of(folder, name);
        CHECK(before.done > 0);
        CHECK(before.done < 200);
        CHECK(folder.tactus("sweep run " + file.string() + " -o " + in(folder, name) + " --jobs 2").code == 0);
        CHECK(results_of(folder, name) == results_of(folder, "good"));
    }
}

TEST_CASE("runners on one folder run no point twice when they have shares, and agree when they have none", "[kernel]") {
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", two_hundred_points("sleep 0.005; "));
    CHECK(folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a") + " --dry-run").code == 0);
    {
        Run first(folder, in(folder, "a") + " --share 1/2", "sweep work");
        Run second(folder, in(folder, "a") + " --share 2/2", "sweep work");
        CHECK(wait_for([&] { return rows_in(folder.path / "a") == 200; }));
    }
    CHECK(status_of(folder, "a").done == 200);
    CHECK(status_of(folder, "a").repeated == 0);
    // All of them twice: nothing was finished when the second began.
    CHECK(folder.tactus("sweep run " + file.string() + " -o " + in(folder, "b") + " --dry-run").code == 0);
    {
        Run first(folder, in(folder, "b"), "sweep work");
        Run second(folder, in(folder, "b"), "sweep work");
        CHECK(wait_for([&] { return rows_in(folder.path / "b") >= 300 && status_of(folder, "b").done == 200; }));
    }
    const SweepStatus status = status_of(folder, "b");
    CHECK(status.done == 200);
    CHECK(status.repeated > 100);
    CHECK(status.hash == status_of(folder, "a").hash);
}

TEST_CASE("a listing that is late makes points run twice, and changes no result", "[kernel]") {
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", two_hundred_points());
    CHECK(folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a")).code == 0);
    const std::string work =
        fmt::format("LD_PRELOAD={} SLOW_LISTING_PATH=/log SLOW_LISTING_SECONDS=100 {} sweep work {} >{}",
                    TACTUS_SLOW_LISTING, tactus::test::command(), in(folder, "a"), in(folder, "out"));
    REQUIRE(std::system(work.c_str()) == 0);
    CHECK(slurp(folder.path / "out") == "share 1/1: 200 points\n");
    const SweepStatus status = status_of(folder, "a");
    CHECK(status.done == 200);
    CHECK(status.repeated == 200);
    CHECK(folder.tactus("sweep status " + in(folder, "a") + " --tables").code == 0);
    CHECK(std::ranges::count(results_of(folder, "a"), '\n') == 201);
}

TEST_CASE("two results of one point are an error that names both logs", "[kernel]") {
    const Folder folder;
    // A value that is not of its inputs.
    const fs::path clock = folder.write("clock.toml",
                                        "format = 1\ntitle = \"Clock\"\n[[step]]\ncommand = [\"sh\", \"-c\", "
                                        "'echo \"{{\\\"t\\\": 1$(date +%N)}}\"']\nvalues = {time = \"/t\"}\n");
    CHECK(folder.tactus("sweep run " + clock.string() + " -o " + in(folder, "a")).code == 0);
    for (const auto& entry : fs::directory_iterator(folder.path / "a/log"))
        fs::rename(entry.path(), folder.path / "first.jsonl");
    CHECK(folder.tactus("sweep run " + clock.string() + " -o " + in(folder, "a")).code == 0);
    fs::rename(folder.path / "first.jsonl", folder.path / "a/log/first.jsonl");
    const Outcome status = folder.tactus("sweep status " + in(folder, "a"));
    CHECK(status.code == 1);
    CHECK(status.out.find("conflict: point 1") != std::string::npos);
    CHECK(status.out.find("first.jsonl") != std::string::npos);
    CHECK(status.out.find("depends on more than its inputs") != std::string::npos);
    CHECK(folder.tactus("sweep report " + in(folder, "a")).code == 2);
    // A fresh process finds the same.
    fs::remove(folder.path / "a/log/first.jsonl");
    const Outcome verify = folder.tactus("sweep verify " + in(folder, "a") + " --sample 100%");
    CHECK(verify.code == 1);
    CHECK(verify.out.find("1 different") != std::string::npos);
}

TEST_CASE("resident renders have the bits of fresh processes", "[slow]") {
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", R"(format = 1
title = "Touch"
[inputs]
patch = "library:patches/touch-sphere.toml"
[axes.stiffness]
unit = "N/mm"
values = [0.5, 1]
[axes.diameter]
unit = "mm"
values = [40, 50]
[[step]]
tactus = ["render", "{inputs.patch}", "--set", "coupling.stiffness={stiffness}", "--set", "ball.diameter={diameter}", "--seconds", "0.1", "-o", "{out}/run", "--json"]
values = {hash = "/output_hash"}
files = ["run/force.csv"]
)");
    const Outcome run = folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a") + " --jobs 1");
    CAPTURE(run.out, run.err);
    REQUIRE(run.code == 0);
    std::set<std::string> hashes;
    std::istringstream lines(query(folder.path / "a/results.sqlite", "select hash from results"));
    for (std::string line; std::getline(lines, line);) hashes.insert(line);
    CHECK(hashes.size() == 4);
    const Outcome verify = folder.tactus("sweep verify " + in(folder, "a") + " --sample 100%");
    CAPTURE(verify.out, verify.err);
    CHECK(verify.code == 0);
    CHECK(verify.out == "4 points run again: 4 equal, 0 different\n");
    const std::string plain =
        folder
            .tactus(
                "render touch-sphere --set 'coupling.stiffness=0.5 N/mm' --set 'ball.diameter=40 mm' "
                "--seconds 0.1 --json -o " +
                in(folder, "plain"))
            .out;
    CHECK(hashes.contains(nlohmann::json::parse(plain)["output_hash"].get<std::string>()));
}

TEST_CASE("rows of another build are not comparable when they differ", "[kernel]") {
    const Folder folder;
    const fs::path file = folder.write("sweep.toml",
                                       "format = 1\ntitle = \"Clock\"\n[[step]]\ncommand = [\"sh\", \"-c\", "
                                       "'echo \"{{\\\"t\\\": 1$(date +%N)}}\"']\nvalues = {time = \"/t\"}\n");
    CHECK(folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a")).code == 0);
    for (const auto& entry : fs::directory_iterator(folder.path / "a/log")) {
        std::string text = slurp(entry.path());
        const std::size_t at = text.find("\"libc\":\"");
        REQUIRE(at != std::string::npos);
        text.replace(at + 8, 1, "1");
        std::ofstream(entry.path(), std::ios::binary) << text;
    }
    const Outcome verify = folder.tactus("sweep verify " + in(folder, "a"));
    CHECK(verify.code == 0);
    CHECK(verify.out == "1 point run again: 0 equal, 0 different, 1 not comparable: made with another libc\n");
}

TEST_CASE("plots and the report show a sweep, failures first", "[kernel]") {
    const Folder folder;
    const fs::path file =
        folder.write("sweep.toml", two_hundred_points("[ $1 != 7 ] || (echo no seven >&2; exit 3) || exit 3; ") +
                                       R"([[figure]]
name = "line"
value = "value"
x = "level"
)");
    const Outcome run = folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a") + " --jobs 2");
    CAPTURE(run.out, run.err);
    CHECK(run.code == 1);
    CHECK(run.out.find("failed: 10 points: exit code 3: no seven; such as point ") != std::string::npos);
    CHECK(folder.tactus("sweep plot " + in(folder, "a") + " -o " + in(folder, "line.svg")).code == 0);
    CHECK(slurp(folder.path / "line.svg").find("level, N") != std::string::npos);
    CHECK(folder
              .tactus("sweep plot " + in(folder, "a") + " --value value --minus drawn --x level -o " +
                      in(folder, "b.svg"))
              .code == 0);
    const Outcome wrong =
        folder.tactus("sweep plot " + in(folder, "a") + " --value vlaue --x level -o " + in(folder, "c.svg"));
    CHECK(wrong.code == 2);
    CHECK(wrong.err.find("did you mean 'value'") != std::string::npos);
    const Outcome twice = folder.tactus("sweep plot " + in(folder, "a") +
                                        " --value value --x level --series level -o " + in(folder, "c.svg"));
    CHECK(twice.code == 2);
    CHECK(twice.err.find("each axis once") != std::string::npos);
    CHECK_FALSE(fs::exists(folder.path / "c.svg"));
    CHECK(folder.tactus("sweep plot " + in(folder, "a") + " --value value,drawn --x level -o " + in(folder, "d.svg"))
              .code == 0);
    CHECK(folder
              .tactus("sweep plot " + in(folder, "a") +
                      " --value value --minus drawn --x level --statistic fraction -o " + in(folder, "e.svg"))
              .code == 0);
    CHECK(slurp(folder.path / "e.svg").find("95 % (Newcombe)") != std::string::npos);
    // An axis of files has their names, and no numbers.
    folder.write("one.txt", "1");
    folder.write("two.txt", "2");
    const fs::path files = folder.write("files.toml", R"(format = 1
title = "Files"
[axes.text]
files = "*o*.txt"
[[step]]
command = ["cat", "{text}"]
values = {value = ""}
[[figure]]
name = "f"
value = "value"
x = "text"
)");
    CHECK(folder.tactus("sweep run " + files.string() + " -o " + in(folder, "f") + " --jobs 1").code == 0);
    CHECK(folder.tactus("sweep plot " + in(folder, "f") + " -o " + in(folder, "f.svg")).code == 0);
    const std::string named = slurp(folder.path / "f.svg");
    CHECK(named.find(">one<") != std::string::npos);
    CHECK(named.find(">two<") != std::string::npos);
    CHECK(named.find(">0<") == std::string::npos);
    const std::string two = slurp(folder.path / "d.svg");
    CHECK(two.find(">value<") != std::string::npos);
    CHECK(two.find(">drawn<") != std::string::npos);
    CHECK(folder.tactus("sweep report " + in(folder, "a")).code == 0);
    const std::string page = slurp(folder.path / "a/report.html");
    CHECK(page.find("<h2>Failures</h2>") < page.find("<h2>Axes</h2>"));
    CHECK(page.find("no seven") != std::string::npos);
    CHECK(page.find("<svg") != std::string::npos);
}

TEST_CASE("a folder follows its sweep file, and refuses inputs that have changed", "[kernel]") {
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", two_hundred_points());
    CHECK(folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a") + " --jobs 2").code == 0);
    std::string more = two_hundred_points();
    more.replace(more.find("count = 10"), 10, "count = 11");
    folder.write("sweep.toml", more);
    CHECK(folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a") + " --jobs 2").code == 0);
    CHECK(status_of(folder, "a").points == 220);
    CHECK(rows_in(folder.path / "a") == 220);
    // Inputs.
    folder.write("input.txt", "1");
    const fs::path other = folder.write("other.toml",
                                        "format = 1\ntitle = \"Input\"\n[inputs]\nname = \"input.txt\"\n[[step]]\n"
                                        "command = [\"cat\", \"{inputs.name}\"]\n");
    CHECK(folder.tactus("sweep run " + other.string() + " -o " + in(folder, "b")).code == 0);
    folder.write("input.txt", "22");
    const Outcome work = folder.tactus("sweep work " + in(folder, "b"));
    CHECK(work.code == 2);
    CHECK(work.err.find("have changed since it was prepared") != std::string::npos);
    CHECK(folder.tactus("sweep run " + other.string() + " -o " + in(folder, "b")).code == 0);
    CHECK(status_of(folder, "b").done == 1);
    CHECK(rows_in(folder.path / "b") == 2);
    // One that changes while the sweep runs: no row has the name of other contents.
    folder.write("input.txt", "1");
    const fs::path during =
        folder.write("during.toml",
                     "format = 1\ntitle = \"During\"\n[inputs]\nname = \"input.txt\"\n[seeds]\ncount "
                     "= 4\n[[step]]\ncommand = [\"sh\", \"-c\", \"cat $0; test $1 != 2 || echo more >>$0\", "
                     "\"{inputs.name}\", \"{seed}\"]\nvalues = {seen = \"\"}\n[limits]\nretries = 0\n");
    const Outcome changed = folder.tactus("sweep run " + during.string() + " -o " + in(folder, "d") + " --jobs 1");
    CHECK(changed.code == 1);
    CHECK(changed.out.find("input.txt has changed since the sweep was prepared") != std::string::npos);
    CHECK(query(folder.path / "d/results.sqlite", "select count(*) from results where state = 'done' and seen <> 1") ==
          "0\n");
    // A folder of something else.
    fs::create_directories(folder.path / "c");
    folder.write("c/mine.txt", "mine");
    CHECK(folder.tactus("sweep run " + other.string() + " -o " + in(folder, "c")).code == 2);
    CHECK(folder.tactus("sweep status " + in(folder, "c")).code == 2);
    CHECK(folder.tactus("sweep work " + in(folder, "b") + " --share 3/2").code == 2);
}

TEST_CASE("a Makefile runs a sweep", "[kernel]") {
    const Folder folder;
    const fs::path file = folder.write("sweep.toml", two_hundred_points());
    const Outcome run =
        folder.tactus("sweep run " + file.string() + " -o " + in(folder, "a") + " --runner make --chunk 40");
    CHECK(run.out.find("with 5 targets") != std::string::npos);
    if (std::system("make --version >/dev/null 2>&1") != 0) return;
    CHECK(std::system(fmt::format("make -s -j 2 -k -C {} >{} 2>&1", in(folder, "a"), in(folder, "make.out")).c_str()) ==
          0);
    CAPTURE(slurp(folder.path / "make.out"));
    CHECK(status_of(folder, "a").done == 200);
    CHECK(status_of(folder, "a").repeated == 0);
}
