// SPDX-License-Identifier: Apache-2.0
#include "tests/support/bone_files.hpp"

#include "dsp/core/hash.hpp"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <sstream>

namespace tactus::test {

std::string sealed(std::string bytes) {
    Hash hash;
    hash.add_bytes(bytes.data(), bytes.size());
    const std::uint64_t value = hash.value();
    return bytes.append("TACTUSBONE000001").append(reinterpret_cast<const char*>(&value), sizeof value);
}

std::string repacked(const std::string& bytes, std::uint32_t packing) {
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
    return out.str();
}

}  // namespace tactus::test
