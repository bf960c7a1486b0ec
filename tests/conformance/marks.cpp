// SPDX-License-Identifier: Apache-2.0
// Points of 3D Slicer and transforms of ITK, taken into a plan.
#include "assets/file/whole_file.hpp"
#include "tests/conformance/cases.hpp"
#include "tests/support/places.hpp"
#include "tests/tools/box_stl.hpp"

#include <fmt/format.h>

#include <cmath>

namespace tactus::conformance {

namespace {

using Text = std::string;

/// A plan of one box beside the file of the case.
void make_plan(const fs::path& path) {
    file::write_whole_file(path.parent_path() / "box.stl", test::box_stl(Vec3(0.0), Vec3(20.0, 20.0, 20.0)));
    by_command(path, {"plan", "new", "case.plan.json", "box.stl"});
}

std::function<void(const fs::path&)> beside_plan(const Text& content) {
    return [=](const fs::path& path) {
        make_plan(path);
        file::write_whole_file(path, content);
    };
}

Text itk(const Text& type, const Text& parameters, const Text& fixed = "0 0 0") {
    return "#Insight Transform File V1.0\n#Transform 0\nTransform: " + type + "\nParameters: " + parameters +
           "\nFixedParameters: " + fixed + "\n";
}

/// The map to the space before the motion: x before = M x after + t. A quarter turn about z, and 10 mm.
const Text quarter = "0 -1 0 1 0 0 0 0 1 10 0 0";

Text is_quarter(const Json& found) {
    // The motion is its inverse: the origin goes to M^T (0 - t) = (0, 10, 0).
    const Json& pose = found["fragments"][0]["pose"];
    const Json& at = pose["position_mm"];
    for (std::size_t n = 0; n < 3; ++n)
        if (std::abs(at[n].get<double>() - (n == 1 ? 10.0 : 0.0)) > 1e-6) return "the place is " + pose.dump();
    return "";
}

/// A transform in HDF5, as 'plan export' writes it: of the box at the pose that `is_quarter` expects.
void write_h5(const fs::path& path) {
    make_plan(path);
    file::write_whole_file(path.parent_path() / "q.tfm", itk("AffineTransform_double_3_3", quarter));
    by_command(path, {"plan", "move", "case.plan.json", "box", "--transform", "q.tfm"});
    by_command(path, {"plan", "export", "case.plan.json", "--out", "out", "--transform-format", "h5"});
    fs::copy_file(path.parent_path() / "out/box.h5", path);
    fs::remove_all(path.parent_path() / "out");
    fs::remove(path.parent_path() / "case.plan.json");
    by_command(path, {"plan", "new", "case.plan.json", "box.stl"});
}

Format transforms() {
    const Text affine = itk("AffineTransform_double_3_3", quarter), one = "1 0 0 0 1 0 0 0 1 0 0 0";
    const Text half = "1.5707963267948966";
    const auto named = [](const Text& feature, const Text& content, Result result = Result::read,
                          const Text& words = {}) {
        return Case{feature, "t.tfm", beside_plan(content), result, words};
    };
    return {
        "transform",
        {"plan", "move", "case.plan.json", "box", "--json", "--transform", "FILE"},
        {},
        is_quarter,
        {
            named("`.tfm`: affine, double precision", affine),
            named("single precision", itk("AffineTransform_float_3_3", quarter)),
            named("with a centre", itk("MatrixOffsetTransformBase_double_3_3", "0 -1 0 1 0 0 0 0 1 5 5 0", "5 0 0")),
            named("Euler angles", itk("Euler3DTransform_double_3_3", "0 0 " + half + " 10 0 0", "0 0 0 0")),
            named("versor", itk("VersorRigid3DTransform_double_3_3", "0 0 0.70710678118654752 10 0 0")),
            named("quaternion",
                  itk("QuaternionRigidTransform_double_3_3", "0 0 0.70710678118654752 0.70710678118654752 10 0 0")),
            {"`.h5` (HDF5)", "t.h5", write_h5},
            {"`.h5` that is no HDF5", "t.h5", beside_plan("some text"), Result::refused, "t.h5"},
            named("two transforms in one file", affine + itk("AffineTransform_double_3_3", one), Result::refused,
                  "a second transform"),
            named("a scale", itk("AffineTransform_double_3_3", "2 0 0 0 1 0 0 0 1 0 0 0"), Result::refused,
                  "scales or shears"),
            named("a mirror", itk("AffineTransform_double_3_3", "-1 0 0 0 1 0 0 0 1 0 0 0"), Result::refused,
                  "mirrors"),
            named("B-splines", itk("BSplineTransform_double_3_3", one), Result::refused, "is not read"),
            named("two dimensions", itk("AffineTransform_double_2_2", "1 0 0 1 0 0"), Result::refused,
                  "three dimensions"),
            named("text that is no number", itk("AffineTransform_double_3_3", "1 0 0 0 1 0 0 0 z 0 0 0"),
                  Result::refused, "'z' is not a number"),
            named("too few numbers", itk("AffineTransform_double_3_3", "1 0 0"), Result::refused, "needs 12"),
            named("text of another kind", "1 0 0\n", Result::refused, "Insight Transform File"),
        }};
}

Text markups(const Text& members, const Text& points) {
    return "{\"markups\": [{\"type\": \"Fiducial\", " + members + "\"controlPoints\": [" + points + "]}]}";
}
Text point(const Text& label, const Text& position, const Text& more = {}) {
    return fmt::format("{{\"label\": \"{}\", \"position\": [{}]{}}}", label, position, more);
}

Text has_artery(const Json& found) {
    const Json& sites = found["reconstruction"]["sites"];
    const double expected[] = {45.0, 20.0, -30.0};
    for (const Json& site : sites) {
        if (site["name"] != "marked artery") continue;
        for (std::size_t n = 0; n < 3; ++n)
            if (std::abs(site["at_mm"][n].get<double>() - expected[n]) > 1e-9) return "the site is " + site.dump();
        return "";
    }
    return "the sites are " + sites.dump();
}

/// Beside the plan of the bundled reconstruction, which has sites.
std::function<void(const fs::path&)> beside_flap(const Text& content) {
    return [=](const fs::path& path) {
        fs::copy_file(test::library_folder() / "cases/fibula-flap/case.plan.json",
                      path.parent_path() / "case.plan.json");
        file::write_whole_file(path, content);
    };
}

Format points() {
    const Text lps = "\"coordinateSystem\": \"LPS\", \"coordinateUnits\": \"mm\", ",
               ras = "\"coordinateSystem\": \"RAS\", \"coordinateUnits\": \"mm\", ",
               artery = point("marked artery", "45, 20, -30");
    const auto json = [](const Text& feature, const Text& content, Result result = Result::read,
                         const Text& words = {}) {
        return Case{feature, "m.mrk.json", beside_flap(content), result, words};
    };
    const auto list = [](const Text& feature, const Text& content, Result result = Result::read,
                         const Text& words = {}) {
        return Case{feature, "m.fcsv", beside_flap(content), result, words};
    };
    const Text head = "# Markups fiducial file version = 4.11\n";
    const auto row = [](const Text& at) { return "1," + at + ",0,0,0,1,1,1,0,marked artery,,\n"; };
    return {
        "points",
        {"plan", "site", "case.plan.json", "--json", "--file", "FILE"},
        {},
        has_artery,
        {
            json("`.mrk.json` in LPS", markups(lps, artery)),
            json("in RAS", markups(ras, point("marked artery", "-45, -20, -30"))),
            json("a unit as a code", markups("\"coordinateSystem\": \"LPS\", \"coordinateUnits\": [\"mm\", \"UCUM\", "
                                             "\"millimeter\"], ",
                                             artery)),
            json("a control point without a position (`undefined`, `preview`)",
                 markups(lps, artery + ", " + point("marked vein", "0, 0, 0", ", \"positionStatus\": \"undefined\"")),
                 Result::note, "left out"),
            json("a defined control point without a position", markups(lps, "{\"label\": \"a\"}"), Result::refused,
                 "has no position"),
            json("an unknown `positionStatus`", markups(lps, point("a", "1, 2, 3", ", \"positionStatus\": \"maybe\"")),
                 Result::refused, "positionStatus"),
            json("another unit", markups("\"coordinateUnits\": \"um\", ", artery), Result::refused,
                 "'coordinateUnits'"),
            json("another coordinate system", markups("\"coordinateSystem\": \"IJK\", ", artery), Result::refused,
                 "'coordinateSystem'"),
            json("no markups", "{}", Result::refused, "markups"),
            json("damaged JSON", "{\"markups\": [", Result::refused, "JSON"),
            list("`.fcsv` in LPS", head + "# CoordinateSystem = LPS\n" + row("45,20,-30")),
            list("in RAS, as 0", head + "# CoordinateSystem = 0\n" + row("-45,-20,-30")),
            list("no coordinate system", head + row("45,20,-30"), Result::refused, "CoordinateSystem"),
            list("text that is no number", head + "# CoordinateSystem = LPS\n" + row("45,x,-30"), Result::refused,
                 "'x' is not a coordinate"),
        }};
}

}  // namespace

Table mark_table() {
    Table table{"marks", {transforms(), points()}};
    for (Format& format : table.formats)
        format.notes = [](const Json& found) {
            std::vector<Text> notes;
            if (const Text said = found["said"].get<Text>(); !said.empty()) notes.push_back(said);
            return notes;
        };
    return table;
}

}  // namespace tactus::conformance
