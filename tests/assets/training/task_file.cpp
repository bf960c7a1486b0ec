// SPDX-License-Identifier: Apache-2.0
#include "assets/training/task_file.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <unistd.h>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;
namespace fs = std::filesystem;
using Catch::Matchers::ContainsSubstring;

namespace {

struct TaskScratch {
    fs::path path = fs::temp_directory_path() / ("tactus_task_" + std::to_string(::getpid()));
    TaskScratch() { fs::create_directories(path); }
    ~TaskScratch() { fs::remove_all(path); }
    fs::path write(const std::string& text) const {
        std::ofstream(path / "task.toml") << text;
        return path / "task.toml";
    }
};

const std::string plane = R"(format = 1
title  = "a cut"
bone   = "../bones/jaw.vdb"
settings = ["simulated.depth=8 mm"]
length = "20 s"

[blade]
kerf = "0.8 mm"

[cut]
kind   = "plane"
point  = "1 mm, -6 mm, 0 mm"
normal = [1, 0, 0]
feed   = [0.2, 1, 0]
depth  = "3 mm"
tolerance = "0.5 mm"
angle_tolerance = "3 deg"

[[spare]]
name   = "nerve"
file   = "nerve.nrrd"
label  = 7
margin = "1 mm"

[limits]
force = "9 N"
heat  = "2 s"
)";

std::string with(std::string text, const std::string& what, const std::string& by) {
    const auto at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), by);
}

std::string task_refusal(const std::string& text) {
    const TaskScratch folder;
    try {
        training::load_task_file(folder.write(text));
    } catch (const Error& error) {
        const std::string what = error.what();
        return what.substr(what.find("task.toml"));
    }
    return "taken";
}

}  // namespace

TEST_CASE("a task is read with its units, relative to its own folder") {
    const TaskScratch folder;
    const training::TaskFile task = training::load_task_file(folder.write(plane));
    CHECK(task.title == "a cut");
    CHECK(task.bone == folder.path.parent_path() / "bones/jaw.vdb");
    CHECK(task.patch.empty());
    CHECK(task.settings == std::vector<std::string>{"simulated.depth=8 mm"});
    CHECK(task.length == 20.0);
    CHECK(std::abs(task.blade.kerf - 0.8 * mm) < 1e-12);
    CHECK(std::abs(task.blade.length - 40 * mm) < 1e-12);
    CHECK(std::abs(task.cuts[0].angle_tolerance - 3.0 * 3.14159265358979 / 180.0) < 1e-9);
    CHECK(task.cuts[0].depth_tolerance == task.cuts[0].tolerance);
    CHECK(task.limits.force == 9.0);
    CHECK_FALSE(task.limits.time);
    CHECK(task.limits.heat == 2.0);
    REQUIRE(task.spare.size() == 1);
    CHECK(task.spare[0].file == folder.path / "nerve.nrrd");
    CHECK(task.spare[0].label == 7);
}

TEST_CASE("the axes of a cut are orthogonal, and the feed is made to lie in the plane") {
    const TaskScratch folder;
    const training::PlannedCut cut = training::load_task_file(folder.write(plane)).cuts[0];
    CHECK(std::abs(cut.feed.y - 1.0) < 1e-12);
    CHECK(std::abs(glm::dot(cut.stroke, cut.feed)) < 1e-12);
    CHECK(std::abs(std::abs(cut.normal.x) - 1.0) < 1e-12);
    CHECK(glm::length(glm::cross(cut.stroke, cut.feed) - cut.normal) < 1e-12);
    // The second name is that of older files.
    for (const char* name : {"\"line\"", "\"guide\""}) {
        const std::string text = with(
            with(with(plane, "\"plane\"", name), "point  = \"1 mm, -6 mm, 0 mm\"", "from = \"0 mm, -6 mm, -4 mm\""),
            "normal = [1, 0, 0]", "to = \"0 mm, -6 mm, 8 mm\"");
        const training::TaskFile line = training::load_task_file(folder.write(text));
        REQUIRE(line.cuts.size() == 1);
        CHECK(std::abs(line.cuts[0].half_length - 6 * mm) < 1e-12);
        CHECK(std::abs(line.cuts[0].point.z - 2 * mm) < 1e-12);
        CHECK(std::abs(line.cuts[0].stroke.z - 1.0) < 1e-12);
    }
}

TEST_CASE("a task has several cuts, each with its slot of a guide") {
    const TaskScratch folder;
    const std::string one =
        plane.substr(plane.find("[cut]\n") + 6, plane.find("[[spare]]") - plane.find("[cut]\n") - 6);
    const std::string slot =
        "slot = { wall = \"-0.4 mm\", width = \"1.3 mm\", top = \"15 mm\", bottom = \"-1 mm\", low = "
        "\"-9 mm\", high = \"8 mm\" }\n";
    const std::string ledge = with(slot, "width = \"1.3 mm\", ", "");
    const std::string guide = "[guide]\nbone = \"guide.vdb\"\nremoval = [0, -2, 0]\n";
    const auto text = [&](const std::string& first, const std::string& second) {
        return with(plane, "[cut]\n" + one,
                    guide + "[[cut]]\nname = \"A\"\n" + one + first + "[[cut]]\n" +
                        with(one, "\"1 mm, -6 mm", "\"21 mm, -6 mm") + second);
    };
    const training::TaskFile task = training::load_task_file(folder.write(text(slot, ledge)));
    REQUIRE(task.cuts.size() == 2);
    CHECK(task.cuts[0].name == "A");
    CHECK(task.cuts[1].name == "2");
    REQUIRE(task.guide);
    CHECK(task.guide->bone == folder.path / "guide.vdb");
    CHECK(task.guide->removal.y == -1.0);
    REQUIRE(task.slots.size() == 2);
    const saw::GuideSlot& first = task.slots[0];
    CHECK(glm::length(first.frame.position - task.cuts[0].point) < 1e-12);
    CHECK(glm::length(first.frame.rotate(Vec3(0.0, 1.0, 0.0)) - task.cuts[0].feed) < 1e-9);
    CHECK(glm::length(first.frame.rotate(Vec3(0.0, 0.0, 1.0)) - task.cuts[0].normal) < 1e-9);
    CHECK(first.other_wall - first.wall == Approx(1.3 * mm));
    CHECK(first.top == Approx(-15 * mm));
    CHECK(first.bottom == Approx(1 * mm));
    CHECK(std::isinf(task.slots[1].other_wall));
    CHECK(training::nearest_cut(task.cuts, Vec3(3 * mm, -5 * mm, 0.0)) == 0);
    CHECK(training::nearest_cut(task.cuts, Vec3(18 * mm, -5 * mm, 0.0)) == 1);
    // Where the planes of a wedge cross, the angle of the blade says which cut it makes.
    std::vector<training::PlannedCut> wedge(2);
    wedge[1].normal = glm::normalize(Vec3(0.0, 1.0, 0.3));
    wedge[1].feed = glm::cross(wedge[1].normal, wedge[1].stroke);
    const auto blade = [&](const training::PlannedCut& cut) {
        return Pose{cut.position(0.0, 0.0, 0.2 * mm), glm::quat_cast(cut.axes())};
    };
    CHECK(training::nearest_cut(wedge, blade(wedge[0])) == 0);
    CHECK(training::nearest_cut(wedge, blade(wedge[1])) == 1);
    CHECK(training::nearest_cut(wedge, Pose{wedge[1].position(0.0, 0.0), glm::quat_cast(wedge[0].axes())}) == 0);

    CHECK_THAT(task_refusal(with(text(slot, slot), "top = \"15 mm\"", "top = \"-3 mm\"")),
               ContainsSubstring("the mouth of the slot is not above its lower end"));
    CHECK_THAT(task_refusal(with(text(slot, slot), guide, "")), ContainsSubstring("a slot needs a table [guide]"));
    CHECK_THAT(task_refusal(with(text(slot, slot), "low = ", "lov = ")), ContainsSubstring("lov"));
    CHECK_THAT(task_refusal(with(text("", "name = \"A\"\n"), "removal = [0, -2, 0]", "removal = [0, 0, 0]")),
               ContainsSubstring("this direction is zero"));
    CHECK_THAT(task_refusal(text("", "name = \"A\"\n")), ContainsSubstring("two cuts are called 'A'"));
}

TEST_CASE("a wrong task is refused with the line of what is wrong") {
    const std::vector<std::pair<std::string, std::string>> cases{
        {with(plane, "format = 1", "format = 2"), "task.toml:1:10: the task has format 2"},
        {with(plane, "format = 1\n", ""), "task.toml:1:1: a task begins with format = 1"},
        {with(plane, "title ", "titel "), "task.toml:2:10: unknown key 'titel' in a task file; did you mean 'title'?"},
        {with(plane, "\"plane\"", "\"plan\""), "task.toml:11:10: 'plan' is neither \"plane\" nor \"line\""},
        {with(plane, "normal = [1, 0, 0]", "normal = [0, 0, 0]"), "task.toml:13:10: this direction is zero"},
        {with(plane, "normal = [1, 0, 0]", "normal = [0, 1, 0]"),
         "task.toml:14:10: the feed does not lie in the plane"},
        {with(plane, "depth  = \"3 mm\"", "depth = \"3\""), "task.toml:15:"},
        {with(plane, "depth  = \"3 mm\"", "depth = \"3 m\""), "task.toml:15:9: must be 0.1 mm to 300 mm"},
        {with(plane, "depth  = \"3 mm\"\n", ""), "task.toml:10:1: a cut needs 'depth'"},
        {with(plane, "label  = 7", "label = 0"), "task.toml:22:9: a label is a whole number from 1 to 65535"},
        {with(plane, "force = \"9 N\"", "force = \"9 mm\""), "task.toml:26:9:"},
        {with(plane, "simulated.depth=8 mm", "depth 8"), "task.toml:4:13: 'depth 8' is not NODE.PARAM=VALUE"},
        {with(plane, "[limits]", "[limit]"), "task.toml:25:1: unknown key 'limit'"},
        {with(plane, "[cut]", "[cut"), "task.toml:10:"},
    };
    for (const auto& [text, expected] : cases) {
        const std::string got = task_refusal(text);
        INFO(got << " instead of " << expected);
        CHECK(got.starts_with(expected));
    }
}

TEST_CASE("a spared structure becomes a distance with room around it") {
    const TaskScratch folder;
    volume::Grid labels{{30, 24, 20}, {5 * mm, -3 * mm, 1 * mm}, Vec3(0.5 * mm), {}};
    labels.values.assign(labels.count(), 0.0f);
    const Vec3 middle = labels.position(15, 12, 10);
    for (int k = 0; k < 20; ++k)
        for (int j = 0; j < 24; ++j)
            for (int i = 0; i < 30; ++i)
                if (glm::length(labels.position(i, j, k) - middle) < 2.6 * mm) labels.at(i, j, k) = 7.0f;
    volume::write_volume(labels, volume::WrittenType::int16, folder.path / "nerve.nrrd");
    const training::Task task = training::load_task(folder.write(plane));
    REQUIRE(task.spared.size() == 1);
    const training::SparedStructure& nerve = task.spared[0];
    CHECK(nerve.margin == 1 * mm);
    CHECK(std::abs(nerve.at(middle) + 2.5 * mm) < 0.3 * mm);
    CHECK(std::abs(nerve.at(middle + Vec3(6 * mm, 0, 0)) - 3.5 * mm) < 0.3 * mm);
    CHECK(nerve.at(middle + Vec3(0, 40 * mm, 0)) > 30 * mm);
}

TEST_CASE("a label map that is missing, or lacks the label, is refused with the line of its structure") {
    const TaskScratch folder;
    const auto refusal_of = [&] {
        try {
            training::load_task(folder.write(plane));
        } catch (const Error& error) {
            return std::string(error.what());
        }
        return std::string("taken");
    };
    CHECK(refusal_of().find("task.toml:19:1: structure 'nerve': ") != std::string::npos);
    volume::Grid labels{{4, 4, 4}, {}, Vec3(0.5 * mm), std::vector<float>(64, 1.0f)};
    volume::write_volume(labels, volume::WrittenType::int16, folder.path / "nerve.nrrd");
    CHECK(refusal_of().find("has no sample with the label 7") != std::string::npos);
}
