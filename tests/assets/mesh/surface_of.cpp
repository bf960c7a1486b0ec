// SPDX-License-Identifier: Apache-2.0
#include "assets/mesh/mesh.hpp"
#include "tests/support/catch.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

using namespace tactus;

TEST_CASE("normals of bone thinner than a voxel look outwards on both of its sides") {
    constexpr double h = 1e-3;  // m
    volume::Grid plate{{24, 24, 12}, Vec3(0.0), Vec3(h), {}};
    // A plate of 0.6 voxels in z that one layer of samples (6) lies in, from 4 to 19 voxels in x and y.
    for (int k = 0; k < 12; ++k)
        for (int j = 0; j < 24; ++j)
            for (int i = 0; i < 24; ++i) {
                const double z = std::abs(k - 5.8) - 0.3;
                plate.values.push_back(
                    static_cast<float>(h * std::max({z, std::abs(i - 11.5) - 7.5, std::abs(j - 11.5) - 7.5})));
            }
    const mesh::Mesh surface = mesh::surface_of(plate);
    REQUIRE(surface.normals.size() == surface.vertices.size());
    std::size_t seen = 0;
    for (std::size_t n = 0; n < surface.vertices.size(); ++n) {
        const Vec3 at = surface.vertices[n] / h;
        if (std::abs(at.x - 11.5) > 6.0 || std::abs(at.y - 11.5) > 6.0) continue;
        ++seen;
        CHECK(surface.normals[n].z * (at.z > 6.0 ? 1.0 : -1.0) > 0.9);
    }
    CHECK(seen > 200);
}
