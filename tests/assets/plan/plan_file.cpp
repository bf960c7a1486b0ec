// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/plan_file.hpp"
#include "assets/plan/plan_history.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <bit>
#include <cstdint>

using namespace tactus;

namespace {

bool same_bits(const Pose& a, const Pose& b) {
    const double x[] = {a.position.x,    a.position.y,    a.position.z,   a.orientation.w,
                        a.orientation.x, a.orientation.y, a.orientation.z};
    const double y[] = {b.position.x,    b.position.y,    b.position.z,   b.orientation.w,
                        b.orientation.x, b.orientation.y, b.orientation.z};
    for (int i = 0; i < 7; ++i)
        if (std::bit_cast<std::uint64_t>(x[i]) != std::bit_cast<std::uint64_t>(y[i])) return false;
    return true;
}

Pose any_pose(std::uint64_t n) {
    const Random random{n};
    return {Vec3(random.normal(0), random.normal(1), random.normal(2)) * 0.1,
            glm::normalize(Quat(random.normal(3), random.normal(4), random.normal(5), random.normal(6)))};
}

/// Four fragments, none of whose files is looked at.
plan::CasePlan four() {
    plan::CasePlan plan;
    plan.title = "a jaw";
    for (const char* name : {"a", "b", "c", "d"}) plan.fragments.push_back({name, name, 7, {0.1, 0.2, 0.3}});
    return plan;
}

plan::PlanStep meaning(plan::StepKind kind, std::vector<int> fragments, std::string group = "") {
    plan::PlanStep step;
    step.kind = kind;
    step.by = "command";
    step.fragments = std::move(fragments);
    step.group = std::move(group);
    return step;
}

void put(plan::CasePlan& plan, int fragment, const Pose& pose) {
    REQUIRE(plan::change(plan, plan::PlaceFragment{fragment, pose}, {}) == plan::PlanHistory::Outcome::done);
}

/// Every kind of step, an undone branch and a second alternative.
plan::CasePlan eventful() {
    plan::CasePlan plan = four();
    for (int n = 1; n < 4; ++n) put(plan, n, any_pose(static_cast<std::uint64_t>(n)));
    plan::add_step(plan, meaning(plan::StepKind::group, {1, 2}, "chin"));
    plan::add_step(plan, meaning(plan::StepKind::add, {3}, "chin"));
    put(plan, 1, any_pose(9));
    plan.steps.back().fit = plan::PlanFit{"a", "fit", 0.8, 0.3, 1e-4, -1e-5, 2e-4, 1.1e-4};
    plan.steps.back().run_second = 1.25;
    plan.steps.back().time = plan::time_of_day();
    REQUIRE(plan::change(plan, plan::UndoStep{}, {}) == plan::PlanHistory::Outcome::done);
    plan::add_step(plan, meaning(plan::StepKind::lock, {0, 1}));
    plan::add_step(plan, meaning(plan::StepKind::hide, {2}));
    plan.alternatives.push_back({"other", plan.place()});
    plan.current = 1;
    plan::PlanStep mirror = meaning(plan::StepKind::mirror, {});
    mirror.mirror = plan::MirrorTarget{"healthy.stl", 3, false, {0.0, 1.0, 0.0}, 0.1, any_pose(11), 1e-3};
    plan::add_step(plan, mirror);
    REQUIRE(plan::change(plan, plan::UndoStep{}, {}) == plan::PlanHistory::Outcome::done);
    return plan;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const auto at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), by);
}

}  // namespace

TEST_CASE("a plan that is read again has the same bits in every pose, and can be undone and redone as before") {
    const plan::CasePlan plan = eventful(), again = plan::read_plan_text(plan::plan_text(plan), "p");
    REQUIRE(again.steps.size() == plan.steps.size());
    for (std::size_t n = 0; n < plan.steps.size(); ++n) {
        REQUIRE(again.steps[n].poses.size() == plan.steps[n].poses.size());
        for (std::size_t k = 0; k < plan.steps[n].poses.size(); ++k)
            CHECK(same_bits(again.steps[n].poses[k], plan.steps[n].poses[k]));
    }
    CHECK(plan::plan_text(again) == plan::plan_text(plan));
    CHECK(again.alternatives[1].place.tip == plan.alternatives[1].place.tip);
    plan::CasePlan redone = again;
    REQUIRE(plan::change(redone, plan::RedoStep{}, {}) == plan::PlanHistory::Outcome::done);
    CHECK(redone.place().head == static_cast<int>(plan.steps.size()) - 1);
    const plan::PlanState before = plan::state_of(plan), after = plan::state_of(again);
    for (int n = 0; n < 4; ++n) CHECK(same_bits(before.arrangement.pose(n), after.arrangement.pose(n)));
    CHECK(before.arrangement.is_hidden(2));
    CHECK(after.arrangement.is_locked(1));
    CHECK(after.find_group("chin") != fit::Arrangement::none);
}

TEST_CASE("a repainted fragment has its file from that step on, in the file of the plan too") {
    plan::CasePlan plan = four();
    const auto file_of_b = [](const plan::CasePlan& p) { return plan::fragments_of(p)[1].file; };
    const auto painted = [](std::vector<int> fragments) {
        plan::PlanStep step = meaning(plan::StepKind::repaint, std::move(fragments));
        step.painted = plan::HashedFile{"b2.vdb", 0x1234567890abcdef};
        return step;
    };
    plan::add_step(plan, painted({1}));
    put(plan, 1, any_pose(1));
    CHECK(file_of_b(plan) == "b2.vdb");
    CHECK(plan::fragments_of(plan)[1].hash == 0x1234567890abcdef);
    CHECK(plan::fragments_of(plan)[1].name == "b");
    CHECK(plan::fragments_of(plan)[2].file == "c");
    const plan::CasePlan again = plan::read_plan_text(plan::plan_text(plan), "p");
    CHECK(file_of_b(again) == "b2.vdb");
    CHECK(plan::plan_text(again) == plan::plan_text(plan));
    for (int n = 0; n < 2; ++n) REQUIRE(plan::change(plan, plan::UndoStep{}, {}) == plan::PlanHistory::Outcome::done);
    CHECK(file_of_b(plan) == "b");
    REQUIRE(plan::change(plan, plan::RedoStep{}, {}) == plan::PlanHistory::Outcome::done);
    CHECK(file_of_b(plan) == "b2.vdb");
    // One fragment, and a file.
    CHECK_THROWS_WITH(plan::add_step(plan, painted({1, 2})), Catch::Matchers::ContainsSubstring("more than one"));
    CHECK_THROWS_WITH(plan::add_step(plan, meaning(plan::StepKind::repaint, {1})),
                      Catch::Matchers::ContainsSubstring("has no file"));
    CHECK_THROWS_WITH(
        plan::read_plan_text(replaced(plan::plan_text(again), "1234567890abcdef", "1234567890abcdeX"), "p"),
        Catch::Matchers::ContainsSubstring("steps[0].painted has a 'hash' that is not a hash"));
}

TEST_CASE("undoing takes poses back to the bit, and no step is ever lost") {
    plan::CasePlan plan = four();
    std::vector<Pose> way{Pose{}};
    for (std::uint64_t n = 0; n < 50; ++n) {
        put(plan, 2, any_pose(n));
        way.push_back(plan::state_of(plan).arrangement.pose(2));
    }
    for (std::size_t n = way.size() - 1; n-- > 0;) {
        REQUIRE(plan::change(plan, plan::UndoStep{}, {}) == plan::PlanHistory::Outcome::done);
        CHECK(same_bits(plan::state_of(plan).arrangement.pose(2), way[n]));
    }
    for (std::size_t n = 1; n < way.size(); ++n) {
        REQUIRE(plan::change(plan, plan::RedoStep{}, {}) == plan::PlanHistory::Outcome::done);
        CHECK(same_bits(plan::state_of(plan).arrangement.pose(2), way[n]));
    }
    for (int n = 0; n < 20; ++n) REQUIRE(plan::change(plan, plan::UndoStep{}, {}) == plan::PlanHistory::Outcome::done);
    put(plan, 1, any_pose(99));
    CHECK(plan.steps.size() == 51);
    CHECK(same_bits(plan::state_of(plan).arrangement.pose(2), way[30]));
}

TEST_CASE("a grouped fragment takes its group along, and the step says where each of them stands") {
    plan::CasePlan plan = four();
    plan::add_step(plan, meaning(plan::StepKind::group, {0, 3}, "pair"));
    put(plan, 3, any_pose(1));
    CHECK(plan.steps.back().fragments == std::vector<int>{3, 0});
    CHECK(same_bits(plan::state_of(plan).arrangement.pose(0), plan.steps.back().poses[1]));
    plan::add_step(plan, meaning(plan::StepKind::remove, {0}));
    CHECK(plan::state_of(plan).find_group("pair") == fit::Arrangement::none);
}

TEST_CASE("a step that cannot be is refused and leaves the plan as it was") {
    plan::CasePlan plan = eventful();
    const std::string text = plan::plan_text(plan);
    CHECK_THROWS_WITH(plan::add_step(plan, meaning(plan::StepKind::add, {0}, "chim")),
                      Catch::Matchers::ContainsSubstring("did you mean 'chin'"));
    CHECK_THROWS_WITH(plan::add_step(plan, meaning(plan::StepKind::group, {1, 2}, "x")),
                      Catch::Matchers::ContainsSubstring("move together already"));
    CHECK_THROWS_WITH(plan::add_step(plan, meaning(plan::StepKind::group, {0, 1}, "chin")),
                      Catch::Matchers::ContainsSubstring("already"));
    CHECK_THROWS_WITH(plan::add_step(plan, meaning(plan::StepKind::hide, {4})),
                      Catch::Matchers::ContainsSubstring("no fragment number 4"));
    CHECK_THROWS_WITH(plan::add_step(plan, meaning(plan::StepKind::hide, {1, 1})),
                      Catch::Matchers::ContainsSubstring("twice"));
    CHECK_THROWS_WITH(plan::add_step(plan, meaning(plan::StepKind::remove, {0})),
                      Catch::Matchers::ContainsSubstring("in no group"));
    CHECK(plan::change(plan, plan::PlaceFragment{1, any_pose(1)}, {}) == plan::PlanHistory::Outcome::locked);
    CHECK(plan::change(plan, plan::PlaceFragment{2, any_pose(1)}, {}) == plan::PlanHistory::Outcome::locked);
    CHECK_THROWS_WITH(plan::find_fragment(plan, "z"), Catch::Matchers::ContainsSubstring("no fragment 'z'"));
    CHECK(plan::plan_text(plan) == text);
}

TEST_CASE("what is no plan of ours is refused in one line that says what to do") {
    const std::string text = plan::plan_text(eventful());
    const auto refusal = [](const std::string& damaged) -> std::string {
        try {
            plan::read_plan_text(damaged, "case.json");
        } catch (const Error& error) {
            CHECK(error.message().find('\n') == std::string::npos);
            CHECK(error.message().starts_with("case.json: "));
            return error.message();
        }
        return "";
    };
    for (std::size_t length = 1; length + 2 < text.size(); length += 37)
        CHECK_THAT(refusal(text.substr(0, length)), Catch::Matchers::ContainsSubstring("is cut short"));
    CHECK_THAT(refusal(replaced(text, "\"version\": 1", "\"version\": 2")),
               Catch::Matchers::ContainsSubstring("version 2, but this program reads version 1; nothing was changed"));
    CHECK_THAT(refusal(replaced(text, "\"name\": \"b\"", "\"name\": \"a\"")),
               Catch::Matchers::ContainsSubstring("another fragment has"));
    CHECK_THAT(refusal(replaced(text, "\"after\": 0", "\"after\": 1")),
               Catch::Matchers::ContainsSubstring("not an earlier step"));
    CHECK_THAT(refusal(replaced(text, "\"kind\": \"lock\"", "\"kind\": \"eat\"")),
               Catch::Matchers::ContainsSubstring("'eat'"));
    CHECK_THAT(refusal(replaced(text, "\"current\": \"other\"", "\"current\": \"x\"")),
               Catch::Matchers::ContainsSubstring("'x'"));
    CHECK_THAT(refusal(replaced(text, "\"unit\": \"m\"", "\"unit\": \"mm\"")),
               Catch::Matchers::ContainsSubstring("unit \"m\""));
    CHECK_THAT(refusal(replaced(text, "\"score\": 0.8", "\"score\": \"0.8\"")),
               Catch::Matchers::ContainsSubstring("not a number"));
    CHECK_THAT(refusal("{}"), Catch::Matchers::ContainsSubstring("is not a plan"));
    CHECK_THAT(refusal("solid ascii"), Catch::Matchers::ContainsSubstring("JSON"));
}

TEST_CASE("a key that a plan does not have is refused in each of its objects, with a similar name and its line") {
    const auto refusal = [](const std::string& text) {
        try {
            plan::read_plan_text(text, "p");
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    const std::string text = plan::plan_text(eventful());
    int objects = 0;
    for (auto at = text.find('{'); at != std::string::npos; at = text.find('{', at + 1), ++objects) {
        std::string other = text;
        other.insert(at + 1, "\"colr\": 1,");
        CAPTURE(text.substr(at, 80));
        CHECK_THAT(refusal(other), Catch::Matchers::ContainsSubstring("has the unknown key 'colr'"));
    }
    CHECK(objects > 20);
    CHECK(refusal(replaced(text, "\"colour\": [", "\"colr\": 1,\n  \"colour\": [")) ==
          "p: fragments[0] has the unknown key 'colr' in line 13; did you mean 'colour'?");
}

TEST_CASE("a plan is saved whole or not at all") {
    const TemporaryFolder folder;
    const auto file = folder / "case.plan.json";
    plan::save_case_plan(eventful(), file);
    const std::string whole = file::read_whole_file(file);
    CHECK(whole == plan::plan_text(plan::load_case_plan(file)));
    // What a crash while writing leaves beside it is in nobody's way.
    file::write_whole_file(file.string() + ".part", whole.substr(0, 100));
    CHECK(plan::load_case_plan(file).steps.size() == eventful().steps.size());
    plan::save_case_plan(four(), file);
    CHECK(plan::load_case_plan(file).steps.empty());
    CHECK_FALSE(std::filesystem::exists(file.string() + ".part"));
    CHECK_THROWS_AS(plan::save_case_plan(four(), folder / "none" / "case.json"), Error);
}

TEST_CASE("a file that is gone or has changed since is named, and names of fragments stay apart") {
    const TemporaryFolder folder;
    const auto file = folder / "bone.stl";
    file::write_whole_file(file, "one");
    plan::CasePlan plan;
    plan::add_fragment(plan, "left", file, file.parent_path(), Vec3(1.0));
    CHECK(plan.fragments[0].file == "bone.stl");
    CHECK_THROWS_WITH(plan::add_fragment(plan, "left", file, file.parent_path(), Vec3(1.0)),
                      Catch::Matchers::ContainsSubstring("another name"));
    CHECK(plan::changed_files(plan, file.parent_path()).empty());
    file::write_whole_file(file, "two");
    REQUIRE(plan::changed_files(plan, file.parent_path()).size() == 1);
    CHECK_THAT(plan::changed_files(plan, file.parent_path())[0],
               Catch::Matchers::ContainsSubstring("has changed since the plan was made"));
    std::filesystem::remove(file);
    CHECK_THAT(plan::changed_files(plan, file.parent_path())[0], Catch::Matchers::ContainsSubstring("is missing"));

    // The samples of a scan may be in a file of their own.
    plan::CasePlan scanned;
    file::write_whole_file(folder / "scan.nhdr",
                           "NRRD0004\ntype: uchar\ndimension: 3\nsizes: 2 2 2\nencoding: raw\ndata file: scan.raw\n");
    file::write_whole_file(folder / "scan.raw", "01234567");
    plan::add_fragment(scanned, "scan", folder / "scan.nhdr", file.parent_path(), Vec3(1.0));
    CHECK(plan::changed_files(scanned, file.parent_path()).empty());
    file::write_whole_file(folder / "scan.raw", "01234568");
    CHECK(plan::changed_files(scanned, file.parent_path()).size() == 1);
}

namespace {

/// A reconstruction with something of each kind, and numbers that have no short decimals.
reconstruction::Reconstruction jaw_of(double third) {
    reconstruction::Reconstruction all;
    reconstruction::FibulaInputs& in = all.inputs;
    in.planes = {{{third, 0.0, 0.0}, Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 1.0)},
                 {{0.04, third, 0.0}, {}, {}},
                 {{0.08, 0.0, 0.0}, Vec3(0.6, 0.8, 0.0), {}}};
    in.line_point = {0.0, third, -0.1};
    in.leg = reconstruction::Leg::right;
    in.along_line = {0.08 + third, 0.12};
    in.roll = 1.0 / 3.0;
    in.reversed = true;
    in.resection = reconstruction::Resection::after_first;
    in.from_curve = reconstruction::CurveSplit{{{0.0, 0.0, third}, {0.04, 0.0, 0.0}}, third * 1e-3, 1e-3};
    all.donor = {"fibula.stl", 5};
    all.jaw = reconstruction::MeshFile{"jaw.stl", 6};
    all.tumour = reconstruction::MeshFile{"tumour.stl", 7};
    all.guides = {{"chin", true, 2, 1, third, "P-0012", {"guide-chin.stl", 8}},
                  {"leg", false, 0, 3, -third, "", {"guide-leg.stl", 9}}};
    all.flap.vessels = {{"a", reconstruction::VesselKind::artery, 1.5e-3, {{0, 0, third}, {0, 0, 0.2}}},
                        {"v", reconstruction::VesselKind::vein, 2e-3, {{0, 0, 0.1}, {0, third, 0.2}}}};
    all.flap.perforators = {{"p", {third, 0.0, 0.1}}};
    all.flap.sites = {{"facial", reconstruction::VesselKind::artery, {0.0, 0.05, third}}};
    all.flap.plates = {{"plate", 7e-3, 2.5e-3, {{0, 0, 0}, {third, 0, 0}}, {{0, 0, 1}, {0, 0, 1}}, {}}};
    all.flap.plates[0].screws = {{{0.0, third, 0.0}, {0.0, 0.6, 0.8}, 12e-3, 2e-3}};
    all.flap.plates[0].laid = {-third, 3};
    all.flap.plates.push_back(
        {"of another hand", 7e-3, 2.5e-3, {{0, 0, 0}, {third, 0, 0}}, {{0, 0, 1}, {0, 0, 1}}, {}});
    all.flap.implants = {{"molar", {third, 0.0, 0.0}, {0.0, 0.0, -1.0}, 4e-3, 14e-3}};
    all.flap.paddle = reconstruction::SkinPaddle{{0.0, third, 0.1}, 0.06, 0.04};
    all.flap.margin = third;
    return all;
}

plan::PlanStep reconstructing(std::vector<int> pieces, double third) {
    plan::PlanStep step = meaning(plan::StepKind::reconstruct, std::move(pieces));
    step.reconstruction = std::make_shared<reconstruction::Reconstruction>(jaw_of(third));
    return step;
}

}  // namespace

TEST_CASE("a plan carries a whole reconstruction, to the bit, and undo takes it back") {
    plan::CasePlan plan = four();
    plan::add_step(plan, reconstructing({0, 1}, 0.1 / 3.0));
    plan::add_step(plan, reconstructing({0, 1}, 0.1 / 7.0));
    const plan::CasePlan again = plan::read_plan_text(plan::plan_text(plan), "p");
    CHECK(plan::plan_text(again) == plan::plan_text(plan));
    const auto found = plan::state_of(again).reconstruction;
    REQUIRE(found);
    const reconstruction::Reconstruction meant = jaw_of(0.1 / 7.0);
    // Every number of every part is in the text that is compared; here is one of each, against a text that leaves it out.
    CHECK(found->inputs.planes[1].origin == meant.inputs.planes[1].origin);
    CHECK_FALSE(found->inputs.planes[1].normal);
    CHECK(found->inputs.planes[0].y == meant.inputs.planes[0].y);
    CHECK(found->inputs.along_line == meant.inputs.along_line);
    CHECK(found->inputs.roll == meant.inputs.roll);
    CHECK(found->inputs.reversed);
    CHECK(found->inputs.leg == reconstruction::Leg::right);
    CHECK(found->inputs.resection == reconstruction::Resection::after_first);
    CHECK(found->inputs.from_curve->joints == meant.inputs.from_curve->joints);
    CHECK(found->tumour->hash == 7);
    CHECK(found->flap.vessels[1].kind == reconstruction::VesselKind::vein);
    CHECK(found->flap.vessels[1].points == meant.flap.vessels[1].points);
    CHECK(found->flap.perforators[0].at == meant.flap.perforators[0].at);
    CHECK(found->flap.sites[0].at == meant.flap.sites[0].at);
    CHECK(found->flap.plates[0].screws[0].axis == meant.flap.plates[0].screws[0].axis);
    REQUIRE(found->flap.plates[0].laid);
    CHECK(found->flap.plates[0].laid->height == meant.flap.plates[0].laid->height);
    CHECK(found->flap.plates[0].laid->screws_per_segment == 3);
    CHECK_FALSE(found->flap.plates[1].laid);
    CHECK(found->flap.implants[0].head == meant.flap.implants[0].head);
    CHECK(found->flap.paddle->at == meant.flap.paddle->at);
    CHECK(found->flap.margin == meant.flap.margin);
    REQUIRE(plan::change(plan, plan::UndoStep{}, {}) == plan::PlanHistory::Outcome::done);
    CHECK(plan::state_of(plan).reconstruction->flap.margin == 0.1 / 3.0);
    REQUIRE(plan::change(plan, plan::UndoStep{}, {}) == plan::PlanHistory::Outcome::done);
    CHECK_FALSE(plan::state_of(plan).reconstruction);
}

TEST_CASE("each alternative of a reconstruction shows its own pieces") {
    plan::CasePlan plan = four();
    plan::add_step(plan, reconstructing({0, 1}, 0.01));
    plan::add_step(plan, meaning(plan::StepKind::hide, {0}));
    plan.alternatives.push_back({"other", plan.place()});
    plan.current = 1;
    plan::add_step(plan, reconstructing({2, 3}, 0.02));
    const auto hidden = [&](int n) { return plan::state_of(plan).arrangement.is_hidden(n); };
    CHECK((hidden(0) && hidden(1) && !hidden(2) && !hidden(3)));
    plan.current = 0;
    CHECK((hidden(0) && !hidden(1) && hidden(2) && hidden(3)));
    // A change of the same pieces, such as a plate that moved, shows nothing that was hidden.
    plan::add_step(plan, reconstructing({0, 1}, 0.03));
    CHECK((hidden(0) && !hidden(1) && hidden(2) && hidden(3)));
    // Nor does it hide what was shown beside them.
    plan::add_step(plan, meaning(plan::StepKind::show, {2}));
    plan::add_step(plan, reconstructing({0, 1}, 0.04));
    CHECK((hidden(0) && !hidden(1) && !hidden(2) && hidden(3)));
}

TEST_CASE("a reconstruction that cannot be is refused with its place") {
    plan::CasePlan plan = four();
    plan::add_step(plan, reconstructing({0, 1}, 0.01));
    const std::string text = plan::plan_text(plan);
    const auto refused = [&](const std::string& what, const std::string& by, const std::string& says) {
        CHECK_THROWS_WITH(plan::read_plan_text(replaced(text, what, by), "p"),
                          Catch::Matchers::ContainsSubstring(says));
    };
    refused("\"right\"", "\"middle\"", "must have the 'leg'");
    refused("\"kind\": \"vein\"", "\"kind\": \"nerve\"", "steps[0].reconstruction: vessels[1] must have");
    refused("\"radius_m\": 0.0015", "\"radius_m\": -1", "not above 0");
    refused("\"thickness_m\": 0.0025", "\"thickness_m\": \"thin\"", "not a number");
    refused("\"name\": \"v\"", "\"name\": \"a\"", "two vessels of the name 'a'");
    refused("\"reconstruction\": {", "\"rebuilt\": {", "unknown key 'rebuilt'");
    refused("\"margin_m\": 0.01", "\"margin_m\": 1e9", "beyond 100 m");
    // A name that no file could hold, before it is written.
    reconstruction::Flap flap;
    flap.sites = {{"\xff artery", reconstruction::VesselKind::artery, Vec3(0.0)}};
    CHECK_THROWS_WITH(reconstruction::check(flap, "the plan"), Catch::Matchers::ContainsSubstring("not UTF-8"));
}
