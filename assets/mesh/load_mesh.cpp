// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "dsp/core/error.hpp"

#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <assimp/Importer.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <numeric>
#include <tuple>

namespace tactus {

namespace {

std::string lower_extension(const std::filesystem::path& path) {
    std::string text = path.extension().string();
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text.empty() ? text : text.substr(1);
}

// A binary STL says how many triangles follow; a file that is shorter would be read past its end or half.
void check_stl(const std::string& bytes, const std::string& file) {
    const bool text =
        bytes.starts_with("solid") && bytes.find("facet") != std::string::npos && bytes.find('\0') == std::string::npos;
    if (text) {
        if (bytes.find("endsolid") == std::string::npos)
            throw Error(fmt::format("{}: cut short: no 'endsolid'; copy the file again", file));
        return;
    }
    std::uint32_t triangles = 0;
    if (bytes.size() >= 84) std::memcpy(&triangles, bytes.data() + 80, 4);
    if (bytes.size() < 84 || bytes.size() < 84 + std::uint64_t{50} * triangles)
        throw Error(fmt::format("{}: cut short or no STL: its header asks for {} triangles, {} bytes are there", file,
                                triangles, bytes.size()));
}

// A PLY header that claims more elements than the file has bytes is refused before anything is made for them.
void check_ply(const std::string& bytes, const std::string& file) {
    const std::string_view header = std::string_view(bytes).substr(0, std::min<std::size_t>(bytes.size(), 65536));
    if (!header.starts_with("ply") || header.find("end_header") == std::string_view::npos)
        throw Error(fmt::format("{}: no PLY header", file));
    for (std::size_t at = header.find("element "); at != std::string_view::npos; at = header.find("element ", at + 1)) {
        const std::size_t number = header.find(' ', at + 8);
        if (number == std::string_view::npos) break;
        const double count = std::strtod(std::string(header.substr(number + 1, 24)).c_str(), nullptr);
        if (!(count >= 0.0) || count > static_cast<double>(bytes.size()))
            throw Error(fmt::format("{}: cut short: its header asks for more elements than the file has bytes", file));
    }
}

void join_equal_points(Mesh& mesh) {
    std::vector<int> order(mesh.vertices.size());
    std::iota(order.begin(), order.end(), 0);
    const auto key = [&mesh](int n) {
        const Vec3& v = mesh.vertices[static_cast<std::size_t>(n)];
        return std::tuple(v.x, v.y, v.z);
    };
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
    std::vector<int> renamed(mesh.vertices.size());
    std::vector<Vec3> kept;
    for (std::size_t n = 0; n < order.size(); ++n) {
        if (n == 0 || key(order[n]) != key(order[n - 1]))
            kept.push_back(mesh.vertices[static_cast<std::size_t>(order[n])]);
        renamed[static_cast<std::size_t>(order[n])] = static_cast<int>(kept.size()) - 1;
    }
    mesh.vertices = std::move(kept);
    for (auto& t : mesh.triangles)
        for (int& v : t) v = renamed[static_cast<std::size_t>(v)];
    std::erase_if(mesh.triangles, [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
}

}  // namespace

Mesh load_mesh(const std::filesystem::path& path, double scale) {
    const std::string file = path.string(), kind = lower_extension(path);
    if (kind != "stl" && kind != "ply" && kind != "obj")
        throw Error(fmt::format("{}: a mesh is read from .stl, .ply or .obj", file));
    const std::string bytes = read_whole_file(path);
    if (kind == "stl") check_stl(bytes, file);
    if (kind == "ply") check_ply(bytes, file);
    Assimp::Importer importer;
    const aiScene* scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_Triangulate, kind.c_str());
    if (!scene) throw Error(fmt::format("{}: cannot be read: {}", file, importer.GetErrorString()));
    Mesh mesh;
    for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
        const aiMesh& part = *scene->mMeshes[m];
        const int first = static_cast<int>(mesh.vertices.size());
        for (unsigned v = 0; v < part.mNumVertices; ++v) {
            const aiVector3D& p = part.mVertices[v];
            mesh.vertices.push_back(Vec3(p.x, p.y, p.z) * scale);
            if (!is_finite(mesh.vertices.back()))
                throw Error(fmt::format("{}: a point's coordinates are not numbers; repair the mesh first", file));
        }
        for (unsigned f = 0; f < part.mNumFaces; ++f) {
            const aiFace& face = part.mFaces[f];
            if (face.mNumIndices != 3) continue;
            std::array<int, 3> t{};
            for (unsigned c = 0; c < 3; ++c) {
                if (face.mIndices[c] >= part.mNumVertices)
                    throw Error(fmt::format("{}: a triangle names a point that is not there", file));
                t[c] = first + static_cast<int>(face.mIndices[c]);
            }
            mesh.triangles.push_back(t);
        }
    }
    join_equal_points(mesh);
    if (mesh.triangles.empty()) throw Error(fmt::format("{}: holds no triangles", file));
    return mesh;
}

}  // namespace tactus
