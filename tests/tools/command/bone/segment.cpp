// SPDX-License-Identifier: Apache-2.0
// tactus segment, from a scan to labels and bones.
#include "assets/bone/bone.hpp"
#include "assets/volume/scan_volume.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/run_command.hpp"

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>

namespace fs = std::filesystem;
using namespace tactus;
using nlohmann::json;

namespace {

struct SegmentFolder : test::Folder {
    std::string operator/(const std::string& name) const { return (path / name).string(); }
    test::Outcome tactus(const std::string& arguments) const { return test::Folder::tactus("segment " + arguments); }
    json answer(const std::string& arguments) const {
        const test::Outcome done = tactus(arguments + " --json");
        INFO(arguments << "\n" << done.err);
        REQUIRE(done.code == 0);
        return json::parse(done.out);
    }
};

// Two thick-walled balls of bone that touch in a gap of 250 HU, marrow of 80 HU within, a third one far from both, and a
// screw of metal. Noise of 15 HU.
volume::Grid two_bones() {
    volume::Grid grid{{72, 40, 40}, Vec3(-0.02, 0.15, 0.4), Vec3(0.8, 0.8, 0.9) * mm, {}};
    for (int k = 0; k < 40; ++k)
        for (int j = 0; j < 40; ++j)
            for (int i = 0; i < 72; ++i) {
                const Vec3 p = grid.position(i, j, k) - grid.origin;
                const auto ball = [&](double x, double radius) {
                    return glm::length(p - Vec3(x, 16.0, 18.0) * mm) - radius * mm;
                };
                const double a = ball(13.0, 11.0), b = ball(35.5, 11.0), c = ball(53.0, 2.5);
                double value = 40.0;
                if (a < 0.0) value = a < -3.0 * mm ? 80.0 : 700.0;
                if (b < 0.0) value = b < -3.0 * mm ? 80.0 : 700.0;
                if (a >= 0.0 && b >= 0.0 && std::hypot(p.y - 16.0 * mm, p.z - 18.0 * mm) < 4.0 * mm &&
                    p.x > 13.0 * mm && p.x < 35.5 * mm)
                    value = 330.0;
                if (c < 0.0) value = 700.0;
                if (k == 20 && j == 20 && i > 5 && i < 9) value = 3000.0;
                if (k < 2) value = -1000.0;
                grid.values.push_back(
                    static_cast<float>(std::round(value + 15.0 * Random{2}.normal(grid.values.size()))));
            }
    return grid;
}

std::string seeds() {
    return R"({"labels": [
        {"name": "left", "colour": "#1b9e77", "strokes": [{"radius_mm": 1.5, "points_mm": [[-16.0, 166, 418], [-7, 176, 418]]}]},
        {"name": "right", "strokes": [{"radius_mm": 1.5, "points_mm": [[25.5, 166, 418]]}]}]})";
}

double volume_of_ball(double radius) { return 4.0 / 3.0 * 3.14159265 * radius * radius * radius; }

}  // namespace

TEST_CASE("segment separates two bones that touch and takes in their marrow") {
    const SegmentFolder folder;
    const volume::Grid scan = two_bones();
    volume::write_volume(scan, volume::WrittenType::int16, folder / "ct.nrrd");
    volume::write_volume(scan, volume::WrittenType::float32, folder / "float.nrrd");
    folder.write("seeds.json", seeds());
    const std::string common = " --seeds " + folder / "seeds.json" + " --threshold 200";
    const json found = folder.answer(folder / "ct.nrrd" + common + " -o " + folder / "labels.nrrd" + " -o " +
                                     folder / "labels.seg.nrrd" + " -o " + folder / "bones.vdb" + " --certainty " +
                                     folder / "certainty.nrrd");
    REQUIRE(found["labels"].size() == 2);
    CHECK(found["labels"][0]["name"] == "left");
    for (const json& label : found["labels"])
        CHECK(label["volume_mm3"].get<double>() == Approx(volume_of_ball(11.0)).epsilon(0.08));
    CHECK(found["marrow_voxels"].get<int>() > 4000);
    CHECK(found["metal_voxels"].get<int>() == 3);
    CHECK(found["residual"].get<double>() < 1e-3);
    CHECK(found["threshold"]["value"].get<double>() == 200.0);
    REQUIRE(found["unseeded_islands"].size() >= 1);
    CHECK(found["unseeded_islands"][0]["centre_mm"][0].get<double>() == Approx(-20.0 + 53.0).margin(0.5));
    REQUIRE(found["touching"].size() == 1);
    CHECK(found["touching"][0]["as_scanned"] == true);

    // The labels as files: left is left of the gap.
    const volume::ScanVolume read = volume::read_volume(folder / "labels.seg.nrrd");
    REQUIRE(read.segments.size() == 2);
    CHECK(read.segments[0].name == "left");
    CHECK(read.segments[0].colour->x == Approx(27.0 / 255.0).margin(1e-3));
    const volume::Grid labels = volume::lps_grid(read);
    std::size_t wrong = 0, labelled = 0;
    for (int k = 0; k < 40; ++k)
        for (int j = 0; j < 40; ++j)
            for (int i = 0; i < 72; ++i) {
                const double x = (labels.position(i, j, k).x - labels.origin.x) / mm;
                if (labels.at(i, j, k) == 0.0f) continue;
                ++labelled;
                wrong += (labels.at(i, j, k) == 1.0f ? x > 26.0 : x < 22.5);
            }
    CHECK(labelled > 15000);
    CHECK(wrong == 0);
    const auto bones = bone::load_bones(folder / "bones.vdb");
    REQUIRE(bones.size() == 2);
    CHECK(bones[1].name == "right");
    CHECK(bones[0].provenance.at("seeds") == "seeds.json");
    const volume::Grid certainty = volume::lps_grid(volume::read_volume(folder / "certainty.nrrd"));
    for (const float c : certainty.values) CHECK((c >= 0.0f && c <= 1.0f));

    // The same values as floats give the same labels, and so does a run with other outputs.
    folder.answer(folder / "float.nrrd" + common + " -o " + folder / "again.nrrd");
    CHECK(volume::lps_grid(volume::read_volume(folder / "again.nrrd")).values == labels.values);
}

TEST_CASE("segment gives the same labels for values in other units, also where it chooses the threshold") {
    const SegmentFolder folder;
    volume::Grid scan = two_bones();
    // Scanner numbers: no air, so that the unit of the values is not known.
    for (float& value : scan.values) value = std::clamp(value, -40.0f, 1000.0f);
    volume::write_volume(scan, volume::WrittenType::int16, folder / "ct.nrrd");
    for (float& value : scan.values) value /= 1000.0f;
    volume::write_volume(scan, volume::WrittenType::float32, folder / "small.nrrd");
    folder.write("seeds.json", seeds());
    const auto labels_of = [&](const std::string& file, const std::string& more = "") {
        folder.answer(folder / file + more + " --seeds " + folder / "seeds.json" + " -o " + folder / "labels.nrrd");
        return volume::lps_grid(volume::read_volume(folder / "labels.nrrd")).values;
    };
    CHECK(labels_of("small.nrrd") == labels_of("ct.nrrd"));
    // A window of eight bits in which air and a frame are 0 is no scan that is masked with zeros: soft tissue has no label.
    scan = two_bones();
    const auto in_frame = [&](std::size_t v) {
        const auto i = static_cast<int>(v % 72), j = static_cast<int>(v / 72 % 40), k = static_cast<int>(v / (72 * 40));
        return i >= 2 && i < 70 && j >= 2 && j < 38 && k >= 2 && k < 38;
    };
    volume::Grid hu = scan;
    for (std::size_t v = 0; v < scan.count(); ++v) {
        float value = scan.values[v];
        // More steps than a label map has.
        value = value > 150.0f ? value + 13.0f * static_cast<float>(v % 36 + v / 72 % 40)
                               : -190.0f + static_cast<float>(v * 7919 % 330);
        if (!in_frame(v) || (value < 150.0f && v % 3 != 0)) value = -1000.0f;
        hu.values[v] = value;
        scan.values[v] = std::round(255.0f * std::clamp((value + 200.0f) / 2000.0f, 0.0f, 1.0f));
    }
    volume::write_volume(hu, volume::WrittenType::int16, folder / "hu.nrrd");
    volume::write_volume(scan, volume::WrittenType::int16, folder / "byte.nrrd");
    // Both thresholds lie between the steps 57 and 58.
    const auto of_bytes = labels_of("byte.nrrd", " --threshold 57.5 --metal 249.5"),
               of_hu = labels_of("hu.nrrd", " --threshold 250.98 --metal 1756.9");
    std::size_t other = 0, labelled = 0;
    for (std::size_t v = 0; v < of_hu.size(); ++v) {
        other += of_bytes[v] != of_hu[v];
        labelled += of_hu[v] != 0.0f;
    }
    CHECK(labelled > 10'000);
    CHECK(other <= labelled / 1000);
    scan = two_bones();
    for (float& value : scan.values) value = std::clamp(value, -40.0f, 1000.0f);
    // A limit for metal that is given counts for scanner numbers, too.
    const json found = folder.answer(folder / "ct.nrrd" + " --metal 950 --seeds " + folder / "seeds.json" + " -o " +
                                     folder / "labels.nrrd");
    CHECK(found["metal_voxels"].get<int>() == 3);
}

TEST_CASE("segment says when its labels are on other axes than the file's") {
    const SegmentFolder folder;
    volume::Grid scan = two_bones();
    volume::write_volume(scan, volume::WrittenType::int16, folder / "ct.nrrd");
    std::string header = test::slurp(folder / "ct.nrrd");
    const auto at = header.find("space directions:");
    REQUIRE(at != std::string::npos);
    header.replace(at, header.find('\n', at) - at, "space directions: (0.7878,0.1389,0) (-0.1389,0.7878,0) (0,0,0.9)");
    folder.write("oblique.nrrd", header);
    const json proposed = folder.answer(folder / "oblique.nrrd" + " --threshold 200 --propose " + folder / "p.json");
    const json found = folder.answer(folder / "oblique.nrrd" + " --threshold 200 --seeds " + folder / "p.json" +
                                     " -o " + folder / "labels.nrrd");
    REQUIRE(found["notes"].size() >= 1);
    CHECK(found["notes"].dump().find("axes") != std::string::npos);
}

TEST_CASE("segment proposes seeds that it can use") {
    const SegmentFolder folder;
    volume::write_volume(two_bones(), volume::WrittenType::int16, folder / "ct.nrrd");
    const json proposed = folder.answer(folder / "ct.nrrd" + " --threshold 200 --propose " + folder / "seeds.json");
    CHECK(proposed["fragments"].get<int>() == 2);
    const json found = folder.answer(folder / "ct.nrrd" + " --threshold 200 --seeds " + folder / "seeds.json" + " -o " +
                                     folder / "labels.nrrd");
    for (const json& label : found["labels"])
        CHECK(label["volume_mm3"].get<double>() == Approx(volume_of_ball(11.0)).epsilon(0.08));
}

TEST_CASE("segment refuses what it cannot use with one line and writes nothing", "[slow]") {
    using Catch::Matchers::ContainsSubstring;
    const SegmentFolder folder;
    volume::write_volume(two_bones(), volume::WrittenType::int16, folder / "ct.nrrd");
    folder.write("seeds.json", seeds());
    const auto refused = [&](const std::string& arguments, const std::string& text) {
        const auto done = folder.tactus(arguments);
        INFO(arguments);
        CHECK(done.code == 2);
        CHECK_THAT(done.err, ContainsSubstring(text));
        CHECK(std::count(done.err.begin(), done.err.end(), '\n') <= 2);
        CHECK_FALSE(fs::exists(folder / "out.nrrd"));
        CHECK_FALSE(fs::exists(folder / "out.nrrd.part"));
    };
    const std::string ct = folder / "ct.nrrd", out = " -o " + folder / "out.nrrd",
                      with_seeds = " --seeds " + folder / "seeds.json";
    refused(ct, "name the result");
    refused(ct + out, "give the seeds");
    refused(ct + with_seeds + " -o " + folder / "out.txt", "written as .vdb or .nrrd");
    refused(ct + with_seeds + " -o " + ct, "this is a source");
    refused(ct + with_seeds + out + " --certainty " + folder / "out.nrrd", "two results have this name");
    refused(ct + " --seeds " + folder / "out.nrrd" + out, "out.nrrd");
    refused(ct + with_seeds + " -o " + folder / "none/out.nrrd", "there is no folder");
    refused(ct + with_seeds + out + " --propose " + folder / "p.json", "--propose writes seeds only");
    refused(ct + with_seeds + out + " --threshold 5000", "there is no bone");
    refused(folder / "none.nrrd" + with_seeds + out, "none.nrrd");
    refused(folder / "seeds.json" + with_seeds + out, "seeds.json");
    folder.write("far.json", R"({"labels": [{"name": "a", "strokes": [{"points_mm": [[-16.0, 166, 418]]}]},
        {"name": "b", "strokes": [{"points_mm": [[25.5, 166, 418]]}, {"points_mm": [[900, 166, 418]]}]}]})");
    refused(ct + " --threshold 200 --seeds " + folder / "far.json" + out, "label 'b', stroke 2: it touches no voxel");
    refused(ct + " --threshold 200 --seeds " + folder / "far.json" + out,
            "900, 166, 418 mm lies outside of the scan, which reaches from -20.0, 150.0, 400.0");
    folder.write("over.json",
                 R"({"labels": [{"name": "a", "strokes": [{"radius_mm": 1, "points_mm": [[25.5, 166, 418]]}]},
        {"name": "b", "strokes": [{"points_mm": [[25.5, 166, 418]]}]}]})");
    refused(ct + " --threshold 200 --seeds " + folder / "over.json" + out, "painted over all strokes of label 'a'");
    std::string points = "[25.5, 166, 418]";
    for (int n = 0; n < 300000; ++n) points += ", [25.5, 166, 418]";
    folder.write("wide.json", R"({"labels": [{"name": "a", "strokes": [{"points_mm": [[-16.0, 166, 418]]}]},
        {"name": "b", "strokes": [{"radius_mm": 100, "points_mm": [)" +
                                  points + "]}]}]}");
    refused(ct + " --threshold 200 --seeds " + folder / "wide.json" + out, "use fewer points");
}

TEST_CASE("segment finds the two fragments of a real sacrum from six dabs each", "[slow]") {
    const char* const data = std::getenv("TACTUS_SHARED_DATA");
    const fs::path ct = data ? fs::path(data) / "fragments/sacrum003_ct.nrrd" : "";
    if (!data || !fs::exists(ct)) return test::skip("TACTUS_SHARED_DATA does not name a folder with " + ct.string());
    const SegmentFolder folder;
    const volume::Grid truth =
        volume::lps_grid(volume::read_volume(fs::path(data) / "fragments/sacrum003_labels.nrrd"));
    // Dabs of 3 mm, far enough from the other fragment.
    const auto is_within = [&](const std::array<int, 3>& at, float label) {
        for (int k = -3; k <= 3; ++k)
            for (int j = -3; j <= 3; ++j)
                for (int i = -3; i <= 3; ++i) {
                    const std::array<int, 3> p{at[0] + i, at[1] + j, at[2] + k};
                    for (std::size_t a = 0; a < 3; ++a)
                        if (p[a] < 0 || p[a] >= truth.size[a]) return false;
                    const float other = truth.at(p[0], p[1], p[2]);
                    if (other != 0.0f && other != label) return false;
                }
        return true;
    };
    const Random random{77};
    std::uint64_t draw = 0;
    constexpr int seedings = 5;
    double mean = 0.0;
    for (int seeding = 0; seeding < seedings; ++seeding) {
        json labels = json::array();
        for (const int label : {1, 2}) {
            json strokes = json::array();
            while (strokes.size() < 6) {
                const auto v = static_cast<int>(random.bits(draw++) % truth.values.size());
                const std::array<int, 3> at{v % truth.size[0], v / truth.size[0] % truth.size[1],
                                            v / truth.size[0] / truth.size[1]};
                const auto value = static_cast<float>(label);
                if (truth.at(at[0], at[1], at[2]) != value || !is_within(at, value)) continue;
                const Vec3 p = truth.position(at[0], at[1], at[2]) * 1e3;
                strokes.push_back({{"radius_mm", 3.0}, {"points_mm", {{p.x, p.y, p.z}}}});
            }
            labels.push_back({{"name", "part " + std::to_string(label)}, {"strokes", strokes}});
        }
        folder.write("seeds.json", json{{"labels", labels}}.dump());
        folder.answer(ct.string() + " --threshold 20 --seeds " + folder / "seeds.json" + " -o " +
                      folder / "labels.nrrd");
        const volume::Grid found = volume::lps_grid(volume::read_volume(folder / "labels.nrrd"));
        REQUIRE(found.size == truth.size);
        for (const float label : {1.0f, 2.0f}) {
            double both = 0.0, sum = 0.0;
            for (std::size_t v = 0; v < truth.values.size(); ++v) {
                both += truth.values[v] == label && found.values[v] == label;
                sum += (truth.values[v] == label) + (found.values[v] == label);
            }
            mean += both / sum / seedings;
        }
    }
    CHECK(mean > 0.92);
}
