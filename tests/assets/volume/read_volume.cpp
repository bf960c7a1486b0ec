// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/scan_volume.hpp"

#include "assets/file/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/assets/volume/written_volume.hpp"
#include "tests/support/catch.hpp"

#include <zlib.h>
#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstring>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

// Even HU that differ at each sample, none of them symmetric: a wrong order or direction shows.
WrittenVolume ramp() {
    WrittenVolume v;
    v.size = {7, 6, 5};
    v.step = Mat3(Vec3(0.5, 0.0, 0.0), Vec3(0.0, 0.6, 0.0), Vec3(0.0, 0.0, 1.5));
    v.origin = {-3.0, 20.0, -100.0};
    v.fill([](const Vec3& p) {
        return -1000.0 + 2.0 * std::round(20.0 * (p.x + 3.0) + 3.0 * (p.y - 20.0) + p.z + 100.0);
    });
    return v;
}

void check_same(const volume::ScanVolume& read, const WrittenVolume& v) {
    const volume::Grid grid = volume::lps_grid(read);
    REQUIRE(grid.size == v.size);
    for (int k = 0; k < v.size[2]; ++k)
        for (int j = 0; j < v.size[1]; ++j)
            for (int i = 0; i < v.size[0]; ++i) REQUIRE(grid.at(i, j, k) == float(v.hu[grid.index(i, j, k)]));
    CHECK(glm::length(grid.origin * 1e3 - v.origin) < 1e-4);
    CHECK(glm::length(grid.position(6, 5, 4) * 1e3 - v.position(6, 5, 4)) < 1e-4);
}

struct Place {
    TemporaryFolder folder;
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        file::write_whole_file(folder / name, bytes);
        return folder / name;
    }
    std::filesystem::path pack(const std::string& name, const std::string& bytes) const {
        const gzFile file = gzopen((folder / name).c_str(), "wb");
        gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
        gzclose(file);
        return folder / name;
    }
};

}  // namespace

TEST_CASE("the same samples lie at the same places in NRRD, NIfTI and DICOM") {
    const Place place;
    const WrittenVolume v = ramp();
    check_same(volume::read_volume(place.write("v.nrrd", nrrd_bytes(v))), v);
    for (const bool second : {false, true})
        for (const bool swapped : {false, true})
            for (const bool quaternion : {false, true}) {
                CAPTURE(second, swapped, quaternion);
                const volume::ScanVolume read =
                    volume::read_volume(place.pack("v.nii.gz", nifti_bytes(v, {second, swapped, quaternion})));
                CHECK(read.file_frame == volume::Frame::ras);
                check_same(read, v);
            }
    check_same(volume::read_volume(place.write("v.nii", nifti_bytes(v))), v);
    write_dicom_folder(v, place.folder / "series");
    const volume::ScanVolume dicom = volume::read_volume(place.folder / "series");
    CHECK(dicom.hu == volume::HuKind::calibrated);
    CHECK(dicom.uniform);
    check_same(dicom, v);
    check_same(volume::read_volume(place.folder / "series/000.dcm"), v);
    check_same(volume::read_volume(place.write("enhanced.dcm", enhanced_dicom_bytes(v))), v);
}

TEST_CASE(
    "samples of an NRRD are found behind skipped lines and bytes, at the end of a file, and in a file per slice") {
    const Place place;
    const WrittenVolume v = ramp();
    const std::string plain = nrrd_bytes(v);
    const std::size_t end = plain.find("\n\n") + 1;
    const std::string samples = plain.substr(end + 1);
    std::string packed_header = plain.substr(0, end);
    packed_header.replace(packed_header.find("encoding: raw"), 13, "encoding: gzip");
    const auto bytes_of = [](const std::filesystem::path& path) { return file::read_whole_file(path); };
    const std::string packed = bytes_of(place.pack("s.gz", samples)),
                      late = bytes_of(place.pack("l.gz", "abc" + samples));
    const std::string header = plain.substr(0, end);
    const auto read = [&](const std::string& bytes) { return volume::read_volume(place.write("v.nrrd", bytes)); };
    check_same(read(header + "byte skip: 3\n\nabc" + samples), v);
    check_same(read(header + "byte skip: -1\n\njunk that nobody counted" + samples), v);
    check_same(read(header + "line skip: 2\nbyte skip: 1\n\none\ntwo\n." + samples), v);
    check_same(read(packed_header + "byte skip: 3\n\n" + late), v);
    check_same(read(packed_header + "line skip: 1\n\none\n" + packed), v);
    CHECK_THROWS_WITH(read(header + "byte skip: 4\n\nabc" + samples), ContainsSubstring("cut short"));
    CHECK_THROWS_WITH(read(header + "line skip: 2000000000\n\n" + samples), ContainsSubstring("of 2000000000"));
    CHECK_THROWS_WITH(read(packed_header + "byte skip: 4\n\n" + late), ContainsSubstring("cut short"));
    CHECK_THROWS_WITH(read(packed_header + "byte skip: -1\n\n" + packed), ContainsSubstring("unpack it"));
    std::string damaged = packed;
    damaged[damaged.size() / 2] = static_cast<char>(~damaged[damaged.size() / 2]);
    CHECK_THROWS_WITH(read(packed_header + "line skip: 1\n\none\n" + damaged),
                      ContainsSubstring("copy the file again"));
    std::string list = header + "data file: LIST 2\n";
    const std::size_t slice = samples.size() / static_cast<std::size_t>(v.size[2]);
    for (int k = 0; k < v.size[2]; ++k) {
        const std::string name = fmt::format("slice{}.raw", k);
        place.write(name, samples.substr(static_cast<std::size_t>(k) * slice, slice));
        list += name + "\n";
    }
    check_same(read(list), v);
    std::filesystem::remove(place.folder / "slice3.raw");
    CHECK_THROWS_WITH(read(list), ContainsSubstring("slice3.raw"));
}

TEST_CASE("an InVesalius project has rows from back to front") {
    const Place place;
    const WrittenVolume v = ramp();
    const volume::ScanVolume read = volume::read_volume(place.pack("v.inv3", inv3_tar(v)));
    CHECK(read.values[7] == float(v.hu[7]));
    CHECK(read.map.step[1].y == Approx(-0.6e-3));
    const volume::Grid grid = volume::lps_grid(read);
    CHECK(grid.at(0, 5, 0) == float(v.hu[0]));
}

TEST_CASE("rescale counts per slice, and inverted display changes no value") {
    const Place place;
    const WrittenVolume v = ramp();
    for (int k = 0; k < v.size[2]; ++k) {
        SliceStyle style;
        style.photometric = "MONOCHROME1";
        style.slope = k % 2 ? 2.0 : 1.0;
        style.intercept = -1000.0 - 2.0 * k;
        file::write_whole_file(place.folder / fmt::format("{}.dcm", k), dicom_bytes(v, k, style));
    }
    check_same(volume::read_volume(place.folder.path), v);
}

TEST_CASE("a folder of several series asks which, and takes the one that is named") {
    const Place place;
    const WrittenVolume v = ramp();
    SliceStyle other;
    other.series = "9.8.7";
    write_dicom_folder(v, place.folder / "a");
    write_dicom_folder(v, place.folder / "b", other);
    CHECK_THROWS_WITH(volume::read_volume(place.folder.path),
                      ContainsSubstring("2 series") && ContainsSubstring("--series") &&
                          ContainsSubstring("9.8.7  5 images") && ContainsSubstring("1.2.3.4"));
    check_same(volume::read_volume(place.folder.path, {"9.8.7", {}}), v);
    CHECK_THROWS_WITH(volume::read_volume(place.folder.path, {"5.5", {}}), ContainsSubstring("matches 0"));
    other.image_type = "ORIGINAL\\PRIMARY\\LOCALIZER";
    std::filesystem::remove_all(place.folder / "b");
    write_dicom_folder(v, place.folder / "b", other);
    check_same(volume::read_volume(place.folder.path), v);
}

TEST_CASE("duplicate slices count once, and a slice that is missing, strange or elsewhere is named") {
    const Place place;
    const WrittenVolume v = ramp();
    const auto folder = place.folder.path;
    const auto put = [&](const std::string& name, const WrittenVolume& from, int k, const SliceStyle& style = {}) {
        file::write_whole_file(folder / name, dicom_bytes(from, k, style));
    };
    write_dicom_folder(v, folder);
    put("copy.dcm", v, 2);
    const volume::ScanVolume read = volume::read_volume(folder);
    check_same(read, v);
    CHECK_THAT(read.notes.at(0), ContainsSubstring("duplicate"));
    WrittenVolume changed = v;
    for (auto& value : changed.hu) value = static_cast<std::int16_t>(value + 10);
    put("copy.dcm", changed, 2);
    CHECK_THROWS_WITH(volume::read_volume(folder), ContainsSubstring("at the same position"));
    std::filesystem::remove(folder / "copy.dcm");
    std::filesystem::remove(folder / "740.dcm");
    CHECK_THROWS_WITH(volume::read_volume(folder),
                      ContainsSubstring("missing in 1 place") && ContainsSubstring("3.00 mm apart"));
    WrittenVolume small = v;
    small.size[0] = 6;
    put("740.dcm", small, 2);
    CHECK_THROWS_WITH(volume::read_volume(folder), ContainsSubstring("different size"));
    SliceStyle beside;
    beside.shift = {0.7, 0.0, 0.0};
    put("740.dcm", v, 2, beside);
    CHECK_THROWS_WITH(volume::read_volume(folder), ContainsSubstring("0.70 mm off the line"));
}

TEST_CASE("unevenly spaced slices are interpolated to even ones") {
    const Place place;
    WrittenVolume v = ramp();
    v.size = {4, 4, 9};
    v.fill([](const Vec3& p) { return -1000.0 + 20.0 * (p.z + 100.0); });
    for (int k = 0; k < 9; ++k) {
        // 1.5 mm in the lower half, 2.5 mm above.
        const double z = k < 5 ? 0.0 : 1.0 * (k - 4);
        WrittenVolume moved = v;
        moved.origin.z += z;
        moved.fill([](const Vec3& p) { return -1000.0 + 20.0 * (p.z + 100.0); });
        file::write_whole_file(place.folder / fmt::format("{}.dcm", k), dicom_bytes(moved, k));
    }
    const volume::ScanVolume read = volume::read_volume(place.folder.path);
    CHECK_FALSE(read.uniform);
    CHECK_THAT(read.notes.at(0), ContainsSubstring("interpolated"));
    const volume::Grid grid = volume::lps_grid(read);
    for (int k = 0; k < grid.size[2]; ++k) {
        const double z = grid.position(0, 0, k).z * 1e3;
        CHECK(grid.at(1, 1, k) == Approx(-1000.0 + 20.0 * (z + 100.0)).margin(0.1));
    }
    CHECK(grid.position(0, 0, grid.size[2] - 1).z * 1e3 == Approx(-100.0 + 16.0));
}

TEST_CASE("numbers that a scanner did not turn to HU are told apart") {
    const Place place;
    WrittenVolume v = ramp();
    SliceStyle style;
    style.rescale_type = "US";
    write_dicom_folder(v, place.folder / "us", style);
    CHECK(volume::read_volume(place.folder / "us").hu == volume::HuKind::scanner);
    for (auto& value : v.hu) value = static_cast<std::int16_t>(value + 1000);
    CHECK(volume::read_volume(place.write("scanner.nrrd", nrrd_bytes(v))).hu == volume::HuKind::scanner);
    std::fill(v.hu.begin(), v.hu.end(), std::int16_t{0});
    v.hu[100] = 3;
    v.hu[101] = 1;
    const volume::ScanVolume labels = volume::read_volume(place.write("labels.nrrd", nrrd_bytes(v)));
    CHECK(labels.kind == volume::VolumeKind::labels);
    CHECK(labels.hu == volume::HuKind::none);
}

TEST_CASE("a segmentation brings the names and colours of its segments, in one layer or several") {
    const Place place;
    const std::string fields =
        "Segment0_ID:=a\nSegment0_Name:=Mandible\nSegment0_LabelValue:=1\nSegment0_Layer:=0\nSegment0_Color:=0.5 0.25 "
        "1\n"
        "Segment1_ID:=b\nSegment1_Name:=Teeth\nSegment1_LabelValue:=1\nSegment1_Layer:=1\n";
    const std::string bytes =
        "NRRD0004\ntype: unsigned char\ndimension: 4\nsizes: 2 2 2 2\nspace: left-posterior-superior\n"
        "kinds: list domain domain domain\nspace directions: none (1,0,0) (0,1,0) (0,0,1)\nspace origin: (0,0,0)\n"
        "encoding: raw\n" +
        fields + "\n" + std::string("\1\0\1\1\0\1\0\0\0\0\0\0\0\0\0\0", 16);
    const volume::ScanVolume read = volume::read_volume(place.write("s.seg.nrrd", bytes));
    CHECK(read.kind == volume::VolumeKind::labels);
    REQUIRE(read.segments.size() == 2);
    CHECK(read.segments[0].name == "Mandible");
    CHECK(read.segments[0].colour->z == 1.0);
    CHECK(read.segments[1].label == 2);
    CHECK(read.values == std::vector<float>{1, 2, 2, 0, 0, 0, 0, 0});
    CHECK_THAT(read.notes.back(), ContainsSubstring("1 voxels lie in several"));
}

TEST_CASE("files cut anywhere, empty ones and headers that claim too much give one error") {
    const Place place;
    const WrittenVolume v = ramp();
    const auto refuses = [&](const std::string& name, const std::string& bytes) {
        CAPTURE(name, bytes.size());
        CHECK_THROWS_AS(volume::read_volume(place.write(name, bytes)), Error);
    };
    std::string packed;
    {
        place.pack("v.inv3", inv3_tar(v));
        packed = file::read_whole_file(place.folder / "v.inv3");
    }
    const std::pair<std::string, std::string> files[] = {
        {"c.nrrd", nrrd_bytes(v)}, {"c.nii", nifti_bytes(v)}, {"c.inv3", packed}, {"c.dcm", enhanced_dicom_bytes(v)}};
    for (const auto& [name, whole] : files)
        for (std::size_t length = 0; length < whole.size() - 1; length += 1 + whole.size() / 23)
            refuses(name, whole.substr(0, length));
    std::string huge = nifti_bytes(v);
    for (const std::size_t at : {42, 44, 46}) huge.replace(at, 2, "\xe8\x03");  // 1000 along each axis
    refuses("huge.nii", huge);
    place.pack("huge.nii.gz", huge);
    CHECK_THROWS_WITH(volume::read_volume(place.folder / "huge.nii.gz"), ContainsSubstring("1000000000 voxels"));
    std::string wide = dicom_bytes(v, 0);
    const std::string rows("\x28\0\x10\0US\2\0", 8);
    wide.replace(wide.find(rows) + 8, 2, "\xff\x7f");
    refuses("wide.dcm", wide);
    CHECK_THROWS_WITH(volume::read_volume(place.folder / "nothing.nii"), ContainsSubstring("no such file"));
    refuses("text.txt", "some text");
}

TEST_CASE("a DICOM element whose head reaches beyond its item asks for no memory but is refused") {
    const Place place;
    std::string bytes = enhanced_dicom_bytes(ramp());
    // The last element of the shared item, "LO" of two letters, becomes "OL": its length now lies in the next element.
    const std::size_t at = bytes.find(std::string("\x28\0\x54\x10LO", 6));
    REQUIRE(at != std::string::npos);
    bytes.replace(at + 4, 2, "OL");
    CHECK_THROWS_WITH(volume::read_volume(place.write("v.dcm", bytes)), ContainsSubstring("reaches beyond"));
}

TEST_CASE("raw samples that look like gzip, big-endian ones and those in a file apart are read as they are") {
    const Place place;
    WrittenVolume v = ramp();
    v.hu[0] = static_cast<std::int16_t>(0x8b1f);
    std::string bytes = nrrd_bytes(v);
    const volume::Grid read = volume::lps_grid(volume::read_volume(place.write("v.nrrd", bytes)));
    for (std::size_t n = 0; n < v.hu.size(); ++n) REQUIRE(read.values[n] == float(v.hu[n]));

    const std::size_t end = bytes.find("\n\n") + 1;
    std::string samples = bytes.substr(end + 1), header = bytes.substr(0, end);
    for (std::size_t n = 0; n < samples.size(); n += 2) std::swap(samples[n], samples[n + 1]);
    header.replace(header.find("little"), 6, "big");
    place.write("samples.raw", samples);
    const volume::Grid apart =
        volume::lps_grid(volume::read_volume(place.write("v.nhdr", header + "data file: samples.raw\n")));
    CHECK(apart.values == read.values);
    CHECK(volume::lps_grid(volume::read_volume(place.write("big.nrrd", header + "\n" + samples))).values ==
          read.values);
    CHECK_THROWS_WITH(volume::read_volume(place.write("cut.nrrd", header + "\n" + samples.substr(2))),
                      ContainsSubstring("cut short"));
}

TEST_CASE("a DICOM file of a kind with frames that does not count them is refused") {
    const Place place;
    std::string bytes = enhanced_dicom_bytes(ramp());
    const std::size_t at = bytes.find(std::string("\x28\0\x08\0IS", 6));
    REQUIRE(at != std::string::npos);
    bytes.erase(at, 8 + static_cast<std::size_t>(bytes[at + 6]));
    CHECK_THROWS_WITH(volume::read_volume(place.write("v.dcm", bytes)),
                      ContainsSubstring("without a number of frames"));
}

TEST_CASE("a NIfTI header whose qform is no rotation, and an NRRD origin that is no place, are refused") {
    const Place place;
    const std::string good = nifti_bytes(ramp(), {.quaternion = true});
    check_same(volume::read_volume(place.write("a.nii", good)), ramp());
    const auto with = [&](std::size_t at, float value) {
        std::string bytes = good;
        std::memcpy(&bytes[at], &value, sizeof value);
        return place.write("a.nii", bytes);
    };
    constexpr std::size_t quatern_b = 256, pixdim_2 = 84, offset_x = 268;
    CHECK_THROWS_WITH(volume::read_volume(with(quatern_b, 1.2f)), ContainsSubstring("has a length of"));
    CHECK_THROWS_AS(volume::read_volume(with(quatern_b, std::nanf(""))), Error);
    CHECK_THROWS_WITH(volume::read_volume(with(pixdim_2, -0.6f)), ContainsSubstring("spacing along axis 1 is -0.6"));
    CHECK_THROWS_WITH(volume::read_volume(with(pixdim_2, 0.0f)), ContainsSubstring("spacing along axis 1"));
    CHECK_THROWS_WITH(volume::read_volume(with(offset_x, INFINITY)), ContainsSubstring("is not a number"));
    // A scale of 0 is none, as the format defines.
    std::string unscaled = nifti_bytes(ramp());
    const float zero = 0.0f;
    std::memcpy(&unscaled[112], &zero, sizeof zero);
    CHECK(volume::read_volume(place.write("b.nii", unscaled)).values[0] == (ramp().hu[0] + 1000) / 2);

    const std::string nrrd = nrrd_bytes(ramp());
    const std::size_t at = nrrd.find("space origin: ") + 14, end = nrrd.find('\n', at);
    const auto with_origin = [&](const std::string& origin) {
        return place.write("a.nrrd", std::string(nrrd).replace(at, end - at, origin));
    };
    CHECK_THROWS_WITH(volume::read_volume(with_origin("(0,inf,0)")), ContainsSubstring("origin is not a place"));
    CHECK_THROWS_WITH(volume::read_volume(with_origin("(0,nan,0)")), ContainsSubstring("origin is not a place"));
    CHECK_THAT(volume::read_volume(with_origin("(nan,nan,nan)")).notes.at(0), ContainsSubstring("no space origin"));
}
