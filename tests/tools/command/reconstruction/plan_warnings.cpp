// SPDX-License-Identifier: Apache-2.0
// One list of warnings per plan, in every verb.
#include "tests/support/catch.hpp"
#include "tests/tools/command/reconstruction/jaw_case.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <string>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;
using nlohmann::json;

namespace {

struct WarnedCase : test::JawCase {
    test::Outcome plan_verb(const std::string& verb, const std::string& rest = "") const {
        return folder.tactus("plan " + verb + " " + plan + " " + rest);
    }
    json read(const std::string& verb, const std::string& rest = "--json") const {
        return json::parse(plan_verb(verb, rest).out);
    }
    json warnings(const std::string& verb) const { return read(verb)["warnings"]; }
    /// Moves a segment by so much, mm, from where it is.
    void shift(const std::string& name, double x, double y, double z) const {
        const json shown = read("show");
        for (const json& one : shown["fragments"]) {
            if (one["name"] != name) continue;
            const json &p = one["pose"]["position_mm"], &q = one["pose"]["quaternion_wxyz"];
            std::string pose;
            for (const double part : {p[0].get<double>() + x, p[1].get<double>() + y, p[2].get<double>() + z,
                                      q[0].get<double>(), q[1].get<double>(), q[2].get<double>(), q[3].get<double>()})
                pose += (pose.empty() ? "" : ",") + json(part).dump();
            REQUIRE(plan_verb("move", name + " --pose " + pose).code == 0);
        }
    }
};

const json* find_code(const json& list, const std::string& code) {
    const auto found = std::find_if(list.begin(), list.end(), [&](const json& w) { return w["code"] == code; });
    return found == list.end() ? nullptr : &*found;
}

}  // namespace

TEST_CASE("a reconstruction whose pieces are at their planned place passes the check without any fit", "[slow]") {
    const WarnedCase made;
    REQUIRE(made.run(made.inputs()).code == 0);
    const test::Outcome checked = made.plan_verb("check");
    INFO(checked.out << checked.err);
    CHECK(checked.code == 0);
    CHECK_THAT(checked.out, ContainsSubstring("all pieces are where they are planned or accepted"));
    CHECK(made.plan_verb("accept", "segment-1 --by plan").code == 0);
}

TEST_CASE("a segment that lies away from its planned place is one and the same warning in every verb", "[slow]") {
    const WarnedCase made;
    REQUIRE(made.run(made.inputs()).code == 0);
    // Before anything is measured, show has what needs no surfaces.
    made.shift("segment-1", 0.0, 0.0, 5.0);
    const json early = made.read("show");
    REQUIRE(find_code(early["warnings"], "away-from-plan"));
    CHECK(early["measured"] == false);
    const json& away = *find_code(early["warnings"], "away-from-plan");
    CHECK(away["object"] == "segment-1");
    CHECK(away["fault"] == true);
    CHECK_THAT(
        away["text"].get<std::string>(),
        ContainsSubstring("segment-1 lies 5.00 mm and 0.00° from its planned place; cuts, tables and the order of "
                          "the operation are locked to the planned place"));
    const json checked = made.warnings("check");
    CHECK(made.plan_verb("check").code == 1);
    CHECK(made.warnings("reach") == checked);
    const json late = made.read("show");
    CHECK(late["measured"] == true);
    CHECK(late["warnings"] == checked);
    CHECK_THAT(made.plan_verb("accept", "segment-1 --by plan").err, ContainsSubstring("--by hand accepts it"));
    REQUIRE(made.plan_verb("accept", "segment-1 --by hand").code == 0);
    const json accepted = made.warnings("check");
    INFO(accepted);
    CHECK_FALSE(find_code(accepted, "away-from-plan"));
    REQUIRE(find_code(accepted, "accepted-away"));
    CHECK((*find_code(accepted, "accepted-away"))["fault"] == false);
    CHECK(made.plan_verb("check").code == 0);
}

TEST_CASE("a gap between segments and a segment in another are faults, once each", "[slow]") {
    const WarnedCase made;
    REQUIRE(made.run(made.inputs()).code == 0);
    // Across the joint: towards the jaw, so that it opens at the other segment.
    made.shift("segment-1", -4.0, 1.0, 0.0);
    const json found = made.warnings("check");
    INFO(found);
    CHECK((find_code(found, "joint-gap") || find_code(found, "overlap")));
    for (const char* code : {"away-from-plan", "joint-gap", "overlap"}) {
        std::vector<std::string> texts;
        for (const json& w : found)
            if (w["code"] == code) texts.push_back(w["text"]);
        std::ranges::sort(texts);
        CHECK(std::ranges::adjacent_find(texts) == texts.end());
    }
}

TEST_CASE("a segment that lies in the leg still is named, and nothing is measured from there", "[slow]") {
    const WarnedCase made;
    REQUIRE(made.run(made.inputs()).code == 0);
    REQUIRE(made.plan_verb("undo").code == 0);
    const json found = made.warnings("check");
    INFO(found);
    REQUIRE(find_code(found, "not-placed"));
    CHECK((*find_code(found, "not-placed"))["object"] == "segment-2");
    CHECK_FALSE(find_code(found, "span-stretched"));
    CHECK_FALSE(find_code(found, "away-from-plan"));
}

TEST_CASE("two cuts that take more bone than there is between two segments are a warning", "[slow]") {
    const WarnedCase made;
    json inputs = made.inputs();
    inputs["kerf_mm"] = 2.0;
    inputs["between_space_mm"] = 1.0;
    const test::Outcome done = made.run(inputs);
    REQUIRE(done.code == 0);
    CHECK_THAT(done.out, ContainsSubstring("1.00 mm of bone along the line, and two cuts of 2.00 mm take 4.00 mm"));
    CHECK(find_code(made.warnings("show"), "wide-kerf"));
    inputs["between_space_mm"] = 4.0;
    const std::string file = made.folder.write("wider.json", inputs.dump()).string();
    CHECK_FALSE(
        find_code(json::parse(made.folder.tactus("plan fibula " + file + " --json").out)["warnings"], "wide-kerf"));
}

TEST_CASE("hardware that meets no bone, stands out of it, or meets other hardware is one warning each", "[slow]") {
    const WarnedCase made;
    REQUIRE(made.run(made.inputs()).code == 0);
    REQUIRE(made.plan_verb("implant", "good --at 0 -40 5 --axis 0 0 -1 --length 8").code == 0);
    REQUIRE(made.plan_verb("implant", "off --at 0 -40 40 --axis 0 0 1").code == 0);
    REQUIRE(made.plan_verb("implant", "out --at 12 -38 4 --axis 0 0 -1 --length 20").code == 0);
    REQUIRE(made.plan_verb("implant", "same --at 12.5 -38 4 --axis 0 0 -1 --length 20").code == 0);
    const json found = made.warnings("check");
    INFO(found);
    std::string texts;
    for (const json& w : found) texts += w["code"].get<std::string>() + ": " + w["text"].get<std::string>() + "\n";
    CHECK_THAT(texts, ContainsSubstring("outside-bone: implant 'off' meets no bone"));
    CHECK_THAT(texts, ContainsSubstring("leaves-bone: implant 'out' leaves the bone"));
    CHECK_THAT(texts, !ContainsSubstring("bone: implant 'good'"));
    int meetings = 0;
    for (const json& w : found) meetings += w["code"] == "near-hardware";
    CHECK(meetings == 1);
}
