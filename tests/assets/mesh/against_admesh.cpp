// SPDX-License-Identifier: Apache-2.0
// STL files as admesh reads them, which shares no code with the reader here.
#include "assets/file/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "tests/assets/bone/temporary_folder.hpp"
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

using namespace tactus;

namespace {

/// Triangles of an ellipsoid about `middle` with these half axes, in single precision as an STL holds them.
std::vector<std::array<Vec3, 3>> ellipsoid_facets(const Vec3& middle, const Vec3& axes, int rings) {
    std::vector<std::array<Vec3, 3>> facets;
    const auto point = [&](int r, int a) {
        const double t = std::numbers::pi * r / rings, p = std::numbers::pi * (a % (2 * rings)) / rings;
        const double s = r == 0 || r == rings ? 0.0 : std::sin(t);
        const Vec3 exact = middle + axes * Vec3(s * std::cos(p), s * std::sin(p), std::cos(t));
        return Vec3(static_cast<float>(exact.x), static_cast<float>(exact.y), static_cast<float>(exact.z));
    };
    for (int r = 0; r < rings; ++r)
        for (int a = 0; a < 2 * rings; ++a) {
            if (r > 0) facets.push_back({point(r, a), point(r + 1, a), point(r, a + 1)});
            if (r < rings - 1) facets.push_back({point(r, a + 1), point(r + 1, a), point(r + 1, a + 1)});
        }
    return facets;
}

std::string admesh_stl(const std::vector<std::array<Vec3, 3>>& facets, bool is_text) {
    if (is_text) {
        std::string out = "solid bone\n";
        for (const auto& facet : facets) {
            out += " facet normal 0 0 0\n  outer loop\n";
            for (const Vec3& v : facet) out += fmt::format("   vertex {:.9g} {:.9g} {:.9g}\n", v.x, v.y, v.z);
            out += "  endloop\n endfacet\n";
        }
        return out + "endsolid bone\n";
    }
    std::string out(80, ' ');
    const auto count = static_cast<std::uint32_t>(facets.size());
    out.append(reinterpret_cast<const char*>(&count), sizeof count);
    for (const auto& facet : facets) {
        out += std::string(12, '\0');
        for (const Vec3& v : facet)
            for (int n = 0; n < 3; ++n) {
                const auto number = static_cast<float>(v[n]);
                out.append(reinterpret_cast<const char*>(&number), sizeof number);
            }
        out += std::string(2, '\0');
    }
    return out;
}

/// The number behind a word of admesh's report.
double number_behind(const std::string& report, const std::string& word) {
    const std::size_t at = report.find(word);
    REQUIRE(at != std::string::npos);
    return std::strtod(report.c_str() + report.find_first_of("-0123456789.", at + word.size()), nullptr);
}

}  // namespace

TEST_CASE("admesh finds the same facets, bounds, parts and volume in binary and text STL") {
    if (std::system("admesh --version >/dev/null 2>&1") != 0) return test::skip("there is no admesh (package admesh)");
    const TemporaryFolder folder;
    std::vector<std::array<Vec3, 3>> facets = ellipsoid_facets({12.5, -40.0, 7.25}, {10.0, 14.0, 6.0}, 24);
    const auto other = ellipsoid_facets({60.0, 10.0, -5.0}, {4.0, 3.0, 8.0}, 11);
    facets.insert(facets.end(), other.begin(), other.end());
    for (const bool is_text : {false, true}) {
        CAPTURE(is_text);
        file::write_whole_file(folder / "a.stl", admesh_stl(facets, is_text));
        REQUIRE(std::system(fmt::format("admesh {} > {}", (folder / "a.stl").string(), (folder / "said.txt").string())
                                .c_str()) == 0);
        const std::string report = file::read_whole_file(folder / "said.txt");
        const mesh::Mesh mesh = mesh::load_mesh(folder / "a.stl");
        CHECK(number_behind(report, "Number of facets") == static_cast<double>(mesh.triangles.size()));
        CHECK(number_behind(report, "Number of parts") == 2.0);
        CHECK(number_behind(report, "Total disconnected facets") == 0.0);
        CHECK(mesh::topology_of(mesh).is_watertight());
        // admesh sums in single precision.
        CHECK(mesh::volume_of(mesh) == Approx(number_behind(report, "Volume")).epsilon(1e-4));
        Vec3 low(1e9), high(-1e9);
        for (const Vec3& v : mesh.vertices)
            for (int n = 0; n < 3; ++n) low[n] = std::min(low[n], v[n]), high[n] = std::max(high[n], v[n]);
        for (int n = 0; n < 3; ++n) {
            const char axis = static_cast<char>('X' + n);
            CHECK(low[n] == Approx(number_behind(report, fmt::format("Min {}", axis))).margin(1e-5));
            CHECK(high[n] == Approx(number_behind(report, fmt::format("Max {}", axis))).margin(1e-5));
        }
    }
}
