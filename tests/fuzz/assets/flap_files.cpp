// SPDX-License-Identifier: Apache-2.0
// What a flap is read from, tables of vessels, marks, transforms and inputs: any text is read or refused with one message,
// and what is read is finite.
#include "assets/reconstruction/flap_files.hpp"
#include "assets/file/json.hpp"
#include "assets/reconstruction/reconstruction.hpp"
#include "assets/transform/transform_file.hpp"
#include "dsp/core/error.hpp"

#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace {

using namespace tactus;

template <class Read>
void read_or_refuse_text(const Read& read) {
    try {
        read();
    } catch (const Error& error) {
        if (error.message().empty() || error.message().find('\n') != std::string::npos) std::abort();
    }
}

void check(const reconstruction::FlapVessel& vessel) {
    if (!(vessel.radius > 0.0) || vessel.points.size() < 2) std::abort();
    for (const Vec3& p : vessel.points)
        if (!is_finite(p)) std::abort();
}

void check(const std::vector<reconstruction::MarkedPoint>& marks) {
    for (const reconstruction::MarkedPoint& mark : marks)
        if (!is_finite(mark.at) || mark.name.empty() || mark.name.find('\n') != std::string::npos) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    for (const int branch : {0, 1})
        read_or_refuse_text([&] { check(reconstruction::vessel_of_table(text, "vessel.csv", branch)); });
    read_or_refuse_text(
        [&] { check(reconstruction::marks_of(markup::points_of_text(text, "marks.mrk.json"), "marks.mrk.json")); });
    read_or_refuse_text(
        [&] { check(reconstruction::marks_of(markup::points_of_fcsv(text, "marks.fcsv"), "marks.fcsv")); });
    read_or_refuse_text([&] {
        const Pose motion = transform::motion_of_text(text, "motion.tfm");
        if (!is_finite(motion.position) || !(std::abs(glm::length(motion.orientation) - 1.0) < 1e-9)) std::abort();
    });
    read_or_refuse_text([&] {
        const reconstruction::Flap flap = reconstruction::flap_of_inputs(file::Json::parse(text), "inputs.json");
        for (const reconstruction::FlapVessel& vessel : flap.vessels) check(vessel);
        for (const reconstruction::RecipientSite& site : flap.sites)
            if (!is_finite(site.at)) std::abort();
    });
    return 0;
}
