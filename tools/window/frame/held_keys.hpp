// SPDX-License-Identifier: Apache-2.0
// Keys that are down already when a window gets the keyboard: X repeats them, and GLFW takes the first repetition for a new
// press. A person who comes back to the window with a key held has not pressed it there.
#pragma once

#include <array>
#include <cstddef>

namespace tactus::window {

class HeldKeys {
public:
    /// The window gets the keyboard, or loses it.
    void focus(bool is_gained);
    /// Once per picture: forgets keys that were released since.
    void tend();
    /// An edge of a key by its number in the system. False: it is only the repetition of one that was down before.
    bool takes(int number, bool is_down);

private:
    static constexpr int keys = 256;
    using Map = std::array<char, keys / 8>;  ///< a bit for each key
    static bool is_in(const Map& map, int number);
    bool has_any() const { return down_ != Map{}; }
    /// The keys that are down now; none where the system does not tell, as with Wayland.
    static Map now();

    Map down_{};
};

}  // namespace tactus::window
