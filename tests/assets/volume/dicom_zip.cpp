// SPDX-License-Identifier: Apache-2.0
// DICOM series in a zip.
#include "assets/bone/import.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/volume/scan_volume.hpp"
#include "dsp/core/error.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/assets/volume/written_volume.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/written_zip.hpp"

#include <glm/geometric.hpp>

#include <algorithm>

using namespace tactus;
using Catch::Matchers::ContainsSubstring;

namespace {

WrittenVolume ball() {
    WrittenVolume v;
    v.size = {32, 30, 28};
    v.step = Mat3(Vec3(0.8, 0.0, 0.0), Vec3(0.0, 0.8, 0.0), Vec3(0.0, 0.0, 1.0));
    v.origin = Vec3(-12.0, -12.0, -14.0);
    v.fill([](const Vec3& p) { return std::clamp(300.0 + 900.0 * (8.0 - glm::length(p)), -1000.0, 1400.0); });
    return v;
}

std::vector<std::pair<std::string, std::string>> files_of(const std::filesystem::path& folder, const std::string& in) {
    std::vector<std::pair<std::string, std::string>> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        files.emplace_back(in + entry.path().filename().string(), file::read_whole_file(entry.path()));
    std::sort(files.begin(), files.end());
    return files;
}

}  // namespace

TEST_CASE("a zip of a DICOM series holds the same volume as its folder, and leaves nothing beside it") {
    const TemporaryFolder folder;
    const WrittenVolume v = ball();
    write_dicom_folder(v, folder / "series");
    auto files = files_of(folder / "series", "PATIENT/CT/");
    files.emplace_back("README.txt", "burned by a viewer");
    files.emplace_back("DICOMDIR", std::string(128, '\0') + "DICM");
    std::filesystem::create_directory(folder / "zips");
    test::write_zip(folder / "zips/ct.zip", files);
    const volume::ScanVolume from_folder = volume::read_volume(folder / "series");
    const volume::ScanVolume from_zip = volume::read_volume(folder / "zips/ct.zip");
    CHECK(from_zip.values == from_folder.values);
    CHECK(from_zip.size == from_folder.size);
    CHECK(from_zip.map.origin == from_folder.map.origin);
    CHECK(from_zip.hu == from_folder.hu);
    CHECK(volume::is_volume_file(folder / "zips/ct.zip"));
    CHECK(std::distance(std::filesystem::directory_iterator(folder / "zips"), {}) == 1);

    bone::ImportOptions options;
    options.input = folder / "zips/ct.zip";
    options.threshold = 300.0;
    bone::ImportSummary summary;
    const bone::Bone bone = bone::import_bone(options, {}, &summary);
    CHECK(summary.bone_volume_mm3 == Approx(4.0 / 3.0 * 3.14159 * 512.0).epsilon(0.02));
    CHECK(bone.name == "ct");
}

TEST_CASE("frames of one enhanced file in a zip, and two files of one name, are read") {
    const TemporaryFolder folder;
    const WrittenVolume v = ball();
    test::write_zip(folder / "one.zip", {{"enhanced.dcm", enhanced_dicom_bytes(v)}});
    CHECK(volume::read_volume(folder / "one.zip").size == v.size);
    write_dicom_folder(v, folder / "series");
    auto files = files_of(folder / "series", "");
    for (auto& [name, bytes] : files) name = "folder" + name.substr(0, name.find('.')) + "/IM";
    test::write_zip(folder / "same.zip", files);
    CHECK(volume::read_volume(folder / "same.zip").size == v.size);
}

TEST_CASE("a zip of other things, or with a damaged image, is one error that names it") {
    const TemporaryFolder folder;
    test::write_zip(folder / "text.zip", {{"a.nrrd", nrrd_bytes(ball())}});
    CHECK_THROWS_WITH(volume::read_volume(folder / "text.zip"), ContainsSubstring("the zip has no DICOM images"));
    write_dicom_folder(ball(), folder / "series");
    auto files = files_of(folder / "series", "");
    files[3].second.resize(files[3].second.size() / 2);
    test::write_zip(folder / "cut.zip", files);
    CHECK_THROWS_WITH(volume::read_volume(folder / "cut.zip"), ContainsSubstring(files[3].first));
}
