// SPDX-License-Identifier: Apache-2.0
// Which edits let the force on a hand fade: every one that may change the force in one step, and no other.
#include "assets/bone/bone.hpp"
#include "graph/node/assets.hpp"
#include "tests/engine/chaos.hpp"
#include "tests/engine/column_tap.hpp"
#include "tests/engine/live_case.hpp"
#include "tests/engine/repeat.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/node_harness.hpp"
#include "tests/support/times.hpp"
#include "tests/support/virtual_clock.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

using namespace tactus;
using namespace tactus::test;

namespace {

/// A patch with one value for each thing that an edit may change.
class Described {
public:
    explicit Described(const std::map<std::string, std::string>& changes = {}) {
        for (const auto& [key, value] : changes) values_.at(key) = value;
    }

    std::string toml() const {
        const auto& v = values_;
        return "quantum = \"1 ms\"\nwires = [\"hand.pose -> spring.device\", \"place.pose -> spring.object" +
               v.at("mode") +
               "\", \"spring.wrench -> sum.in1\", \"hand.pose -> dial.pose\", \"dial.wrench -> sum.in2\", " +
               "\"hand.pose -> blade.pose\", \"bone -> blade.bone\", \"blade.wrench -> sum.in3\", \"" + v.at("last") +
               "sum.out -> out.wrench" + v.at("delay") + "\"]\n[assets]\nbone = \"" + v.at("bone") +
               "\"\n[groups.hand]\nrate = \"1 kHz\"\nlatency = \"" + v.at("hand latency") +
               "\"\n[groups.contact]\nrate = \"" + v.at("rate") + "\"\nlatency = \"" + v.at("latency") +
               "\"\n[nodes]\nhand = {type = \"device_input\", group = \"hand\", device = \"simulated\"}\n"
               "place = {type = \"chaos\", rate = \"60 Hz\"}\n"
               "spring = {type = \"spring\", group = \"contact\", stiffness = \"" +
               v.at("stiffness") + "\"}\ndial = {type = \"dial\", group = \"contact\", notches = " + v.at("notches") +
               "}\nblade = {type = \"blade_contact\", group = \"contact\"}\nsum = {type = \"wrench_sum\", group = \"" +
               v.at("sum group") + "\"}\nout = {type = \"device_output\", group = \"hand\", device = \"simulated\", " +
               "max_force = \"" + v.at("max_force") + "\", recover = " + v.at("recover") + "}\n" + v.at("more");
    }

private:
    std::map<std::string, std::string> values_{{"mode", ""},
                                               {"delay", ""},
                                               {"last", ""},
                                               {"bone", "ball.vdb"},
                                               {"hand latency", "1 ms"},
                                               {"rate", "1 kHz"},
                                               {"latency", "1 ms"},
                                               {"stiffness", "0.001 N/mm"},
                                               {"notches", "12"},
                                               {"sum group", "contact"},
                                               {"max_force", "10 N"},
                                               {"recover", "0"},
                                               {"more", ""}};
};

/// Whether forces fade when the second patch takes over.
bool fades_between(const std::string& before, const std::string& after) {
    run::EngineOptions options;
    options.seconds = 0.1;
    run::Engine engine(compile_text(before), options);
    engine.schedule(compile_text(after), 50 * ms);
    return std::ranges::any_of(engine.groups(), [](const auto& group) {
        return group->scheduled.size() > 1 && group->scheduled[1]->changes_force;
    });
}

}  // namespace

TEST_CASE("an edit fades the force when it may change it in one step, and only then") {
    const auto folder = scratch("force-path");
    std::filesystem::create_directories(folder);
    bone::Bone bone = *std::static_pointer_cast<const bone::Bone>(sample_asset(AssetLoader<bone::Bone>::name));
    bone::save_bone(bone, folder / "ball.vdb");
    std::filesystem::copy_file(folder / "ball.vdb", folder / "copy.vdb");
    bone.density.at(0, 0, 0) += 1.0f;
    bone::save_bone(bone, folder / "other.vdb");
    const std::string ball = folder / "ball.vdb";
    const auto with = [&](std::map<std::string, std::string> changes) {
        changes.try_emplace("bone", ball);
        return Described(changes).toml();
    };
    const std::string base = with({});
    struct Edit {
        std::map<std::string, std::string> changes;
        bool fades;
    };
    const std::vector<Edit> edits{
        {{}, false},
        {{{"latency", "3 ms"}}, true},
        {{{"hand latency", "2 ms"}}, true},
        {{{"rate", "500 Hz"}}, true},
        {{{"mode", " as linear"}}, true},
        {{{"delay", " as delay 2"}}, true},
        {{{"sum group", "hand"}}, true},
        {{{"notches", "24"}}, true},
        {{{"max_force", "5 N"}}, true},
        {{{"bone", folder / "other.vdb"}}, true},
        {{{"bone", folder / "copy.vdb"}}, false},
        {{{"stiffness", "0.002 N/mm"}}, false},
        {{{"recover", "1"}}, false},
        {{{"last", "sum.out -> ear.in\", \""},
          {"more", "ear = {type = \"probe\", rate = \"100 Hz\"}\nelse = {type = \"chaos\", rate = \"9 Hz\"}\n"}},
         false},
        {{{"last", "other.wrench -> sum.in4\", \"hand.pose -> other.pose\", \""},
          {"more", "other = {type = \"planted\", group = \"contact\"}\n"}},
         true}};
    for (const Edit& edit : edits) {
        const std::string after = with(edit.changes);
        CAPTURE(after);
        CHECK(fades_between(base, after) == edit.fades);
        CHECK(fades_between(after, base) == edit.fades);
    }
    std::filesystem::remove_all(folder);
}

TEST_CASE("an edit fades no hand but those whose force it may change") {
    const auto text = [](const std::string& stiffer) {
        PatchText patch;
        for (const std::string hand : {"left", "right"}) {
            patch.nodes.insert(patch.nodes.end(), {{hand + "_in", "device_input", "1 kHz", {{"device", hand}}},
                                                   {hand + "_out", "device_output", "500 Hz", {{"device", hand}}}});
            patch.nodes[patch.nodes.size() - 2].rate = patch.nodes.back().rate = hand == "left" ? "1 kHz" : "500 Hz";
            patch.nodes.push_back({hand + "_dial", "dial", "1 kHz", {{"notches", hand == stiffer ? "24" : "12"}}});
            patch.wires.insert(patch.wires.end(), {hand + "_in.pose -> " + hand + "_dial.pose",
                                                   hand + "_dial.wrench -> " + hand + "_out.wrench"});
            patch.extra += "[devices." + hand + "]\ndriver = \"simulated\"\n";
        }
        return patch.toml();
    };
    run::EngineOptions options;
    options.seconds = 0.1;
    run::Engine engine(compile_text(text("")), options);
    engine.schedule(compile_text(text("right")), 50 * ms);
    for (const auto& group : engine.groups())
        CHECK(group->scheduled.at(1)->changes_force == (group->plan->name == "500 Hz"));
}

TEST_CASE("a discrete parameter is set while forces are held off, a request at once", "[virtual]") {
    const std::string text =
        "wires = [\"hand.pose -> dial.pose\", \"hand.pose -> spring.device\", \"place.pose -> spring.object\",\n"
        "\"spring.wrench -> sum.in1\", \"dial.wrench -> sum.in2\", \"sum.out -> out.wrench\"]\n"
        "[devices.left]\ndriver = \"left\"\n[nodes]\nhand = {type = \"device_input\", rate = \"1 kHz\"}\n"
        "dial = {type = \"dial\", rate = \"500 Hz\"}\nplace = {type = \"still\", rate = \"1 kHz\"}\n"
        "spring = {type = \"spring\", rate = \"1 kHz\", stiffness = \"0.2 N/mm\"}\n"
        "sum = {type = \"wrench_sum\", rate = \"1 kHz\"}\nout = {type = \"device_output\", rate = \"1 kHz\"}\n";
    for (const bool is_request : {false, true}) {
        CAPTURE(is_request);
        const VirtualClock clock;
        WatchedHand& hand = watched_hand("left");
        double asked_at = 0.0, holds_at = 0.0;
        const LiveOutcome o = run_case(
            {text, 30.0,
             [&](run::Engine& engine) {
                 asked_at = hand.logical_s;
                 holds_at = seconds(engine.set(is_request ? "out" : "dial", is_request ? "recover" : "notches", "7"));
             },
             [&](run::Engine&) { return hand.logical_s > asked_at + 0.3; }},
            hand);
        CHECK(o.faults.empty());
        double least = 1e9;
        for (const auto& given : hand.given())
            if (given.ns > o.done_ns && given.ns < o.stopped_ns) least = std::min(least, given.force_N);
        CHECK(hand.force_at(o.done_ns) == Approx(0.4));
        CHECK(hand.force_at(o.stopped_ns) == Approx(0.4));
        CHECK((least == 0.0) == !is_request);
        CHECK(holds_at - asked_at < (is_request ? 5.5e-3 : 25e-3));
    }
}
