// SPDX-License-Identifier: Apache-2.0
// Breaking a bone and putting it together, as scripts do it.
#include "assets/bone/bone.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/types.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/bar.hpp"
#include "tests/tools/box_stl.hpp"
#include "tests/tools/json_schema.hpp"
#include "tests/tools/plan_pose.hpp"
#include "tests/tools/run_command.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>

using namespace tactus;
using nlohmann::json;
using tactus::test::bar;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::pose_in;
using tactus::test::slurp;

// Costly: a global search on whole surfaces.
TEST_CASE("a bone that fracture broke is put together by snap, and a stranger's half is refused", "[slow]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::save_bone(bar(), file("bar.vdb"));
    const Outcome broken = folder.tactus("fracture " + file("bar.vdb") + " -o " + file("a") + " --seed 4 --json");
    INFO(broken.err);
    REQUIRE(broken.code == 0);
    const json truth = json::parse(slurp(folder.path / "a/truth.json"));
    CHECK(json::parse(broken.out) == truth);
    REQUIRE(truth["fragments"].size() == 2);
    CHECK(slurp(folder.path / "a/fragment_01.stl").substr(0, 80).find("SPACE=LPS") != std::string::npos);
    const Pose wanted = pose_in(truth["fragments"][0]["pose"]).inverse() * pose_in(truth["fragments"][1]["pose"]);
    const std::string fixed = file("a/fragment_01.vdb");
    for (const std::string mode : {"extended", "global"}) {
        const Outcome done =
            folder.tactus("snap " + file("a/fragment_02.vdb") + " " + fixed + " --json --mode " + mode);
        INFO(mode << " " << done.out << done.err);
        CHECK(done.code == 0);
        const json fit = json::parse(done.out);
        CHECK(fit["verdict"] == "fit");
        CHECK(fit["free_directions"].empty());
        CHECK(fit["margin"].get<double>() > 0.2);
        CHECK(fit["overlap_mm2"].get<double>() > 150.0);
        const Pose found = pose_in(fit["pose"]);
        for (const Vec3& corner : {Vec3(20.0, 6.0, 11.0), Vec3(20.0, -6.0, -11.0), Vec3(0.0, 0.0, 11.0)}) {
            const Vec3 at = pose_in(truth["fragments"][1]["pose"]).inverse().apply(corner * mm);
            CHECK(glm::length(found.apply(at) - wanted.apply(at)) < 0.2 * mm);
        }
    }
    REQUIRE(folder.tactus("fracture " + file("bar.vdb") + " -o " + file("b") + " --seed 5").code == 0);
    const Outcome stranger = folder.tactus("snap " + file("b/fragment_02.vdb") + " " + fixed + " --json --mode global");
    CHECK(stranger.code == 1);
    CHECK(json::parse(stranger.out)["verdict"] != "fit");
}

// Costly: three searches on whole surfaces.
TEST_CASE("snap calls halves that lost bone between them a fit only if its bound contains the loss", "[slow]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::save_bone(bar(), file("bar.vdb"));
    REQUIRE(folder.tactus("fracture " + file("bar.vdb") + " -o " + file("a") + " --seed 4 --kerf 1.6").code == 0);
    const json truth = json::parse(slurp(folder.path / "a/truth.json"));
    const Pose wanted = pose_in(truth["fragments"][0]["pose"]).inverse() * pose_in(truth["fragments"][1]["pose"]);
    const std::string snap = "snap " + file("a/fragment_02.vdb") + " " + file("a/fragment_01.vdb") + " --json";
    const auto error_of = [&](const json& fit) {
        const Vec3 middle = pose_in(truth["fragments"][1]["pose"]).inverse().apply(Vec3(0.0));
        return glm::length(pose_in(fit["pose"]).apply(middle) - wanted.apply(middle));
    };
    const json open = json::parse(folder.tactus(snap).out), given = json::parse(folder.tactus(snap + " --kerf 1.6").out);
    CAPTURE(open.dump(1), given.dump(1), error_of(open) / mm, error_of(given) / mm);
    CHECK(error_of(open) > 1.0 * mm);
    CHECK(open["verdict"] != "fit");
    if (open["verdict"] == "uncertain") CHECK(open["bound"]["face_mm"].get<double>() * mm > error_of(open));
    CHECK(folder.tactus(snap.substr(0, snap.rfind(' '))).out.find("--kerf") != std::string::npos);
    CHECK(error_of(given) < 0.5 * mm);
}

TEST_CASE("halves that touch in one scan are not called a fit where the scan has them", "[long]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::save_bone(bar(), file("bar.vdb"));
    REQUIRE(folder.tactus("fracture " + file("bar.vdb") + " -o " + file("a") + " --seed 4 --spread 0 --turn 0").code ==
            0);
    const std::string halves = file("a/fragment_02.vdb") + " " + file("a/fragment_01.vdb");
    const Outcome alone = folder.tactus("snap " + halves + " --json --start 2,1,0,1,0,0,0");
    INFO(alone.out << alone.err);
    CHECK(alone.code == 1);
    const json fit = json::parse(alone.out);
    CHECK(fit["verdict"] == "ambiguous");
    CHECK(tactus::test::broken_schema(folder, "snap", fit) == "");
    CHECK(fit["as_scanned"] == true);
    CHECK(fit["moved"]["distance_mm"].get<double>() == Approx(std::sqrt(5.0)).margin(0.1));
    CHECK(folder.tactus("snap " + halves).out.find("only reproduces the scanned position") != std::string::npos);
    const std::string plan = file("case.plan.json");
    REQUIRE(
        folder.tactus("plan new " + plan + " " + file("a/fragment_01.vdb") + " " + file("a/fragment_02.vdb")).code ==
        0);
    const Outcome planned = folder.tactus("plan snap " + plan + " fragment_02 --json");
    INFO(planned.out << planned.err);
    CHECK(planned.code == 1);
    CHECK(json::parse(planned.out)["as_scanned"] == true);
    CHECK(json::parse(planned.out)["placed"] == false);
}

// Costly: three searches on whole surfaces.
TEST_CASE("the break is proposed by the unbroken bone, laid on the piece by itself or on the main fragment", "[slow]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::save_bone(bar(), file("bar.vdb"));
    REQUIRE(folder.tactus("fracture " + file("bar.vdb") + " -o " + file("a") + " --seed 4 --spread 4 --turn 5").code ==
            0);
    const auto area = [](const json& found) {
        double sum = 0.0;
        for (const json& face : found["faces"]) sum += face["area_mm2"].get<double>();
        return sum;
    };
    const Outcome filed =
        folder.tactus("fracture-surface " + file("a/fragment_02.vdb") + " -o " + file("f.json") + " --keep --json");
    REQUIRE(filed.code == 0);
    const double wanted = area(json::parse(filed.out));
    const Outcome done =
        folder.tactus("fracture-surface " + file("a/fragment_02.vdb") + " -o " + file("p.vdb") + " --intact " +
                      file("bar.vdb") + " --main " + file("a/fragment_01.vdb") + " --json");
    INFO(done.out << done.err);
    REQUIRE(done.code == 0);
    const json found = json::parse(done.out);
    CHECK(area(found) == Approx(wanted).epsilon(0.25));
    CHECK(found["intact"]["on_main"]["median_mm"].get<double>() < 0.3);
    CHECK(found["intact"]["on_bone"]["median_mm"].get<double>() < 0.3);
    const Outcome tiny =
        folder.tactus("fracture-surface " + file("a/fragment_02.vdb") + " -o " + file("p.vdb") + " --intact " +
                      file("bar.vdb") + " --main " + file("a/fragment_01.vdb") + " --least-area 0 --json");
    REQUIRE(tiny.code == 0);
    CHECK(area(json::parse(tiny.out)) >= area(found));
    const Outcome none =
        folder.tactus("fracture-surface " + file("a/fragment_02.vdb") + " -o " + file("p.vdb") + " --intact " +
                      file("bar.vdb") + " --main " + file("a/fragment_01.vdb") + " --least-area 5000 --json");
    CHECK(none.code == 1);
    const Outcome far =
        folder.tactus("fracture-surface " + file("a/fragment_01.vdb") + " -o " + file("q.vdb") + " --intact " +
                      file("bar.vdb") + " --facing " + file("a/fragment_02.vdb") + " --json");
    INFO(far.out << far.err);
    REQUIRE(far.code == 0);
    CHECK(area(json::parse(far.out)) == Approx(wanted).epsilon(0.25));
    CHECK(folder.tactus("fracture-surface " + file("bar.vdb") + " -o " + file("n.json") + " --mirror").code == 2);
}

TEST_CASE("an unbroken bone that does not lie on the fragment is said, with the next step", "[slow]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::save_bone(bar(), file("bar.vdb"));
    folder.write("other.stl", test::box_stl(Vec3(0.0, 0.0, 0.0), Vec3(60.0, 60.0, 60.0)));
    const std::string verb =
        "fracture-surface " + file("bar.vdb") + " -o " + file("p.json") + " --intact " + file("other.stl");
    const Outcome doubted = folder.tactus(verb);
    INFO(doubted.out << doubted.err);
    CHECK(doubted.code == 1);
    CHECK(doubted.out.find("warning: the unbroken bone lies more than 2 mm away from half of the fragment") !=
          std::string::npos);
    CHECK(doubted.out.find("--main") != std::string::npos);
    CHECK(json::parse(folder.tactus(verb + " --json").out)["intact"]["doubt"].is_string());
}

TEST_CASE("snap and fracture refuse what they cannot use with one clear line", "[slow]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    bone::save_bone(bar(), file("bar.vdb"));
    for (const std::string& arguments : {"snap " + file("bar.vdb") + " " + file("none.vdb"),
                                         "snap " + file("bar.vdb") + " " + file("bar.vdb") + " --start 1,2",
                                         "snap " + file("bar.vdb") + " " + file("bar.vdb") + " --start 0,0,0,2,0,0,0",
                                         "snap " + file("bar.vdb") + " " + file("bar.vdb") + " --paint " +
                                             folder.write("bad.json", "{\"moving\": 3}").string(),
                                         "fracture " + file("bar.vdb") + " -o " + file("x") + " --pieces 3 --missing 2",
                                         std::string("bench snap --seeds 1 --case chiped25")}) {
        const Outcome done = folder.tactus(arguments);
        INFO(arguments << "\n" << done.err);
        CHECK(done.code == 2);
        CHECK(std::ranges::count(done.err, '\n') == 1);
    }
}

TEST_CASE("a fragment is painted towards several neighbours at once, and the paint that it has is kept", "[long]") {
    const Folder folder;
    const auto file = [&folder](const std::string& name) { return (folder.path / name).string(); };
    const std::string jaw = (test::library_folder() / "bones/mandible.vdb").string();
    REQUIRE(folder.tactus("fracture " + jaw + " -o " + file("a") + " --pieces 3 --seed 5 --spread 3").code == 0);
    const auto area_of = [&](const std::string& piece, const std::string& options) {
        const Outcome done = folder.tactus("fracture-surface " + piece + " -o " + file("q.vdb") + " --json " + options);
        INFO(done.out << done.err);
        REQUIRE(done.code == 0);
        double sum = 0.0;
        const json told = json::parse(done.out);
        for (const json& face : told["faces"]) {
            CHECK(face["area_mm2"].get<double>() >= 20.0);
            sum += face["area_mm2"].get<double>();
        }
        return sum;
    };
    // The third piece broke from both others.
    const std::string piece = file("a/fragment_03.vdb"), first = " --facing " + file("a/fragment_01.vdb"),
                      second = " --facing " + file("a/fragment_02.vdb");
    const double other = area_of(piece, second), one = area_of(piece, first);
    std::filesystem::copy_file(file("q.vdb"), file("once.vdb"));
    CHECK(one > 100.0);
    CHECK(other > 100.0);
    CHECK(area_of(piece, first + second) == Approx(one + other).epsilon(0.02));
    // In two calls: the second keeps what the first has painted.
    CHECK(area_of(file("once.vdb"), "--keep" + second) == Approx(one + other).epsilon(0.02));
    CHECK(area_of(file("once.vdb"), second) == Approx(other).epsilon(0.02));
}
