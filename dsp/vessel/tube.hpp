// SPDX-License-Identifier: Apache-2.0
// A short straight tube fitted to a scan: image = contrast · profile + background, weighted by a window.
#pragma once

#include "dsp/vessel/scan.hpp"

#include <vector>

namespace tactus::vessel {

struct Tube {
    Vec3 centre{0.0};             ///< m
    Vec3 direction{0.0, 0.0, 1.0};  ///< unit
    double radius = 0.0;          ///< m
    double contrast = 0.0;        ///< brightness of the vessel above its surroundings
    double background = 0.0;
    /// t-statistic of the contrast per independent sample (see Sampling); 0 if it cannot be computed.
    double score = 0.0;
    double contrast_error = 0.0;  ///< standard deviation
    double valid = 0.0;           ///< fraction of the window inside of the scan and not excluded
};

/// Sample positions, in units of the radius, with the weight W = exp(-(axial / axial window)² - (across / window
/// across)²), without those below 0.1. They lie on rings around the axis, closer near the edge of the vessel.
struct Window {
    struct Place {
        double along, across_1, across_2;  ///< radii
        double weight;
        double volume;  ///< radii³
        double smooth;  ///< smooth_profile at this position
    };
    std::vector<Place> places;
    double reach = 0.0;  ///< largest distance of a position, radii
};

/// The window of tracking. Friman: `axial` 2.25; `across` 4.5, see TrackSettings. Radii.
Window tracking_window(double axial, double across);
/// A short window for refinement: `axial`, and `beyond` radii outside of the vessel's edge. Radii.
Window refining_window(double axial, double beyond);

/// Defines independent samples: the volume that one independent sample of the image fills, m³. Closer samples count as
/// less than one.
struct Sampling {
    double independent_volume = 0.0;
};

/// Contrast, background and score of the tube with this centre, direction and radius: weighted least squares.
Tube measured(const Scan& scan, const Window& window, const Sampling& sampling, Tube tube);

struct FitLimits {
    double min_radius, max_radius;  ///< m
    double shift = 1.0;  ///< greatest move across the axis, in radii of the start
    double angle = 0.6;  ///< largest rotation, rad
    int rounds = 3;  ///< number of times that the image is sampled again
    double blur = 0.0;  ///< m; above 0: blurred_profile
    bool turns = true, resizes = true;
    double contrast = 0.0;  ///< above 0: fixed at this value
};

/// Fits centre (across the axis), direction, radius, contrast and background from `start` on by Levenberg and
/// Marquardt. The result comes from measured().
Tube fitted(const Scan& scan, const Window& window, const Sampling& sampling, const Tube& start,
            const FitLimits& limits);

/// Two unit vectors across a unit direction.
struct Across {
    Vec3 first, second;
};
Across across(const Vec3& direction);

}  // namespace tactus::vessel
