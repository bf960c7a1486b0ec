// SPDX-License-Identifier: Apache-2.0
// A terminal that closes ends a run in order, and nobody who stops listening ends it at all.
#include "tests/support/catch.hpp"
#include "tests/tools/background_run.hpp"
#include "tests/tools/outputs_patch.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::recording_patch;
using tactus::test::Run;
using tactus::test::shell;
using tactus::test::slurp;
using tactus::test::wait_for;

namespace {

namespace fs = std::filesystem;

void is_complete(const fs::path& out) {
    INFO(out);
    const json summary = json::parse(slurp(out / "summary.json"));
    CHECK(summary["lost"].empty());
    CHECK(slurp(out / "table.csv").ends_with('\n'));
    CHECK(fs::exists(out / "sound.wav"));
    for (const auto& entry : fs::directory_iterator(out)) CHECK(entry.path().extension() != ".part");
}

}  // namespace

TEST_CASE("a run ends in order with SIGHUP as with SIGTERM", "[slow]") {
    for (const int signal : {SIGHUP, SIGTERM}) {
        const Folder folder;
        const std::string file = folder.write("p.toml", recording_patch).string();
        const fs::path out = folder.path / "out";
        Run run(folder, file + " --audio none --out " + out.string());
        REQUIRE(wait_for(
            [&] { return fs::exists(out / "sound.wav.part") && fs::file_size(out / "sound.wav.part") > 1000; }));
        CHECK(run.stop(signal) == 0);
        is_complete(out);
    }
}

TEST_CASE("a run that was told to ignore SIGHUP, as by nohup, ignores it", "[slow]") {
    const Folder folder;
    folder.write("p.toml", recording_patch);
    const Outcome ran = shell(folder,
                              "trap '' HUP\n$T run p.toml --audio none --no-edits --seconds 1 --json --out out &\n"
                              "sleep 0.4\nkill -HUP $!\nwait $!\n");
    INFO(ran.err);
    CHECK(ran.code == 0);
    CHECK(json::parse(ran.out)["seconds"] == 1.0);
}

TEST_CASE("a render that is asked to end keeps what it has computed and says how far it came", "[slow]") {
    for (const char* signal : {"HUP", "TERM", "INT"}) {
        const Folder folder;
        folder.write("p.toml", recording_patch);
        const Outcome ended = shell(folder, std::string("$T render p.toml --seconds 100000 --json --out out &\n") +
                                                // More than the header: some samples are computed.
                                                "until [ -n \"$(find out -name sound.wav.part -size +16k)\" ]; do "
                                                "sleep 0.05; done\nkill -" +
                                                signal + " $!\nwait $!\n");
        INFO(signal << "\n" << ended.out << ended.err);
        CHECK(ended.code == 1);
        CHECK(ended.err.find("ended at ") != std::string::npos);
        is_complete(folder.path / "out");
        const double ran = json::parse(ended.out)["seconds"];
        CHECK(ran > 0.0);
        CHECK(ran < 100000.0);
    }
}

TEST_CASE("a closed terminal or pipe does not end a run", "[slow]") {
    const Folder folder;
    folder.write("p.toml", recording_patch);
    // Nobody reads either of them when the run speaks; the fault is one that it tells at once.
    folder.write("edit.toml", recording_patch);
    const Outcome ran =
        shell(folder,
              "( $T run p.toml --audio none --seconds 1 --out live 2>&1; echo $? >code ) | true\n"
              "( $T render p.toml --seconds 1 --out virtual 2>&1; echo $? >>code ) | true\n"
              "$T run p.toml --audio none --seconds 0.3 --out closed >&- 2>&-; echo $? >>code\n"
              "$T run p.toml --audio none --seconds 0.3 --out full >/dev/full 2>/dev/full; echo $? >>code\n");
    CHECK(ran.code == 0);
    CHECK(slurp(folder.path / "code") == "0\n0\n0\n0\n");
    for (const char* out : {"live", "virtual", "closed", "full"}) is_complete(folder.path / out);
}
