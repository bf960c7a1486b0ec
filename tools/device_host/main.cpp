// SPDX-License-Identifier: Apache-2.0
// `tactus-device-host`: runs the driver of one device in a process of its own. The engine starts it.
#include "devices/hosted/device_host.hpp"

int main() { return tactus::hosted::run_device_host(); }
