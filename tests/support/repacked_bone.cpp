// SPDX-License-Identifier: Apache-2.0
// The module that bone_files.cpp loads.
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <cstdint>
#include <sstream>
#include <string>

extern "C" void tactus_test_repack(const std::string& bytes, std::uint32_t packing, std::string& into) {
    openvdb::initialize();
    std::istringstream in(bytes, std::ios::binary);
    openvdb::io::Stream from(in, /*delayLoad=*/false);
    const auto grids = from.getGrids();
    // Zip is left out where a grid says that it is a level set.
    for (const auto& grid : *grids) grid->setGridClass(openvdb::GRID_UNKNOWN);
    std::ostringstream out(std::ios::binary);
    openvdb::io::Stream to(out);
    to.setCompression(packing);
    to.write(*grids, *from.getMetadata());
    into = out.str();
}
