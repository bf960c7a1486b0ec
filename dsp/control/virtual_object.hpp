// SPDX-License-Identifier: Apache-2.0
// Virtual object of an admittance device: the measured force deflects it.
#pragma once

#include "dsp/control/deflection_table.hpp"

#include <cstdint>

namespace tactus::control {

enum class ObjectKind : std::uint8_t {
    elastic,  ///< spring ∥ damper, with mass if any (thesis 6.3.3: F = k x + b ẋ)
    wall,     ///< rigid
    table,    ///< measured force → deflection
};

struct ObjectSettings {
    ObjectKind kind = ObjectKind::elastic;
    double stiffness = 1000.0;   ///< N/m
    double damping = 0.0;        ///< N·s/m
    double mass = 0.0;           ///< kg
    bool one_sided = false;  ///< the object begins at `rest` and lies towards +; before it the finger is free
    double rest = 0.0;  ///< m, position without force
    double free_damping = 80.0;  ///< N·s/m, in front of a one-sided object
    const DeflectionTable* table = nullptr;

    /// False without stiffness, damping and mass: any force would give an infinite velocity.
    bool is_renderable() const noexcept;
    bool operator==(const ObjectSettings&) const = default;
};

/// A mass, spring and damper in one step of held force: x⁺ = xx x + xv v + xf F, v⁺ = vx x + vv v + vf F.
struct HeldStep {
    double xx = 1.0, xv = 0.0, xf = 0.0, vx = 0.0, vv = 0.0, vf = 0.0;
};

/// Exact for a force that is constant over `dt` s. Without mass v is not a state; without damping too, x = F/k.
HeldStep held_step(double stiffness, double damping, double mass, double dt) noexcept;

/// Advances an object under forces that are held for one period each; exact for massless objects, also when a one-sided
/// one is reached or left within the period. With mass, sides change at the ends of periods; a wall stops the motion.
class VirtualObject {
public:
    /// Position and velocity are kept. Real-time safe.
    void set(const ObjectSettings& settings, double period_s) noexcept;
    /// Puts it at rest at `position`. Real-time safe.
    void place(double position) noexcept;
    /// Position at the end of the period under the force, m. Real-time safe.
    double step(double force) noexcept;

    double position() const noexcept { return x_ + settings_.rest; }
    const ObjectSettings& settings() const noexcept { return settings_; }

private:
    void step_massless(double force) noexcept;
    double leave_or_press(double force, double left) noexcept;

    ObjectSettings settings_;
    HeldStep contact_, free_;
    double dt_ = 1.0, x_ = 0.0, v_ = 0.0;  // x relative to `rest`
};

}  // namespace tactus::control
