// SPDX-License-Identifier: Apache-2.0
#include "tests/tools/window/person.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <thread>

namespace tactus::test {

namespace {

/// The beginning of an XImage, as Xlib.h declares it.
struct Image {
    int width, height, xoffset, format;
    unsigned char* data;
    int byte_order, bitmap_unit, bitmap_bit_order, bitmap_pad, depth, bytes_per_line, bits_per_pixel;
};

}  // namespace

struct Person::Libraries {
    void* x11 = ::dlopen("libX11.so.6", RTLD_NOW);
    void* xtst = ::dlopen("libXtst.so.6", RTLD_NOW);
    void* display = nullptr;

    template <class F>
    F* find(void* library, const char* name) const {
        return reinterpret_cast<F*>(::dlsym(library, name));
    }
    template <class... A>
    long x(const char* name, A... a) const {
        return find<long(A...)>(x11, name)(a...);
    }
    template <class... A>
    void test(const char* name, A... a) const {
        find<int(A...)>(xtst, name)(a...);
        x("XFlush", display);
    }
};

Person::Person(const VirtualDisplay& display) : x_(std::make_unique<Libraries>()) {
    if (!x_->x11 || !x_->xtst) return;
    const std::string name = ":" + display.number();
    x_->display = x_->find<void*(const char*)>(x_->x11, "XOpenDisplay")(name.c_str());
}

Person::~Person() {
    if (x_->display) x_->x("XCloseDisplay", x_->display);
}

bool Person::is_there() const { return x_->display != nullptr; }

void Person::wait(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

void Person::move(double x, double y) {
    x_->test("XTestFakeMotionEvent", x_->display, -1, static_cast<int>(x), static_cast<int>(y), 0ul);
}

void Person::button(int which, bool is_down) {
    x_->test("XTestFakeButtonEvent", x_->display, static_cast<unsigned>(which), static_cast<int>(is_down), 0ul);
}

void Person::key(const std::string& name, bool is_down) {
    const auto symbol = x_->find<unsigned long(const char*)>(x_->x11, "XStringToKeysym")(name.c_str());
    const auto code = x_->find<unsigned char(void*, unsigned long)>(x_->x11, "XKeysymToKeycode")(x_->display, symbol);
    x_->test("XTestFakeKeyEvent", x_->display, static_cast<unsigned>(code), static_cast<int>(is_down), 0ul);
}

void Person::click(double x, double y) {
    move(x, y);
    wait(0.15);
    button(1, true);
    button(1, false);
    wait(0.15);
}

void Person::drag(double x, double y, double to_x, double to_y, double seconds, int which) {
    constexpr int steps = 40;
    move(x, y);
    wait(0.15);
    button(which, true);
    for (int i = 1; i <= steps; ++i) {
        wait(seconds / steps);
        move(x + (to_x - x) * i / steps, y + (to_y - y) * i / steps);
    }
    wait(0.15);
    button(which, false);
}

void Person::tap(const std::string& name) {
    key(name, true);
    key(name, false);
    wait(0.1);
}

void Person::chord(const std::vector<std::string>& modifiers, const std::string& name) {
    for (const std::string& modifier : modifiers) key(modifier, true);
    wait(0.1);
    tap(name);
    for (const std::string& modifier : modifiers) key(modifier, false);
    wait(0.3);
}

void Person::double_click(double x, double y) {
    move(x, y);
    wait(0.3);
    for (int i = 0; i < 2; ++i) {
        button(1, true);
        button(1, false);
    }
    wait(0.5);
}

void Person::type(const std::string& text) {
    static const std::string shifted = "_:\">ABCDEFGHIJKLMNOPQRSTUVWXYZ";
    for (const char c : text) {
        std::string name(1, static_cast<char>(std::tolower(static_cast<unsigned char>(c))));
        if (c == ' ') name = "space";
        if (c == '_' || c == '-') name = "minus";
        if (c == '.' || c == '>') name = "period";
        if (c == ',') name = "comma";
        if (c == '"') name = "apostrophe";
        if (c == '/') name = "slash";
        if (c == ':') name = "semicolon";
        const bool is_shifted = shifted.find(c) != std::string::npos;
        if (is_shifted) key("Shift_L", true);
        key(name, true);
        key(name, false);
        if (is_shifted) key("Shift_L", false);
        wait(0.05);
    }
    wait(0.4);
}

Picture Person::look() const {
    Picture picture;
    const auto root = x_->find<unsigned long(void*)>(x_->x11, "XDefaultRootWindow")(x_->display);
    const int width = static_cast<int>(x_->x("XDisplayWidth", x_->display, 0)),
              height = static_cast<int>(x_->x("XDisplayHeight", x_->display, 0));
    using Get = Image*(void*, unsigned long, int, int, unsigned, unsigned, unsigned long, int);
    constexpr int by_pixels = 2;
    Image* image = x_->find<Get>(x_->x11, "XGetImage")(x_->display, root, 0, 0, static_cast<unsigned>(width),
                                                       static_cast<unsigned>(height), ~0ul, by_pixels);
    if (!image) return picture;
    picture.width = width;
    picture.height = height;
    picture.rgb.reserve(static_cast<std::size_t>(3 * width * height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const unsigned char* bgr = image->data + y * image->bytes_per_line + 4 * x;
            for (const int part : {2, 1, 0}) picture.rgb.push_back(bgr[part]);
        }
    x_->x("XFree", static_cast<void*>(image->data));
    x_->x("XFree", static_cast<void*>(image));
    return picture;
}

unsigned long Person::window(const std::string& title) const {
    using Tree = int(void*, unsigned long, unsigned long*, unsigned long*, unsigned long**, unsigned*);
    const auto root = x_->find<unsigned long(void*)>(x_->x11, "XDefaultRootWindow")(x_->display);
    unsigned long top = 0, parent = 0, *children = nullptr, found = 0;
    unsigned count = 0;
    x_->find<Tree>(x_->x11, "XQueryTree")(x_->display, root, &top, &parent, &children, &count);
    for (unsigned i = 0; i < count; ++i) {
        char* name = nullptr;
        x_->find<int(void*, unsigned long, char**)>(x_->x11, "XFetchName")(x_->display, children[i], &name);
        if (!name) continue;
        if (std::string(name).find(title) != std::string::npos) found = children[i];
        x_->x("XFree", static_cast<void*>(name));
    }
    if (children) x_->x("XFree", static_cast<void*>(children));
    return found;
}

bool Person::sees_window(const std::string& title, double max_s) const {
    for (double waited = 0.0; waited < max_s; waited += 0.1) {
        if (window(title) != 0) return true;
        wait(0.1);
    }
    return false;
}

void Person::give_keyboard(const std::string& title) {
    constexpr int back_to_parent = 2;
    x_->x("XSetInputFocus", x_->display, window(title), back_to_parent, 0ul);
    x_->x("XFlush", x_->display);
}

void Person::take_keyboard() {
    constexpr unsigned long nobody = 0;
    constexpr int back_to_nobody = 0;
    x_->x("XSetInputFocus", x_->display, nobody, back_to_nobody, 0ul);
    x_->x("XFlush", x_->display);
}

}  // namespace tactus::test
