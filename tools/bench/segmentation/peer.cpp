// SPDX-License-Identifier: Apache-2.0
// scikit-image as peer: exchanges raw files with a Python process.
#include "tools/bench/segmentation/seeded_case.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace tactus::bench {

namespace {

// The Laplacian of a scan is the same for all seedings: it is made once. scikit-image 0.19 numbers the nodes of edges, so
// a seed on a voxel without neighbours shifts all numbers behind it and its solver runs on not-a-numbers for hours: such
// voxels are masked, and keep the label of their seed. Its solver has no limit of its own, either.
constexpr const char* script = R"py(
import os, sys, time, warnings
import numpy as np
import scipy.ndimage as ndi
import skimage.segmentation.random_walker_segmentation as rw
warnings.simplefilter("ignore")
folder = sys.argv[1]
size = [int(n) for n in sys.argv[2:5]]
spacing = [float(h) for h in sys.argv[5:8]]
values = np.fromfile(folder + "/values", "<f4").reshape(size).astype(float)
build = rw._build_laplacian
kept = {}
def build_once(data, spacing, mask, **rest):
    key = None if mask is None else mask.tobytes()
    if key not in kept:
        kept.clear()
        kept[key] = build(data, spacing, mask, **rest)
    return kept[key]
rw._build_laplacian = build_once
solve = rw.cg
def solve_with_limit(*system, **rest):
    found, info = solve(*system, **dict(rest, maxiter=5000))
    if info != 0 or not np.isfinite(found).all():
        raise ArithmeticError("conjugate gradients do not converge")
    return found, info
rw.cg = solve_with_limit
neighbours = ndi.generate_binary_structure(3, 1)
neighbours[1, 1, 1] = False
for name in open(folder + "/names").read().split():
    seeds = np.fromfile(folder + "/" + name + ".seeds", "u1").reshape(size).astype(int)
    inside = seeds != 255
    alone = inside & ~ndi.binary_dilation(inside, neighbours)
    of_alone = seeds[alone]
    seeds[~inside | alone] = -1
    begin = time.process_time()
    found = rw.random_walker(values, seeds, beta=130, mode="cg_j", tol=1e-3, spacing=spacing)
    seconds = time.process_time() - begin
    found[alone] = of_alone
    with open(folder + "/" + name + ".part", "wb") as out:
        out.write(b"%.3f\n" % seconds + np.maximum(found, 0).astype("u1")[inside].tobytes())
    os.rename(folder + "/" + name + ".part", folder + "/" + name)
)py";

template <class Value>
void write(const std::filesystem::path& path, const std::vector<Value>& values) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(Value)));
}

/// FNV-1a (Fowler, Noll and Vo).
class Hash {
public:
    template <class Value>
    void add(const std::vector<Value>& values) {
        add(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
    }
    void add(const char* bytes, std::size_t count) {
        for (std::size_t n = 0; n < count; ++n) {
            hash_ ^= static_cast<unsigned char>(bytes[n]);
            hash_ *= 0x100000001b3u;
        }
    }
    std::string text() const { return fmt::format("{:016x}", hash_); }

private:
    std::uint64_t hash_ = 0xcbf29ce484222325u;
};

/// A file of the cache: the seconds in a line, then a byte per node.
std::optional<PeerLabels> kept(const std::filesystem::path& path, std::size_t nodes) {
    std::ifstream in(path, std::ios::binary);
    PeerLabels peer;
    if (!(in >> peer.seconds) || in.get() != '\n') return {};
    peer.label.resize(nodes);
    in.read(reinterpret_cast<char*>(peer.label.data()), static_cast<std::streamsize>(nodes));
    if (in.gcount() != static_cast<std::streamsize>(nodes)) return {};
    return peer;
}

std::string last_line(const std::filesystem::path& path) {
    std::ifstream in(path);
    std::string last;
    for (std::string line; std::getline(in, line);)
        if (!line.empty()) last = line;
    return last;
}

}  // namespace

std::vector<PeerLabels> peer_labels(const SeededCase& real, const std::vector<std::vector<std::uint8_t>>& seeds,
                                    const std::filesystem::path& cache) {
    float low = real.grid.values[real.graph.voxel[0]], high = low;
    for (const std::uint32_t v : real.graph.voxel) {
        low = std::min(low, real.grid.values[v]);
        high = std::max(high, real.grid.values[v]);
    }
    std::vector<float> values(real.grid.count());
    for (std::size_t v = 0; v < values.size(); ++v)
        values[v] = std::clamp((real.grid.values[v] - low) / (high - low), 0.0f, 1.0f);
    const Vec3 h = real.grid.spacing / std::min({real.grid.spacing.x, real.grid.spacing.y, real.grid.spacing.z});
    const std::string arguments =
        fmt::format("{} {} {} {} {} {}", real.grid.size[2], real.grid.size[1], real.grid.size[0], h.z, h.y, h.x);
    Hash common;
    common.add(values);
    common.add(arguments.data(), arguments.size());
    common.add(script, std::strlen(script));

    const auto own = std::filesystem::temp_directory_path() / fmt::format("tactus_random_walker_{}", ::getpid());
    const std::filesystem::path folder = cache.empty() ? own : cache;
    std::filesystem::create_directories(folder);
    std::vector<std::string> names;
    std::string wanted;
    for (const std::vector<std::uint8_t>& seed : seeds) {
        std::vector<std::uint8_t> of_voxel(real.grid.count(), 255);
        for (std::size_t n = 0; n < seed.size(); ++n) of_voxel[real.graph.voxel[n]] = seed[n];
        Hash hash = common;
        hash.add(of_voxel);
        names.push_back(hash.text());
        if (kept(folder / names.back(), seed.size())) continue;
        write(folder / (names.back() + ".seeds"), of_voxel);
        wanted += names.back() + "\n";
    }
    if (!wanted.empty()) {
        write(folder / "values", values);
        std::ofstream(folder / "names") << wanted;
        std::ofstream(folder / "peer.py") << script;
        // One thread: the walks beside it have one.
        const std::string command =
            fmt::format("OMP_NUM_THREADS=1 OPENBLAS_NUM_THREADS=1 python3 '{0}/peer.py' '{0}' {1} 2>'{0}/errors'",
                        folder.string(), arguments);
        if (std::system(command.c_str()) != 0)
            fmt::print(
                stderr,
                "scikit-image is left out: {} (package python3-skimage; the first python3 of PATH must have it)\n",
                last_line(folder / "errors"));
    }
    for (const std::string& name : names) std::filesystem::remove(folder / (name + ".seeds"));
    std::vector<PeerLabels> peers;
    for (std::size_t n = 0; n < seeds.size(); ++n) {
        auto peer = kept(folder / names[n], seeds[n].size());
        if (!peer) break;
        peers.push_back(std::move(*peer));
    }
    if (cache.empty()) std::filesystem::remove_all(own);
    return peers;
}

}  // namespace tactus::bench
