// SPDX-License-Identifier: Apache-2.0
// A patch with errors at the bench: what is shown of it, and how it is repaired.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/run_command.hpp"
#include "tests/tools/window/broken_patch.hpp"
#include "tools/window/document/workbench.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

using namespace tactus;
using namespace tactus::run;
using namespace tactus::window;
using tactus::test::broken_patch;
using tactus::test::Folder;

namespace {

RunChoice broken_choice(const Folder& folder, const std::string& text) {
    RunChoice choice;
    choice.patch = folder.write("broken.toml", text).string();
    choice.out = folder.path / "out";
    choice.audio = "file";
    return choice;
}

const PictureNode& node_of(const Workbench& bench, const std::string& name) {
    const int index = bench.picture().find(name);
    REQUIRE(index >= 0);
    return bench.picture().nodes[static_cast<std::size_t>(index)];
}

const Fault& fault_of(const Workbench& bench, const std::string& part) {
    const auto found =
        std::ranges::find_if(bench.faults(), [&](const Fault& f) { return f.message.find(part) != std::string::npos; });
    REQUIRE(found != bench.faults().end());
    return *found;
}

}  // namespace

TEST_CASE("a patch with errors shows all its nodes and wires, and lists every error with its place") {
    const Folder folder;
    const Workbench bench(broken_choice(folder, broken_patch));
    CHECK(bench.is_broken());
    // The compiler alone stops at two of them.
    REQUIRE(bench.faults().size() == 3);
    for (const char* name : {"hand", "ball", "hand_out", "tone", "speaker", "depth"}) node_of(bench, name);
    CHECK(bench.picture().wires.size() == 5);
    CHECK(node_of(bench, "ball").is_at_fault);
    CHECK(node_of(bench, "tone").is_at_fault);
    CHECK_FALSE(node_of(bench, "speaker").is_at_fault);
    CHECK(fault_of(bench, "stiffness").node == "ball");
    CHECK(fault_of(bench, "stiffness").param == "stiffness");
    CHECK(bench.line(fault_of(bench, "stiffness").line) == "stiffness = \"0.8 N/m/s\"");
    CHECK(fault_of(bench, "'sin'").suggestion == "sine");
    const Fault& wire = fault_of(bench, "penetraton");
    REQUIRE(wire.wire);
    CHECK(wire.wire->to_node == "depth");
    CHECK(wire.suggestion == "penetration");
    const auto broken =
        std::ranges::find_if(bench.picture().wires, [](const PictureWire& w) { return !w.fault.empty(); });
    REQUIRE(broken != bench.picture().wires.end());
    CHECK(node_of(bench, "depth").name == bench.picture().nodes[static_cast<std::size_t>(broken->to)].name);
}

TEST_CASE("errors are repaired one by one, and after the last one the patch compiles") {
    const Folder folder;
    Workbench bench(broken_choice(folder, broken_patch));
    REQUIRE(bench.faults().size() == 3);
    REQUIRE(bench.correct(fault_of(bench, "'sin'")));
    CHECK(bench.faults().size() == 2);
    const Fault wire = fault_of(bench, "penetraton");
    REQUIRE(bench.replace_line(wire.line, "  \"ball.penetration -> depth.in\","));
    REQUIRE(bench.faults().size() == 1);
    REQUIRE(bench.set("ball", "stiffness", "0.8 N/mm"));
    CHECK_FALSE(bench.is_broken());
    REQUIRE(bench.plan());
    CHECK(bench.plan()->nodes.size() == 6);
    REQUIRE(bench.undo());
    CHECK(bench.faults().size() == 1);
    REQUIRE(bench.redo());
    REQUIRE(bench.save());
    CHECK_NOTHROW(bench.check_saved());
}

TEST_CASE("an edit that adds an error to a patch with errors and repairs none is refused") {
    const Folder folder;
    Workbench bench(broken_choice(folder, broken_patch));
    const std::string text = bench.editor().text();
    CHECK_FALSE(bench.set("hand", "no_such_thing", "1"));
    CHECK(bench.editor().text() == text);
    // One that is only another error of the same line repairs nothing for a person, but is a step on the way.
    CHECK(bench.set("ball", "stiffness", "0.8 mm"));
    CHECK(bench.faults().size() == 3);
}

TEST_CASE("lines that are no TOML leave the rest of the patch in sight") {
    const Folder folder;
    std::string text = tactus::test::sound_patch;
    text.replace(text.find("stiffness = \"0.8 N/mm\""), 22, "stiffness = \"0.8 N/mm");
    Workbench bench(broken_choice(folder, text));
    REQUIRE(bench.faults().size() == 1);
    CHECK(bench.picture().nodes.size() == 6);
    CHECK(node_of(bench, "ball").is_at_fault);
    CHECK(bench.line(bench.faults()[0].line) == "stiffness = \"0.8 N/mm");
    // The text of nodes cannot be edited meanwhile, and nothing is lost by an attempt.
    REQUIRE(bench.replace_line(bench.faults()[0].line, "stiffness = \"0.8 N/mm\""));
    CHECK_FALSE(bench.is_broken());
    CHECK(bench.editor().text() == tactus::test::sound_patch);
}

TEST_CASE("a repair from outside clears the errors of a patch") {
    const Folder folder;
    Workbench bench(broken_choice(folder, broken_patch));
    bench.tend();
    REQUIRE(bench.is_broken());
    folder.write("broken.toml", tactus::test::sound_patch);
    const auto clears = [&] {
        for (int i = 0; i < 100 && bench.is_broken(); ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
            bench.tend();
        }
        return !bench.is_broken();
    };
    REQUIRE(clears());
    CHECK(bench.plan());
    CHECK(bench.editor().is_saved());
}

TEST_CASE("a sub-patch with errors is one node at fault, and the rest of the patch is shown as it is") {
    const Folder folder;
    folder.write("part.toml",
                 "[outputs]\nout = \"tone.signal\"\n[nodes.tone]\ntype = \"sine\"\nrate = \"outer\"\nno = 1\n");
    Workbench bench(broken_choice(folder,
                                  "wires = [\"part.out -> half.in\"]\n[nodes.part]\ntype = \"patch:part.toml\"\n"
                                  "rate = \"48 kHz\"\n[nodes.half]\ntype = \"gain\"\nrate = \"48 kHz\"\n"
                                  "[nodes.alone]\ntype = \"sine\"\nrate = \"48 kHz\"\n"));
    REQUIRE(bench.faults().size() == 1);
    CHECK(bench.faults()[0].node == "part");
    CHECK(bench.faults()[0].file.filename() == "part.toml");
    CHECK(bench.faults()[0].line == 0);
    CHECK(node_of(bench, "part").is_at_fault);
    CHECK(node_of(bench, "half").lacks.find("part") != std::string::npos);
    CHECK(node_of(bench, "alone").lacks.empty());
    bench.tend();
    folder.write("part.toml", "[outputs]\nout = \"tone.signal\"\n[nodes.tone]\ntype = \"sine\"\nrate = \"outer\"\n");
    for (int i = 0; i < 100 && bench.is_broken(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        bench.tend();
    }
    CHECK_FALSE(bench.is_broken());
}

TEST_CASE("a patch whose errors lie in no line of it shows its nodes, and none runs") {
    const Folder folder;
    RunChoice choice = broken_choice(folder, tactus::test::sound_patch);
    choice.overrides.settings = {"nobody.gain=2"};
    const Workbench bench(choice);
    REQUIRE(bench.faults().size() == 1);
    CHECK(bench.faults()[0].line == 0);
    CHECK(bench.picture().nodes.size() == 6);
    CHECK_FALSE(bench.plan());
}
