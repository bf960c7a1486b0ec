// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/labels.hpp"

#include "assets/bone/from_hu.hpp"
#include "assets/bone/import.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/random.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

using Shape = std::function<double(const Vec3&)>;  // signed distance, m

volume::Grid layout(const Vec3& spacing, const Vec3& middle, const std::array<int, 3>& size) {
    return {size, middle - 0.5 * Vec3(size[0] - 1, size[1] - 1, size[2] - 1) * spacing, spacing, {}};
}

volume::Grid sampled(volume::Grid grid, const std::function<double(const Vec3&)>& value) {
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i)
                grid.values.push_back(static_cast<float>(value(grid.position(i, j, k))));
    return grid;
}

double voxel_volume(const volume::Grid& grid) { return grid.spacing.x * grid.spacing.y * grid.spacing.z; }
double count_of(const volume::Grid& labels, float label) {
    return static_cast<double>(std::count(labels.values.begin(), labels.values.end(), label));
}

struct Errors {
    double median, p95;
};

// How far the true surface lies from the bone's, in shares of the smallest spacing, at the bone's vertices.
Errors errors_of(const bone::Bone& bone, const Shape& truth) {
    std::vector<double> errors;
    for (const Vec3& v : mesh::surface_of(bone.distance).vertices) errors.push_back(std::abs(truth(v)));
    std::sort(errors.begin(), errors.end());
    const double voxel = std::min({bone.distance.spacing.x, bone.distance.spacing.y, bone.distance.spacing.z});
    return {errors[errors.size() / 2] / voxel, errors[errors.size() * 95 / 100] / voxel};
}

const Vec3 label_far_off(1.0, -0.8, 1.2);

Shape ball(double radius) {
    return [radius](const Vec3& p) { return glm::length(p - label_far_off) - radius; };
}
Shape ring(double wide, double thick) {
    return [=](const Vec3& at) {
        const Vec3 p = at - label_far_off;
        return std::hypot(std::hypot(p.x, p.y) - wide, p.z) - thick;
    };
}
// A wall of so many samples across a ball, slanted to all axes.
Shape wall(double thick) {
    return [thick](const Vec3& at) {
        const Vec3 p = at - label_far_off;
        return std::max(std::abs(glm::dot(p, glm::normalize(Vec3(1.0, 0.6, 0.4)))) - 0.5 * thick,
                        glm::length(p) - 9.0 * mm);
    };
}

volume::Grid labelled(const Shape& shape, const Vec3& spacing, int size = 48) {
    return sampled(layout(spacing, label_far_off, {size, size, size}),
                   [&](const Vec3& p) { return shape(p) < 0.0 ? 1.0 : 0.0; });
}

std::string nrrd_of(const volume::Grid& grid, const std::string& extra = "") {
    std::string text = fmt::format(
        "NRRD0005\ntype: uchar\ndimension: 3\nspace: left-posterior-superior\nsizes: {} {} {}\nspace directions: "
        "({},0,0) "
        "(0,{},0) (0,0,{})\nspace origin: ({},{},{})\nencoding: raw\n{}\n",
        grid.size[0], grid.size[1], grid.size[2], grid.spacing.x / mm, grid.spacing.y / mm, grid.spacing.z / mm,
        grid.origin.x / mm, grid.origin.y / mm, grid.origin.z / mm, extra);
    for (const float value : grid.values) text += static_cast<char>(static_cast<unsigned char>(value));
    return text;
}

}  // namespace

TEST_CASE("a label's surface has no staircase and its voxels' volume, and 1 m from the origin as anywhere") {
    const Vec3 spacing(0.5 * mm);
    for (const auto& [shape, limit] :
         {std::pair{ball(5.2 * mm), 0.17}, {ball(9.0 * mm), 0.15}, {ring(6.0 * mm, 2.5 * mm), 0.16}}) {
        const volume::Grid labels = labelled(shape, spacing);
        const bone::Bone bone = bone::bone_of_label(labels, {1, "part", {}}, {});
        const Errors errors = errors_of(bone, shape);
        CAPTURE(errors.median, errors.p95);
        // The nearest samples are right to half a voxel; a staircase would show as 0.25 at the median.
        CHECK(errors.median < 0.08);
        CHECK(errors.p95 < limit);
        CHECK(mesh::volume_of(mesh::surface_of(bone.distance)) ==
              Approx(count_of(labels, 1.0f) * voxel_volume(labels)).epsilon(0.01));
        CHECK(bone.name == "part");
        CHECK(bone.provenance.at("label") == "1");
    }
}

TEST_CASE("a slanted wall little more than one voxel thick stays a wall without holes") {
    const Shape truth = wall(0.7 * mm);
    const volume::Grid labels = labelled(truth, Vec3(0.5 * mm));
    const bone::Bone bone = bone::bone_of_label(labels, {}, {});
    CHECK(mesh::volume_of(mesh::surface_of(bone.distance)) ==
          Approx(count_of(labels, 1.0f) * voxel_volume(labels)).epsilon(0.1));
    // Along the middle of the wall everything is inside.
    const Vec3 n = glm::normalize(Vec3(1.0, 0.6, 0.4)), u = glm::normalize(glm::cross(n, Vec3(0, 0, 1))),
               v = glm::cross(n, u);
    int outside = 0;
    for (int a = -6; a <= 6; ++a)
        for (int b = -6; b <= 6; ++b) {
            const Vec3 q = (label_far_off + 1.0 * mm * (u * double(a) + v * double(b)) - bone.distance.origin) /
                           bone.distance.spacing;
            double least = 1.0;
            for (int c = 0; c < 8; ++c)
                least = std::min(
                    least, double(bone.distance.at(int(q.x) + (c & 1), int(q.y) + (c >> 1 & 1), int(q.z) + (c >> 2))));
            outside += least >= 0.0;
        }
    CHECK(outside == 0);
}

TEST_CASE("a slanted sheet of single voxels has a closed surface without holes, lit from its own side") {
    // One labelled sample per column along x: the thinnest digital plane, whose voxels meet along edges only.
    const Vec3 spacing(0.5 * mm), n = glm::normalize(Vec3(1.0, 0.8, 0.45));
    const volume::Grid labels = sampled(layout(spacing, label_far_off, {48, 48, 48}), [&](const Vec3& at) {
        const Vec3 p = at - label_far_off;
        const double step = 0.5 * spacing.x * n.x, level = glm::dot(p, n);
        return std::abs(p.y) < 6.0 * mm && std::abs(p.z) < 6.0 * mm && level >= -step && level < step ? 1.0 : 0.0;
    });
    const bone::Bone bone = bone::bone_of_label(labels, {}, {});
    const mesh::Mesh surface = mesh::surface_of(bone.distance);
    const mesh::MeshTopology topology = mesh::topology_of(surface);
    CHECK(topology.is_watertight());
    CHECK(topology.components == 1);
    // Euler's characteristic of a ball's surface; each hole through the sheet takes 2 away.
    CHECK(static_cast<double>(surface.vertices.size()) - 0.5 * static_cast<double>(surface.triangles.size()) == 2.0);
    CHECK(mesh::volume_of(surface) == Approx(count_of(labels, 1.0f) * voxel_volume(labels)).epsilon(0.25));
    double wrong = 0.0, all = 0.0;
    for (const auto& t : surface.triangles) {
        const auto at = [&](std::size_t c) { return surface.vertices[static_cast<std::size_t>(t[c])]; };
        const Vec3 twice = glm::cross(at(1) - at(0), at(2) - at(0));
        for (const int c : t) {
            all += glm::length(twice);
            if (glm::dot(surface.normals[static_cast<std::size_t>(c)], twice) < 0.0) wrong += glm::length(twice);
        }
    }
    CHECK(wrong < 0.005 * all);
}

TEST_CASE("the sheet of a thin label takes no sample from the label beside it") {
    volume::Grid labels = layout(Vec3(0.5 * mm), label_far_off, {24, 24, 24});
    labels.values.assign(labels.count(), 0.0f);
    for (int k = 8; k < 16; ++k)
        for (int n = 6; n < 16; ++n) labels.at(n, n, k) = 1.0f;
    labels.at(11, 10, 12) = 2.0f;
    const bone::Bone bone = bone::bone_of_label(labels, {}, {});
    const Vec3 first = (labels.position(0, 0, 0) - bone.distance.origin) / bone.distance.spacing;
    const auto at = [&](int i, int j, int k) {
        return bone.distance.at(i + static_cast<int>(std::lround(first.x)), j + static_cast<int>(std::lround(first.y)),
                                k + static_cast<int>(std::lround(first.z)));
    };
    CHECK(at(10, 10, 12) < 0.0f);
    CHECK(at(11, 10, 12) > 0.0f);
    CHECK(at(10, 11, 12) < 0.0f);
}

TEST_CASE("with a CT the surface goes to its grey values, also through noise and blur on uneven voxels", "[slow]") {
    const Vec3 spacing(0.35 * mm, 0.35 * mm, 0.6 * mm);
    const Random random{11};
    for (const Shape& shape : {ball(6.0 * mm), ring(5.0 * mm, 1.8 * mm)}) {
        std::uint64_t n = 0;
        // An edge of 0.4 mm standard deviation between 40 and 1240 HU.
        const volume::Grid hu = sampled(layout(spacing, label_far_off, {56, 56, 34}), [&](const Vec3& p) {
            return 640.0 - 600.0 * std::erf(shape(p) / (std::sqrt(2.0) * 0.4 * mm)) + 15.0 * random.normal(n++);
        });
        volume::Grid labels = hu;
        for (float& value : labels.values) value = value >= 640.0f ? 3.0f : 0.0f;
        const bone::Bone plain = bone::bone_of_label(labels, {3, "", {}}, {});
        const bone::Bone seen = bone::bone_of_label(labels, {3, "", {}}, {{}, &hu, false});
        const Errors before = errors_of(plain, shape), after = errors_of(seen, shape);
        CAPTURE(before.p95, after.median, after.p95, seen.provenance.at("surface"));
        CHECK(after.p95 < 0.15);
        CHECK(after.p95 < 0.7 * before.p95);
        CHECK_THAT(seen.provenance.at("surface"), ContainsSubstring("grey values"));
        CHECK_THAT(seen.provenance.at("calibration"), ContainsSubstring("without a density phantom"));
        CHECK(seen.name == "label_3");
        // The same CT taken by its threshold.
        const bone::Bone direct = bone::bone_from_hu(hu, {640.0f, 1, true}).bone;
        CHECK(mesh::volume_of(mesh::surface_of(seen.distance)) ==
              Approx(mesh::volume_of(mesh::surface_of(direct.distance))).epsilon(0.01));
    }
}

TEST_CASE("between two labels grey values are not asked: each ends where the other begins") {
    const Vec3 spacing(0.5 * mm);
    const Shape whole = ball(8.0 * mm);
    const auto half = [](const Vec3& p) { return p.x - label_far_off.x + 0.3 * (p.y - label_far_off.y); };
    const volume::Grid labels = sampled(layout(spacing, label_far_off, {44, 44, 44}), [&](const Vec3& p) {
        return whole(p) >= 0.0 ? 0.0 : half(p) < 0.0 ? 1.0 : 2.0;
    });
    const volume::Grid hu = sampled(layout(spacing, label_far_off, {44, 44, 44}),
                                    [&](const Vec3& p) { return std::clamp(300.0 - 1e6 * whole(p), -1000.0, 1400.0); });
    double volume = 0.0;
    for (const int label : {1, 2}) {
        const bone::Bone bone = bone::bone_of_label(labels, {label, "", {}}, {{}, &hu, false});
        volume += mesh::volume_of(mesh::surface_of(bone.distance));
        std::vector<double> face;
        for (const Vec3& v : mesh::surface_of(bone.distance).vertices)
            if (whole(v) < -1.5 * mm) face.push_back(std::abs(half(v)) / std::hypot(1.0, 0.3) / spacing.x);
        std::sort(face.begin(), face.end());
        REQUIRE(face.size() > 100);
        CHECK(face[face.size() * 95 / 100] < 0.35);
    }
    CHECK(volume == Approx(4.0 / 3.0 * std::numbers::pi * std::pow(8.0 * mm, 3)).epsilon(0.02));
}

TEST_CASE("a label at the border of its map, of one voxel, or in parts becomes a closed bone of its volume") {
    const Vec3 spacing(1.0 * mm, 1.0 * mm, 2.0 * mm);
    volume::Grid labels = sampled(layout(spacing, Vec3(0.0), {9, 8, 7}), [](const Vec3&) { return 0.0; });
    labels.at(4, 4, 3) = 1.0f;
    for (int k = 0; k < 7; ++k)
        for (int j = 0; j < 8; ++j) labels.at(0, j, k) = labels.at(1, j, k) = 2.0f;
    labels.at(8, 0, 0) = labels.at(8, 7, 6) = 2.0f;
    labels.at(7, 1, 1) = 2.0f;  // touches the one before at a corner
    for (const int label : {1, 2}) {
        std::size_t voxels = 0;
        const bone::Bone bone = bone::bone_of_label(labels, {label, "", {}}, {}, run_in_turn, &voxels);
        CHECK(double(voxels) == count_of(labels, static_cast<float>(label)));
        const mesh::Mesh surface = mesh::surface_of(bone.distance);
        CHECK(mesh::topology_of(surface).is_watertight());
        CHECK(mesh::volume_of(surface) == Approx(double(voxels) * 2e-9).epsilon(label == 1 ? 0.3 : 0.05));
    }
    CHECK_THROWS_WITH(bone::bone_of_label(labels, {7, "", {}}, {}), ContainsSubstring("no voxel has label 7"));
}

TEST_CASE("a ragged label with stray voxels spans its voxels: no streak leads from a touching edge out of the bone") {
    const Vec3 spacing(0.5 * mm, 0.5 * mm, 0.8 * mm);
    const Random random{7};
    std::uint64_t n = 0;
    // A ball whose outer half is full of holes, so that its voxels touch at faces, edges and corners.
    volume::Grid labels = sampled(layout(spacing, label_far_off, {40, 40, 26}), [&](const Vec3& p) {
        const double depth = -ball(7.0 * mm)(p);
        return depth > 0.0 && random.uniform(n++) < 0.4 + depth / (6.0 * mm) ? 1.0 : 0.0;
    });
    labels.at(2, 20, 13) = labels.at(20, 37, 20) = 1.0f;
    Vec3 low(1e9), high(-1e9);
    for (int k = 0; k < labels.size[2]; ++k)
        for (int j = 0; j < labels.size[1]; ++j)
            for (int i = 0; i < labels.size[0]; ++i)
                if (labels.at(i, j, k) > 0.0f)
                    low = glm::min(low, labels.position(i, j, k)), high = glm::max(high, labels.position(i, j, k));
    const bone::Bone bone = bone::bone_of_label(labels, {1, "", {}}, {});
    const mesh::Mesh surface = mesh::surface_of(bone.distance);
    CHECK(mesh::topology_of(surface).is_watertight());
    CHECK(mesh::volume_of(surface) == Approx(count_of(labels, 1.0f) * voxel_volume(labels)).epsilon(0.03));
    Vec3 least(1e9), most(-1e9);
    for (const Vec3& v : surface.vertices) least = glm::min(least, v), most = glm::max(most, v);
    for (int a = 0; a < 3; ++a) {
        CAPTURE(a);
        CHECK(std::abs(least[a] - low[a]) < spacing[a]);
        CHECK(std::abs(most[a] - high[a]) < spacing[a]);
    }
}

TEST_CASE("what is no label map is refused in one sentence") {
    volume::Grid grid = layout(Vec3(1.0 * mm), Vec3(0.0), {40, 40, 1});
    for (int n = 0; n < 1600; ++n) grid.values.push_back(float(n));
    CHECK_THROWS_WITH(bone::labels_in(grid), ContainsSubstring("1599 different values"));
    grid.values[5] = 0.5f;
    CHECK_THROWS_WITH(bone::labels_in(grid), ContainsSubstring("0.5 is not a label"));
    grid.values[5] = -1000.0f;
    CHECK_THROWS_WITH(bone::labels_in(grid), ContainsSubstring("-1000 is not a label"));
    grid.values.assign(1600, 0.0f);
    CHECK(bone::labels_in(grid).empty());
}

TEST_CASE("a label map's file becomes one file of bones in its frame, and labels are chosen by number") {
    const TemporaryFolder folder;
    volume::Grid labels = labelled(ball(3.0 * mm), Vec3(0.5 * mm), 24);
    for (int k = 0; k < 24; ++k)
        for (int j = 0; j < 24; ++j)
            for (int i = 0; i < 24; ++i)
                if (labels.at(i, j, k) > 0.0f && i > 12) labels.at(i, j, k) = 5.0f;
    bone::ImportOptions options;
    options.input = folder / "two.nrrd";
    options.unit = "mm";
    options.label = "all";
    file::write_whole_file(options.input, nrrd_of(labels));
    const std::vector<bone::ImportedBone> both = bone::import_labels(options);
    REQUIRE(both.size() == 2);
    CHECK(both[0].bone.name == "label_1");
    CHECK(both[1].bone.name == "label_5");
    CHECK(both[0].bone.colour != both[1].bone.colour);
    CHECK(both[0].summary.bone_volume_mm3 == Approx(count_of(labels, 1.0f) * 0.125).epsilon(0.02));
    CHECK(both[1].summary.bone_volume_mm3 == Approx(count_of(labels, 5.0f) * 0.125).epsilon(0.02));
    CHECK(both[0].bone.provenance.at("source") == "two.nrrd");
    CHECK(both[0].summary.components == 1);
    CHECK(both[1].summary.components == 1);
    options.label = "5";
    CHECK(bone::import_labels(options).front().bone.distance.values == both[1].bone.distance.values);
    options.label = "2";
    CHECK_THROWS_WITH(bone::import_labels(options), ContainsSubstring("there is no label '2'; there are 1, 5"));
    for (int k = 0; k < 24; ++k)
        for (int j = 0; j < 24; ++j)
            for (int i = 9; i < 15; ++i) labels.at(i, j, k) = 0.0f;
    for (float& value : labels.values) value = value > 0.0f ? 1.0f : 0.0f;
    file::write_whole_file(options.input, nrrd_of(labels));
    options.label = "1";
    const bone::ImportedBone both_parts = bone::import_labels(options).front();
    CHECK(both_parts.summary.components == 2);
    options.component = "largest";
    const bone::ImportedBone larger = bone::import_labels(options).front();
    CHECK(larger.summary.components == 2);
    CHECK(larger.bone.provenance.at("component") == "largest");
    CHECK(larger.summary.bone_volume_mm3 < 0.7 * both_parts.summary.bone_volume_mm3);
    CHECK(larger.summary.bone_volume_mm3 > 0.4 * both_parts.summary.bone_volume_mm3);
    options.component = "2";
    CHECK(bone::import_labels(options).front().bone.distance.values == both_parts.bone.distance.values);
    options.component = "none";
    CHECK_THROWS_WITH(bone::import_labels(options), ContainsSubstring("'largest', 'all'"));
    options.component.clear();
    options.crop = "0:1,0:1,0:1";
    CHECK_THROWS_WITH(bone::import_labels(options), ContainsSubstring("crop"));
}
