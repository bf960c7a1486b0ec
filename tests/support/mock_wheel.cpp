// SPDX-License-Identifier: Apache-2.0
// A force-feedback wheel in umockdev's /dev and /sys, for programs that run with UMOCKDEV_DIR and umockdev's library
// preloaded. It answers the calls on its event device as the kernel does (drivers/input/evdev.c, ff-core.c, ff-memless.c,
// hid-lg4ff.c): effects belong to the file that uploaded them, are erased when it is closed, and end by themselves. One
// command a line on the standard input, one line of answer:
//   turn COUNT     the axis X                  unplug, plug
//   state          playing=LEVEL effects=N gain=N centring=N files=N played=N   (-1: was never set)
//   keep           from now on a file that is closed leaves its effects: only their length ends them
#include <glib-object.h>
#include <glib.h>
#include <linux/input.h>
#include <umockdev.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <deque>
#include <iostream>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace {

constexpr const char *node = "/dev/input/event5", *name = "Logitech G29 Driving Force Racing Wheel";
constexpr int full = 65535;

/// hid-lg4ff keeps the range beside the device of the USB interface, two folders above the event device.
constexpr const char* description = R"(P: /devices/pci0000:00/0000:00:14.0/usb1/1-2/1-2:1.0/0003:046D:C24F.0003
E: SUBSYSTEM=hid
A: range=540
A: autocenter=13107

P: /devices/pci0000:00/0000:00:14.0/usb1/1-2/1-2:1.0/0003:046D:C24F.0003/input/input23
E: SUBSYSTEM=input
E: NAME="Logitech G29 Driving Force Racing Wheel"
L: device=../../../0003:046D:C24F.0003

P: /devices/pci0000:00/0000:00:14.0/usb1/1-2/1-2:1.0/0003:046D:C24F.0003/input/input23/event5
N: input/event5
E: DEVNAME=/dev/input/event5
A: dev=13:69
E: SUBSYSTEM=input
L: device=../../input23
)";

std::int64_t now_ms() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

struct Effect {
    ff_effect effect{};
    std::int64_t until_ms = 0;

    /// A length of 0 is no end.
    void play() {
        until_ms =
            effect.replay.length == 0 ? std::numeric_limits<std::int64_t>::max() : now_ms() + effect.replay.length;
    }
};

struct OpenFile {
    std::deque<input_event> events;
    std::set<std::int16_t> effects;
};

class MockWheel {
public:
    int answer(OpenFile& file, unsigned long request, UMockdevIoctlData* argument);
    int take(OpenFile& file, const input_event& event);
    void turn(int count);
    std::string state();
    /// umockdev 0.17 declares a signal for a file that was closed, and never sends it: files are asked.
    void close_ended();

    std::mutex mutex;
    std::map<UMockdevIoctlClient*, OpenFile> files;
    bool is_away = false, keeps = false;

private:
    int upload(OpenFile& file, UMockdevIoctlData* argument);

    std::map<std::int16_t, Effect> effects_;
    int count_ = full / 2, gain_ = -1, centring_ = -1, played_ = 0;
};

std::vector<unsigned char> bits(std::size_t size, const std::vector<unsigned>& codes) {
    std::vector<unsigned char> bytes(size);
    for (const unsigned code : codes)
        if (code / 8 < size) bytes[code / 8] = static_cast<unsigned char>(bytes[code / 8] | 1u << code % 8);
    return bytes;
}

int MockWheel::upload(OpenFile& file, UMockdevIoctlData* argument) {
    GError* error = nullptr;
    UMockdevIoctlData* const data = umockdev_ioctl_data_resolve(argument, 0, sizeof(ff_effect), &error);
    if (!data) return -EFAULT;
    ff_effect wanted{};
    std::memcpy(&wanted, data->data, sizeof wanted);
    if (wanted.type != FF_CONSTANT) return -EINVAL;
    if (wanted.id == -1) {
        for (wanted.id = 0; effects_.contains(wanted.id); ++wanted.id) {
        }
        if (wanted.id >= 16) return -ENOSPC;
        file.effects.insert(wanted.id);
        std::memcpy(data->data, &wanted, sizeof wanted);
    } else if (!effects_.contains(wanted.id)) return -EINVAL;
    else if (!file.effects.contains(wanted.id)) return -EACCES;
    Effect& effect = effects_[wanted.id];
    effect.effect = wanted;
    if (now_ms() < effect.until_ms)
        effect.until_ms = now_ms() + wanted.replay.length;  // as ml_ff_upload begins it anew
    return 0;
}

int MockWheel::answer(OpenFile& file, unsigned long request, UMockdevIoctlData* argument) {
    if (is_away) return -ENODEV;
    const std::size_t size = _IOC_SIZE(request);
    const unsigned number = _IOC_NR(request);
    const auto give = [&](const void* from, std::size_t count) {
        GError* error = nullptr;
        UMockdevIoctlData* const data = umockdev_ioctl_data_resolve(argument, 0, size, &error);
        if (!data) return -EFAULT;
        count = std::min(count, size);
        std::memcpy(data->data, from, count);
        return static_cast<int>(count);
    };
    const auto give_bits = [&](const std::vector<unsigned>& codes) {
        const std::vector<unsigned char> bytes = bits(size, codes);
        return give(bytes.data(), bytes.size());
    };
    if (_IOC_TYPE(request) != 'E') return -ENOTTY;
    if (request == EVIOCSFF) return upload(file, argument);
    if (request == EVIOCRMFF) {
        std::uint64_t id = 0;
        std::memcpy(&id, argument->data, sizeof id);
        const auto own = file.effects.find(static_cast<std::int16_t>(id));
        if (own == file.effects.end()) return -EINVAL;
        effects_.erase(*own);
        file.effects.erase(own);
        return 0;
    }
    if (request == EVIOCGID) {
        const input_id id{BUS_USB, 0x046D, 0xC24F, 0x111};
        give(&id, sizeof id);
        return 0;
    }
    if (number == _IOC_NR(EVIOCGNAME(0))) return give(name, std::strlen(name) + 1);
    if (number == _IOC_NR(EVIOCGUNIQ(0))) return -ENOENT;
    if (number == _IOC_NR(EVIOCGKEY(0))) return give_bits({});
    if (number == 0x20 + EV_ABS) return give_bits({ABS_X, ABS_Y, ABS_Z, ABS_RZ, ABS_HAT0X, ABS_HAT0Y});
    if (number == 0x20 + EV_FF) return give_bits({FF_CONSTANT, FF_GAIN, FF_AUTOCENTER});
    if (number == 0x20 + EV_KEY) return give_bits({BTN_TRIGGER, BTN_THUMB, BTN_THUMB2, BTN_TOP, BTN_TOP2, BTN_PINKIE});
    if (number == 0x20) return give_bits({EV_SYN, EV_KEY, EV_ABS, EV_MSC, EV_FF});
    if (number >= 0x40 && number < 0x80) {
        const input_absinfo info{number == 0x40 + ABS_X ? count_ : 0, 0, full, 0, 0, 0};
        give(&info, sizeof info);
        return 0;
    }
    return -EINVAL;
}

int MockWheel::take(OpenFile& file, const input_event& event) {
    if (is_away) return -ENODEV;
    if (event.type != EV_FF) return 0;
    if (event.code == FF_GAIN) gain_ = event.value;
    else if (event.code == FF_AUTOCENTER) centring_ = event.value;
    else if (const auto effect = effects_.find(static_cast<std::int16_t>(event.code));
             effect != effects_.end() && file.effects.contains(effect->first)) {
        if (event.value == 0) effect->second.until_ms = 0;
        else effect->second.play();
        played_ += event.value != 0;
    }
    return 0;
}

void MockWheel::turn(int count) {
    count_ = count;
    input_event moved{}, report{};
    moved.type = EV_ABS;
    moved.code = ABS_X;
    moved.value = count;
    report.type = EV_SYN;
    report.code = SYN_REPORT;
    for (auto& [client, file] : files) file.events.insert(file.events.end(), {moved, report});
}

std::string MockWheel::state() {
    int playing = 0;
    for (const auto& [id, one] : effects_)
        if (!is_away && now_ms() < one.until_ms) playing += one.effect.u.constant.level;
    std::ostringstream text;
    text << "playing=" << playing << " effects=" << effects_.size() << " gain=" << gain_ << " centring=" << centring_
         << " files=" << files.size() << " played=" << played_;
    return text.str();
}

void MockWheel::close_ended() {
    for (auto file = files.begin(); file != files.end();) {
        if (umockdev_ioctl_client_get_connected(file->first)) {
            ++file;
            continue;
        }
        if (!keeps)
            for (const std::int16_t id : file->second.effects) effects_.erase(id);
        g_object_unref(file->first);
        file = files.erase(file);
    }
}

void end(UMockdevIoctlClient* client, long result) {
    umockdev_ioctl_client_complete(client, result < 0 ? -1 : result, result < 0 ? static_cast<int>(-result) : 0);
}

gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer wheel) {
    MockWheel& self = *static_cast<MockWheel*>(wheel);
    const std::lock_guard lock(self.mutex);
    UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
    end(client, self.answer(self.files[client], umockdev_ioctl_client_get_request(client), argument));
    return TRUE;
}

gboolean on_read(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer wheel) {
    MockWheel& self = *static_cast<MockWheel*>(wheel);
    const std::lock_guard lock(self.mutex);
    UMockdevIoctlData* const into = umockdev_ioctl_client_get_arg(client);
    std::deque<input_event>& events = self.files[client].events;
    long bytes = 0;
    for (; !events.empty() && bytes + static_cast<long>(sizeof(input_event)) <= into->data_len; events.pop_front()) {
        std::memcpy(into->data + bytes, &events.front(), sizeof(input_event));
        bytes += static_cast<long>(sizeof(input_event));
    }
    end(client, self.is_away ? -ENODEV : bytes == 0 ? -EAGAIN : bytes);
    return TRUE;
}

gboolean on_write(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer wheel) {
    MockWheel& self = *static_cast<MockWheel*>(wheel);
    const std::lock_guard lock(self.mutex);
    UMockdevIoctlData* const from = umockdev_ioctl_client_get_arg(client);
    long failure = 0;
    for (int at = 0; at + static_cast<int>(sizeof(input_event)) <= from->data_len && failure == 0;
         at += static_cast<int>(sizeof(input_event))) {
        input_event event{};
        std::memcpy(&event, from->data + at, sizeof event);
        failure = self.take(self.files[client], event);
    }
    end(client, failure < 0 ? failure : from->data_len);
    return TRUE;
}

void on_open(UMockdevIoctlBase*, UMockdevIoctlClient* client, gpointer wheel) {
    MockWheel& self = *static_cast<MockWheel*>(wheel);
    const std::lock_guard lock(self.mutex);
    self.files[client];
    g_object_ref(client);  // until close_ended() has seen its end
}

}  // namespace

int main() {
    MockWheel wheel;
    UMockdevTestbed* const bed = umockdev_testbed_new();
    UMockdevIoctlBase* const calls = umockdev_ioctl_base_new();
    g_signal_connect(calls, "handle-ioctl", G_CALLBACK(on_ioctl), &wheel);
    g_signal_connect(calls, "handle-read", G_CALLBACK(on_read), &wheel);
    g_signal_connect(calls, "handle-write", G_CALLBACK(on_write), &wheel);
    g_signal_connect(calls, "client-connected", G_CALLBACK(on_open), &wheel);
    GError* error = nullptr;
    if (!umockdev_testbed_add_from_string(bed, description, &error) ||
        !umockdev_testbed_attach_ioctl(bed, node, calls, &error)) {
        std::cerr << "mock_wheel: " << error->message << '\n';
        return 1;
    }
    char* const root = umockdev_testbed_get_root_dir(bed);
    const std::string plugged = root + std::string(node), unplugged = root + std::string("/dev/input/gone");
    std::cout << root << std::endl;
    g_free(root);
    for (std::string line; std::getline(std::cin, line);) {
        std::istringstream words(line);
        std::string verb;
        int count = 0;
        words >> verb >> count;
        const std::lock_guard lock(wheel.mutex);
        // umockdev 0.17 cannot add what it removed once.
        if (verb == "unplug" || verb == "plug") {
            wheel.is_away = verb == "unplug";
            if (wheel.is_away) std::rename(plugged.c_str(), unplugged.c_str());
            else std::rename(unplugged.c_str(), plugged.c_str());
        }
        if (verb == "turn") wheel.turn(count);
        if (verb == "keep") wheel.keeps = true;
        wheel.close_ended();
        std::cout << wheel.state() << std::endl;
    }
    g_object_unref(calls);
    g_object_unref(bed);  // removes its folder
    return 0;
}
