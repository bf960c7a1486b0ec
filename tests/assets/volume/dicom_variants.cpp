// SPDX-License-Identifier: Apache-2.0
// DICOM files as scanners and programs write them, against the standard or at its edges.
#include "assets/file/whole_file.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/assets/volume/dicom_changes.hpp"
#include "tests/assets/volume/written_volume.hpp"
#include "tests/support/catch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <string>
#include <vector>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

WrittenVolume block_with_bone(int slices = 12) {
    WrittenVolume v;
    v.size = {12, 10, slices};
    v.step = Mat3(Vec3(2.5, 0.0, 0.0), Vec3(0.0, 2.5, 0.0), Vec3(0.0, 0.0, 2.0));
    v.origin = {-10.5, 20.25, -100.5};
    v.fill([](const Vec3& p) { return p.x > 0.0 && p.x < 10.0 ? 1500.0 : -1000.0; });
    return v;
}

/// A file per slice, each changed by `change`.
void write_slices(const WrittenVolume& v, const std::filesystem::path& folder,
                  const std::function<std::string(std::string)>& change) {
    std::filesystem::create_directories(folder);
    for (int k = 0; k < v.size[2]; ++k)
        file::write_whole_file(folder / fmt::format("{:03}.dcm", k), change(dicom_bytes(v, k)));
}

std::string note_of(const volume::ScanVolume& read) { return fmt::format("{}", fmt::join(read.notes, "; ")); }

}  // namespace

TEST_CASE("DICOM files of unusual encoding hold the same volume") {
    const WrittenVolume v = block_with_bone();
    const TemporaryFolder place;
    write_slices(v, place / "plain", [](std::string bytes) { return bytes; });
    const volume::ScanVolume plain = volume::read_volume(place / "plain");
    const std::pair<const char*, std::function<std::string(std::string)>> ways[] = {
        {"private UN of undefined length", [](std::string bytes) { return with_unknown_sequence(std::move(bytes)); }},
        {"zeros behind the last element", [](std::string bytes) { return bytes + std::string(64, '\0'); }},
        {"without a preamble", [](std::string bytes) { return bytes.substr(132); }},
        {"spacing as unlimited text", with_spacing_as_text},
        {"deflated", deflated},
    };
    for (const auto& [name, change] : ways) {
        CAPTURE(name);
        write_slices(v, place / name, change);
        const volume::ScanVolume read = volume::read_volume(place / name);
        CHECK(read.values == plain.values);
        CHECK(read.map.step[0].x == plain.map.step[0].x);
    }
}

TEST_CASE("a segmentation of one bit per sample, without gaps between frames, is a label map") {
    WrittenVolume v = block_with_bone(5);
    // 11 x 9 samples a frame: frames begin within bytes.
    v.size = {11, 9, 5};
    v.fill([](const Vec3& p) { return p.x > 0.0 && p.x < 10.0 && p.z > -97.0 ? 1500.0 : -1000.0; });
    std::vector<float> expected;
    for (const std::int16_t hu : v.hu) expected.push_back(hu > 0 ? 1.0f : 0.0f);
    const TemporaryFolder place;
    file::write_whole_file(place / "seg.dcm", one_bit_segmentation(v));
    const volume::ScanVolume read = volume::read_volume(place / "seg.dcm");
    CHECK(read.size == std::array<int, 3>{11, 9, 5});
    CHECK(read.values == expected);
    CHECK(read.kind == volume::VolumeKind::labels);
}

TEST_CASE("numbers with decimal commas are read whole and noted, other text is refused with its element") {
    const WrittenVolume v = block_with_bone();
    const TemporaryFolder place;
    const auto commas = [](std::string text) {
        std::replace(text.begin(), text.end(), '.', ',');
        return text;
    };
    write_slices(v, place / "comma", [&](const std::string& bytes) {
        return with_value(with_value(bytes, 0x28, 0x30, commas), 0x20, 0x32, commas);
    });
    const volume::ScanVolume read = volume::read_volume(place / "comma");
    CHECK(read.spacing().x == Approx(2.5e-3));
    CHECK(read.map.origin.x == Approx(-10.5e-3));
    CHECK_THAT(note_of(read), ContainsSubstring("decimal commas"));
    for (const char* wrong : {"2.5x\\2.5", "2.5.1\\2.5", "\\2,5", "1e999\\1", "nan\\1"}) {
        CAPTURE(wrong);
        write_slices(v, place / "wrong", [&](const std::string& bytes) {
            return with_value(bytes, 0x28, 0x30, [&](auto&&) { return wrong; });
        });
        CHECK_THROWS_WITH(volume::read_volume(place / "wrong"), ContainsSubstring("(0028,0030)"));
    }
}

TEST_CASE("colour images and scout views beside the slices of a CT are left out and listed") {
    const WrittenVolume v = block_with_bone();
    const TemporaryFolder place;
    write_slices(v, place / "ct", [](std::string bytes) { return bytes; });
    const std::string colour = with_value(dicom_bytes(v, 0), 0x28, 2, [](auto&&) { return std::string("\3\0", 2); });
    file::write_whole_file(place / "ct/screen.dcm", colour);
    SliceStyle scout;
    scout.image_type = "ORIGINAL\\PRIMARY\\LOCALIZER";
    scout.shift = Vec3(50.0, 0.0, 3.3);
    file::write_whole_file(place / "ct/scout.dcm", dicom_bytes(v, 1, scout));
    const volume::ScanVolume read = volume::read_volume(place / "ct");
    CHECK(read.size == v.size);
    CHECK_THAT(note_of(read),
               ContainsSubstring("1 colour image (screen.dcm)") && ContainsSubstring("1 scout view (scout.dcm)"));
    std::filesystem::create_directory(place / "only");
    file::write_whole_file(place / "only/screen.dcm", colour);
    CHECK_THROWS_WITH(volume::read_volume(place / "only"), ContainsSubstring("colour"));
}

TEST_CASE("padding is air, whether the file states it or not, and bits beyond the stored ones are refused") {
    const WrittenVolume v = block_with_bone();
    const TemporaryFolder place;
    // Unsigned, with the samples of the first row outside the field of view.
    const auto padded = [&](std::string bytes) {
        bytes = with_value(std::move(bytes), 0x28, 0x103, [](auto&&) { return std::string(2, '\0'); });
        const std::size_t samples = bytes.size() - static_cast<std::size_t>(v.size[0] * v.size[1]) * 2;
        for (std::size_t n = 0; n < static_cast<std::size_t>(v.size[0]); ++n)
            bytes.replace(samples + 2 * n, 2, "\x30\xf8");
        return bytes;
    };
    write_slices(v, place / "unstated", padded);
    const std::string stated = tag_bytes(0x28, 0x120) + std::string("US\2\0\x30\xf8", 6);
    write_slices(v, place / "stated", [&](std::string bytes) {
        bytes = padded(std::move(bytes));
        return bytes.insert(bytes.find(tag_bytes(0x28, 0x1052), 132), stated);
    });
    for (const char* name : {"unstated", "stated"}) {
        CAPTURE(name);
        volume::ScanVolume read = volume::read_volume(place / name);
        CHECK(*std::max_element(read.values.begin(), read.values.end()) == 1500.0f);
        CHECK(*std::min_element(read.values.begin(), read.values.end()) == -1000.0f);
        CHECK_THAT(note_of(read), ContainsSubstring("144 samples are padding (63536"));
    }
    write_slices(v, place / "twelve", [&](std::string bytes) {
        bytes = with_value(padded(std::move(bytes)), 0x28, 0x101, [](auto&&) { return std::string("\14\0", 2); });
        return with_value(std::move(bytes), 0x28, 0x102, [](auto&&) { return std::string("\13\0", 2); });
    });
    CHECK_THROWS_WITH(volume::read_volume(place / "twelve"), ContainsSubstring("63536 does not fit the 12 bits"));
}

TEST_CASE("missing slices are found among uneven ones, and a series whose spacing changes once is legal") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const WrittenVolume v = block_with_bone(24);
    for (int round = 0; round < 12; ++round) {
        const TemporaryFolder place;
        const double noise = 0.02 * (round % 4), change = round % 3 == 2 ? 2.0 : 1.0;
        const int missing = round % 3 == 1 ? 5 + round : -1;
        CAPTURE(round, noise, change, missing);
        double height = 0.0;
        for (int k = 0; k < v.size[2]; ++k) {
            SliceStyle style;
            height += k < 12 ? 2.0 : 2.0 * change;
            style.shift.z = height + noise * uniform(random) - 2.0 * k;
            if (k != missing) file::write_whole_file(place / fmt::format("{:03}.dcm", k), dicom_bytes(v, k, style));
        }
        if (missing < 0) {
            CHECK_NOTHROW(volume::read_volume(place.path));
            continue;
        }
        CHECK_THROWS_WITH(volume::read_volume(place.path),
                          ContainsSubstring("missing in 1 place") && ContainsSubstring("--fill-gaps") &&
                              ContainsSubstring(fmt::format("{:03}.dcm and {:03}.dcm", missing - 1, missing + 1)));
        volume::ReadOptions fills;
        fills.fill_gaps = true;
        const volume::ScanVolume read = volume::read_volume(place.path, fills);
        CHECK_THAT(note_of(read), ContainsSubstring("interpolated"));
        for (const float value : read.values) CHECK((value >= -1000.0f && value <= 1500.0f));
    }
}

TEST_CASE("a library that ends on a file is one error, and the next file is read") {
    const WrittenVolume v = block_with_bone();
    const TemporaryFolder place;
    write_slices(v, place / "ct", [](std::string bytes) { return bytes; });
    const char* before = std::getenv("TACTUS_SCAN_DECODER");
    const std::string program = before ? before : "";
    ::setenv("TACTUS_SCAN_DECODER", "/bin/false", 1);
    CHECK_THROWS_WITH(volume::read_volume(place / "ct"),
                      ContainsSubstring("000.dcm") && ContainsSubstring("ended with exit code 1"));
    ::setenv("TACTUS_SCAN_DECODER", "/nowhere", 1);
    CHECK_THROWS_AS(volume::read_volume(place / "ct"), Error);
    if (before) ::setenv("TACTUS_SCAN_DECODER", program.c_str(), 1);
    else ::unsetenv("TACTUS_SCAN_DECODER");
    CHECK(volume::read_volume(place / "ct").size == v.size);
}

TEST_CASE(
    "voxels that are not numbers are air, float label maps may be labels, and a fourth axis of one sample is none") {
    const TemporaryFolder place;
    const auto nrrd = [&](const std::string& name, const std::string& head, const std::vector<float>& values) {
        std::string bytes =
            "NRRD0004\ntype: float\nspace: left-posterior-superior\nencoding: raw\nendian: little\n" + head + "\n";
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float));
        file::write_whole_file(place / name, bytes);
        return volume::read_volume(place / name);
    };
    const std::string three = "dimension: 3\nsizes: 4 4 4\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n";
    const std::string origin = "space origin: (1,2,3)\n";
    std::vector<float> values(64, -1000.0f);
    values[20] = 1200.0f, values[21] = std::nanf("");
    volume::ScanVolume read = nrrd("nan.nrrd", three + origin, values);
    CHECK(read.values[21] == -1000.0f);
    CHECK(read.hu == volume::HuKind::calibrated);
    CHECK_THAT(note_of(read), ContainsSubstring("1 of 64 voxels are not numbers"));
    CHECK_THROWS_WITH(nrrd("all.nrrd", three + origin, std::vector<float>(64, std::nanf(""))),
                      ContainsSubstring("no voxel"));
    std::vector<float> labels(64, 0.0f);
    labels[5] = 1.0f, labels[9] = 2.0f;
    CHECK(volume::name_of(nrrd("labels.nrrd", three + origin, labels).kind) == "labels?");
    CHECK_THAT(note_of(nrrd("noorigin.nrrd", three, values)), ContainsSubstring("no space origin"));
    read = nrrd("four.nrrd", "dimension: 4\nsizes: 4 4 4 1\nspace directions: (1,0,0) (0,1,0) (0,0,1) none\n" + origin,
                values);
    CHECK(read.size == std::array{4, 4, 4});
    CHECK_THAT(note_of(read), ContainsSubstring("fourth axis"));
}

TEST_CASE("a NIfTI pair is read by either of its files") {
    const WrittenVolume v = block_with_bone();
    const TemporaryFolder place;
    std::string bytes = nifti_bytes(v);
    const std::string samples = bytes.substr(352);
    bytes.resize(348);
    bytes.replace(344, 3, "ni1");
    bytes.replace(108, 4, std::string(4, '\0'));
    file::write_whole_file(place / "a.hdr", bytes);
    CHECK_THROWS_WITH(volume::read_volume(place / "a.hdr"), ContainsSubstring("a.img"));
    file::write_whole_file(place / "a.img", samples);
    file::write_whole_file(place / "a.nii", nifti_bytes(v));
    const std::vector<float> right = volume::read_volume(place / "a.nii").values;
    CHECK(volume::read_volume(place / "a.hdr").values == right);
    CHECK(volume::read_volume(place / "a.img").values == right);
}
