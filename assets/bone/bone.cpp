// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/bone.hpp"

#include "assets/bone/sealed_file.hpp"
#include "assets/bone/sparse_bone.hpp"
#include "assets/bone/vdb_check.hpp"
#include "assets/bone/vdb_codec.hpp"
#include "assets/file/module.hpp"
#include "assets/file/room.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/hash.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ostream>

namespace tactus::bone {

namespace {

void check(const Bone& bone) {
    const volume::Grid &a = bone.distance, &b = bone.density;
    if (a.size != b.size || a.origin != b.origin || a.spacing != b.spacing)
        throw Error("a bone's distance and density must be on the same grid");
    if (a.size[0] < 1 || a.size[1] < 1 || a.size[2] < 1 || a.values.size() != a.count() || b.values.size() != b.count())
        throw Error("a bone's grids must hold as many values as their size states, and at least one");
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

const VdbCodec& codec() {
    using Make = const VdbCodec*();
    static const VdbCodec& loaded = *reinterpret_cast<Make*>(file::load_module(vdb_module, vdb_codec_symbol))();
    return loaded;
}

VdbCodec::Call this_call() { return {stop_of_this_thread(), file::memory_limit()}; }

/// Writes the file that `write` writes to a stream.
template <typename Write>
void write_sealed(const std::filesystem::path& path, std::string identifier, Write write) {
    SealedFile file(path, std::move(identifier));
    std::ostream out(&file);
    // An Error thrown by the file must reach the caller unchanged.
    out.exceptions(std::ios::badbit);
    write(out);
    file.seal();
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
    const VdbCodec& vdb = codec();
    write_sealed(path, identifier_of(bones), [&](std::ostream& out) { vdb.write(bones, out, this_call()); });
}

void save_bone(SparseBone bone, const Bone& about, const std::filesystem::path& path) {
    const VdbCodec& vdb = codec();
    write_sealed(path, identifier_of(bone, about),
                 [&](std::ostream& out) { vdb.write(bone, about, out, this_call()); });
}

void save_bone(const Bone& bone, const std::filesystem::path& path) { save_bones({&bone, 1}, path); }

std::vector<Bone> load_bones(const std::filesystem::path& path) {
    const std::string file = path.string();
    std::string bytes = read_sealed(path);
    check_vdb(bytes, file);
    std::vector<Bone> bones = codec().read(std::move(bytes), file, this_call());
    check(bones);
    return bones;
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
