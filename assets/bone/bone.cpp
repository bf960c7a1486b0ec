// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/bone.hpp"

#include "assets/bone/point_bytes.hpp"
#include "assets/bone/sealed_file.hpp"
#include "assets/bone/sparse_bone.hpp"
#include "assets/bone/vdb_check.hpp"
#include "assets/file/room.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "dsp/core/stop.hpp"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

namespace tactus::bone {

namespace {

constexpr std::string_view provenance_prefix = "provenance.";
// Files without this number hold one bone whose name and provenance stand in the file's own metadata.
constexpr const char* format_key = "tactus_format";
// Format 3 stores only blocks near the bone. All other samples have the grid's background value.
constexpr std::int32_t newest_format = 3, sparse_format = 3, dense_format = 2;
// Limits of a sparse file: dense samples per stored sample, and dense samples in all.
constexpr double most_claimed = 4096.0, most_samples = 1e9;
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
        (is_sparse ? claimed > most_claimed * held || claimed > most_samples : claimed != held))
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

void check(const Bone& bone) {
    const volume::Grid &a = bone.distance, &b = bone.density;
    if (a.size != b.size || a.origin != b.origin || a.spacing != b.spacing)
        throw Error("a bone's distance and density must be on the same grid");
    if (a.size[0] < 1 || a.size[1] < 1 || a.size[2] < 1 || a.values.size() != a.count() || b.values.size() != b.count())
        throw Error("a bone's grids must hold as many values as their size says, and at least one");
}

void check(std::span<const Bone> bones) {
    if (bones.empty()) throw Error("a bone file holds at least one bone");
    for (std::size_t n = 0; n < bones.size(); ++n) {
        check(bones[n]);
        if (bones.size() > 1 && (bones[n].name.empty() || bones[n].name.find('#') != std::string::npos))
            throw Error(fmt::format("'{}' cannot name one of several bones: it is empty or has a '#'", bones[n].name));
        for (std::size_t m = 0; m < n; ++m)
            if (bones[m].name == bones[n].name)
                throw Error(fmt::format("two bones of one file are both called '{}'", bones[n].name));
    }
}

void add_text(openvdb::MetaMap& meta, const std::string& key, const std::string& value) {
    meta.insertMeta(key, openvdb::StringMetadata(value));
}

void add_place(Hash& hash, const volume::Grid& grid) {
    hash.add_bytes(grid.size.data(), sizeof grid.size);
    hash.add_bytes(&grid.origin, sizeof grid.origin);
    hash.add_bytes(&grid.spacing, sizeof grid.spacing);
}

// The identifier is a hash of the content, so that equal bones give equal files; OpenVDB would use a random one.
std::string identifier_of(const Hash& hash) {
    const std::uint64_t content = hash.value();
    return fmt::format("{:08x}-{:04x}-4000-8000-{:012x}", content >> 32, content & 0xffff, content >> 16);
}

std::string identifier_of(std::span<const Bone> bones) {
    Hash hash;
    for (const Bone& bone : bones) {
        hash.add_text(bone.name);
        for (const volume::Grid* grid : {&bone.distance, &bone.density}) {
            add_place(hash, *grid);
            add_in_pieces(hash,
                          {reinterpret_cast<const char*>(grid->values.data()), grid->values.size() * sizeof(float)});
        }
    }
    return identifier_of(hash);
}

std::string identifier_of(const SparseBone& bone, const Bone& about) {
    Hash hash;
    hash.add_text(about.name);
    add_place(hash, bone.layout);
    for (const auto& block : bone.blocks) {
        if (!block) continue;
        leave_if_stopped();
        hash.add_bytes(block.get(), sizeof *block);
    }
    return identifier_of(hash);
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

void write(const openvdb::GridPtrVec& grids, std::int32_t format, std::string identifier,
           const std::filesystem::path& path) {
    SealedFile file(path, std::move(identifier));
    std::ostream out(&file);
    // An Error thrown by the file must reach the caller unchanged.
    out.exceptions(std::ios::badbit);
    openvdb::MetaMap meta;
    meta.insertMeta(format_key, openvdb::Int32Metadata(format));
    openvdb::io::Stream(out).write(grids, meta);
    file.seal();
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

struct BonePath {
    std::filesystem::path file;
    std::optional<std::string> name;
};

BonePath split(const std::filesystem::path& path) {
    const std::string text = path.string();
    const std::size_t mark = text.rfind('#');
    std::error_code ignored;
    if (mark == std::string::npos || std::filesystem::exists(path, ignored)) return {path, {}};
    return {text.substr(0, mark), text.substr(mark + 1)};
}

}  // namespace

void save_bones(std::span<const Bone> bones, const std::filesystem::path& path) {
    check(bones);
    openvdb::initialize();
    openvdb::GridPtrVec grids;
    for (const Bone& bone : bones) {
        const std::string prefix = bones.size() > 1 ? bone.name + "." : "";
        const VdbPair vdb{to_vdb(bone.distance, prefix + "distance"), to_vdb(bone.density, prefix + "density")};
        add_meta(vdb, bone);
        grids.push_back(vdb.distance);
        grids.push_back(vdb.density);
    }
    write(grids, dense_format, identifier_of(bones), path);
}

void save_bone(SparseBone bone, const Bone& about, const std::filesystem::path& path) {
    openvdb::initialize();
    const std::string identifier = identifier_of(bone, about);
    const VdbPair vdb = to_vdb(bone);
    add_meta(vdb, about);
    write({vdb.distance, vdb.density}, sparse_format, identifier, path);
}

void save_bone(const Bone& bone, const std::filesystem::path& path) { save_bones({&bone, 1}, path); }

std::vector<Bone> load_bones(const std::filesystem::path& path) {
    const std::string file = path.string();
    std::string bytes = read_sealed(path);
    check_vdb(bytes, file);
    openvdb::initialize();
    try {
        std::vector<Bone> bones = deserialise(std::move(bytes), file);
        check(bones);
        return bones;
    } catch (const openvdb::Exception& failure) {
        throw Error(fmt::format("{}: OpenVDB cannot read it: {}", file, failure.what()));
    }
}

Bone load_bone(const std::filesystem::path& path) {
    const auto [file, name] = split(path);
    std::vector<Bone> bones = load_bones(file);
    if (!name && bones.size() == 1) return std::move(bones.front());
    std::vector<std::string> names;
    for (Bone& bone : bones) {
        if (name && bone.name == *name) return std::move(bone);
        names.push_back(bone.name);
    }
    if (!name)
        throw Error(fmt::format("{}: holds {} bones ({}); name one of them: {}#{}", file.string(), bones.size(),
                                fmt::join(names, ", "), file.string(), names.front()));
    throw Error(fmt::format("{}: holds no bone '{}' but {}{}", file.string(), *name, fmt::join(names, ", "),
                            did_you_mean(*name, names)));
}

std::filesystem::path file_of_bone(const std::filesystem::path& path) { return split(path).file; }

bool name_one_bone(const std::filesystem::path& one, const std::filesystem::path& other) {
    const auto a = split(one), b = split(other);
    std::error_code failed;
    // Without a name a path is that of the only bone of its file.
    const bool may_be_alike = a.name == b.name || !a.name || !b.name;
    return may_be_alike && std::filesystem::equivalent(a.file, b.file, failed);
}

}  // namespace tactus::bone
