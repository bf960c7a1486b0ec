// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/bone.hpp"

#include "assets/bone/whole_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <fmt/format.h>

#include <cstring>
#include <sstream>

namespace tactus {

namespace {

constexpr std::string_view seal_mark = "TACTUSBONE000001";
constexpr std::size_t seal_size = seal_mark.size() + 8;
constexpr std::string_view provenance_prefix = "provenance.";
// Magic (8), file version (4), library version (8) and one flag stand before OpenVDB's identifier.
constexpr std::size_t identifier_offset = 21, identifier_size = 36;

std::uint64_t hash_of(std::string_view bytes) {
    Hash hash;
    hash.add_bytes(bytes.data(), bytes.size());
    return hash.value();
}

openvdb::FloatGrid::Ptr to_vdb(const Grid& grid, const std::string& name) {
    auto vdb = openvdb::FloatGrid::create(0.0f);
    vdb->setName(name);
    openvdb::Mat4d map = openvdb::Mat4d::identity();
    map.preScale(openvdb::Vec3d(grid.spacing.x, grid.spacing.y, grid.spacing.z));
    map.setTranslation(openvdb::Vec3d(grid.origin.x, grid.origin.y, grid.origin.z));
    vdb->setTransform(openvdb::math::Transform::createLinearTransform(map));
    vdb->insertMeta("size", openvdb::Vec3IMetadata({grid.size[0], grid.size[1], grid.size[2]}));
    vdb->insertMeta("origin", openvdb::Vec3DMetadata({grid.origin.x, grid.origin.y, grid.origin.z}));
    vdb->insertMeta("spacing", openvdb::Vec3DMetadata({grid.spacing.x, grid.spacing.y, grid.spacing.z}));
    // Every sample is active, so that compression keeps its bits.
    auto access = vdb->getAccessor();
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) access.setValueOn({i, j, k}, grid.at(i, j, k));
    return vdb;
}

Grid from_vdb(const openvdb::FloatGrid& vdb, const std::string& file) {
    Grid grid;
    const auto size = vdb.metaValue<openvdb::Vec3i>("size");
    const auto origin = vdb.metaValue<openvdb::Vec3d>("origin");
    const auto spacing = vdb.metaValue<openvdb::Vec3d>("spacing");
    grid.size = {size.x(), size.y(), size.z()};
    grid.origin = {origin.x(), origin.y(), origin.z()};
    grid.spacing = {spacing.x(), spacing.y(), spacing.z()};
    if (size.x() < 1 || size.y() < 1 || size.z() < 1 || grid.count() != vdb.activeVoxelCount())
        throw Error(fmt::format("{}: grid '{}' does not hold the samples its size asks for", file, vdb.getName()));
    grid.values.resize(grid.count());
    auto access = vdb.getConstAccessor();
    std::size_t at = 0;
    for (int k = 0; k < grid.size[2]; ++k)
        for (int j = 0; j < grid.size[1]; ++j)
            for (int i = 0; i < grid.size[0]; ++i) grid.values[at++] = access.getValue({i, j, k});
    return grid;
}

void check(const Bone& bone) {
    const Grid &a = bone.distance, &b = bone.density;
    if (a.size != b.size || a.origin != b.origin || a.spacing != b.spacing)
        throw Error("a bone's distance and density must be on the same grid");
    if (a.size[0] < 1 || a.size[1] < 1 || a.size[2] < 1 || a.values.size() != a.count() || b.values.size() != b.count())
        throw Error("a bone's grids must hold as many values as their size says, and at least one");
}

std::string serialise(const Bone& bone) {
    openvdb::GridPtrVec grids{to_vdb(bone.distance, "distance"), to_vdb(bone.density, "density")};
    grids[0]->setGridClass(openvdb::GRID_LEVEL_SET);
    openvdb::MetaMap meta;
    meta.insertMeta("name", openvdb::StringMetadata(bone.name));
    for (const auto& [key, value] : bone.provenance)
        meta.insertMeta(std::string(provenance_prefix) + key, openvdb::StringMetadata(value));
    std::ostringstream out(std::ios::binary);
    openvdb::io::Stream(out).write(grids, meta);
    std::string bytes = std::move(out).str();
    // OpenVDB draws a random identifier per file; one made from the content keeps equal bones equal as files.
    if (bytes.size() < identifier_offset + identifier_size) throw Error("OpenVDB wrote no header");
    bytes.replace(identifier_offset, identifier_size, identifier_size, '0');
    const std::uint64_t content = hash_of(bytes);
    bytes.replace(identifier_offset, identifier_size,
                  fmt::format("{:08x}-{:04x}-4000-8000-{:012x}", content >> 32, content & 0xffff, content >> 16));
    return bytes;
}

Bone deserialise(const std::string& bytes, const std::string& file) {
    std::istringstream in(bytes, std::ios::binary);
    openvdb::io::Stream stream(in, /*delayLoad=*/false);
    const auto grids = stream.getGrids();
    Bone bone;
    bool has_distance = false, has_density = false;
    for (const auto& base : *grids) {
        const auto vdb = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
        if (!vdb) continue;
        if (vdb->getName() == "distance") bone.distance = from_vdb(*vdb, file), has_distance = true;
        if (vdb->getName() == "density") bone.density = from_vdb(*vdb, file), has_density = true;
    }
    if (!has_distance || !has_density)
        throw Error(fmt::format("{}: a bone file holds the float grids 'distance' and 'density'", file));
    const auto meta = stream.getMetadata();
    for (auto it = meta->beginMeta(); it != meta->endMeta(); ++it) {
        const auto text = std::dynamic_pointer_cast<openvdb::StringMetadata>(it->second);
        if (!text) continue;
        if (it->first == "name") bone.name = text->value();
        if (it->first.starts_with(provenance_prefix))
            bone.provenance[it->first.substr(provenance_prefix.size())] = text->value();
    }
    return bone;
}

}  // namespace

void save_bone(const Bone& bone, const std::filesystem::path& path) {
    check(bone);
    openvdb::initialize();
    std::string bytes = serialise(bone);
    const std::uint64_t hash = hash_of(bytes);
    bytes += seal_mark;
    bytes.append(reinterpret_cast<const char*>(&hash), sizeof hash);
    write_whole_file(path, bytes);
}

Bone load_bone(const std::filesystem::path& path) {
    const std::string file = path.string();
    std::string bytes = read_whole_file(path);
    // OpenVDB trusts the sizes it reads, so only bytes that are known to be whole reach it.
    if (bytes.size() < seal_size || bytes.compare(bytes.size() - seal_size, seal_mark.size(), seal_mark) != 0)
        throw Error(fmt::format("{}: not a whole bone file; make it again with 'tactus import'", file));
    std::uint64_t hash = 0;
    std::memcpy(&hash, bytes.data() + bytes.size() - sizeof hash, sizeof hash);
    bytes.resize(bytes.size() - seal_size);
    if (hash_of(bytes) != hash)
        throw Error(fmt::format("{}: damaged (its checksum differs); make it again with 'tactus import'", file));
    openvdb::initialize();
    try {
        Bone bone = deserialise(bytes, file);
        check(bone);
        return bone;
    } catch (const openvdb::Exception& failure) {
        throw Error(fmt::format("{}: OpenVDB cannot read it: {}", file, failure.what()));
    }
}

}  // namespace tactus
