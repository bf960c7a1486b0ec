// SPDX-License-Identifier: Apache-2.0
#include "tests/tools/window/file_drag.hpp"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cctype>

#include <chrono>
#include <optional>
#include <thread>

namespace tactus::test {

namespace {

using Name = unsigned long;  // of a window, an atom, a time

/// The events of Xlib.h that the protocol uses.
struct Message {
    int type;
    unsigned long serial;
    int is_sent;
    void* display;
    Name window, kind;
    int format;
    long data[5];
};
struct Request {
    int type;
    unsigned long serial;
    int is_sent;
    void* display;
    Name owner, requestor, selection, target, property, time;
};
struct Answer {
    int type;
    unsigned long serial;
    int is_sent;
    void* display;
    Name requestor, selection, target, property, time;
};
union Event {
    int type;
    Message message;
    Request request;
    Answer answer;
    long room[24];
};
constexpr int selection_request = 30, selection_answer = 31, client_message = 33;

/// As RFC 3986 has them in a file's address.
std::string escaped(const std::string& path) {
    std::string all;
    for (const char c : path) {
        const auto byte = static_cast<unsigned char>(c);
        const bool is_plain = std::isalnum(byte) || std::string("/-._~").find(c) != std::string::npos;
        constexpr char digits[] = "0123456789ABCDEF";
        if (is_plain) all += c;
        else all += {'%', digits[byte >> 4], digits[byte & 15]};
    }
    return all;
}

class Source {
public:
    Source(const VirtualDisplay& where, const std::vector<std::filesystem::path>& files)
        : display_(find<void*(const char*)>("XOpenDisplay")((":" + where.number()).c_str())) {
        for (const auto& file : files) list_ += "file://" + escaped(file.string()) + "\r\n";
        root_ = find<Name(void*)>("XDefaultRootWindow")(display_);
        own_ = find<Name(void*, Name, int, int, unsigned, unsigned, unsigned, Name, Name)>("XCreateSimpleWindow")(
            display_, root_, 0, 0, 1, 1, 0, 0, 0);
    }
    ~Source() { find<int(void*)>("XCloseDisplay")(display_); }
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;

    std::string drop(const std::string& title, int x, int y) {
        target_ = window(title);
        if (!target_) return "no window " + title;
        if (!takes_drops()) return "the window does not say that files may be dropped (XdndAware)";
        find<int(void*, Name, Name, Name)>("XSetSelectionOwner")(display_, atom("XdndSelection"), own_, 0);
        constexpr long version = 5L << 24;
        send("XdndEnter", {static_cast<long>(own_), version, static_cast<long>(atom("text/uri-list")), 0, 0});
        const auto copies = static_cast<long>(atom("XdndActionCopy"));
        send("XdndPosition", {static_cast<long>(own_), 0, static_cast<long>(x) << 16 | y, 0, copies});
        const auto status = message("XdndStatus");
        if (!status) return "no answer to the position";
        if (!(status->data[1] & 1)) return "the window refuses files";
        send("XdndDrop", {static_cast<long>(own_), 0, 0, 0, 0});
        return message("XdndFinished") ? "" : "the drop was never finished";
    }

private:
    template <class F>
    F* find(const char* name) const {
        return reinterpret_cast<F*>(::dlsym(library_, name));
    }
    Name atom(const char* name) const { return find<Name(void*, const char*, int)>("XInternAtom")(display_, name, 0); }

    Name window(const std::string& title) const {
        Name top = 0, parent = 0, *children = nullptr, found = 0;
        unsigned count = 0;
        find<int(void*, Name, Name*, Name*, Name**, unsigned*)>("XQueryTree")(display_, root_, &top, &parent, &children,
                                                                              &count);
        for (unsigned i = 0; i < count; ++i) {
            char* name = nullptr;
            find<int(void*, Name, char**)>("XFetchName")(display_, children[i], &name);
            if (!name) continue;
            if (std::string(name).find(title) != std::string::npos) found = children[i];
            find<int(void*)>("XFree")(name);
        }
        if (children) find<int(void*)>("XFree")(children);
        return found;
    }

    bool takes_drops() const {
        Name kind = 0, count = 0, left = 0;
        int format = 0;
        unsigned char* data = nullptr;
        find<int(void*, Name, Name, long, long, int, Name, Name*, int*, Name*, Name*, unsigned char**)>(
            "XGetWindowProperty")(display_, target_, atom("XdndAware"), 0, 1, 0, 0, &kind, &format, &count, &left,
                                  &data);
        if (data) find<int(void*)>("XFree")(data);
        return count == 1;
    }

    void send(const char* kind, const std::array<long, 5>& data) const {
        Event event{};
        event.message = {client_message, 0, 1, display_, target_, atom(kind), 32, {}};
        std::copy(data.begin(), data.end(), event.message.data);
        find<int(void*, Name, int, long, Event*)>("XSendEvent")(display_, target_, 0, 0, &event);
        find<int(void*)>("XFlush")(display_);
    }

    void give_list(const Request& request) const {
        find<int(void*, Name, Name, Name, int, int, const unsigned char*, int)>("XChangeProperty")(
            display_, request.requestor, request.property, request.target, 8, 0,
            reinterpret_cast<const unsigned char*>(list_.data()), static_cast<int>(list_.size()));
        Event event{};
        event.answer = {
            selection_answer, 0,           1, display_, request.requestor, request.selection, request.target,
            request.property, request.time};
        find<int(void*, Name, int, long, Event*)>("XSendEvent")(display_, request.requestor, 0, 0, &event);
        find<int(void*)>("XFlush")(display_);
    }

    /// Waits for a message, a minute at most: pictures of a busy machine are slow. Gives the list when it is asked for.
    std::optional<Message> message(const char* kind) const {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (std::chrono::steady_clock::now() < end) {
            while (find<int(void*)>("XPending")(display_) > 0) {
                Event event{};
                find<int(void*, Event*)>("XNextEvent")(display_, &event);
                if (event.type == selection_request) give_list(event.request);
                if (event.type == client_message && event.message.kind == atom(kind)) return event.message;
            }
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        }
        return std::nullopt;
    }

    void* library_ = ::dlopen("libX11.so.6", RTLD_NOW);
    void* display_;
    Name root_ = 0, own_ = 0, target_ = 0;
    std::string list_;
};

}  // namespace

std::string drop_files(const VirtualDisplay& display, const std::string& title,
                       const std::vector<std::filesystem::path>& files, int x, int y) {
    return Source(display, files).drop(title, x, y);
}

}  // namespace tactus::test
