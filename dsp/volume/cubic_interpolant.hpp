// SPDX-License-Identifier: Apache-2.0
// Value and gradient between the samples of a grid, by Catmull–Rom cubics along each axis.
#pragma once

#include "dsp/volume/grid.hpp"

#include <algorithm>
#include <cmath>

namespace tactus::volume {

/// Positions are in samples from the grid's origin; the border is repeated outside. Gradients are per m. The grid may
/// hold some of the `layers` layers of a volume, from `first` on; positions count from the whole volume's first layer.
struct CubicInterpolant {
    const Grid& grid;
    int first = 0, layers = grid.size[2];

    struct Sample {
        double value;
        Vec3 gradient;
    };

    Sample operator()(const Vec3& at) const {
        Axis x(at.x, grid.size[0]), y(at.y, grid.size[1]), z(at.z, layers);
        // Safe also for layers that are not held.
        for (int& layer : z.index) layer = std::clamp(layer - first, 0, grid.size[2] - 1);
        const bool inner = x.inner && y.inner && z.inner;
        // Sums over y and z first, for four neighbours along x in parallel.
        float value[4] = {}, along_y[4] = {}, along_z[4] = {};
        for (int c = 0; c < 4; ++c)
            for (int b = 0; b < 4; ++b) {
                const float* row = &grid.values[grid.index(0, y.index[b], z.index[c])];
                float edge[4];
                if (!inner)
                    for (int a = 0; a < 4; ++a) edge[a] = row[x.index[a]];
                const float* r = inner ? row + x.index[0] : edge;
                const float w = y.weight[b] * z.weight[c], wy = y.slope[b] * z.weight[c], wz = y.weight[b] * z.slope[c];
                for (int a = 0; a < 4; ++a) {
                    value[a] += w * r[a];
                    along_y[a] += wy * r[a];
                    along_z[a] += wz * r[a];
                }
            }
        double v = 0.0, gx = 0.0, gy = 0.0, gz = 0.0;
        for (int a = 0; a < 4; ++a) {
            const double w = double(x.weight[a]);
            v += w * double(value[a]);
            gx += double(x.slope[a]) * double(value[a]);
            gy += w * double(along_y[a]);
            gz += w * double(along_z[a]);
        }
        return {v, Vec3(gx, gy, gz) / grid.spacing};
    }

private:
    struct Axis {
        int index[4];
        float weight[4], slope[4];
        bool inner;

        Axis(double u, int size) {
            const int last = size - 1;
            u = std::clamp(u, 0.0, double(last));
            const int cell = std::min(static_cast<int>(u), std::max(last - 1, 0));
            inner = cell >= 1 && cell + 2 <= last;
            for (int n = 0; n < 4; ++n) index[n] = std::clamp(cell - 1 + n, 0, last);
            const auto t = static_cast<float>(u - cell);
            const float t2 = t * t, t3 = t2 * t;
            weight[0] = -0.5f * t3 + t2 - 0.5f * t;
            weight[1] = 1.5f * t3 - 2.5f * t2 + 1.0f;
            weight[2] = -1.5f * t3 + 2.0f * t2 + 0.5f * t;
            weight[3] = 0.5f * t3 - 0.5f * t2;
            slope[0] = -1.5f * t2 + 2.0f * t - 0.5f;
            slope[1] = 4.5f * t2 - 5.0f * t;
            slope[2] = -4.5f * t2 + 4.0f * t + 0.5f;
            slope[3] = 1.5f * t2 - t;
        }
    };
};

}  // namespace tactus::volume
