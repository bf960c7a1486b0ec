// SPDX-License-Identifier: Apache-2.0
// paint_from_text: any text paints points within its strokes or is refused with one message.
#include "assets/plan/paint_file.hpp"
#include "dsp/core/error.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::vector<tactus::contact::SurfacePoint> points;
    for (int n = 0; n < 400; ++n)
        points.push_back({1e-3 * tactus::Vec3(n % 20, n / 20, (n * 7) % 5), {0.0, 0.0, 1.0}, 1e-6, 0});
    try {
        tactus::plan::paint_from_text(points, {reinterpret_cast<const char*>(data), size}, "paint.json", size % 2 == 0);
        tactus::plan::painted_faces(points);
    } catch (const tactus::Error& error) {
        if (error.message().empty() || error.message().find('\n') != std::string::npos) std::abort();
    }
    return 0;
}
