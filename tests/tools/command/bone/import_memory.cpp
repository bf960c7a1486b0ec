// SPDX-License-Identifier: Apache-2.0
// How much memory the import of a large CT takes, as the system counts it.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/peak_memory.hpp"
#include "tests/tools/run_command.hpp"

#include <cmath>
#include <cstdint>
#include <vector>

using namespace tactus::test;

namespace {

constexpr int width = 320, ball = 12;

// A masked CT of so many layers, written as a file with holes: zeros, and a ball of 1000 HU in two opposite corners, so
// that the box around them is all of it.
void write_ct(const fs::path& path, int layers) {
    std::ofstream file(path, std::ios::binary);
    file << "NRRD0005\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: " << width << ' ' << width
         << ' ' << layers
         << "\nspace directions: (0.45,0,0) (0,0.45,0) (0,0,0.45)\nspace origin: (0,0,0)\nendian: little\n"
         << "encoding: raw\n\n";
    const std::streamoff start = file.tellp();
    const auto at = [&](int i, int j, int k) {
        return start + 2 * ((static_cast<std::streamoff>(k) * width + j) * width + i);
    };
    for (const bool top : {false, true})
        for (int k = -ball; k <= ball; ++k)
            for (int j = -ball; j <= ball; ++j) {
                const int half = static_cast<int>(std::sqrt(std::max(0, ball * ball - j * j - k * k)));
                const std::vector<std::int16_t> row(static_cast<std::size_t>(2 * half + 1), std::int16_t{1000});
                const int across = top ? width - 40 : 40, middle = top ? layers - 40 : 40;
                file.seekp(at(across - half, across + j, middle + k));
                file.write(reinterpret_cast<const char*>(row.data()), static_cast<std::streamsize>(2 * row.size()));
            }
    file.seekp(at(width, width - 1, layers - 1) - 2);
    file.write("\0\0", 2);
}

// Peak of what a child held, in MB.
double peak_of_import(const fs::path& ct, const fs::path& out) {
    const auto peak = tactus::test::peak_memory({"import", ct.string(), "--component", "all", "-o", out.string()});
    REQUIRE(peak.code == 0);
    return peak.kilobytes / 1024.0;
}

}  // namespace

// Costly: whole scans are imported.
TEST_CASE("the memory that an import takes does not grow with the layers of the CT", "[slow]") {
    if (sanitized) {
        skip("sanitizers hold memory of their own");
        return;
    }
    const Folder folder;
    write_ct(folder.path / "ct.nrrd", 300);
    const double small = peak_of_import(folder.path / "ct.nrrd", folder.path / "bone.vdb");
    write_ct(folder.path / "ct.nrrd", 900);
    const double large = peak_of_import(folder.path / "ct.nrrd", folder.path / "bone.vdb");
    const double samples = 1e-6 * width * width * 600;  // millions more
    CAPTURE(small, large, samples);
    // As floats the volume would take 245 MB more, as the file's numbers 123. One run differs from the next by up to
    // 20 MB, as its threads happen to meet: a byte per sample is well apart from both.
    CHECK(large - small < 1.0 * samples);
    CHECK(fs::file_size(folder.path / "bone.vdb") < 2000000);
}
