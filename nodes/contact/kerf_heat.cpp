// SPDX-License-Identifier: Apache-2.0
#include "dsp/saw/kerf_heat.hpp"

#include "dsp/saw/heat_partition.hpp"

#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace tactus::nodes {

struct KerfHeat {
    static constexpr auto about =
        "Temperature of the bone along the cut: the teeth's work becomes heat at a line that moves with them (Jaeger "
        "1942). Bone above 47 °C, 10 K above the body, for a minute is damaged (Eriksson and Albrektsson 1983).";

    In<Pose> pose{"of the blade: x along the teeth, y into the bone, origin in the middle of the tooth line", "m"};
    Batch<double> load{"thrust against the cutting direction", "N"};
    Batch<double> cutting{optional, "force of the teeth along the stroke; unconnected: the thrust over 'thrust_ratio'",
                          "N"};
    Batch<double> teeth{optional, "teeth that bear; with 'cutting', in place of 'contact'", "1"};
    Batch<double> feed{
        optional,
        "advance of the teeth: the more a tooth takes, the more heat leaves with the chip (Weiner 1955); "
        "unconnected: 'share'",
        "m/s"};
    In<bool> running{optional, "the saw runs; unconnected: always"};
    In<double> strokes{optional, "cycles of the stroke per second; unconnected: 'stroke_rate'", "Hz"};
    In<bool> irrigated{optional, "water flows into the kerf; unconnected: 'irrigation'"};
    Out<double> rise{"of the hottest place beside the kerf now, above the body", "K"};
    Out<double> peak{"of the hottest place since the start, above the body", "K"};
    Out<double> hot_time{"longest time that one place was hotter than 'limit'", "s"};
    Out<double> hot_reach{"greatest distance from the middle of the cut at which bone was hotter than 'limit'", "m"};
    Param stroke_rate{"228 Hz", "1 Hz", "1000 Hz", "cycles of the stroke per second, unless 'strokes' is connected"};
    Param stroke{"3 mm", "0.5 mm", "20 mm", "of the teeth, peak to peak"};
    Param thrust_ratio{"1.6", "0.2", "10", "thrust over cutting force; 1.4 to 1.8 were measured on bone"};
    Param contact{"15 mm", "1 mm", "80 mm", "length of the tooth line that cuts, if 'teeth' is not wired"};
    Flag irrigation{false, "water flows into the kerf, unless 'irrigated' is connected"};
    Param limit{"10 K", "1 K", "60 K", "rise above the body that counts as hot"};
    Param share{structural, "0.5", "0", "1",
                "of the heat that enters the bone, unless 'feed' is connected; an assumption"};
    Param coolant{structural, "-17 K", "-37 K", "0 K", "the water's temperature above the body's"};
    Param transfer{structural, "10 kW/m^2/K", "0 W/m^2/K", "100 kW/m^2/K",
                   "heat transfer of the water that fills the slot between blade and wall"};
    Param kerf{structural, "1 mm", "0 mm", "8 mm", "width of the cut: the bone in it leaves with its heat"};

    std::vector<Visual> visuals() const {
        return {{.kind = VisualKind::mark, .value = "rise", .pose = "pose", .radius = 6e-3, .length = limit}};
    }

    void prepare(const Setup&) {
        saw::KerfMaterial material;
        material.coolant = coolant;
        material.transfer = transfer;
        material.kerf = kerf;
        diffusivity_ = material.diffusivity();
        heat_.emplace(material);
        cut_.reset();
    }

    void process(const Tick& tick) noexcept {
        const Pose now = pose.get();
        const double thrust = mean(load);
        const bool runs = !running.connected || running.get();
        const bool cuts = runs && thrust > 0.0 && is_valid(now);
        if (cuts && !is_in_cut(now)) {
            heat_->begin_cut();
            cut_ = Cut{now.position, axis(now, {0.0, 1.0, 0.0}), axis(now, {0.0, 0.0, 1.0})};
        }
        heat_->limit = limit;
        const double rate = strokes.connected ? std::max(strokes.get(), 0.0) : static_cast<double>(stroke_rate);
        // W per metre of tooth line. Of the teeth that pass a place one bears, per length of the stroke.
        double heat = 0.0;
        if (cuts && cutting.connected && teeth.connected) {
            if (const double bearing = mean(teeth); bearing > 0.0) heat = 2.0 * rate * mean(cutting) / bearing;
        } else if (cuts) {
            heat = 2.0 * rate * stroke * thrust / thrust_ratio / contact;
        }
        heat *= share_of(mean(feed));
        if (cut_ && is_valid(now)) depth_ = glm::dot(now.position - cut_->origin, cut_->into);
        heat_->advance(tick.elapsed_seconds(), cut_ ? depth_ : 0.0, heat,
                       irrigated.connected ? irrigated.get() : static_cast<bool>(irrigation));
        rise = heat_->hottest();
        peak = heat_->peak();
        hot_time = heat_->longest_above();
        hot_reach = heat_->reach();
    }

    void report(Report& report) const {
        report.set("heat", "peak_above_body_K", heat_->peak());
        report.set("heat", "longest_above_limit_s", heat_->longest_above());
        report.set("heat", "hot_reach_mm", heat_->reach() * 1e3);
    }

private:
    struct Cut {
        Vec3 origin, into, across;
    };

    /// Of the heat, into the bone. A cycle of the stroke has two cuts, so speed times depth of cut is stroke times feed.
    double share_of(double advance) const noexcept {
        if (!feed.connected) return share;
        return saw::share_into_bone(stroke, advance, saw::tangent_of_shear(saw::CuttingLaw{}), diffusivity_);
    }

    static double mean(const Batch<double>& batch) noexcept {
        double sum = 0.0, count = 0.0;
        for (const double value : batch.values()) {
            if (!std::isfinite(value)) continue;
            sum += std::max(value, 0.0);
            ++count;
        }
        return count > 0.0 ? sum / count : 0.0;
    }

    static Vec3 axis(const Pose& at, const Vec3& of) noexcept { return glm::normalize(at.orientation) * of; }

    /// Bone further away than heat reaches while one cuts is at rest.
    bool is_in_cut(const Pose& now) const noexcept {
        if (!cut_) return false;
        const Vec3 offset = now.position - cut_->origin;
        const double depth = glm::dot(offset, cut_->into), aside = glm::dot(offset, cut_->across);
        return std::abs(aside) < 3e-3 && depth > -saw::KerfHeat::ahead &&
               glm::length(offset - depth * cut_->into) < 40e-3 &&
               glm::dot(axis(now, {0.0, 1.0, 0.0}), cut_->into) > 0.9;
    }

    std::optional<saw::KerfHeat> heat_;
    std::optional<Cut> cut_;
    double depth_ = 0.0, diffusivity_ = 1.0;
};

TACTUS_NODE(KerfHeat, pose, load, cutting, teeth, feed, running, strokes, irrigated, rise, peak, hot_time, hot_reach,
            stroke_rate, stroke, thrust_ratio, contact, irrigation, limit, share, coolant, transfer, kerf)
TACTUS_VISUALS(KerfHeat)

}  // namespace tactus::nodes
