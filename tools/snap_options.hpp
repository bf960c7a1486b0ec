// SPDX-License-Identifier: Apache-2.0
// The verbs that break bones and put them together.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace tactus {

struct FractureChoice {
    std::filesystem::path bone, out;
    int pieces = 2, missing = 0;
    std::uint64_t seed = 1;
    double chips = 0.0;                                ///< % of the area
    double kerf = 0.0, roughness = 0.8;                ///< mm
    double voxel = 0.35, blur = 0.25;                  ///< mm, of the scan
    double noise = 3.0;                                ///< %, of the contrast
    double spread = 10.0, turn = 20.0;                 ///< mm, degrees: how far the fragments lie from their places
    double spacing = 0.42;                             ///< mm, of the surface points
    bool json = false;
};

struct SnapChoice {
    std::filesystem::path moving, fixed;
    std::string paint = "auto", start, mode = "extended";
    bool json = false;
};

struct FractureSurfaceChoice {
    std::filesystem::path bone, out, paint, facing, intact, main;
    double roughness = 0.06, reach = 10.0;  ///< mean of 1 − cos between normals; mm
    std::optional<double> least_area;  ///< mm²; each proposal has its own otherwise
    bool mirror = false, correct = false, keep = false, json = false;
};

struct RegisterChoice {
    std::filesystem::path moving, fixed;
    double away = 1.5, gap = 3.0, margin = 2.0;  ///< mm, of a region that lies elsewhere
    bool mirror = false, anywhere = false, region = false, json = false;
};

struct SnapBenchChoice {
    std::uint64_t seed = 1001;
    int seeds = 8, trials = 1;
    std::vector<std::string> cases, methods;
    std::filesystem::path bone;
    bool pushed = false, json = false;
};

struct SnapChoices {
    FractureChoice fracture;
    FractureSurfaceChoice surface;
    SnapChoice snap;
    RegisterChoice registration;
};

void add_snap_verbs(CLI::App& app, SnapChoices& choices);
void add_snap_bench(CLI::App& bench, SnapBenchChoice& choice);

int fracture_verb(const FractureChoice& choice);
int fracture_surface_verb(const FractureSurfaceChoice& choice);
int register_verb(const RegisterChoice& choice);
int snap_verb(const SnapChoice& choice);
int bench_snap_verb(const SnapBenchChoice& choice);

}  // namespace tactus
