// SPDX-License-Identifier: Apache-2.0
// The inner loop of PointshellContact: chunks of a shell against one voxmap, in single precision on 16 lanes.
//
// Everything is relative to the chunk: cells count from the cell of its centre and offsets are a few cells, so single
// precision resolves about 1e-6 cells. On every processor point i goes to lane i mod 16, lanes are summed in the order
// of the points, and products are rounded before they are added, so the sums have the same bits.
#pragma once

#include "dsp/contact/contact_law.hpp"
#include "dsp/contact/pointshell.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace tactus::contact::kernel {

inline constexpr std::size_t lanes = 16;
/// Maximum per call. Lanes are summed in single precision within a call; this number keeps seven digits.
inline constexpr std::size_t max_chunks = 32;

/// Data of a pair, common to its chunks. Map frame.
struct PairFrame {
    explicit PairFrame(const ContactLaw& contact_law) noexcept : law(contact_law) {}

    const float* values = nullptr;  ///< of the voxmap
    std::ptrdiff_t row = 0, plane = 0;  ///< number of samples from one row and one plane to the next
    int size[3] = {};
    float rotation[9] = {};  ///< rows of the rotation from shell to map
    float cells[9] = {};  ///< the same, in cells per metre
    float spacing[3] = {}, per_spacing[3] = {};  ///< m and 1/m
    float stiffness = 0.0f;  ///< k
    float near = 0.0f;  ///< m: where the trilinear field is above this, the quadratic one cannot reach the surface
    bool by_area = false, by_normal = false, quadratic = false, saturates = false, energy_only = false;
    /// Prefetches the samples of the next chunk during the computation of the current one; useful if the map exceeds
    /// the caches.
    bool prefetches = false;
    DepthLaw<float> law;
};

/// Position of a chunk. Cells count from `cell`, the one that holds the chunk's centre.
struct ChunkFrame {
    const ShellChunk* chunk = nullptr;
    std::ptrdiff_t base = 0;  ///< index of the sample at `cell`
    int cell[3] = {};
    float fraction[3] = {};  ///< of the centre within its cell
    float lever[3] = {};  ///< m, from the reference point to the corner of `cell`, map frame
    std::size_t rows = 0;  ///< rows of 16 points in the chunk
    bool border = false;  ///< some point may lie outside of the grid or next to its border
};

/// energy, total force; force and moment along n and r × n (6); stiffness nn (xx xy xz yy yz zz), nm (9), mm (6).
inline constexpr std::size_t sums = 2 + 6 + 21;

struct LaneSums {
    alignas(64) float value[sums][lanes] = {};
    alignas(64) float deepest[lanes] = {};
    std::size_t in_contact = 0;
};

/// Adds at most `max_chunks` chunks.
void evaluate(const PairFrame& pair, std::span<const ChunkFrame> chunks, LaneSums& into) noexcept;

/// Variants that this processor can run, best first, and the one in use. For tests and reports.
std::vector<std::string_view> variants();
std::string_view variant_in_use();
/// Selects a variant, "" for the best. Returns false if this processor cannot run it. Must not run in parallel with
/// computations.
bool use_variant(std::string_view name);

}  // namespace tactus::contact::kernel
