// SPDX-License-Identifier: Apache-2.0
#include "assets/volume/reoriented_volume.hpp"

#include "assets/file/room.hpp"
#include "assets/volume/voxel_limit.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tactus::volume {

namespace {

using Axes = std::array<int, 3>;

// The file axis along x, y and z of LPS; -1 when none is parallel.
Axes axes_of(const SampleMap<Frame::lps>& map) {
    Axes file_axis{-1, -1, -1};
    for (int from = 0; from < 3; ++from) {
        const Vec3 direction = glm::abs(glm::normalize(map.step[from]));
        for (int axis = 0; axis < 3; ++axis)
            if (direction[axis] > 0.999998) file_axis[static_cast<std::size_t>(axis)] = from;  // 0.1 degrees
    }
    return file_axis;
}

// Catmull–Rom weights of the samples base - 1 .. base + 2 at fraction t.
std::array<double, 4> cubic(double t) {
    return {((-0.5 * t + 1.0) * t - 0.5) * t, (1.5 * t - 2.5) * t * t + 1.0, ((-1.5 * t + 2.0) * t + 0.5) * t,
            (0.5 * t - 0.5) * t * t};
}

// Per LPS axis the spacing of the most parallel file axis; the smallest spacing when one file axis would be used twice.
Vec3 spacing_for(const ScanVolume& in) {
    const Vec3 steps = in.spacing();
    std::array<bool, 3> used{};
    Vec3 spacing(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        int best = 0;
        for (int from = 1; from < 3; ++from)
            if (std::abs(in.map.step[from][axis]) / steps[from] > std::abs(in.map.step[best][axis]) / steps[best])
                best = from;
        if (used[static_cast<std::size_t>(best)]) return Vec3(std::min({steps.x, steps.y, steps.z}));
        used[static_cast<std::size_t>(best)] = true;
        spacing[axis] = steps[best];
    }
    return spacing;
}

// A volume in memory.
class HeldSlices final : public SliceReader {
public:
    explicit HeldSlices(ScanVolume volume) : values_(std::move(volume.values)) { about = std::move(volume); }
    void read(int k, std::span<float> values) override {
        std::copy_n(values_.begin() + static_cast<std::ptrdiff_t>(static_cast<std::size_t>(k) * values.size()),
                    values.size(), values.begin());
    }
    void settle(const Tally&) override {}

private:
    std::vector<float> values_;
};

}  // namespace

ReorientedVolume::ReorientedVolume(SliceReader& reader, RunJobs run)
    : reader_(reader),
      run_(stoppable(std::move(run))),
      width_(static_cast<std::size_t>(reader.about.size[0])),
      slices_(static_cast<std::size_t>(reader.about.size[2])),
      is_counted_(slices_.size()) {
    file_axis_ = axes_of(reader.about.map);
    turned_ = std::find(file_axis_.begin(), file_axis_.end(), -1) != file_axis_.end();
    back_ = glm::inverse(reader.about.map.step);
    if (turned_) box_around();
    else sort_axes();
    const bool downwards = turned_ ? back_[2].z < 0.0 : file_axis_[2] == 2 && mirrored_[2];
    keep_all_ = downwards && !reader.in_any_order();
}

void ReorientedVolume::sort_axes() {
    const ScanVolume& in = reader_.about;
    layout_.origin = in.map.origin;
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis), from = static_cast<std::size_t>(file_axis_[a]);
        const Vec3& step = in.map.step[file_axis_[a]];
        layout_.size[a] = in.size[from];
        layout_.spacing[axis] = glm::length(step);
        mirrored_[a] = step[axis] < 0.0;
        if (mirrored_[a]) layout_.origin[axis] += step[axis] * (layout_.size[a] - 1);
    }
}

void ReorientedVolume::box_around() {
    const ScanVolume& in = reader_.about;
    Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (int c = 0; c < 8; ++c) {
        const Vec3 corner =
            in.map(Vec3(c & 1 ? in.size[0] - 1 : 0, c & 2 ? in.size[1] - 1 : 0, c & 4 ? in.size[2] - 1 : 0));
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    layout_ = {{}, low, spacing_for(in), {}};
    double count = 1.0;
    for (int axis = 0; axis < 3; ++axis) count *= std::floor((high[axis] - low[axis]) / layout_.spacing[axis]) + 1.0;
    if (!(count <= max_voxels))
        throw Error("the rotated volume would need more than a billion voxels on LPS axes; crop the file first");
    for (int axis = 0; axis < 3; ++axis)
        layout_.size[static_cast<std::size_t>(axis)] =
            static_cast<int>((high[axis] - low[axis]) / layout_.spacing[axis]) + 1;
}

// Slices are read one by one; then all cores count and pack them.
void ReorientedVolume::read(const std::vector<int>& slices, bool keep) {
    constexpr std::size_t at_once = 8;
    std::vector<std::vector<float>> values(std::min(at_once, slices.size()), std::vector<float>(reader_.slice_size()));
    for (std::size_t start = 0; start < slices.size(); start += at_once) {
        const std::size_t count = std::min(at_once, slices.size() - start);
        std::vector<Tally> tallies(count);
        for (std::size_t n = 0; n < count; ++n) {
            leave_if_stopped();
            const std::size_t replaced = reader_.read_finite(slices[start + n], values[n]);
            if (!is_counted_[static_cast<std::size_t>(slices[start + n])]) tallies[n].not_numbers = replaced;
        }
        run_(static_cast<int>(count), [&](int job) {
            const auto n = static_cast<std::size_t>(job);
            const int slice = slices[start + n];
            if (!is_counted_[static_cast<std::size_t>(slice)]) tallies[n].add(values[n], slice, reader_.about.size);
            if (keep) slices_[static_cast<std::size_t>(slice)] = CompactSlice(values[n]);
        });
        for (std::size_t n = 0; n < count; ++n) {
            tally_.add(tallies[n]);
            is_counted_[static_cast<std::size_t>(slices[start + n])] = 1;
        }
    }
}

// Caches the slices from `first` to `last`; others are dropped unless reading them again is slow.
void ReorientedVolume::hold(int first, int last) {
    std::vector<int> passed, wanted;
    for (int n = 0; n < static_cast<int>(slices_.size()); ++n) {
        const auto slot = static_cast<std::size_t>(n);
        const bool needed = (n >= first || keep_all_) && n <= last;
        if (!keep_all_ && !needed) slices_[slot] = {};
        if (needed && slices_[slot].empty()) wanted.push_back(n);
        // The slice is read on the way, so its values are counted now at no cost.
        else if (n < first && !reader_.in_any_order() && !is_counted_[slot]) passed.push_back(n);
    }
    read(passed, false);
    read(wanted, true);
}

void ReorientedVolume::settle() {
    if (std::exchange(settled_, true)) return;
    std::vector<int> left;
    for (int n = 0; n < static_cast<int>(slices_.size()); ++n)
        if (!is_counted_[static_cast<std::size_t>(n)]) left.push_back(n);
    read(left, keep_all_);
    reader_.settle(tally_);
}

std::pair<int, int> ReorientedVolume::slices_for(int first, int count) const {
    const int last = static_cast<int>(slices_.size()) - 1, end = first + count - 1;
    if (!turned_) {
        if (file_axis_[2] != 2) return {0, last};
        return mirrored_[2] ? std::pair{last - end, last - first} : std::pair{first, end};
    }
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (int c = 0; c < 8; ++c) {
        const Vec3 corner =
            layout_.position(c & 1 ? layout_.size[0] - 1 : 0, c & 2 ? layout_.size[1] - 1 : 0, c & 4 ? end : first);
        const double u = (back_ * (corner - reader_.about.map.origin)).z;
        low = std::min(low, u), high = std::max(high, u);
    }
    return {std::clamp(static_cast<int>(std::floor(low)) - 2, 0, last),
            std::clamp(static_cast<int>(std::ceil(high)) + 3, 0, last)};
}

double ReorientedVolume::cubic_at(const Vec3& u) const {
    const auto& size = reader_.about.size;
    std::array<int, 3> base{};
    std::array<std::array<double, 4>, 3> weight{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        if (!(u[axis] >= -0.5 && u[axis] <= size[a] - 0.5))
            return double(line_ && line_->first < 0.0 ? tally_.high : tally_.low);
        base[a] = static_cast<int>(std::floor(u[axis]));
        weight[a] = cubic(u[axis] - base[a]);
    }
    const auto clamped = [&](std::size_t a, int n) { return std::clamp(base[a] - 1 + n, 0, size[a] - 1); };
    double sum = 0.0, low = std::numeric_limits<double>::infinity(), high = -low;
    for (int k = 0; k < 4; ++k)
        for (int j = 0; j < 4; ++j) {
            double along = 0.0;
            for (int i = 0; i < 4; ++i) {
                const auto sample = double(value(clamped(0, i), clamped(1, j), clamped(2, k)));
                low = std::min(low, sample), high = std::max(high, sample);
                along += weight[0][static_cast<std::size_t>(i)] * sample;
            }
            sum += weight[1][static_cast<std::size_t>(j)] * weight[2][static_cast<std::size_t>(k)] * along;
        }
    // A cubic overshoots at edges; values that no sample has are artefacts.
    return std::clamp(sum, low, high);
}

double ReorientedVolume::nearest_at(const Vec3& u) const {
    std::array<int, 3> at{};
    for (int axis = 0; axis < 3; ++axis) {
        const auto a = static_cast<std::size_t>(axis);
        const double n = std::floor(u[axis] + 0.5);
        if (!(n >= 0.0 && n <= reader_.about.size[a] - 1.0)) return 0.0;
        at[a] = static_cast<int>(n);
    }
    return double(value(at[0], at[1], at[2]));
}

void ReorientedVolume::sorted_row(int first, int j, int k, std::span<float> out) const {
    const auto& size = layout_.size;
    std::array<int, 3> at{};  // index in the file
    const auto place = [&](std::size_t axis, int n) {
        at[static_cast<std::size_t>(file_axis_[axis])] = mirrored_[axis] ? size[axis] - 1 - n : n;
    };
    place(1, j);
    place(2, k);
    const int count = static_cast<int>(out.size());
    if (file_axis_[0] == 0) {
        place(0, mirrored_[0] ? first + count - 1 : first);
        const std::size_t from = static_cast<std::size_t>(at[1]) * width_ + static_cast<std::size_t>(at[0]);
        slices_[static_cast<std::size_t>(at[2])].copy(from, out);
        if (mirrored_[0]) std::reverse(out.begin(), out.end());
        return;
    }
    for (int i = 0; i < count; ++i) {
        place(0, first + i);
        out[static_cast<std::size_t>(i)] = value(at[0], at[1], at[2]);
    }
}

Grid ReorientedVolume::layers(int first, int count, const Window& window) {
    const auto [low, high] = slices_for(first, count);
    hold(low, high);
    const int i0 = window.low[0], j0 = window.low[1];
    Grid out{{window.high[0] - i0 + 1, window.high[1] - j0 + 1, count},
             layout_.position(i0, j0, first),
             layout_.spacing,
             {}};
    file::require_room(double(out.count()) * sizeof(float), reader_.about.source, "some of its slices");
    out.values.resize(out.count());
    const bool labels = reader_.about.kind == VolumeKind::labels;
    run_(count, [&](int layer) {
        for (int j = 0; j < out.size[1]; ++j) {
            const std::span row(&out.values[out.index(0, j, layer)], static_cast<std::size_t>(out.size[0]));
            if (!turned_) {
                sorted_row(i0, j0 + j, first + layer, row);
            } else {
                leave_if_stopped();
                int i = i0;
                for (float& value : row) {
                    const Vec3 u = back_ * (layout_.position(i++, j0 + j, first + layer) - reader_.about.map.origin);
                    value = static_cast<float>(labels ? nearest_at(u) : cubic_at(u));
                }
            }
            if (line_)
                for (float& value : row) value = static_cast<float>(line_->first * double(value) + line_->second);
        }
    });
    return out;
}

Grid part_of(ReorientedVolume& layers, const std::array<int, 3>& low, const std::array<int, 3>& high) {
    constexpr int at_once = 16;
    const Grid& all = layers.layout();
    Grid out{{}, all.position(low[0], low[1], low[2]), all.spacing, {}};
    for (std::size_t a = 0; a < 3; ++a) out.size[a] = high[a] - low[a] + 1;
    file::require_room(double(out.count()) * sizeof(float), layers.source(), "its samples");
    out.values.resize(out.count());
    for (int k = 0; k < out.size[2]; k += at_once) {
        const Grid slab =
            layers.layers(low[2] + k, std::min(at_once, out.size[2] - k), {{low[0], low[1]}, {high[0], high[1]}});
        std::copy(slab.values.begin(), slab.values.end(), &out.values[out.index(0, 0, k)]);
    }
    return out;
}

Grid whole_of(ReorientedVolume& layers) {
    const auto& size = layers.layout().size;
    return part_of(layers, {0, 0, 0}, {size[0] - 1, size[1] - 1, size[2] - 1});
}

Grid lps_grid(ScanVolume volume) {
    HeldSlices reader(std::move(volume));
    ReorientedVolume layers(reader, run_in_turn);
    layers.settle();
    return whole_of(layers);
}

std::pair<double, double> ReorientedVolume::range() const {
    const double low = double(tally_.low), high = double(tally_.high);
    if (!line_) return {low, high};
    return std::minmax({line_->first * low + line_->second, line_->first * high + line_->second});
}

}  // namespace tactus::volume
