// SPDX-License-Identifier: Apache-2.0
// Files for ITK, read back by ITK itself.
#include "assets/file/whole_file.hpp"
#include "assets/transform/transform_file.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/random.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/skip.hpp"

#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

using namespace tactus;

namespace {

/// Compiles the reader; empty if that fails, as on a machine without ITK.
std::string itk_reader(const TemporaryFolder& folder) {
    constexpr const char* headers = "/usr/include/ITK-5.2";
    std::string libraries;
    for (const char* name : {"ITKCommon", "ITKTransformFactory", "ITKTransform", "ITKIOTransformBase",
                             "ITKIOTransformInsightLegacy", "ITKIOTransformHDF5", "ITKIOImageBase", "ITKIONRRD",
                             "ITKIONIFTI", "itksys", "itkvnl", "itkvnl_algo", "itkvcl"})
        libraries += fmt::format(" -l{}-5.2", name);
    const std::string program = (folder / "read_by_itk").string();
    if (!std::filesystem::exists(headers)) return "";
    const std::string build = fmt::format(
        "c++ -std=c++17 -w -isystem {} $(pkg-config --cflags hdf5) -x c++ {} -x none -o {} {} 2>&1", headers,
        (test::source_folder() / "tests/assets/transform/read_by_itk.cxx").string(), program, libraries);
    REQUIRE(std::system(build.c_str()) == 0);
    return program;
}

std::vector<double> numbers_in(std::istringstream& lines, const std::string& kind) {
    std::string line, word;
    REQUIRE(std::getline(lines, line));
    std::istringstream words(line);
    REQUIRE((words >> word && word == kind));
    std::vector<double> numbers;
    for (double number; words >> number;) numbers.push_back(number);
    return numbers;
}

/// Uneven in size, spacing and origin.
volume::Grid small_scan() {
    volume::Grid grid;
    grid.size = {5, 7, 11};
    grid.origin = Vec3(12.5, -80.25, 301.0) * mm;
    grid.spacing = Vec3(0.5, 0.625, 1.25) * mm;
    grid.values.resize(grid.count());
    for (std::size_t n = 0; n < grid.values.size(); ++n) grid.values[n] = static_cast<float>(n % 97) - 40.0f;
    return grid;
}

}  // namespace

TEST_CASE("ITK maps points by written transforms, and places written voxels, as the program does", "[long]") {
    const TemporaryFolder folder;
    const std::string reader = itk_reader(folder);
    if (reader.empty()) return test::skip("no libinsighttoolkit5-dev here");
    std::string files;
    std::vector<Pose> motions;
    for (std::uint64_t n = 0; n < 4; ++n) {
        const Random random{n};
        const auto normal = [&](std::uint64_t k) { return random.normal(k); };
        motions.push_back(
            {0.2 * Vec3(normal(0), normal(1), normal(2)), glm::normalize(Quat(normal(3), normal(4), normal(5), 1.0))});
        for (const char* type : {"tfm", "h5"}) {
            const auto file = folder / fmt::format("motion-{}.{}", n, type);
            transform::write_motion(file, motions.back());
            files += " " + file.string();
        }
    }
    const volume::Grid scan = small_scan();
    std::vector<std::uint8_t> labels(scan.count());
    for (std::size_t n = 0; n < labels.size(); ++n) labels[n] = static_cast<std::uint8_t>(n % 3);
    volume::write_volume(scan, volume::WrittenType::int16, folder / "scan.nrrd");
    volume::write_volume(scan, volume::WrittenType::int16, folder / "scan.nii.gz");
    volume::write_labels(scan, labels, std::vector<volume::Segment>{}, folder / "labels.seg.nrrd");
    for (const char* name : {"scan.nrrd", "scan.nii.gz", "labels.seg.nrrd"}) files += " " + (folder / name).string();
    const std::string printed = (folder / "itk.txt").string();
    REQUIRE(std::system((reader + files + " > " + printed).c_str()) == 0);
    std::istringstream lines(file::read_whole_file(printed));
    // ITK's transform leads from the space after the motion to the space before it.
    for (const Pose& motion : motions)
        for (int type = 0; type < 2; ++type) {
            const std::vector<double> there = numbers_in(lines, "transform");
            REQUIRE(there.size() == 3);
            const Vec3 back = motion.apply(mm * Vec3(there[0], there[1], there[2])) / mm;
            CHECK(glm::length(back - Vec3(10.0, 20.0, 30.0)) < 1e-9);
        }
    const double values = std::accumulate(scan.values.begin(), scan.values.end(), 0.0),
                 all_labels = std::accumulate(labels.begin(), labels.end(), 0.0);
    for (const double sum : {values, values, all_labels}) {
        const std::vector<double> image = numbers_in(lines, "image");
        REQUIRE(image.size() == 19);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            CHECK(image[axis] == scan.size[axis]);
            CHECK(image[3 + axis] == Approx(scan.spacing[static_cast<int>(axis)] / mm).epsilon(1e-6));
            CHECK(image[6 + axis] == Approx(scan.origin[static_cast<int>(axis)] / mm).epsilon(1e-6));
            for (std::size_t column = 0; column < 3; ++column)
                CHECK(image[9 + 3 * axis + column] == Approx(axis == column ? 1.0 : 0.0).margin(1e-6));
        }
        CHECK(image[18] == sum);
    }
}
