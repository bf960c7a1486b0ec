// SPDX-License-Identifier: Apache-2.0
#include "assets/plan/kept_bone.hpp"

#include "assets/bone/assumed_density.hpp"
#include "assets/bone/mesh_part.hpp"
#include "assets/file/cache.hpp"
#include "assets/plan/kept_result.hpp"
#include "dsp/core/hash.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <string_view>
#include <utility>

namespace tactus::plan {

namespace {

// To be raised with every change of code that changes what import_bone makes of a mesh.
constexpr int import_of_meshes = 2;

constexpr std::string_view kept_bone_format = "tactus kept bone 1\n";
constexpr std::size_t sum_length = 17, length_length = 9;  // with their line breaks

// The mesh's file, its name, which the import states, and its unit.
ResultKey key_of_bone(const std::filesystem::path& path, const std::optional<std::string>& unit) {
    ResultKey key("bone of a mesh", import_of_meshes);
    key.add_file(path).add_text("name", path.filename().string()).add_text("unit", unit.value_or(""));
    return key;
}

std::filesystem::path file_of_bone_key(const ResultKey& key) {
    std::filesystem::path file = file_of_result(key);
    return file.empty() ? file : file.replace_extension("bone");
}

std::string checksum_of(std::string_view about, const std::vector<float>& values) {
    Hash hash;
    hash.add_text(about);
    hash.add_bytes(values.data(), values.size() * sizeof(float));
    return fmt::format("{:016x}\n", hash.value());
}

/// Numbers, a line each, then texts with their lengths.
std::string about(const bone::Bone& bone) {
    const volume::Grid& grid = bone.distance;
    std::string text;
    for (const int n : grid.size) text += fmt::format("{}\n", n);
    for (const Vec3& v : {grid.origin, grid.spacing, bone.colour})
        text += fmt::format("{:.17g}\n{:.17g}\n{:.17g}\n", v.x, v.y, v.z);
    const auto add = [&text](const std::string& words) { text += fmt::format("{}\n{}\n", words.size(), words); };
    text += fmt::format("{}\n", bone.provenance.size());
    add(bone.name);
    for (const auto& [name, value] : bone.provenance) add(name), add(value);
    return text;
}

bone::Bone bone_about(const std::string& text) {
    std::istringstream stream(text);
    const auto line = [&stream] {
        std::string words;
        std::getline(stream, words);
        return words;
    };
    const auto words = [&] {
        std::string all(std::min<std::size_t>(std::stoul(line()), text.size()), '\0');
        stream.read(all.data(), static_cast<std::streamsize>(all.size()));
        line();
        return all;
    };
    bone::Bone bone;
    for (int& n : bone.distance.size) n = std::stoi(line());
    for (Vec3* v : {&bone.distance.origin, &bone.distance.spacing, &bone.colour})
        for (int axis = 0; axis < 3; ++axis) (*v)[axis] = std::strtod(line().c_str(), nullptr);
    const std::size_t count = std::stoul(line());
    bone.name = words();
    for (std::size_t n = 0; n < count; ++n) {
        const std::string name = words();
        bone.provenance[name] = words();
    }
    return bone;
}

/// None when nothing is kept, or what is there is damaged or not of this key.
std::optional<bone::Bone> kept_bone(const ResultKey& key) {
    const std::filesystem::path file = file_of_bone_key(key);
    std::ifstream stream(file, std::ios::binary);
    if (file.empty() || !stream) return std::nullopt;
    const auto read = [&stream](std::size_t size) {
        std::string bytes(size, '\0');
        stream.read(bytes.data(), static_cast<std::streamsize>(size));
        return stream ? bytes : std::string();
    };
    const std::string head = std::string(kept_bone_format) + key.text() + "\n\n";
    if (read(head.size()) != head) return std::nullopt;
    const std::string sum = read(sum_length), length = read(length_length);
    try {
        // A length that is damaged must not ask for memory that the file does not fill.
        const std::size_t size = std::stoul(length, nullptr, 16), whole = std::filesystem::file_size(file);
        if (size > whole) return std::nullopt;
        const std::string text = read(size);
        bone::Bone bone = bone_about(text);
        std::vector<float>& values = bone.distance.values;
        const std::size_t count = bone.distance.count();
        if (whole != head.size() + sum_length + length_length + size + count * sizeof(float)) return std::nullopt;
        values.resize(count);
        stream.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(count * sizeof(float)));
        if (!stream || sum != checksum_of(text, values)) return std::nullopt;
        file::touch_cached(file);
        return bone;
    } catch (const std::exception&) {
        return std::nullopt;
    }
}

void keep_bone(const ResultKey& key, const bone::Bone& bone) noexcept {
    try {
        const std::filesystem::path file = file_of_bone_key(key);
        if (file.empty()) return;
        const std::string text = about(bone);
        const std::vector<float>& values = bone.distance.values;
        std::string bytes = std::string(kept_bone_format) + key.text() + "\n\n" + checksum_of(text, values);
        bytes += fmt::format("{:08x}\n", text.size()) + text;
        const std::size_t size = values.size() * sizeof(float);
        bytes.reserve(bytes.size() + size);
        bytes.append(reinterpret_cast<const char*>(values.data()), size);
        file::write_cached(file, bytes);
    } catch (const std::exception&) {
        // A bone that is not kept is imported again.
    }
}

}  // namespace

std::filesystem::path file_of_kept_bone(const std::filesystem::path& path, const std::optional<std::string>& unit) {
    return file_of_bone_key(key_of_bone(path, unit));
}

bone::Bone bone_of_mesh(const std::filesystem::path& path, const std::optional<std::string>& unit, Contents contents,
                        const RunJobs& run) {
    const ResultKey key = key_of_bone(path, unit);
    std::optional<bone::Bone> bone = kept_bone(key);
    if (!bone) {
        bone = bone::shape_of_mesh(path, unit, run);
        keep_bone(key, *bone);
    }
    if (contents == Contents::all) bone->density = bone::assumed_density(bone->distance);
    return *std::move(bone);
}

}  // namespace tactus::plan
