// SPDX-License-Identifier: Apache-2.0
// seeds_of_text: any text gives labels that are safe to paint, or is refused with one message.
#include "assets/segmentation/seeds_file.hpp"
#include "dsp/core/error.hpp"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    namespace segment = tactus::segmentation;
    const tactus::volume::Grid layout{{6, 5, 4}, tactus::Vec3(0.0), tactus::Vec3(1e-3), {}};
    std::vector<std::int32_t> node(layout.count());
    for (std::size_t v = 0; v < node.size(); ++v) node[v] = static_cast<std::int32_t>(v);
    std::vector<std::uint8_t> seed(layout.count(), 0);
    try {
        const auto labels = segmentation::seeds_of_text({reinterpret_cast<const char*>(data), size}, "seeds.json");
        if (labels.size() < 2 || labels.size() > segmentation::max_labels) std::abort();
        for (const auto& label : labels)
            for (const auto& stroke : label.strokes) segmentation::paint(layout, node, stroke, 1, seed);
    } catch (const tactus::Error& error) {
        if (error.message().empty() || error.message().find('\n') != std::string::npos) std::abort();
    }
    return 0;
}
