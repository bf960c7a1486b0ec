// SPDX-License-Identifier: Apache-2.0
#include "assets/library/mandible.hpp"

#include "assets/mesh/mesh.hpp"
#include "tests/support/catch.hpp"

using namespace tactus;

TEST_CASE("the bundled mandible is one closed piece of plausible size with a dense shell and a light core", "[slow]") {
    const bone::Bone bone = library::make_mandible();
    const mesh::Mesh surface = mesh::surface_of(bone.distance);
    const mesh::MeshTopology topology = mesh::topology_of(surface);
    CHECK(topology.is_watertight());
    CHECK(topology.components == 1);
    // An egg of 12 mm by 28 mm has 264 mm²; times 55 mm.
    CHECK(mesh::volume_of(surface) == Approx(264e-6 * 55e-3).epsilon(0.08));
    double shell = 0.0, core = 0.0, shell_count = 0.0, core_count = 0.0;
    for (int k = 0; k < bone.distance.size[2]; ++k)
        for (int j = 0; j < bone.distance.size[1]; ++j)
            for (int i = 0; i < bone.distance.size[0]; ++i) {
                // Away from the two open ends.
                if (std::abs(bone.distance.position(i, j, k).x) > 0.015) continue;
                const double depth = -bone.distance.at(i, j, k);
                if (depth > 1.0e-3 && depth < 1.7e-3) shell += bone.density.at(i, j, k), shell_count += 1.0;
                if (depth > 4e-3) core += bone.density.at(i, j, k), core_count += 1.0;
            }
    CHECK(shell / shell_count == Approx(1700.0).margin(100.0));
    CHECK(core / core_count == Approx(450.0).margin(120.0));
}

TEST_CASE("the bundled mandible is the same every time", "[slow]") {
    CHECK(library::mandible_hu().values == library::mandible_hu().values);
}
