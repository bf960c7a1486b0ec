// SPDX-License-Identifier: Apache-2.0
// make_library OUT_DIR: generates the bundled bones and saw recordings, which are not stored in the repository.
#include "assets/file/whole_file.hpp"
#include "assets/library/broken_mandible.hpp"
#include "assets/library/fibula.hpp"
#include "assets/library/flap_plan.hpp"
#include "assets/library/fragments.hpp"
#include "assets/library/mandible.hpp"
#include "assets/library/saw_recordings.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "assets/plan/plan_file.hpp"
#include "assets/vessel/track_file.hpp"
#include "assets/volume/write_volume.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace fs = std::filesystem;

namespace {

/// The case of the patch 'planning-trauma': fragments, plan, the script of the hand, and the ground truth, which the
/// patch never reads.
void make_case(const tactus::bone::Bone& mandible, const fs::path& folder) {
    fs::create_directories(folder);
    const tactus::library::BrokenMandible broken = tactus::library::break_mandible(mandible);
    std::vector<std::string> files;
    std::vector<std::uint64_t> hashes;
    std::string truth = "# p_bone = R p_fragment + t: name, t in mm, quaternion w x y z, middle in mm\n";
    for (std::size_t n = 0; n < broken.fragments.size(); ++n) {
        const tactus::bone::Bone& fragment = broken.fragments[n];
        files.push_back(fragment.name + ".vdb");
        tactus::bone::save_bone(fragment, folder / files.back());
        tactus::Hash hash;
        tactus::file::add_file(hash, folder / files.back());
        hashes.push_back(hash.value());
        const tactus::Vec3 t = broken.truth[n].position * 1e3;
        const tactus::Quat& q = broken.truth[n].orientation;
        tactus::Vec3 middle(0.0);
        for (const tactus::contact::SurfacePoint& p : fragment.points)
            middle += p.position * (1e3 / static_cast<double>(fragment.points.size()));
        truth += fmt::format("{} {} {} {} {} {} {} {} {} {} {}\n", fragment.name, t.x, t.y, t.z, q.w, q.x, q.y, q.z,
                             middle.x, middle.y, middle.z);
    }
    tactus::file::write_whole_file(folder / "truth.txt", truth);
    tactus::file::write_whole_file(folder / "hand.txt", broken.script);
    tactus::plan::save_case_plan(tactus::library::plan_of(broken, files, hashes), folder / "case.plan.json");
    fmt::print("{}: the hand needs {:.1f} s\n", (folder / "case.plan.json").string(), broken.seconds);
}

/// The case of the patch 'planning-reconstruction': pieces, vessels, plan and the script of the hand.
void make_flap_case(const fs::path& folder) {
    fs::create_directories(folder);
    const tactus::library::FlapCase made = tactus::library::make_flap();
    const tactus::library::FlapPieces pieces = tactus::library::cut_flap(made);
    std::vector<std::string> files;
    std::vector<std::uint64_t> hashes;
    for (const tactus::bone::Bone& bone : pieces.bones) {
        files.push_back(bone.name + ".vdb");
        tactus::bone::save_bone(bone, folder / files.back());
        tactus::Hash hash;
        tactus::file::add_file(hash, folder / files.back());
        hashes.push_back(hash.value());
    }
    tactus::vessel::write_track(made.artery, folder / "artery.csv");
    tactus::vessel::write_track(made.vein, folder / "vein.csv");
    tactus::bone::save_bone(pieces.tumour, folder / "tumour.vdb");
    std::array<std::uint64_t, 3> meshes{};
    for (std::size_t n = 0; n < meshes.size(); ++n) {
        const fs::path file = folder / std::array{"fibula.stl", "jaw.stl", "tumour.stl"}[n];
        tactus::mesh::write_mesh(
            std::vector<tactus::mesh::ColouredSurface>{{*std::array{&made.fibula, &made.jaw, &made.tumour}[n], {}}},
            file);
        tactus::Hash hash;
        tactus::file::add_file(hash, file);
        meshes[n] = hash.value();
    }
    tactus::file::write_whole_file(folder / "hand.txt", pieces.script);
    tactus::plan::save_case_plan(
        tactus::library::plan_of(pieces, files, hashes, tactus::library::reconstruction_of(made, meshes)),
        folder / "case.plan.json");
    fmt::print("{}: the hand needs {:.1f} s in {} lines\n", (folder / "case.plan.json").string(), pieces.seconds,
               pieces.moves);
}

/// What the tasks of the library need beside their texts: a bone and the structures to spare.
void make_tasks(const fs::path& folder) {
    const fs::path fibula = folder / "bones" / "fibula.vdb", tasks = folder / "tasks";
    fs::create_directories(tasks);
    tactus::bone::save_bone(tactus::library::make_fibula(), fibula);
    fmt::print("{}\n", fibula.string());
    for (const auto& [name, labels] : {std::pair{"mandible-canal.nrrd", tactus::library::mandible_canal()},
                                       std::pair{"fibula-vessels.nrrd", tactus::library::fibula_vessels()}}) {
        tactus::volume::write_volume(labels, tactus::volume::WrittenType::int16, tasks / name);
        fmt::print("{}\n", (tasks / name).string());
    }
}

void make_library(const fs::path& folder) {
    const fs::path bone = folder / "bones" / "mandible.vdb", saw = folder / "saw";
    std::error_code failure;
    fs::create_directories(bone.parent_path(), failure);
    if (failure)
        throw tactus::Error(fmt::format("{}: cannot be made: {}", bone.parent_path().string(), failure.message()));
    const tactus::bone::Bone mandible = tactus::library::make_mandible();
    tactus::bone::save_bone(mandible, bone);
    fmt::print("{}\n", bone.string());
    make_case(mandible, folder / "cases" / "mandible-twelve");
    make_flap_case(folder / "cases" / "fibula-flap");
    const fs::path fragments = folder / "bones" / "fragments.vdb";
    tactus::bone::save_bones(tactus::library::make_fragments(), fragments);
    fmt::print("{}\n", fragments.string());
    make_tasks(folder);
    tactus::library::make_saw_recordings(saw);
    std::set<std::string> written;
    for (const auto& entry : fs::directory_iterator(saw)) written.insert(entry.path().string());
    for (const std::string& path : written) fmt::print("{}\n", path);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        fmt::print(stderr, "usage: make_library OUT_DIR\n");
        return 2;
    }
    try {
        make_library(argv[1]);
    } catch (const std::exception& error) {
        fmt::print(stderr, "make_library: {}\n", error.what());
        return 1;
    }
    return 0;
}
