// SPDX-License-Identifier: Apache-2.0
#include "devices/audio/jack_watch.hpp"

#include <fmt/format.h>
#include <jack/jack.h>
#include <pa_jack.h>

namespace tactus::audio {

JackWatch::JackWatch() noexcept {
    jack_client_t* const client = jack_client_open("tactus-watch", JackNoStartServer, nullptr);
    if (client == nullptr) return;
    client_ = client;
    jack_set_freewheel_callback(
        client, [](int starting, void* self) { static_cast<JackWatch*>(self)->freewheels_ = starting != 0; }, this);
    jack_on_shutdown(client, [](void* self) { static_cast<JackWatch*>(self)->gone_ = true; }, this);
    jack_activate(client);
}

JackWatch::~JackWatch() {
    if (client_ != nullptr) jack_client_close(static_cast<jack_client_t*>(client_));
}

void JackWatch::name_ports(const char* kind, const std::vector<std::string>& names) const {
    auto* const client = static_cast<jack_client_t*>(client_);
    const char* stream = nullptr;
    if (client == nullptr || PaJack_GetClientName(&stream) != paNoError) return;
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (names[i].empty()) continue;
        const std::string now = fmt::format("{}:{}_{}", stream, kind, i);
        if (jack_port_t* const port = jack_port_by_name(client, now.c_str()))
            jack_port_rename(client, port, names[i].c_str());
    }
}

}  // namespace tactus::audio
