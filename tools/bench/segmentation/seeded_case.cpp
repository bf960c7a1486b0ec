// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/segmentation/seeded_case.hpp"

#include "assets/volume/scan_volume.hpp"
#include "dsp/segmentation/gap_statistics.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace tactus::bench {

namespace {

constexpr int dab_radius = 3;  // voxels

}  // namespace

std::optional<SeededCase> seeded_case(const std::filesystem::path& folder, const std::string& name) {
    const auto ct = folder / "fragments" / (name + "_ct.nrrd"), map = folder / "fragments" / (name + "_labels.nrrd");
    if (!std::filesystem::exists(ct) || !std::filesystem::exists(map)) return {};
    SeededCase real;
    real.name = name;
    real.grid = volume::lps_grid(volume::read_volume(ct));
    const volume::Grid labels = volume::lps_grid(volume::read_volume(map));
    std::map<int, int> number;  // labels of the file need not be in sequence
    for (const float value : labels.values)
        if (value > 0.0f) number[static_cast<int>(value)] = 0;
    for (auto& [value, index] : number) index = ++real.labels;
    std::vector<std::uint8_t> inside(labels.count(), 0);
    for (std::size_t v = 0; v < inside.size(); ++v)
        if (labels.values[v] > 0.0f) inside[v] = static_cast<std::uint8_t>(number[static_cast<int>(labels.values[v])]);
    real.law = segmentation::gap_law(segmentation::gap_statistics(real.grid, inside));
    real.graph = segmentation::make_voxel_graph(real.grid, inside, real.law);
    real.inside = inside;
    real.node_of_voxel = real.graph.node_of_voxel();
    for (const std::uint32_t v : real.graph.voxel) real.truth.push_back(inside[v]);
    for (std::size_t n = 0; n < real.graph.nodes(); ++n) {
        const auto at = real.graph.place(n);
        bool open = false;
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const int step : {-1, 1}) {
                auto next = at;
                next[axis] += step;
                open = open || next[axis] < 0 || next[axis] >= real.grid.size[axis] ||
                       inside[real.grid.index(next[0], next[1], next[2])] == 0;
            }
        if (open) real.surface.push_back(static_cast<std::uint32_t>(n));
    }
    return real;
}

void add_dab(const SeededCase& real, std::size_t node, std::vector<std::uint8_t>& seed) {
    const auto at = real.graph.place(node);
    for (int z = -dab_radius; z <= dab_radius; ++z)
        for (int y = -dab_radius; y <= dab_radius; ++y)
            for (int x = -dab_radius; x <= dab_radius; ++x) {
                const std::array<int, 3> p{at[0] + x, at[1] + y, at[2] + z};
                if (x * x + y * y + z * z > dab_radius * dab_radius) continue;
                bool is_outside = false;
                for (std::size_t a = 0; a < 3; ++a) is_outside = is_outside || p[a] < 0 || p[a] >= real.grid.size[a];
                if (is_outside) continue;
                const std::int32_t n = real.node_of_voxel[real.grid.index(p[0], p[1], p[2])];
                if (n >= 0 && real.truth[static_cast<std::size_t>(n)] == real.truth[node])
                    seed[static_cast<std::size_t>(n)] = real.truth[node];
            }
}

std::vector<std::uint8_t> painted_seeds(const SeededCase& real, int dabs, Random random) {
    std::vector<std::uint8_t> seed(real.graph.nodes(), 0);
    std::uint64_t draw = 0;
    for (int label = 1; label <= real.labels; ++label)
        for (int dab = 0; dab < dabs;) {
            const std::size_t node = real.surface[random.bits(draw++) % real.surface.size()];
            if (real.truth[node] != label) continue;
            add_dab(real, node, seed);
            ++dab;
        }
    return seed;
}

segmentation::VoxelGraph graph_of_seeds(const SeededCase& real, const std::vector<std::uint8_t>& seed) {
    const segmentation::GapLaw law = segmentation::law_of_seeds(real.law, real.graph, real.grid, seed);
    if (!(law.bright < real.law.bright)) return real.graph;
    return segmentation::make_voxel_graph(real.grid, real.inside, law);
}

double mean_dice(const SeededCase& real, const std::vector<std::uint8_t>& label) {
    const auto labels = static_cast<std::size_t>(real.labels);
    std::vector<double> both(labels + 1, 0.0), either(labels + 1, 0.0);
    for (std::size_t n = 0; n < label.size(); ++n) {
        either[real.truth[n]] += 1.0;
        if (label[n] <= labels) either[label[n]] += 1.0;
        if (label[n] == real.truth[n]) both[label[n]] += 1.0;
    }
    double sum = 0.0;
    for (std::size_t l = 1; l <= labels; ++l) sum += 2.0 * both[l] / either[l];
    return sum / static_cast<double>(labels);
}

}  // namespace tactus::bench
