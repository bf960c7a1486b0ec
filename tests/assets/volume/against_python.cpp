// SPDX-License-Identifier: Apache-2.0
// Scans as nibabel and pydicom read them, which share no code with the readers here.
#include "assets/file/whole_file.hpp"
#include "assets/volume/scan_volume.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/assets/volume/written_volume.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

using namespace tactus;

namespace {

bool has_module(const char* name) {
    if (std::system(fmt::format("/usr/bin/python3 -c 'import {}' >/dev/null 2>&1", name).c_str()) == 0) return true;
    test::skip(fmt::format("there is no {} for /usr/bin/python3", name));
    return false;
}

std::istringstream said_by(const TemporaryFolder& folder, const std::string& script, const std::string& arguments) {
    file::write_whole_file(folder / "script.py", script);
    REQUIRE(std::system(fmt::format("/usr/bin/python3 {} {} > {}", (folder / "script.py").string(), arguments,
                                    (folder / "said.txt").string())
                            .c_str()) == 0);
    return std::istringstream(file::read_whole_file(folder / "said.txt"));
}

WrittenVolume oblique_block() {
    WrittenVolume v;
    v.size = {7, 6, 5};
    const double c = std::cos(0.3), s = std::sin(0.3);
    v.step = Mat3(0.5 * Vec3(c, s, 0.0), 0.6 * Vec3(-s, c, 0.0), Vec3(0.0, 0.0, 1.5));
    v.origin = {-3.25, 20.5, -100.0};
    int n = 0;
    v.fill([&n](const Vec3&) { return -1000.0 + 2.0 * (n++ * 37 % 900); });
    return v;
}

/// Number, sum and weighted sum of the values of a scan, and where a sample lies, mm.
void check_alike(const volume::ScanVolume& scan, std::istringstream& said, double sign) {
    double count = 0.0, sum = 0.0, weighted = 0.0;
    Vec3 place{0.0};
    REQUIRE(said >> count >> sum >> weighted >> place.x >> place.y >> place.z);
    double own_sum = 0.0, own_weighted = 0.0;
    for (std::size_t n = 0; n < scan.values.size(); ++n) {
        own_sum += double(scan.values[n]);
        own_weighted += double(scan.values[n]) * static_cast<double>(n % 13);
    }
    CHECK(count == static_cast<double>(scan.values.size()));
    CHECK(own_sum == Approx(sum).epsilon(1e-6));
    CHECK(own_weighted == Approx(weighted).epsilon(1e-6));
    const Vec3 own = scan.map(Vec3(3.0, 2.0, 4.0)) * 1e3;
    CHECK(glm::length(own - Vec3(sign * place.x, sign * place.y, place.z)) < 1e-3);
}

}  // namespace

TEST_CASE("nibabel reads the same samples at the same places from NIfTI, whatever sform, qform and scale say",
          "[slow]") {
    if (!has_module("nibabel")) return;
    const TemporaryFolder folder;
    const auto with = [](std::string bytes, std::size_t at, auto value) {
        std::memcpy(&bytes[at], &value, sizeof value);
        return bytes;
    };
    const WrittenVolume v = oblique_block();
    const std::string rows = nifti_bytes(v), turned = nifti_bytes(v, {.quaternion = true});
    constexpr std::size_t slope = 112, intercept = 116, qform = 252, pixdim_1 = 80;
    const std::pair<const char*, std::string> files[] = {
        {"rows.nii", rows},
        {"turned.nii", turned},
        {"swapped.nii", nifti_bytes(v, {.swapped = true, .quaternion = true})},
        {"second.nii", nifti_bytes(v, {.second = true})},
        {"no_scale.nii", with(rows, slope, 0.0f)},
        {"no_number.nii", with(rows, slope, std::nanf(""))},
        {"negative_scale.nii", with(with(rows, slope, -1.5f), intercept, 7.0f)},
        // The rows count, whatever the spacing and a second transform say.
        {"both.nii", with(rows, qform, std::int16_t{1})},
        {"no_spacing.nii", with(rows, pixdim_1, 0.0f)},
    };
    std::string names;
    for (const auto& [name, bytes] : files) {
        file::write_whole_file(folder / name, bytes);
        names += " " + (folder / name).string();
    }
    std::istringstream said = said_by(folder,
                                      "import sys, nibabel, numpy\nfor name in sys.argv[1:]:\n v = nibabel.load(name)\n"
                                      " d = numpy.asarray(v.dataobj, float).reshape(-1, order='F')\n"
                                      " print(d.size, d.sum(), (d * (numpy.arange(d.size) % 13)).sum(), "
                                      "*(v.affine @ [3, 2, 4, 1])[:3])\n",
                                      names);
    for (const auto& [name, bytes] : files) {
        CAPTURE(name);
        // RAS is LPS with x and y turned round.
        check_alike(volume::read_volume(folder / name), said, -1.0);
    }
}

TEST_CASE(
    "pydicom reads the same samples at the same places from slices with a rescale of their own and a tilted gantry",
    "[slow]") {
    if (!has_module("pydicom")) return;
    for (const double degrees : {0.0, 20.0}) {
        CAPTURE(degrees);
        const TemporaryFolder folder;
        WrittenVolume v = oblique_block();
        const double angle = degrees * 3.14159265358979 / 180.0;
        v.step = Mat3(Vec3(0.5, 0.0, 0.0), 0.6 * Vec3(0.0, std::cos(angle), std::sin(angle)), Vec3(0.0, 0.0, 1.5));
        int n = 0;
        v.fill([&n](const Vec3&) { return -1000.0 + 2.0 * (n++ * 37 % 900); });
        std::filesystem::create_directories(folder.path / "series");
        for (int k = 0; k < v.size[2]; ++k) {
            SliceStyle style;
            style.slope = 1.0 + 0.5 * (k % 3), style.intercept = -1024.0 - 2.0 * k;
            file::write_whole_file(folder.path / "series" / fmt::format("{}.dcm", (k * 3) % 5),
                                   dicom_bytes(v, k, style));
        }
        std::istringstream said = said_by(
            folder,
            "import sys, glob, numpy, pydicom\ns = [pydicom.dcmread(f) for f in glob.glob(sys.argv[1] + '/*.dcm')]\n"
            "s.sort(key=lambda d: float(d.ImagePositionPatient[2]))\n"
            "d = numpy.concatenate([(i.pixel_array * float(i.RescaleSlope) + float(i.RescaleIntercept)).reshape(-1) "
            "for i in s])\n"
            "o = numpy.array(s[4].ImageOrientationPatient, float)\n"
            "p = numpy.array(s[4].ImagePositionPatient, float) + 3 * float(s[4].PixelSpacing[1]) * o[:3] + 2 * "
            "float(s[4].PixelSpacing[0]) * o[3:]\nprint(d.size, d.sum(), (d * (numpy.arange(d.size) % 13)).sum(), "
            "*p)\n",
            (folder.path / "series").string());
        check_alike(volume::read_volume(folder.path / "series"), said, 1.0);
    }
}
