// SPDX-License-Identifier: Apache-2.0
// A whole display rig from the places that a device's tip touched: where the device, the mirror and the screens stand in
// the world of the viewer.
#pragma once

#include "dsp/core/error.hpp"
#include "dsp/display/touched.hpp"

#include <glm/vec2.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace tactus::display {

/// One place, as the tip of the device was there.
struct RigTouch {
    enum class Of : std::uint8_t {
        workspace,  ///< a place that is known in the world of the viewer as well
        screen,  ///< a mark of a screen
        image,  ///< a mark of a screen where it is seen in the mirror
        mirror,  ///< the plane of the mirror
    } of = Of::workspace;
    std::string screen;  ///< whose mark
    glm::dvec2 shown{0.0};  ///< of the mark: (0, 0) lower left, (1, 1) upper right
    Vec3 reading{0.0};  ///< frame of the device, m
    Vec3 place{0.0};  ///< of a workspace touch: the same place in the world of the viewer, m

    /// "mark (0.9, 0.1) of screen 'left'", for people.
    std::string name() const;
};

/// A touch that the others contradict.
class BadTouch : public Error {
public:
    BadTouch(std::size_t touch_, const std::string& message) : Error(message), touch(touch_) {}
    std::size_t touch;  ///< index among those that were given
};

/// One fit and how far its touches are off it.
struct TouchedPart {
    std::string what;  ///< "device", "mirror" or "screen 'NAME'"
    std::vector<std::size_t> touches;  ///< indices among those that were given
    std::vector<double> off;  ///< m, of each
    TouchResidual residual;
};

struct RigFit {
    Pose device;  ///< its frame in the world of the viewer; as it is when there are no workspace touches
    Mat3 stretch{1.0};  ///< of the device's frame, before that
    std::optional<Plane> mirror;
    std::vector<std::pair<std::string, Screen>> screens;  ///< in the order of their first touches
    std::vector<TouchedPart> parts;
};

struct RigFitOptions {
    bool is_affine = false;  ///< take up scales and skews of the device as well
    double tolerance = 3e-3;  ///< m: a touch farther off what the others say is refused
    std::optional<Plane> mirror;  ///< as known before, in the world of the viewer
    Pose device;  ///< likewise, when there are no workspace touches
    Mat3 stretch{1.0};
};

/// Least squares for every part; each needs one touch more than decides it, so that a bad one shows. Throws BadTouch
/// naming the touch that does not fit, by how much and what to do, and Error for touches that decide nothing.
RigFit fit_rig(std::span<const RigTouch> touches, const RigFitOptions& options = {});

}  // namespace tactus::display
