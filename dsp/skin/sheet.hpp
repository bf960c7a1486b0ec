// SPDX-License-Identifier: Apache-2.0
// A sheet of skin: stretch, shear and bending of a rectangular grid of nodes.
//
// Each step minimises the incremental potential of an implicit Euler step, kinetic term plus elastic energy, by Newton's
// method with conjugate gradients and a line search (Martin et al., Example-Based Elastic Materials, SIGGRAPH 2011, §4).
// The minimum is never above the energy of standing still, so the sheet gains no energy at any step length. XPBD with a
// few iterations was not used: 64 constraints in a row need hundreds of iterations before the force is right
// (dsp/rope has the same problem in one dimension), and here tension is a result.
#pragma once

#include "dsp/core/types.hpp"
#include "dsp/rope/obstacle.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace tactus::skin {

/// Skin with its fat as one elastic layer without transverse contraction. The numbers are assumed: in vivo moduli of skin
/// differ by two orders of magnitude with the method of measurement.
struct SheetSettings {
    int columns = 30, rows = 20;  ///< nodes along the length and the width; 2 to 200
    double length = 60e-3, width = 40e-3;  ///< m, at rest
    double thickness = 10e-3;  ///< m; assumed
    double young = 100e3;  ///< Pa, in the plane; assumed
    double shear = 50e3;  ///< Pa; half of Young's modulus, as without transverse contraction
    double bending_young = 10e3;  ///< Pa, of bending alone: layers slide on each other; assumed
    double density = 1000.0;  ///< kg/m³
    double contact = 200.0;  ///< N/m of a node against an obstacle
    double drag = 0.0;  ///< 1/s: velocity decays with this rate in addition to the step's own loss
};

/// A spring from a node to a fixed point that pulls only when it is longer than `slack_length`.
struct Tether {
    int node = 0;
    Vec3 to{0.0};
    double slack_length = 50e-3;  ///< m
    double stiffness = 40.0;  ///< N/m
};

/// What acts on a sheet from outside.
struct SheetLoads {
    Vec3 gravity{0.0};  ///< m/s²
    Vec3 pressure{0.0};  ///< Pa over the area at rest, in a fixed direction
    const rope::Obstacle* obstacle = nullptr;  ///< kept at half of the thickness from the nodes
    std::span<const Tether> tethers{};
};

class Sheet {
public:
    /// Flat, in the xy plane of `pose`: columns along x, rows along y, centred. Throws Error for settings out of range.
    Sheet(const SheetSettings& settings, const Pose& pose);

    const SheetSettings& settings() const noexcept { return settings_; }
    std::size_t size() const noexcept { return positions_.size(); }
    int index(int column, int row) const noexcept { return row * settings_.columns + column; }
    const std::vector<Vec3>& positions() const noexcept { return positions_; }
    const std::vector<Vec3>& velocities() const noexcept { return velocities_; }

    /// Holds a node at a point until it is released.
    void pin(int node, const Vec3& at) noexcept;
    void release(int node) noexcept;

    /// Advances by `dt` s > 0. Allocates nothing. Returns the number of Newton rounds.
    int step(double dt, const SheetLoads& loads) noexcept;

    /// Moves to rest under the loads: steps without inertia until the largest motion is below `tolerance` m. Returns
    /// false if it still moves after `max_steps`.
    bool settle(const SheetLoads& loads, double tolerance = 1e-7, int max_steps = 400) noexcept;

    /// J: elastic, of the tethers, of contact and of weight and pressure (zero at the origin).
    double potential(const SheetLoads& loads) const noexcept;
    double kinetic() const noexcept;
    /// N, of a tether at the present positions: 0 while it is slack.
    double tension(const Tether& tether) const noexcept;
    /// m², of the deformed sheet.
    double area() const noexcept;

private:
    struct Stretch {
        int a, b;
        double length, stiffness;  ///< m, N/m
    };
    struct Shear {
        int n00, n10, n01, n11;
        double across, weight;  ///< m², of a cell; J
    };
    struct Bend {
        int a, b, c;
        double weight;  ///< N/m
    };
    struct Twist4 {
        int n00, n10, n01, n11;
        double weight;  ///< N/m
    };

    double energy(std::span<const Vec3> at, const SheetLoads& loads) const noexcept;
    void gradient(std::span<const Vec3> at, const SheetLoads& loads, std::vector<Vec3>& out) const noexcept;
    /// The energy of bending is quadratic: its gradient at `at`, and its Hessian times `at`.
    void add_bending(std::span<const Vec3> at, std::vector<Vec3>& out) const noexcept;
    void elastic_gradient(std::span<const Vec3> at, std::vector<Vec3>& out) const noexcept;
    /// Linearises at `at`: the parts that multiply() uses.
    void linearise(std::span<const Vec3> at, const SheetLoads& loads, double inertia_scale) noexcept;
    void multiply(const std::vector<Vec3>& in, std::vector<Vec3>& out) const noexcept;
    int minimise(const SheetLoads& loads, double inertia_scale, int max_rounds) noexcept;
    double contact_energy(const Vec3& at, const rope::Obstacle& obstacle, Vec3& normal, double& depth) const noexcept;

    SheetSettings settings_;
    std::vector<Stretch> stretches_;
    std::vector<Shear> shears_;
    std::vector<Bend> bends_;
    std::vector<Twist4> twists_;
    std::vector<double> masses_;  ///< kg
    std::vector<double> areas_;  ///< m², at rest
    std::vector<char> held_;
    std::vector<Vec3> positions_, velocities_;
    // Of the solver.
    std::vector<Vec3> predicted_, before_, trial_, gradient_, direction_, residual_, product_, search_, scaled_;
    std::vector<Mat3> stretch_hessians_, node_hessians_, inverse_diagonals_;
    std::vector<Vec3> shear_u_, shear_v_;
};

}  // namespace tactus::skin
