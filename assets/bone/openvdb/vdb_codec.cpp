// SPDX-License-Identifier: Apache-2.0
// The module of vdb_codec.hpp: the only file of the product that includes OpenVDB.
#include "assets/bone/vdb_codec.hpp"

#include "assets/bone/point_bytes.hpp"
#include "assets/file/room.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <sstream>
#include <string_view>
#include <utility>

namespace tactus::bone {

namespace {

constexpr std::string_view provenance_prefix = "provenance.";
// Files without this number hold one bone whose name and provenance stand in the file's own metadata.
constexpr const char* format_key = "tactus_format";
// Format 3 stores only blocks near the bone. All other samples have the grid's background value.
constexpr std::int32_t newest_format = 3, sparse_format = 3, dense_format = 2;
// Limits of a sparse file: dense samples per stored sample, and dense samples in all.
constexpr double max_claimed = 4096.0, max_samples = 1e9;
constexpr const char *points_key = "points", *border_key = "scanned border";

// Calls visit(leaf, first, end) for every block of 8 x 8 x 8 samples: those of the grid in [first, end).
template <typename Visit>
void for_each_block(const std::array<int, 3>& size, Visit visit) {
    constexpr int side = openvdb::FloatTree::LeafNodeType::DIM;
    for (int k = 0; k < size[2]; k += side)
        for (int j = 0; j < size[1]; j += side) {
            leave_if_stopped();
            for (int i = 0; i < size[0]; i += side)
                visit(openvdb::Coord(i, j, k), openvdb::Coord(std::min(i + side, size[0]), std::min(j + side, size[1]),
                                                              std::min(k + side, size[2])));
        }
}

openvdb::FloatGrid::Ptr empty_vdb(const volume::Grid& grid, const std::string& name, float background) {
    auto vdb = openvdb::FloatGrid::create(background);
    vdb->setName(name);
    openvdb::Mat4d map = openvdb::Mat4d::identity();
    map.preScale(openvdb::Vec3d(grid.spacing.x, grid.spacing.y, grid.spacing.z));
    map.setTranslation(openvdb::Vec3d(grid.origin.x, grid.origin.y, grid.origin.z));
    vdb->setTransform(openvdb::math::Transform::createLinearTransform(map));
    vdb->insertMeta("size", openvdb::Vec3IMetadata({grid.size[0], grid.size[1], grid.size[2]}));
    vdb->insertMeta("origin", openvdb::Vec3DMetadata({grid.origin.x, grid.origin.y, grid.origin.z}));
    vdb->insertMeta("spacing", openvdb::Vec3DMetadata({grid.spacing.x, grid.spacing.y, grid.spacing.z}));
    return vdb;
}

openvdb::FloatGrid::Ptr to_vdb(const volume::Grid& grid, const std::string& name) {
    auto vdb = empty_vdb(grid, name, 0.0f);
    // All samples are active: compression may change the bits of inactive ones.
    for_each_block(grid.size, [&](const openvdb::Coord& first, const openvdb::Coord& end) {
        auto* leaf = vdb->tree().touchLeaf(first);
        for (int k = first.z(); k < end.z(); ++k)
            for (int j = first.y(); j < end.y(); ++j)
                for (int i = first.x(); i < end.x(); ++i) leaf->setValueOn({i, j, k}, grid.at(i, j, k));
    });
    return vdb;
}

struct VdbPair {
    openvdb::FloatGrid::Ptr distance, density;
};

// Each block is freed once it is copied, so that the bone is never in memory twice.
VdbPair to_vdb(SparseBone& bone) {
    VdbPair vdb{empty_vdb(bone.layout, "distance", bone.outside), empty_vdb(bone.layout, "density", 0.0f)};
    constexpr int side = SparseBone::side;
    static_assert(side == openvdb::FloatTree::LeafNodeType::DIM);
    const auto [nx, ny, nz] = bone.blocks_per_axis();
    for (int bz = 0; bz < nz; ++bz)
        for (int by = 0; by < ny; ++by) {
            leave_if_stopped();
            for (int bx = 0; bx < nx; ++bx) {
                std::unique_ptr<SparseBone::Block> block = std::move(bone.blocks[bone.block_index(bx, by, bz)]);
                if (!block) continue;
                const openvdb::Coord first(bx * side, by * side, bz * side);
                auto *distance = vdb.distance->tree().touchLeaf(first), *density = vdb.density->tree().touchLeaf(first);
                for (int z = 0; z < std::min(side, bone.layout.size[2] - first.z()); ++z)
                    for (int y = 0; y < std::min(side, bone.layout.size[1] - first.y()); ++y)
                        for (int x = 0; x < std::min(side, bone.layout.size[0] - first.x()); ++x) {
                            const auto n = static_cast<std::size_t>((z * side + y) * side + x);
                            const openvdb::Coord at = first.offsetBy(x, y, z);
                            distance->setValueOn(at, block->distance[n]);
                            density->setValueOn(at, block->density[n]);
                        }
            }
        }
    return vdb;
}

volume::Grid from_vdb(const openvdb::FloatGrid& vdb, bool is_sparse, const std::string& file) {
    volume::Grid grid;
    const auto size = vdb.metaValue<openvdb::Vec3i>("size");
    const auto origin = vdb.metaValue<openvdb::Vec3d>("origin");
    const auto spacing = vdb.metaValue<openvdb::Vec3d>("spacing");
    grid.size = {size.x(), size.y(), size.z()};
    grid.origin = {origin.x(), origin.y(), origin.z()};
    grid.spacing = {spacing.x(), spacing.y(), spacing.z()};
    const double claimed = double(size.x()) * size.y() * size.z(), held = double(vdb.activeVoxelCount());
    if (size.x() < 1 || size.y() < 1 || size.z() < 1 ||
        (is_sparse ? claimed > max_claimed * held || claimed > max_samples : claimed != held))
        throw Error(
            fmt::format("{}: grid '{}' does not hold the number of samples that its size states", file, vdb.getName()));
    if (!is_finite(grid.origin) || !is_finite(grid.spacing) ||
        !(std::min({grid.spacing.x, grid.spacing.y, grid.spacing.z}) > 0.0))
        throw Error(fmt::format("{}: grid '{}' has no usable origin and spacing", file, vdb.getName()));
    file::require_room(claimed * sizeof(float), file, "the samples of one grid");
    grid.values.resize(grid.count());
    for_each_block(grid.size, [&](const openvdb::Coord& first, const openvdb::Coord& end) {
        const auto* leaf = vdb.tree().probeConstLeaf(first);
        const float elsewhere = leaf ? 0.0f : vdb.tree().getValue(first);
        for (int k = first.z(); k < end.z(); ++k)
            for (int j = first.y(); j < end.y(); ++j)
                for (int i = first.x(); i < end.x(); ++i)
                    grid.at(i, j, k) = leaf ? leaf->getValue({i, j, k}) : elsewhere;
    });
    return grid;
}

void add_text(openvdb::MetaMap& meta, const std::string& key, const std::string& value) {
    meta.insertMeta(key, openvdb::StringMetadata(value));
}

void add_meta(const VdbPair& vdb, const Bone& bone) {
    vdb.distance->setGridClass(openvdb::GRID_LEVEL_SET);
    add_text(*vdb.distance, "quantity", "distance");
    add_text(*vdb.density, "quantity", "density");
    for (const auto& grid : {vdb.distance, vdb.density}) add_text(*grid, "bone", bone.name);
    vdb.distance->insertMeta("colour", openvdb::Vec3DMetadata({bone.colour.x, bone.colour.y, bone.colour.z}));
    if (!bone.points.empty()) add_text(*vdb.distance, points_key, to_bytes(bone.points));
    if (!bone.border.faces.empty()) add_text(*vdb.distance, border_key, border_bytes(bone.border));
    for (const auto& [key, value] : bone.provenance)
        add_text(*vdb.distance, std::string(provenance_prefix) + key, value);
}

void write_grids(const openvdb::GridPtrVec& grids, std::int32_t format, std::ostream& out) {
    openvdb::MetaMap meta;
    meta.insertMeta(format_key, openvdb::Int32Metadata(format));
    openvdb::io::Stream(out).write(grids, meta);
}

std::string text_of(const openvdb::MetaMap& meta, const std::string& key) {
    const auto text = meta.getMetadata<openvdb::StringMetadata>(key);
    return text ? text->value() : "";
}

void read_provenance(const openvdb::MetaMap& meta, Bone& bone) {
    for (auto it = meta.beginMeta(); it != meta.endMeta(); ++it)
        if (const auto text = std::dynamic_pointer_cast<openvdb::StringMetadata>(it->second);
            text && it->first.starts_with(provenance_prefix))
            bone.provenance[it->first.substr(provenance_prefix.size())] = text->value();
}

std::vector<Bone> deserialise(std::string bytes, const std::string& file) {
    // In one call, which cannot be left: what OpenVDB has read by then would be lost.
    std::istringstream in(std::move(bytes), std::ios::binary);
    openvdb::io::Stream stream(in, /*delayLoad=*/false);
    const auto grids = stream.getGrids();
    const auto meta = stream.getMetadata();
    const auto format = meta->getMetadata<openvdb::Int32Metadata>(format_key);
    const std::int32_t version = format ? format->value() : 1;
    if (version < 1 || version > newest_format)
        throw Error(
            fmt::format("{}: bone file of format {}; this program reads up to {}", file, version, newest_format));
    std::vector<std::pair<std::string, VdbPair>> found;
    for (const auto& base : *grids) {
        const auto vdb = openvdb::gridPtrCast<openvdb::FloatGrid>(base);
        if (!vdb) continue;
        const std::string name = version == 1 ? text_of(*meta, "name") : text_of(*vdb, "bone");
        const std::string quantity = version == 1 ? vdb->getName() : text_of(*vdb, "quantity");
        if (quantity != "distance" && quantity != "density") continue;
        auto at = std::find_if(found.begin(), found.end(), [&](const auto& entry) { return entry.first == name; });
        if (at == found.end()) at = found.insert(found.end(), {name, {}});
        (quantity == "distance" ? at->second.distance : at->second.density) = vdb;
    }
    grids->clear();
    std::vector<Bone> bones;
    for (auto& [name, parts] : found) {
        if (!parts.distance || !parts.density)
            throw Error(
                fmt::format("{}: a bone has the float grids 'distance' and 'density'; '{}' lacks one", file, name));
        Bone& bone = bones.emplace_back();
        bone.name = name;
        read_provenance(version == 1 ? *meta : *parts.distance, bone);
        if (const auto colour = parts.distance->getMetadata<openvdb::Vec3DMetadata>("colour"))
            bone.colour = {colour->value().x(), colour->value().y(), colour->value().z()};
        if (const std::string points = text_of(*parts.distance, points_key); !points.empty())
            bone.points = points_from(points, file);
        if (const std::string border = text_of(*parts.distance, border_key); !border.empty())
            bone.border = border_from(border, file);
        bone.distance = from_vdb(*parts.distance, version >= sparse_format, file);
        parts.distance.reset();
        bone.density = from_vdb(*parts.density, version >= sparse_format, file);
        parts.density.reset();
    }
    if (bones.empty()) throw Error(fmt::format("{}: a bone file holds the float grids 'distance' and 'density'", file));
    return bones;
}

/// The module has its own copy of these two settings of the program.
class CallScope {
public:
    explicit CallScope(const VdbCodec::Call& call) : stop_(call.is_stopped) {
        file::set_memory_limit(call.memory_limit);
    }

private:
    StopScope stop_;
};

class OpenVdbCodec final : public VdbCodec {
public:
    OpenVdbCodec() { openvdb::initialize(); }

    void write(std::span<const Bone> bones, std::ostream& out, const Call& call) const override {
        const CallScope scope(call);
        openvdb::GridPtrVec grids;
        for (const Bone& bone : bones) {
            const std::string prefix = bones.size() > 1 ? bone.name + "." : "";
            const VdbPair vdb{to_vdb(bone.distance, prefix + "distance"), to_vdb(bone.density, prefix + "density")};
            add_meta(vdb, bone);
            grids.push_back(vdb.distance);
            grids.push_back(vdb.density);
        }
        write_grids(grids, dense_format, out);
    }

    void write(SparseBone& bone, const Bone& about, std::ostream& out, const Call& call) const override {
        const CallScope scope(call);
        const VdbPair vdb = to_vdb(bone);
        add_meta(vdb, about);
        write_grids({vdb.distance, vdb.density}, sparse_format, out);
    }

    std::vector<Bone> read(std::string bytes, const std::string& file, const Call& call) const override {
        const CallScope scope(call);
        try {
            return deserialise(std::move(bytes), file);
        } catch (const openvdb::Exception& failure) {
            throw Error(fmt::format("{}: OpenVDB cannot read it: {}", file, failure.what()));
        }
    }
};

}  // namespace

}  // namespace tactus::bone

extern "C" const tactus::bone::VdbCodec* tactus_vdb_codec() {
    static const tactus::bone::OpenVdbCodec codec;
    return &codec;
}
