// SPDX-License-Identifier: Apache-2.0
// Keys by what stands on them. GLFW numbers keys by their places on a US keyboard. No user interface.
#pragma once

#include <map>

namespace tactus::window {

class KeyLetters {
public:
    /// The code of a key: of a letter that stands on it, that letter, as on a German or French keyboard; else its
    /// place. `name`: what GLFW says stands on it, may be null. A key that is released has the code that it was
    /// pressed with.
    int code(int key, int scancode, const char* name, bool is_down);
    /// A key that writes, as GLFW numbers them.
    static bool is_printable(int key) { return key > 32 && key < 256; }

private:
    std::map<int, int> down_;  ///< codes by scancode
};

}  // namespace tactus::window
