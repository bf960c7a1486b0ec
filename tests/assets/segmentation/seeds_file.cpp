// SPDX-License-Identifier: Apache-2.0
#include "assets/segmentation/seeds_file.hpp"

#include "assets/volume/scan_volume.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/error.hpp"
#include "tests/support/catch.hpp"

#include <unistd.h>

#include <filesystem>
#include <string>

using namespace tactus;
namespace fs = std::filesystem;

namespace {

std::string seeds_refusal(const std::string& text) {
    try {
        segmentation::seeds_of_text(text, "seeds.json");
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}

struct File {
    explicit File(const std::string& name)
        : path(fs::temp_directory_path() / (std::to_string(::getpid()) + "_" + name)) {}
    ~File() { fs::remove(path); }
    fs::path path;
};

}  // namespace

TEST_CASE("assets: seeds are read as they were written") {
    const File file("seeds.json");
    const std::vector<segmentation::SeedLabel> labels{
        {"main \"part\"",
         Vec3(217.0, 95.0, 2.0) / 255.0,
         {{3e-3, {Vec3(0.012, -0.2, 1.5), Vec3(0.0)}}, {1e-3, {Vec3(1.0)}}}},
        {"fragment", {}, {{2.5e-3, {Vec3(-0.01, 0.0, 0.002)}}}}};
    segmentation::write_seeds(labels, file.path);
    const auto read = segmentation::read_seeds(file.path);
    REQUIRE(read.size() == 2);
    for (std::size_t l = 0; l < 2; ++l) {
        CHECK(read[l].name == labels[l].name);
        CHECK(read[l].colour == labels[l].colour);
        REQUIRE(read[l].strokes.size() == labels[l].strokes.size());
        for (std::size_t s = 0; s < read[l].strokes.size(); ++s) {
            CHECK(read[l].strokes[s].radius == Approx(labels[l].strokes[s].radius));
            REQUIRE(read[l].strokes[s].points.size() == labels[l].strokes[s].points.size());
            for (std::size_t n = 0; n < read[l].strokes[s].points.size(); ++n)
                for (int axis = 0; axis < 3; ++axis)
                    CHECK(read[l].strokes[s].points[n][axis] ==
                          Approx(labels[l].strokes[s].points[n][axis]).margin(1e-9));
        }
    }
}

TEST_CASE("assets: a wrong seeds file is refused with label and stroke") {
    using Catch::Matchers::ContainsSubstring;
    const std::string good = R"({"name": "b", "strokes": [{"points_mm": [[1, 2, 3]]}]})";
    const auto with = [&](const std::string& label) { return R"({"labels": [)" + label + ", " + good + "]}"; };
    CHECK(seeds_refusal(with(R"({"name": "a", "strokes": [{"points_mm": [[1, 2, 3]]}]})")) == "accepted");
    CHECK_THAT(seeds_refusal(""), ContainsSubstring("seeds.json:1:1: "));
    CHECK_THAT(seeds_refusal("[]"), ContainsSubstring("expected {\"labels\""));
    CHECK_THAT(seeds_refusal(R"({"labels": []})"), ContainsSubstring("no labels"));
    CHECK_THAT(seeds_refusal(R"({"labels": [)" + good + "]}"), ContainsSubstring("one label"));
    CHECK_THAT(seeds_refusal(with(good)), ContainsSubstring("two labels 'b'"));
    CHECK_THAT(seeds_refusal(with(R"({"strokes": []})")), ContainsSubstring("label 1 has no 'name'"));
    CHECK_THAT(seeds_refusal(with(R"({"name": "", "strokes": []})")), ContainsSubstring("1 to 200 characters"));
    CHECK_THAT(seeds_refusal(with(R"({"name": "a\nb", "strokes": []})")), ContainsSubstring("one line"));
    CHECK_THAT(seeds_refusal(with(R"({"name": "a", "strokes": []})")), ContainsSubstring("label 'a' has no strokes"));
    CHECK_THAT(seeds_refusal(with(R"({"name": "a", "colour": "red", "strokes": []})")), ContainsSubstring("'colour'"));
    const auto stroke = [&](const std::string& text) {
        return seeds_refusal(with(R"({"name": "a", "strokes": [{"points_mm": [[0, 0, 0]]}, )" + text + "]}"));
    };
    CHECK_THAT(stroke("{}"), ContainsSubstring("label 'a', stroke 2: 'points_mm'"));
    CHECK_THAT(stroke(R"({"points_mm": []})"), ContainsSubstring("at least one point"));
    CHECK_THAT(stroke(R"({"points_mm": [[1, 2]]})"), ContainsSubstring("three numbers"));
    CHECK_THAT(stroke(R"({"points_mm": [[1, 2, null]]})"), ContainsSubstring("three numbers"));
    CHECK_THAT(stroke(R"({"points_mm": [[1, 2, 1e300]]})"), ContainsSubstring("each at most 100000"));
    CHECK_THAT(stroke(R"({"radius_mm": 0, "points_mm": [[1, 2, 3]]})"), ContainsSubstring("'radius_mm'"));
    CHECK_THAT(stroke(R"({"radius_mm": -1e9, "points_mm": [[1, 2, 3]]})"), ContainsSubstring("'radius_mm'"));
    CHECK_THAT(stroke(R"({"radius_mm": "3", "points_mm": [[1, 2, 3]]})"), ContainsSubstring("'radius_mm'"));
}

TEST_CASE("assets: a written label map is read with its names and colours and place") {
    const File file("labels.seg.nrrd");
    const volume::Grid layout{{5, 4, 3}, Vec3(0.01, -0.2, 0.5), Vec3(0.7e-3, 0.8e-3, 2e-3), {}};
    std::vector<std::uint8_t> labels(layout.count(), 0);
    labels[7] = 1, labels[33] = 2, labels[59] = 2;
    volume::write_labels(
        layout, labels, std::vector<volume::Segment>{{1, "ischium left", Vec3(0.2, 0.4, 0.6)}, {2, "", {}}}, file.path);
    const volume::ScanVolume read = volume::read_volume(file.path);
    CHECK(read.kind == volume::VolumeKind::labels);
    REQUIRE(read.segments.size() == 2);
    CHECK(read.segments[0].name == "ischium left");
    REQUIRE(read.segments[0].colour);
    CHECK(read.segments[0].colour->y == Approx(0.4));
    CHECK(read.segments[1].name == "label_2");
    CHECK_FALSE(read.segments[1].colour);
    const volume::Grid grid = volume::lps_grid(read);
    CHECK(grid.size == layout.size);
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(grid.origin[axis] == Approx(layout.origin[axis]));
        CHECK(grid.spacing[axis] == Approx(layout.spacing[axis]));
    }
    for (std::size_t v = 0; v < labels.size(); ++v) CHECK(grid.values[v] == static_cast<float>(labels[v]));
    CHECK_THROWS_AS(volume::write_labels(layout, labels, {}, "labels.txt"), Error);
}
