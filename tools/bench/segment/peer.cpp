// SPDX-License-Identifier: Apache-2.0
// scikit-image as peer: exchanges raw files with a Python process.
#include "tools/bench/segment/seeded_case.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

namespace tactus::bench {

namespace {

constexpr const char* script = R"py(
import sys, time, warnings
import numpy as np
from skimage.segmentation import random_walker
warnings.simplefilter("ignore")
folder = sys.argv[1]
size = [int(n) for n in sys.argv[2:5]]
spacing = [float(h) for h in sys.argv[5:8]]
values = np.fromfile(folder + "/values", "<f4").reshape(size).astype(float)
seeds = np.fromfile(folder + "/seeds", "u1").reshape(size).astype(int)
seeds[seeds == 255] = -1
begin = time.process_time()
found = random_walker(values, seeds, beta=130, mode="cg_j", tol=1e-3, spacing=spacing)
np.maximum(found, 0).astype("u1").tofile(folder + "/labels")
print(time.process_time() - begin)
)py";

template <class Value>
void write(const std::filesystem::path& path, const std::vector<Value>& values) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(Value)));
}

}  // namespace

std::optional<PeerLabels> peer_labels(const SeededCase& real, const std::vector<std::uint8_t>& seed) {
    const auto folder = std::filesystem::temp_directory_path() / fmt::format("tactus_random_walker_{}", ::getpid());
    std::filesystem::create_directories(folder);
    float low = real.grid.values[real.graph.voxel[0]], high = low;
    for (const std::uint32_t v : real.graph.voxel) {
        low = std::min(low, real.grid.values[v]);
        high = std::max(high, real.grid.values[v]);
    }
    std::vector<float> values(real.grid.count());
    for (std::size_t v = 0; v < values.size(); ++v)
        values[v] = std::clamp((real.grid.values[v] - low) / (high - low), 0.0f, 1.0f);
    std::vector<std::uint8_t> seeds(real.grid.count(), 255);
    for (std::size_t n = 0; n < seed.size(); ++n) seeds[real.graph.voxel[n]] = seed[n];
    write(folder / "values", values);
    write(folder / "seeds", seeds);
    std::ofstream(folder / "peer.py") << script;
    const Vec3 h = real.grid.spacing / std::min({real.grid.spacing.x, real.grid.spacing.y, real.grid.spacing.z});
    const std::string command =
        fmt::format("python3 {0}/peer.py {0} {1} {2} {3} {4} {5} {6} >{0}/seconds 2>/dev/null", folder.string(),
                    real.grid.size[2], real.grid.size[1], real.grid.size[0], h.z, h.y, h.x);
    std::optional<PeerLabels> peer;
    if (std::system(command.c_str()) == 0) {
        peer.emplace();
        std::ifstream(folder / "seconds") >> peer->seconds;
        std::vector<char> labels(real.grid.count());
        std::ifstream(folder / "labels", std::ios::binary)
            .read(labels.data(), static_cast<std::streamsize>(labels.size()));
        for (const std::uint32_t v : real.graph.voxel) peer->label.push_back(static_cast<std::uint8_t>(labels[v]));
    }
    if (!peer) fmt::print(stderr, "scikit-image is left out: python3 cannot import it, or it failed\n");
    std::filesystem::remove_all(folder);
    return peer;
}

}  // namespace tactus::bench
