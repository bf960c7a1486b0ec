// SPDX-License-Identifier: Apache-2.0
// A bone in memory: distance and density in sparse bricks, edited by one writer, read by any number of threads through
// immutable snapshots.
//
// A brick holds the 9 × 9 × 9 samples at the corners of 8 × 8 × 8 cells. Samples on the border between bricks are
// stored in each of them (the apron), so that every interpolation reads one brick only. Copy on write: a brick is
// copied at its first write after a publication; a snapshot is a table of pointers to bricks that are no longer
// written.
#pragma once

#include "dsp/core/hash.hpp"
#include "dsp/core/types.hpp"
#include "dsp/volume/grid.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

namespace tactus::volume {

inline constexpr int brick_cells = 8, brick_side = brick_cells + 1,
                     brick_samples = brick_side * brick_side * brick_side;

/// Layout of the samples in bricks. Frame: LPS, metres.
struct BrickLayout {
    std::array<int, 3> size{0, 0, 0};  ///< samples per axis
    std::array<int, 3> bricks{0, 0, 0};  ///< bricks per axis
    Vec3 origin{0.0, 0.0, 0.0}, spacing{0.0, 0.0, 0.0};
    double far = 0.0;  ///< value where no brick is stored: lower bound of the distance there, m

    int brick_index(int bx, int by, int bz) const { return (bz * bricks[1] + by) * bricks[0] + bx; }
    int brick_count() const { return bricks[0] * bricks[1] * bricks[2]; }
    static int sample_index(int x, int y, int z) { return (z * brick_side + y) * brick_side + x; }
};

/// One version of a bone: tables of bricks, null where none is stored.
struct BoneRoot {
    const BrickLayout* layout = nullptr;
    std::vector<const float*> distance, density;
};

/// An empty bone: `far` everywhere.
extern const BoneRoot empty_bone;

/// Value and exact gradient of the trilinear interpolant.
struct Sample {
    double value = 0.0;  ///< m, negative inside the bone
    Vec3 gradient{0.0, 0.0, 0.0};  ///< m/m; points out of the bone
    bool inside = false;  ///< false: nothing is stored nearby; value = far, gradient 0
};

/// Handle of one version, the value on wires. Reading is wait-free.
struct BoneSnapshot {
    static constexpr std::string_view wire_name = "bone";

    const BoneRoot* root = &empty_bone;
    std::int64_t version = 0;
    std::uint64_t content_hash = 0;  ///< over all changes up to this version

    /// Outside of the grid the distance is extrapolated from its border, up to `far`, as if the surface lay straight
    /// inwards. This is needed because a tool may be thicker than the air around the bone.
    Sample sample(const Vec3& position) const noexcept;
    double value(const Vec3& position) const noexcept;
    /// The same from a quadratic B-spline over 27 samples: its gradient is continuous, so that forces derived from it
    /// do not jump at cell faces. It smooths curvature: a surface of curvature κ moves by about κ·spacing²/4.
    Sample smooth_sample(const Vec3& position) const noexcept;
    /// kg/m³, 0 where nothing is stored.
    double density(const Vec3& position) const noexcept;
    const BrickLayout& layout() const noexcept { return *root->layout; }
};

struct BoneEditorOptions {
    double band = 0.003;  ///< m: bricks completely farther outside than this are not stored
    int max_dirty = 512;  ///< bricks that may change between two publications
    int max_versions = 24;  ///< published versions that may be readable at the same time
};

/// The single writer of a bone. Allocates in the constructor only: every readable version pins at most the bricks that
/// changed after it, so 2·N + max_versions·max_dirty bricks always suffice.
class BoneEditor {
public:
    /// Both grids of equal size, at least 2 samples per axis. Throws Error otherwise.
    BoneEditor(const Grid& distance, const Grid& density, const BoneEditorOptions& options = {});
    BoneEditor(const BoneEditor&) = delete;
    BoneEditor& operator=(const BoneEditor&) = delete;

    const BrickLayout& layout() const noexcept { return layout_; }

    /// Distance at a sample with all edits; `far` where no brick is stored.
    float get(int i, int j, int k) const noexcept;
    /// Writes a sample to every brick that holds it. Returns false, without writing, if no brick does or if the budget
    /// of changed bricks would be exceeded.
    bool set(int i, int j, int k, float value) noexcept;
    /// Distance and density with all edits, before publication.
    BoneSnapshot working() const noexcept { return {&working_, version_, hash_.state}; }

    int dirty() const noexcept { return static_cast<int>(dirty_.size()); }
    int dirty_left() const noexcept { return options_.max_dirty - dirty(); }

    BoneSnapshot current() const noexcept { return current_; }
    /// Publishes the edits as the current version. Without edits returns the current version again.
    BoneSnapshot publish() noexcept;
    /// Bricks that the last publication changed, ascending.
    std::span<const std::uint32_t> changed_bricks() const noexcept { return changed_; }

    /// Call when versions before `oldest_readable` have no readers: frees bricks that only they use.
    void reclaim(std::int64_t oldest_readable) noexcept;
    /// Call when that version was published and then dropped: it has no readers.
    void forget(std::int64_t version) noexcept;

    /// Free bricks, for tests and telemetry.
    std::size_t free_bricks() const noexcept { return free_.size(); }

private:
    struct Retired {
        float* brick;
        std::int64_t first, end;  // versions first … end − 1 hold it
    };
    struct Published {
        std::int64_t version;
        BoneRoot* root;
    };

    float* writable(int brick) noexcept;
    void release_unreadable() noexcept;

    BrickLayout layout_;
    BoneEditorOptions options_;
    std::unique_ptr<float[]> storage_;
    std::vector<float*> free_;
    std::vector<std::unique_ptr<BoneRoot>> roots_;
    std::vector<BoneRoot*> free_roots_;
    BoneRoot working_;
    std::vector<std::int64_t> born_;  // per brick: version that first held it
    std::vector<std::uint8_t> is_dirty_;  // per brick
    std::vector<std::uint32_t> dirty_, changed_;
    std::vector<Retired> retired_;
    std::vector<Published> readable_;  // ascending; the last is current
    std::int64_t version_ = 1;
    Hash hash_;
    BoneSnapshot current_;
};

/// Returns the distance of a version as a dense grid, for files and images.
Grid to_grid(const BoneSnapshot& bone);

}  // namespace tactus::volume
