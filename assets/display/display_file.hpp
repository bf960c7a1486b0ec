// SPDX-License-Identifier: Apache-2.0
// Display files: poses of screens, mirror and haptic device in the world of the viewer, and the eye for which each
// screen is. `tactus calibrate` writes them; they can also be written and edited by hand.
#pragma once

#include "dsp/display/screen.hpp"

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace tactus::display {

/// The eyes for which a screen is.
enum class ScreenEyes : std::uint8_t { both, left, right, middle };
inline constexpr std::array<std::string_view, 4> screen_eye_names{"both", "left", "right", "middle"};

/// Output of one screen.
struct ScreenSettings {
    std::string name;
    ScreenEyes eyes = ScreenEyes::both;
    std::optional<Vec3> eye;  ///< m, a fixed eye instead of the head: one direction of a multi-view display
    std::optional<StereoMode> stereo;  ///< none: as given by --stereo
    int monitor = 0;  ///< from 1, full screen on it; 0: none
    std::array<int, 4> window{};  ///< x, y from the upper left of the desktop, width, height in pixels; 0: none
};

struct DisplayFile {
    std::string title;
    DisplayGeometry geometry;  ///< its haptic world is the device's frame: position, orientation and stretch
    std::vector<ScreenSettings> screens;  ///< in the order of geometry.screens
    Pose eyes_in_head;  ///< the point between the eyes in the frame of the tracked body
    double head_away = 0.6;  ///< m from the first screen: position of the head without a tracker
};

/// Reads TOML. Throws Error with file:line:column for missing, unknown or impossible values, such as screens that are
/// not rectangles.
///
///     title = "half-transparent mirror"
///     between_eyes = "63 mm"
///     offset = "0 mm, 0 mm, 0 mm"           # shift of the picture against the haptic position
///
///     [head]                                # the point between the eyes in the frame of the tracked body
///     position = "0 mm, -60 mm, -20 mm"
///     rotation = "0 deg, 0 deg, 0 deg"      # about x first, then y, then z; x leads from the left eye to the right one
///     away     = "600 mm"                   # from the first screen, without a tracked head
///
///     [device]                              # frame of the haptic device, in the world of the viewer
///     position    = "10 mm, -250 mm, -40 mm"
///     orientation = [1, 0, 0, 0]            # quaternion w, x, y, z; or rotation, as above
///     stretch     = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]   # rows; before the rotation
///
///     [mirror]
///     point  = "0 mm, 0 mm, 0 mm"
///     normal = [0, 0, 1]
///
///     [[screens]]
///     name      = "monitor"
///     low_left  = "-260 mm, 0 mm, 300 mm"
///     low_right = "260 mm, 0 mm, 300 mm"
///     high_left = "-260 mm, -290 mm, 300 mm"
///     in_mirror = true
///     eyes      = "both"                    # left, right, middle: one projector each
///     eye       = "0 mm, -500 mm, 400 mm"   # a fixed eye, for displays with one projector per direction
///     stereo    = "side-by-side"            # mono, anaglyph, quad-buffer
///     monitor   = 1                         # a full screen there
///     window    = [0, 0, 1920, 1080]        # or a rectangle of the desktop, pixels: x, y, width, height
DisplayFile load_display_file(const std::filesystem::path& path);

/// The text of a display file. load_display_file reads the same values back, within a nanometre. `about`: lines of comment at its head.
std::string display_text(const DisplayFile& file, const std::vector<std::string>& about = {});

/// Parses "1 mm, 2 mm, 3 mm" to SI; each part has the dimension of `unit`. Throws Error.
Vec3 parse_vector(std::string_view text, std::string_view unit);

}  // namespace tactus::display
