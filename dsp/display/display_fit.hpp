// SPDX-License-Identifier: Apache-2.0
// Calibrates a display from positions touched with a device's tip: poses of the device, the mirror and the screens
// in the viewer's world.
#pragma once

#include "dsp/core/error.hpp"
#include "dsp/display/touched.hpp"

#include <glm/vec2.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::display {

/// One touched position.
struct Touch {
    enum class Of : std::uint8_t {
        workspace,  ///< a position that is also known in the viewer's world
        screen,  ///< a mark of a screen
        image,  ///< a mark of a screen, at its image in the mirror
        mirror,  ///< the plane of the mirror
    } of = Of::workspace;
    std::string screen;  ///< the mark's screen
    glm::dvec2 shown{0.0};  ///< of the mark: (0, 0) lower left, (1, 1) upper right
    Vec3 reading{0.0};  ///< frame of the device, m
    Vec3 place{0.0};  ///< for a workspace touch: the same position in the viewer's world, m

    /// "mark (0.9, 0.1) of screen 'left'", for messages.
    std::string name() const;
};

/// A touch that contradicts the others.
class BadTouch : public Error {
public:
    BadTouch(std::size_t touch_, const std::string& message) : Error(message), touch(touch_) {}
    std::size_t touch;  ///< index in the input
};

/// One fit and the residuals of its touches.
struct TouchedPart {
    std::string what;  ///< "device", "mirror" or "screen 'NAME'"
    std::vector<std::size_t> touches;  ///< indices in the input
    std::vector<double> off;  ///< m, residual of each
    TouchResidual residual;
};

struct DisplayFit {
    Pose device;  ///< its frame in the viewer's world; unchanged without workspace touches
    Mat3 stretch{1.0};  ///< linear map applied in the device's frame first
    std::optional<Plane> mirror;
    std::vector<std::pair<std::string, Screen>> screens;  ///< in the order of their first touches
    std::vector<TouchedPart> parts;
};

struct DisplayFitOptions {
    bool is_affine = false;  ///< also estimates scale and skew of the device
    double tolerance = 3e-3;  ///< m: touches with a greater residual are rejected
    std::optional<Plane> mirror;  ///< if already known, in the viewer's world
    Pose device;  ///< likewise, used without workspace touches
    Mat3 stretch{1.0};
};

/// Least squares for every part; each needs one touch more than its minimum, so that a faulty one can be detected.
/// Throws BadTouch with the touch, its residual and what to do; throws Error for touches that do not determine a part.
DisplayFit fit_display(std::span<const Touch> touches, const DisplayFitOptions& options = {});

}  // namespace tactus::display
