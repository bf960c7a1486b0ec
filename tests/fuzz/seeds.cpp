// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/seeds.hpp"

#include "assets/bone/bone.hpp"
#include "assets/bone/sealed_file.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "assets/volume/write_volume.hpp"
#include "tests/assets/volume/dicom_changes.hpp"
#include "tests/assets/volume/written_volume.hpp"
#include "tests/support/bone_files.hpp"
#include "tests/support/written_recordings.hpp"
#include "tests/support/written_zip.hpp"

#include <glm/geometric.hpp>

#include <fmt/format.h>

#include <cmath>

namespace tactus {

namespace {

using Path = std::filesystem::path;

// A ball of bone, small enough that a mutated file is tried thousands of times per second.
WrittenVolume ball() {
    WrittenVolume v;
    v.size = {6, 5, 4};
    v.step = Mat3(Vec3(0.5, 0.0, 0.0), Vec3(0.0, 0.6, 0.0), Vec3(0.0, 0.0, 1.5));
    v.origin = {-1.5, -1.5, 10.0};
    v.fill([](const Vec3& p) { return glm::length(p - Vec3(0.0, 0.0, 12.0)) < 1.2 ? 1000.0 : -1000.0; });
    return v;
}

void write_universal(const Path& folder) {
    for (const bool is_binary : {false, true})
        for (const bool is_even : {false, true}) {
            test::UniversalFunction f;
            f.is_binary = is_binary, f.is_even = is_even, f.type = is_even ? 2 : 4;
            for (int n = 0; n < 12; ++n) f.times.push_back(n * 5e-4), f.values.push_back(n % 3);
            file::write_whole_file(
                folder / fmt::format("{}{}.uff", is_binary ? "binary" : "text", is_even ? "_even" : ""),
                "    -1\n   164\n         1SI\n    -1\n" + test::universal_function(f) + test::universal_function(f));
        }
}

void write_matlab(const Path& folder) {
    const std::vector<double> times{0.0, 0.001, 0.002, 0.003}, both{1.0, 2.0, 1.0, 3.0, 5.0, 4.0, 6.0, 5.0};
    const std::string variables =
        test::matlab_numbers("t", 4, 1, times) + test::matlab_numbers("ax", 4, 2, both, false, 3);
    file::write_whole_file(folder / "plain.mat", test::matlab_file(variables));
    file::write_whole_file(folder / "packed.mat",
                           test::matlab_file(test::matlab_packed(test::matlab_numbers("ax", 4, 1, times)) +
                                             test::matlab_packed(test::matlab_numbers("fs", 1, 1, {1000.0}))));
    const std::string names("time\0\0\0\0acc_g\0\0\0", 16);
    file::write_whole_file(folder / "structure.mat",
                           test::matlab_file(test::matlab_element(
                               14, test::matlab_array(2, "s", 1, 1) + test::bytes_of(std::uint32_t{0x40005}) +
                                       test::bytes_of(std::int32_t{8}) + test::matlab_element(1, names) +
                                       test::matlab_numbers("", 4, 1, times) + test::matlab_numbers("", 4, 1, times))));
    file::write_whole_file(folder / "big.mat", test::matlab_file(test::matlab_numbers("x", 1, 4, times, true), true));
}

void write_nrrd(const Path& folder) {
    const WrittenVolume v = ball();
    std::string plain = nrrd_bytes(v);
    file::write_whole_file(folder / "raw.nrrd", plain);
    const std::size_t end = plain.find("\n\n");
    file::write_whole_file(folder / "named.nrrd",
                           std::string(plain).insert(end,
                                                     "\nSegment0_ID:=a\nSegment0_LabelValue:=1\nSegment0_Name:=jaw\n"
                                                     "Segment0_Color:=0.9 0.8 0.7\nSegment0_Layer:=0"));
    std::string text = plain.substr(0, end + 2);
    text.replace(text.find("encoding: raw"), 13, "encoding: ascii");
    for (const std::int16_t value : v.hu) text += fmt::format("{} ", value);
    file::write_whole_file(folder / "ascii.nrrd", text);
    volume::Grid grid{v.size, v.origin * 1e-3, Vec3(0.5e-3, 0.6e-3, 1.5e-3), {}};
    grid.values.assign(v.hu.begin(), v.hu.end());
    volume::write_volume(grid, volume::WrittenType::int16, folder / "gzip.nrrd");
    file::write_whole_file(
        folder / "layers.nrrd",
        "NRRD0005\ntype: uchar\ndimension: 4\nspace: right-anterior-superior\nsizes: 2 3 2 2\n"
        "space directions: none (1,0,0) (0,1,0) (0,0,1)\nkinds: list domain domain domain\n"
        "encoding: raw\nspace origin: (0,0,0)\nSegment0_ID:=a\nSegment0_LabelValue:=1\nSegment0_Layer:=0\n"
        "Segment1_ID:=b\nSegment1_LabelValue:=1\nSegment1_Layer:=1\n\n" +
            std::string("\0\1\1\0\0\0\1\1\0\0\0\1\0\1\1\0\0\0\1\1\0\0\0\1", 24));
}

void write_nifti(const Path& folder) {
    const WrittenVolume v = ball();
    file::write_whole_file(folder / "first.nii", nifti_bytes(v));
    file::write_whole_file(folder / "second.nii", nifti_bytes(v, {.second = true}));
    file::write_whole_file(folder / "quaternion.nii", nifti_bytes(v, {.swapped = true, .quaternion = true}));
}

void write_dicom(const Path& folder) {
    const WrittenVolume v = ball();
    file::write_whole_file(folder / "slice.dcm", dicom_bytes(v, 1));
    file::write_whole_file(folder / "frames.dcm", enhanced_dicom_bytes(v));
    // As scanners write them; what public collections hold.
    file::write_whole_file(folder / "unknown.dcm", with_unknown_sequence(dicom_bytes(v, 0)));
    file::write_whole_file(folder / "zeros.dcm", dicom_bytes(v, 0) + std::string(64, '\0'));
    file::write_whole_file(folder / "no_preamble.dcm", dicom_bytes(v, 0).substr(132));
    file::write_whole_file(folder / "text_spacing.dcm", with_spacing_as_text(dicom_bytes(v, 0)));
    file::write_whole_file(folder / "deflated.dcm", deflated(enhanced_dicom_bytes(v)));
    file::write_whole_file(folder / "one_bit.dcm", one_bit_segmentation(v));
    // Implicit elements, as the oldest scanners wrote them: group, number, length.
    std::string implicit = dicom_bytes(v, 0).substr(0, 132);
    const auto put = [&implicit](const std::string& text) { implicit += text; };
    put(
        std::string("\2\0\x10\0UI\x12\0"
                    "1.2.840.10008.1.2\0",
                    26));
    put(std::string("\x28\0\2\0\2\0\0\0\1\0\x28\0\x10\0\2\0\0\0\2\0\x28\0\x11\0\2\0\0\0\2\0", 30));
    put(std::string("\x28\0\0\1\2\0\0\0\x10\0\xe0\x7f\x10\0\x8\0\0\0\0\0\1\0\2\0\3\0", 26));
    file::write_whole_file(folder / "implicit.dcm", implicit);
}

void write_dicom_zip(const Path& folder) {
    const WrittenVolume v = ball();
    std::vector<std::pair<std::string, std::string>> files{{"notes.txt", "not DICOM"}};
    for (int z = 0; z < v.size[2]; ++z) files.emplace_back(fmt::format("study/{}.dcm", z), dicom_bytes(v, z));
    test::write_zip(folder / "slices.zip", files);
    test::write_zip(folder / "frames.zip", {{"f.dcm", enhanced_dicom_bytes(v)}});
}

geometry::TriangleSurface tetrahedron() {
    return {{Vec3(0.0), Vec3(0.02, 0.0, 0.0), Vec3(0.0, 0.02, 0.0), Vec3(0.0, 0.0, 0.02)},
            {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}};
}

// Numbers of a surface as text, in mm: the closed one, and one with a hole, a triangle on two others' edge and a point twice.
void write_texts(const Path& folder, const std::string& kind) {
    const std::vector<Vec3> points{{0, 0, 0}, {20, 0, 0}, {0, 20, 0}, {0, 0, 20}, {10, 10, 10}, {0, 0, 0}};
    const std::vector<std::array<int, 3>> closed{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}},
        open{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {1, 2, 4}, {5, 4, 3}};
    for (const auto* triangles : {&closed, &open}) {
        std::string text;
        if (kind == "obj") {
            text = "# SPACE=RAS\n";
            for (const Vec3& p : points) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
            for (const auto& t : *triangles) text += fmt::format("f {}//1 {}/2 -{}\n", t[0] + 1, t[1] + 1, 6 - t[2]);
        } else if (kind == "ply") {
            text = fmt::format(
                "ply\nformat ascii 1.0\ncomment SPACE=RAS\nelement vertex {}\nproperty float x\nproperty float y\n"
                "property double z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
                points.size(), triangles->size());
            for (const Vec3& p : points) text += fmt::format("{} {} {}\n", p.x, p.y, p.z);
            for (const auto& t : *triangles) text += fmt::format("3 {} {} {}\n", t[0], t[1], t[2]);
        } else {
            text = "solid SPACE=RAS\n";
            for (const auto& t : *triangles) {
                text += "facet normal 0 0 0\nouter loop\n";
                for (const int c : t) {
                    const Vec3& p = points[static_cast<std::size_t>(c)];
                    text += fmt::format("vertex {} {} {}\n", p.x, p.y, p.z);
                }
                text += "endloop\nendfacet\n";
            }
            text += "endsolid\n";
        }
        file::write_whole_file(folder / ((triangles == &closed ? "closed." : "open.") + kind), text);
    }
}

void write_bones(const Path& folder) {
    bone::Bone bone;
    bone.name = "ball";
    bone.distance = volume::Grid{{8, 8, 8}, Vec3(-3.5e-3), Vec3(1e-3), {}};
    for (int k = 0; k < 8; ++k)
        for (int j = 0; j < 8; ++j)
            for (int i = 0; i < 8; ++i)
                bone.distance.values.push_back(static_cast<float>(glm::length(bone.distance.position(i, j, k)) - 2e-3));
    bone.density = bone.distance;
    for (float& value : bone.density.values) value = value < 0.0f ? 1800.0f : 0.0f;
    bone.provenance["frame"] = "LPS";
    bone::Bone other = bone;
    other.name = "other";
    other.points = {contact::SurfacePoint{}};
    bone::save_bone(bone, folder / "one.vdb");
    bone::save_bones(std::vector{bone, other}, folder / "two.vdb");
    for (const std::uint32_t packing : {0u, 1u, 2u, 3u, 4u, 6u})
        file::write_whole_file(folder / fmt::format("packed{}.vdb", packing),
                               test::sealed(test::repacked(bone::read_sealed(folder / "one.vdb"), packing)));
}

}  // namespace

void write_seeds(const std::filesystem::path& root) {
    const auto folder = [&root](const std::string& target) {
        std::filesystem::create_directories(root / target);
        return root / target;
    };
    write_nrrd(folder("assets_nrrd"));
    write_universal(folder("assets_universal_file"));
    write_matlab(folder("assets_matlab_file"));
    write_nifti(folder("assets_nifti"));
    write_dicom(folder("assets_dicom"));
    write_dicom_zip(folder("assets_dicom_zip"));
    file::write_whole_file(folder("assets_inv3") / "project.tar", inv3_tar(ball()));
    for (const std::string kind : {"stl", "ply", "obj"}) write_texts(folder("assets_" + kind), kind);
    for (const std::string kind : {"stl", "ply"})
        mesh::write_mesh(std::vector<mesh::ColouredSurface>{{tetrahedron()}},
                         folder("assets_" + kind) / ("binary." + kind));
    write_bones(folder("assets_vdb"));
}

}  // namespace tactus
