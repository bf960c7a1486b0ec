// SPDX-License-Identifier: Apache-2.0
// 'tactus session': order, what is kept, and going on after a crash.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/background_run.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <string>

using namespace tactus;
using test::Folder;
using test::Outcome;
using test::slurp;
using json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

/// The command in a process of its own.
class Background {
public:
    Background(const Folder& folder, const std::string& words) {
        process_ = ::fork();
        if (process_ != 0) return;
        const std::string command = "exec " + test::command() + " " + words + " >" +
                                    (folder.path / "background.out").string() + " 2>" +
                                    (folder.path / "background.err").string();
        ::execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
        ::_exit(127);
    }
    ~Background() { end(SIGKILL); }
    Background(const Background&) = delete;
    Background& operator=(const Background&) = delete;
    int end(int signal) {
        if (process_ <= 0) return -1;
        int status = 0;
        if (signal != 0) ::kill(process_, signal);
        ::waitpid(std::exchange(process_, -1), &status, 0);
        return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    }

private:
    pid_t process_ = -1;
};

std::string words(const Folder& folder, const std::string& seconds, const std::string& more = "") {
    return "session mandible-canal mandible-canal fibula-osteotomy --trainee P01 --offline --seconds " + seconds +
           " --out " + (folder.path / "out").string() + " " + more;
}

}  // namespace

TEST_CASE("a session that is killed goes on with the next task and keeps what was done", "[slow]") {
    const Folder folder;
    const fs::path session = folder.path / "out/P01/1";
    {
        Background run(folder, words(folder, "5"));
        REQUIRE(test::wait_for([&] { return fs::exists(session / "02-mandible-canal/take/timing.log"); }));
        run.end(SIGKILL);
    }
    REQUIRE(json::parse(slurp(session / "session.json"))["attempts"].size() == 1);
    const std::string first = slurp(session / "01-mandible-canal/run/summary.json");
    CHECK_FALSE(first.empty());

    // Other tasks are no resumption of it.
    const Outcome other = folder.tactus("session fibula-osteotomy --trainee P01 --offline --seconds 0.2 --out " +
                                        (folder.path / "out").string());
    CHECK(other.code == 2);
    CHECK(other.err.find("has other tasks (mandible-canal mandible-canal fibula-osteotomy)") != std::string::npos);

    const Outcome again = folder.tactus(words(folder, "0.5"));
    INFO(again.err);
    REQUIRE(again.code == 0);
    CHECK(again.err.find("1 of 3 tasks were completed") != std::string::npos);
    CHECK(slurp(session / "01-mandible-canal/run/summary.json") == first);
    CHECK(fs::exists(session / "02-mandible-canal-cut-off-1/take/timing.log"));
    for (const char* attempt : {"02-mandible-canal", "03-fibula-osteotomy"}) {
        CHECK(fs::exists(session / attempt / "run/summary.json"));
        CHECK(fs::exists(session / attempt / "run/task.csv"));
        CHECK(fs::exists(session / attempt / "take/result.json"));
        CHECK(fs::exists(session / attempt / "score.json"));
    }
    const json kept = json::parse(slurp(session / "session.json"));
    CHECK(kept["complete"] == true);
    CHECK(kept["trainee"] == "P01");
    CHECK(kept["scores"] == "not validated");
    CHECK(kept["attempts"].size() == 3);
    CHECK(kept["attempts"][2]["folder"] == "03-fibula-osteotomy");

    // A complete session is followed by the next one.
    {
        const Background next(folder, words(folder, "5"));
        CHECK(test::wait_for([&] { return fs::exists(folder.path / "out/P01/2/01-mandible-canal/take/timing.log"); }));
    }
    const Outcome all = folder.tactus("score --json " + session.string());
    INFO(all.err);
    CHECK(all.code == 0);
    CHECK(json::parse(all.out)["rows"].size() == 3);
    CHECK(json::parse(all.out)["rows"][0]["trainee"] == "P01");
}

// Costly: tasks of the library are sawn from begin to end.
TEST_CASE("Ctrl-C ends the attempt and the session, and the same command goes on", "[slow]") {
    const Folder folder;
    const fs::path session = folder.path / "out/P01/1";
    {
        Background run(folder, words(folder, "600"));
        REQUIRE(test::wait_for([&] { return fs::exists(session / "01-mandible-canal/take/timing.log"); }));
        CHECK(run.end(SIGINT) == 1);
    }
    const json kept = json::parse(slurp(session / "session.json"));
    REQUIRE(kept["attempts"].size() == 1);
    CHECK(kept["attempts"][0]["ended_early"] == true);
    CHECK(kept["attempts"][0]["seconds"].get<double>() < 600.0);
    CHECK(kept["complete"] == false);
    REQUIRE(folder.tactus(words(folder, "0.2")).code == 0);
    CHECK(json::parse(slurp(session / "session.json"))["complete"] == true);
}

TEST_CASE("a start that fails leaves no attempt, and is not taken for an interrupted one") {
    const Folder folder;
    const fs::path session = folder.path / "out/P01/1";
    const std::string line =
        "session mandible-canal --trainee P01 --seconds 0.2 --out " + (folder.path / "out").string();
    // There is no such device.
    const Outcome failed = folder.tactus(line + " --set hand.device=falcon");
    CAPTURE(failed.err);
    CHECK(failed.code != 0);
    CHECK_FALSE(fs::exists(session / "01-mandible-canal"));
    // As an earlier version left it.
    fs::create_directories(session / "01-mandible-canal/take/streams");
    const Outcome again = folder.tactus(line + " --offline");
    CAPTURE(again.err);
    CHECK(again.code == 0);
    CHECK(fs::exists(session / "01-mandible-canal/run/summary.json"));
    CHECK_FALSE(fs::exists(session / "01-mandible-canal-cut-off-1"));
}

TEST_CASE("a session is refused before anything is made when its trainee or a task is wrong") {
    const Folder folder;
    const std::string out = (folder.path / "out").string();
    for (const char* name : {"../P01", "P/01", ".P", "-P", "P 1", "P\xc3\xa9", "P.",
                             "aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"}) {
        const Outcome o =
            folder.tactus(std::string("session mandible-canal --offline --out ") + out + " --trainee='" + name + "'");
        INFO(name << ": " << o.err);
        CHECK(o.code == 2);
        CHECK(o.err.find("pseudonym") != std::string::npos);
    }
    const Outcome unknown = folder.tactus("session mandible-canal mandible-kanal --offline --trainee P01 --out " + out);
    CHECK(unknown.code == 2);
    CHECK(unknown.err.find("no task 'mandible-kanal'") != std::string::npos);
    const std::string bones = (test::library_folder() / "bones").string();
    const Outcome other = folder.tactus("session mandible-canal --offline --trainee P01 --out " + out +
                                        " --asset bone=" + bones + "/fibula.vdb");
    INFO(other.err);
    CHECK(other.code == 2);
    CHECK(other.err.find("is another bone than") != std::string::npos);
    CHECK_FALSE(fs::exists(out));
}

TEST_CASE("a folder of sessions is not scored as a run, and says which sessions it holds", "[slow]") {
    const Folder folder;
    const std::string out = (folder.path / "out").string();
    REQUIRE(folder.tactus("session mandible-canal --offline --seconds 0.2 --trainee P01 --out " + out).code == 0);
    for (const std::string& at : {out, out + "/P01"}) {
        const Outcome o = folder.tactus("score " + at);
        CHECK(o.code == 2);
        CHECK(o.err.find("holds sessions; name those to score: " + out + "/P01/1") != std::string::npos);
    }
    CHECK(folder.tactus("score " + out + "/P01/1").code == 0);
}

TEST_CASE("two programs do not run one session at the same time", "[slow]") {
    const Folder folder;
    Background run(folder, words(folder, "600"));
    REQUIRE(test::wait_for([&] { return fs::exists(folder.path / "out/P01/1/01-mandible-canal/take/timing.log"); }));
    const Outcome other = folder.tactus(words(folder, "0.2"));
    CHECK(other.code == 2);
    CHECK(other.err.find("another program runs this session") != std::string::npos);
}
