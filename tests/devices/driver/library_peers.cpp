// SPDX-License-Identifier: Apache-2.0
#include "tests/devices/driver/library_peers.hpp"

#include "devices/forcedimension/dhd_device.hpp"
#include "devices/openhaptics/hd_device.hpp"

#include <glm/gtc/quaternion.hpp>

#include <dlfcn.h>

#include <stdexcept>

namespace tactus::test {

namespace {

/// A maker's axes as the maker's manual says them, and its unit of length.
struct Native {
    Vec3 right, away, up;
    double per_metre;

    Vec3 to(const Vec3& v) const { return right * v.x + away * v.y + up * v.z; }
    Vec3 from(const Vec3& v) const { return {glm::dot(v, right), glm::dot(v, away), glm::dot(v, up)}; }
};

class LibraryPeer : public Peer {
public:
    LibraryPeer(const std::string& path, const Native& native) : path_(path), native_(native) {
        handle_ = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
        if (!handle_) throw std::runtime_error(::dlerror());
        call<void()>("fake_reset")();
    }
    ~LibraryPeer() override {
        hang(false);
        ::dlclose(handle_);
    }

    void place(const Vec3& position, const Quat& orientation) override {
        const Vec3 at = native_.to(position) * native_.per_metre;
        const Mat3 axes(native_.right, native_.away, native_.up);
        const Mat3 turn = axes * glm::mat3_cast(orientation) * glm::transpose(axes);
        double rows[9];
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 3; ++column) rows[3 * row + column] = turn[column][row];
        call<void(const double*, const double*)>("fake_place")(&at.x, rows);
    }
    void press(std::uint32_t mask) override { call<void(unsigned)>("fake_buttons")(mask); }
    Wrench given() override {
        double six[6] = {};
        call<void(double*)>("fake_given")(six);
        return {native_.from({six[0], six[1], six[2]}), native_.from({six[3], six[4], six[5]}) * torque_unit};
    }
    void hang(bool on) override { call<void(int)>("fake_hang")(on); }
    void unplug(bool on) override { call<void(int)>("fake_lose")(on); }
    void send_nan(bool on) override { call<void(int)>("fake_nan")(on); }

    template <class F>
    F* call(const char* name) const {
        void* const found = ::dlsym(handle_, name);
        if (!found) throw std::runtime_error(name);
        return reinterpret_cast<F*>(found);
    }

    double torque_unit = 1.0;

protected:
    std::string path_;

private:
    Native native_;
    void* handle_;
};

class DhdPeer final : public LibraryPeer {
public:
    DhdPeer() : LibraryPeer(TACTUS_FAKE_DHD, {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}, 1.0}) { twists = true; }
    std::unique_ptr<driver::Backend> backend() override {
        Options options = options_of({{"library", path_, {}}});
        return forcedimension::make_force_dimension(options);
    }
};

class HdPeer final : public LibraryPeer {
public:
    HdPeer() : LibraryPeer(TACTUS_FAKE_HD, {{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, 1e3}) {}
    std::unique_ptr<driver::Backend> backend() override {
        Options options = options_of({{"library", path_, {}}});
        return openhaptics::make_touch(options);
    }
};

}  // namespace

std::unique_ptr<Peer> make_dhd_peer() { return std::make_unique<DhdPeer>(); }
std::unique_ptr<Peer> make_hd_peer() { return std::make_unique<HdPeer>(); }

void* function_of(Peer& peer, const char* name) {
    return reinterpret_cast<void*>(dynamic_cast<LibraryPeer&>(peer).call<void()>(name));
}

}  // namespace tactus::test
