// SPDX-License-Identifier: Apache-2.0
#include "tools/window/frame/held_keys.hpp"

#include <dlfcn.h>

namespace tactus::window {

/// By name, because GLFW for Wayland has no display of X.
HeldKeys::Map HeldKeys::now() {
    using Display = void*();
    using Query = int(void*, char*);
    static auto* const display = reinterpret_cast<Display*>(::dlsym(RTLD_DEFAULT, "glfwGetX11Display"));
    static auto* const query = reinterpret_cast<Query*>(::dlsym(RTLD_DEFAULT, "XQueryKeymap"));
    Map map{};
    if (void* const server = display && query ? display() : nullptr) query(server, map.data());
    return map;
}

bool HeldKeys::is_in(const Map& map, int number) {
    return number >= 0 && number < keys &&
           (static_cast<unsigned char>(map[static_cast<std::size_t>(number / 8)]) >> (number % 8) & 1) != 0;
}

void HeldKeys::focus(bool is_gained) { down_ = is_gained ? now() : Map{}; }

void HeldKeys::tend() {
    if (!has_any()) return;
    const Map still = now();
    for (std::size_t i = 0; i < down_.size(); ++i) down_[i] = static_cast<char>(down_[i] & still[i]);
}

bool HeldKeys::takes(int number, bool is_down) {
    if (!is_in(down_, number)) return true;
    // Once it is released, its next press counts.
    if (!is_down) down_[static_cast<std::size_t>(number / 8)] &= static_cast<char>(~(1 << (number % 8)));
    return !is_down;
}

}  // namespace tactus::window
