// SPDX-License-Identifier: Apache-2.0
#include "devices/audio/jack_watch.hpp"

#include <jack/jack.h>

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

}  // namespace tactus::audio
