// SPDX-License-Identifier: Apache-2.0
// Any bytes called .ply are triangles between points that are there, or a tactus::Error; repaired, they have an inside.
#include "assets/mesh/mesh.hpp"
#include "assets/mesh/repair.hpp"
#include "dsp/core/error.hpp"
#include "tests/fuzz/memory_file.hpp"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const tactus::MemoryFile file(data, size, "m.ply");
    try {
        tactus::Mesh mesh = tactus::load_mesh(file.path());
        for (const auto& t : mesh.triangles)
            for (const int v : t)
                if (v < 0 || static_cast<std::size_t>(v) >= mesh.vertices.size()) std::abort();
        tactus::repair(mesh, "mesh");
        if (tactus::topology_of(mesh).boundary_edges > 0) std::abort();
    } catch (const tactus::Error&) {
        // Refusing is right for most bytes.
    }
    return 0;
}
