// SPDX-License-Identifier: Apache-2.0
// What the fuzz targets of all kinds of mesh files try.
#pragma once

#include "assets/mesh/mesh.hpp"
#include "assets/mesh/repair.hpp"
#include "dsp/core/error.hpp"
#include "tests/fuzz/memory_file.hpp"

#include <cstdlib>
#include <string>

namespace tactus {

/// Aborts unless a file of these bytes and that name is triangles between points that are there, with an inside once they
/// are repaired, or a tactus::Error.
inline void try_mesh(const std::uint8_t* data, std::size_t size, const std::string& name) {
    const MemoryFile file(data, size, name);
    try {
        mesh::Mesh mesh = mesh::load_mesh(file.path());
        for (const auto& t : mesh.triangles)
            for (const int v : t)
                if (v < 0 || static_cast<std::size_t>(v) >= mesh.vertices.size()) std::abort();
        mesh::repair(mesh, "mesh");
        if (mesh::topology_of(mesh).boundary_edges > 0) std::abort();
    } catch (const Error&) {
        // Refusing is right for most bytes.
    }
}

}  // namespace tactus
