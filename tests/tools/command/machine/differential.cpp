// SPDX-License-Identifier: Apache-2.0
// The same files read by the libraries that other programs use: what differs is a fault of one of them.
#include "assets/file/whole_file.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/run_command.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace fs = std::filesystem;
using namespace tactus;
using nlohmann::json;

namespace {

/// Runs a script in `folder`, which writes files, and what the library reads from them into expected.json. None where
/// the library is not installed.
json expected_of(const fs::path& folder, const std::string& import, const std::string& script) {
    if (std::system(fmt::format("/usr/bin/python3 -c '{}' >/dev/null 2>&1", import).c_str()) != 0) {
        test::skip(fmt::format("/usr/bin/python3 has no {}", import));
        return {};
    }
    file::write_whole_file(folder / "write.py",
                           import + "\nimport json, numpy as np\nr = np.random.RandomState(11)\nfound = []\n" + script +
                               "\njson.dump(found, open('expected.json', 'w'))\n");
    REQUIRE(std::system(fmt::format("cd '{}' && /usr/bin/python3 write.py >log.txt 2>&1", folder.string()).c_str()) ==
            0);
    return json::parse(file::read_whole_file(folder / "expected.json"));
}

json answer(const test::Folder& folder, const std::string& arguments) {
    const test::Outcome done = folder.tactus(arguments);
    INFO(arguments << "\n" << done.err);
    REQUIRE(done.code == 0);
    return json::parse(done.out);
}

/// Size, spacing, range and the bounds of the part above the threshold, which depend on origin and directions.
void check_volume(const test::Folder& folder, const json& expected) {
    const json found =
        answer(folder, "info " + (folder.path / expected["file"].get<std::string>()).string() + " --json");
    INFO(expected.dump() << "\n" << found.dump());
    CHECK(found["size"] == expected["size"]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        CHECK(found["spacing_mm"][axis].get<double>() == Approx(expected["spacing"][axis].get<double>()).epsilon(1e-5));
        for (std::size_t end = 0; end < 2; ++end)
            CHECK(found["components"][0]["bounds_mm"][axis][end].get<double>() ==
                  Approx(expected["bounds"][axis][end].get<double>()).margin(1e-3));
    }
    for (std::size_t end = 0; end < 2; ++end)
        CHECK(found["range"][end].get<double>() == Approx(expected["range"][end].get<double>()).epsilon(1e-5));
}

// Bounds of the voxels above 300 from indices to LPS mm, up to the outer faces.
constexpr const char* bounds = R"(
def bounds_of(values, to_lps):
    at = np.argwhere(values > 300)
    corners = np.array([[x, y, z] for x in (at[:, 0].min() - .5, at[:, 0].max() + .5)
                        for y in (at[:, 1].min() - .5, at[:, 1].max() + .5) for z in (at[:, 2].min() - .5, at[:, 2].max() + .5)])
    points = corners @ to_lps[:3, :3].T + to_lps[:3, 3]
    return [[points[:, n].min(), points[:, n].max()] for n in range(3)]
)";

}  // namespace

TEST_CASE("volumes of nibabel have the size, place, directions and values that it reads", "[long]") {
    const test::Folder folder;
    const json expected = expected_of(folder.path, "import nibabel", std::string(bounds) + R"(
for n, kind in enumerate(['<i2', '>i2', '<f4', '>f8', '<u2', '<i4', '<i2', '>u2']):
    size = r.randint(9, 15, 3)
    values = np.full(size, -1000.0)
    values[2:7, 3:6, 4:8] = 1000
    # Axes in any order and direction.
    step = np.zeros((4, 4))
    for axis, to in enumerate(r.permutation(3)): step[to, axis] = r.choice([-1, 1]) * r.uniform(.4, 2)
    step[:3, 3], step[3, 3] = r.uniform(-90, 90, 3), 1
    slope, offset = (1, 0) if kind[1] != 'u' else (2, -1000)
    image = nibabel.Nifti1Image(((values - offset) / slope).astype(kind), step, nibabel.Nifti1Header(endianness=kind[0]))
    if n % 4 == 3: image = nibabel.Nifti2Image(values.astype(kind.replace('>u2', '>i2')), step)
    image.set_qform(step, 1), image.set_sform(step if n % 3 else None, 1 if n % 3 else 0)
    image.header.set_xyzt_units('mm')
    name = 'v%d.nii%s' % (n, '.gz' if n % 2 else '')
    if kind[1] == 'u' and n % 4 != 3: image.header.set_slope_inter(slope, offset)
    nibabel.save(image, name)
    back = nibabel.load(name)
    seen = back.get_fdata()
    found.append(dict(file=name, size=list(map(int, size)), spacing=list(map(float, nibabel.affines.voxel_sizes(back.affine))),
                      range=[seen.min(), seen.max()], bounds=bounds_of(seen, np.diag([-1, -1, 1, 1]) @ back.affine)))
)");
    for (const json& each : expected) check_volume(folder, each);
}

TEST_CASE("a series of pydicom has the size, place, directions and values that it reads", "[long]") {
    const test::Folder folder;
    const json expected = expected_of(folder.path, "import pydicom", std::string(bounds) + R"(
import os
from pydicom.dataset import FileDataset, FileMetaDataset
from pydicom.uid import ExplicitVRLittleEndian, ImplicitVRLittleEndian, ExplicitVRBigEndian, generate_uid
for n, syntax in enumerate([ExplicitVRLittleEndian, ImplicitVRLittleEndian, ExplicitVRBigEndian]):
    size = r.randint(9, 15, 3)
    stored = np.full(size, 24 if n else -1000)
    stored[2:7, 3:6, 4:8] = 2024 if n else 1000
    across, down = (np.array(v, float) for v in [((1, 0, 0), (0, 1, 0)), ((0, 1, 0), (0, 0, -1)), ((0, -1, 0), (1, 0, 0))][n])
    spacing, gap, origin = r.uniform(.4, 2, 2).round(3), round(float(r.uniform(.5, 3)), 2), r.uniform(-90, 90, 3).round(2)
    normal, series, folder = np.cross(across, down), generate_uid(), 'd%d' % n
    os.mkdir(folder)
    for k in r.permutation(int(size[2])):
        meta = FileMetaDataset()
        meta.TransferSyntaxUID, meta.MediaStorageSOPClassUID = syntax, '1.2.840.10008.5.1.4.1.1.2'
        meta.MediaStorageSOPInstanceUID = generate_uid()
        d = FileDataset(None, {}, file_meta=meta, preamble=b'\0' * 128)
        d.is_little_endian, d.is_implicit_VR = syntax.is_little_endian, syntax.is_implicit_VR
        d.SOPClassUID, d.SOPInstanceUID, d.SeriesInstanceUID = meta.MediaStorageSOPClassUID, meta.MediaStorageSOPInstanceUID, series
        d.Modality, d.ImageOrientationPatient = 'CT', [*across, *down]
        d.ImagePositionPatient = [round(float(v), 6) for v in origin + gap * k * normal]
        d.PixelSpacing, d.Rows, d.Columns = [float(spacing[1]), float(spacing[0])], int(size[1]), int(size[0])
        d.BitsAllocated, d.BitsStored, d.HighBit = 16, 16, 15
        d.PixelRepresentation, d.SamplesPerPixel, d.PhotometricInterpretation = 0 if n else 1, 1, 'MONOCHROME2'
        d.RescaleSlope, d.RescaleIntercept, d.RescaleType = 1, -1024 if n else 0, 'HU'
        kind = ('u2' if n else 'i2') if syntax.is_little_endian else '>u2'
        d.PixelData = stored[:, :, k].T.astype(kind).tobytes()
        d.save_as('%s/%03d.dcm' % (folder, k), write_like_original=False)
    files = sorted((pydicom.dcmread(folder + '/' + f) for f in os.listdir(folder)),
                   key=lambda d: np.dot(np.cross(d.ImageOrientationPatient[:3], d.ImageOrientationPatient[3:]), d.ImagePositionPatient))
    seen = np.stack([(d.pixel_array * float(d.RescaleSlope) + float(d.RescaleIntercept)).T for d in files], -1)
    to_lps = np.eye(4)
    to_lps[:3, 0], to_lps[:3, 1], to_lps[:3, 2] = across * spacing[0], down * spacing[1], normal * gap
    to_lps[:3, 3] = files[0].ImagePositionPatient
    found.append(dict(file=folder, size=list(map(int, size)), spacing=[float(spacing[0]), float(spacing[1]), gap],
                      range=[seen.min(), seen.max()], bounds=bounds_of(seen, to_lps)))
)");
    for (const json& each : expected) check_volume(folder, each);
}

TEST_CASE("sounds have the rate, channels and level that scipy reads", "[long]") {
    const test::Folder folder;
    const json expected = expected_of(folder.path, "import scipy.io.wavfile", R"(
for n, (kind, full) in enumerate([('u1', 128), ('<i2', 32768), ('<i4', 2 ** 31), ('<f4', 1), ('<f8', 1)]):
    rate, channels = int(r.choice([8000, 11025, 44100])), 1 + n % 3
    values = .4 * np.sin(np.arange(rate)[:, None] * r.uniform(.05, .9, channels)) + .01 * r.randn(rate, channels)
    stored = (values * full + (128 if kind == 'u1' else 0)).astype(kind)
    name = 's%d.wav' % n
    scipy.io.wavfile.write(name, rate, stored)
    back_rate, back = scipy.io.wavfile.read(name)
    back = (back.reshape(rate, -1).astype(float) - (128 if kind == 'u1' else 0)) / full
    found.append(dict(file=name, rate=back_rate, rms=back.std(0).tolist(), mean=back.mean(0).tolist()))
)");
    for (const json& each : expected) {
        const json found = answer(
            folder, "spectrum " + (folder.path / each["file"].get<std::string>()).string() + " --json")["rows"][0];
        INFO(each.dump());
        CHECK(found["sample_rate_hz"] == each["rate"].get<double>());
        REQUIRE(found["channels"].size() == each["rms"].size());
        for (std::size_t c = 0; c < each["rms"].size(); ++c) {
            CHECK(found["channels"][c]["rms"].get<double>() == Approx(each["rms"][c].get<double>()).epsilon(1e-5));
            CHECK(found["channels"][c]["mean"].get<double>() == Approx(each["mean"][c].get<double>()).margin(1e-6));
        }
    }
}

TEST_CASE("a mesh has the volume and the number of facets that admesh reads", "[long]") {
    if (std::system("command -v admesh >/dev/null 2>&1") != 0)
        return test::skip("the Debian package admesh is not installed");
    const test::Folder folder;
    // A torus of 20 and 6 mm, as text.
    constexpr int around = 48, across = 24;
    constexpr double turn = 6.283185307179586;
    const auto point = [](int i, int j) {
        const double a = turn * (i % around) / around, b = turn * (j % across) / across,
                     radius = 20.0 + 6.0 * std::cos(b);
        return fmt::format("vertex {:.6f} {:.6f} {:.6f}\n", radius * std::cos(a), radius * std::sin(a),
                           6.0 * std::sin(b));
    };
    std::string text = "solid torus\n";
    const auto facet = [&](const std::string& a, const std::string& b, const std::string& c) {
        text += "facet normal 0 0 0\nouter loop\n" + a + b + c + "endloop\nendfacet\n";
    };
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j) {
            facet(point(i, j), point(i + 1, j), point(i + 1, j + 1));
            facet(point(i, j), point(i + 1, j + 1), point(i, j + 1));
        }
    file::write_whole_file(folder.path / "torus.stl", text + "endsolid torus\n");
    REQUIRE(
        std::system(fmt::format("cd '{}' && timeout 30 admesh torus.stl </dev/null >log.txt 2>&1", folder.path.string())
                        .c_str()) == 0);
    const std::string log = file::read_whole_file(folder.path / "log.txt");
    const auto number_behind = [&](const std::string& words) {
        const std::size_t at = log.find(words);
        REQUIRE(at != std::string::npos);
        return std::strtod(log.c_str() + log.find(':', at) + 1, nullptr);
    };
    const json found = answer(folder, "info " + (folder.path / "torus.stl").string() + " --json");
    CHECK(number_behind("Number of facets") == 2.0 * around * across);
    CHECK(found["notes"].dump().find(fmt::format("{} triangles", 2 * around * across)) != std::string::npos);
    CHECK(found["components"][0]["volume_mm3"].get<double>() == Approx(number_behind("Volume")).epsilon(1e-4));
}
