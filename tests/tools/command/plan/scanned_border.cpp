// SPDX-License-Identifier: Apache-2.0
// A label border through solid bone beside a true fracture: fits leave the border out, and say so.
#include "assets/bone/bone.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/constants.hpp"
#include "tests/support/catch.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

using namespace tactus;
using nlohmann::json;
using test::Outcome;

namespace {

double wave(double place, double length) { return std::sin(2.0 * pi * place / length); }

/// A bar along x, in mm. Labels 1 and 2 meet at a wavy border through it; label 3 is broken off label 2, 4.1 mm away
/// and turned by 6 degrees.
void write_bar(const std::string& path) {
    constexpr double h = 0.5;
    const auto is_bar = [](double y, double z) {
        return std::pow((y - 14.0) / 10.5, 2) + std::pow((z - 10.0) / 7.0, 2) < 1.0;
    };
    const auto border = [](double y, double z) { return 22.0 + 1.5 * wave(y, 9.0) + wave(z + 1.75 + 0.56 * y, 7.0); };
    const auto fracture = [](double y, double z) {
        return 44.0 + 1.6 * wave(y + 0.4, 8.0) * wave(z + 2.25, 9.0) + 0.9 * wave(y + z, 5.0) + 0.25 * y;
    };
    const volume::Grid grid{{152, 56, 40}, Vec3(0.0), Vec3(h * 1e-3), {}};
    std::vector<std::uint8_t> label;
    const double turn = 6.0 * pi / 180.0;
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) {
                const double x = h * i, y = h * j, z = h * k;
                std::uint8_t value = 0;
                if (is_bar(y, z) && x > 4.0 && x < fracture(y, z)) value = x < border(y, z) ? 1 : 2;
                const double dx = x - 48.0, dy = y - 15.0;
                const double u = 44.0 + std::cos(turn) * dx + std::sin(turn) * dy;
                const double v = 14.0 - std::sin(turn) * dx + std::cos(turn) * dy;
                if (is_bar(v, z) && u >= fracture(v, z) && u < 66.0) value = 3;
                label.push_back(value);
            }
    volume::write_labels(grid, label,
                         std::vector<volume::Segment>{{1, "left", {}}, {2, "middle", {}}, {3, "right", {}}}, path);
}

struct BorderFolder : test::Folder {
    std::string operator/(const std::string& name) const { return (path / name).string(); }
};

}  // namespace

TEST_CASE("fits leave the border between two labels out, say so, and join the true fracture beside it", "[slow]") {
    const BorderFolder folder;
    write_bar(folder / "labels.nrrd");
    REQUIRE(folder.tactus("import " + folder / "labels.nrrd" + " --label all -o " + folder / "bones.vdb").code == 0);
    const auto bones = bone::load_bones(folder / "bones.vdb");
    REQUIRE(bones.size() == 3);
    CHECK(bones[0].border.faces.size() > 1000);
    CHECK(bones[1].border.faces.size() == bones[0].border.faces.size() + bones[2].border.faces.size());
    CHECK(bones[2].border.faces.size() < 50);
    // What is around a bone that is imported by itself may be muscle.
    REQUIRE(folder.tactus("import " + folder / "labels.nrrd" + " --label left -o " + folder / "left.vdb").code == 0);
    CHECK(bone::load_bone(folder / "left.vdb").border.faces.empty());

    const std::string plan = folder / "bar.plan.json";
    REQUIRE(folder.tactus("plan new " + plan + " " + folder / "bones.vdb").code == 0);
    // The border fits itself from wherever the fragment is moved to.
    REQUIRE(folder.tactus("plan move " + plan + " left --pose=-2,1,0,1,0,0,0").code == 0);
    const Outcome snapped = folder.tactus("plan snap " + plan + " left middle");
    INFO(snapped.out << snapped.err);
    CHECK(snapped.code == 1);
    CHECK(snapped.out.find("left stays where it is") != std::string::npos);
    CHECK(snapped.out.find("only reproduces the scanned position") == std::string::npos);
    CHECK(snapped.out.find("mm² touch another fragment in the scan; they are left out of fits") != std::string::npos);

    const Outcome assembled = folder.tactus("plan assemble " + plan + " --json");
    INFO(assembled.out << assembled.err);
    CHECK(assembled.code == 1);
    const json found = json::parse(assembled.out);
    REQUIRE(found["placed"].size() == 1);
    CHECK(found["placed"][0]["rms_mm"].get<double>() < 0.15);
    const json& moved = found["placed"][0]["moved"];
    CHECK(moved["angle_deg"].get<double>() == Approx(6.0).margin(0.5));
    REQUIRE(found["stays"].size() == 1);
    CHECK(found["stays"][0]["fragment"] == "left");
    CHECK(found["stays"][0]["as_scanned"] == false);
    // A section of the bar, seen along it, is an ellipse; the waves make the border larger.
    const double section = pi * 10.5 * 7.0;
    for (const char* name : {"left", "middle"}) {
        CHECK(found["as_scanned_mm2"][name].get<double>() > 1.1 * section);
        CHECK(found["as_scanned_mm2"][name].get<double>() < 2.2 * section);
    }
    CHECK(found["as_scanned_mm2"].value("right", 0.0) < 10.0);
}

TEST_CASE("no paint covers what touches in the scan, and the mark stays in the painted file", "[slow]") {
    const BorderFolder folder;
    write_bar(folder / "labels.nrrd");
    REQUIRE(folder.tactus("import " + folder / "labels.nrrd" + " --label all -o " + folder / "bones.vdb").code == 0);
    const auto surface = [&](const std::string& bone, const std::string& how) {
        const Outcome done = folder.tactus("fracture-surface " + bone + how + " --json");
        INFO(how << done.out << done.err);
        REQUIRE(done.code <= 1);
        return json::parse(done.out);
    };
    // Proposed by roughness, by the neighbour, and painted by hand over the whole bar.
    const std::string left = folder / "bones.vdb#left", middle = folder / "bones.vdb#middle";
    folder.write("all.json", R"({"radius_mm": 90, "paint": [[20, 14, 10]]})");
    for (const json& face : surface(left, " -o " + folder / "a.json")["faces"])
        CHECK(face["middle_mm"][0].get<double>() < 10.0);  // the rim of its other end
    CHECK(surface(left, " -o " + folder / "b.json --facing " + middle)["faces"].empty());
    const json painted = surface(middle, " -o " + folder / "painted.vdb --paint " + folder / "all.json");
    CHECK(painted["as_scanned_mm2"].get<double>() > 200.0);
    const bone::Bone kept = bone::load_bone(folder / "painted.vdb");
    std::size_t marked = 0;
    for (const contact::SurfacePoint& p : kept.points) {
        const bool is_far = p.position.x > 27e-3 && p.position.x < 40e-3;
        if (is_far) CHECK(p.label == contact::surface_label::fracture);
        marked += p.label == contact::surface_label::as_scanned;
    }
    CHECK(marked > 500);
    CHECK(kept.border.faces.size() > 1000);
    // Nor does a stroke of 'snap'.
    folder.write("strokes.json", R"({"radius_mm": 4, "moving": [[22, 14, 10]], "fixed": [[22, 14, 10]]})");
    const Outcome snapped = folder.tactus("snap " + left + " " + middle + " --paint " + folder / "strokes.json");
    CHECK(snapped.code == 2);
    CHECK(snapped.err.find("are no fracture: they touch another fragment in the scan") != std::string::npos);
}
