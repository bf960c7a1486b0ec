// SPDX-License-Identifier: Apache-2.0
#include "dsp/vessel/track.hpp"

#include <vector>

namespace tactus::vessel {

std::string_view reason_of(End end) {
    switch (end) {
        case End::contrast: return "the contrast is lost";
        case End::noise: return "the vessel is not told from noise";
        case End::border: return "the scan ends";
        case End::excluded: return "it meets bone or a stent";
        case End::larger_vessel: return "it joins a larger vessel";
        case End::meets_track: return "it meets a vessel that is tracked";
        case End::forks: return "it forks";
        case End::length: return "the limit of length is reached";
    }
    return "";
}

std::vector<LostStretch> Branch::lost() const {
    std::vector<LostStretch> found;
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        if (!nodes[n].is_lost) continue;
        if (n > 0 && nodes[n - 1].is_lost) found.back().to = nodes[n].along;
        else found.push_back({nodes[n].along, nodes[n].along});
    }
    std::erase_if(found, [](const LostStretch& stretch) { return stretch.to <= stretch.from; });
    return found;
}

double Track::length() const {
    double sum = 0.0;
    for (const Branch& branch : branches) sum += branch.length();
    return sum;
}

}  // namespace tactus::vessel
