// SPDX-License-Identifier: Apache-2.0
#include "assets/bone/content_hash.hpp"
#include "dsp/carve/carver.hpp"
#include "dsp/carve/kerf_voxels.hpp"
#include "dsp/saw/saw_shape.hpp"
#include "dsp/volume/components.hpp"
#include "dsp/volume/surface_density.hpp"
#include "graph/node/assets.hpp"
#include "graph/node/node.hpp"
#include "graph/node/visual.hpp"
#include "nodes/contact/site_parameters.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace tactus::nodes {

struct Carve {
    static constexpr auto about =
        "Removes bone: what the front of a saw has passed (saw_blade, burr), or what the teeth of a blade reach along "
        "its path at a speed inversely proportional to density (thesis 6.2.2).";

    Batch<Pose> path{optional,
                     "all poses of the blade: x along the stroke, y into the bone; speed and force law below; "
                     "unconnected, and without 'front', nothing is carved"};
    Batch<carve::CutFront> front{
        optional, "all fronts that a saw has cut; then 'path' is not read, and only 'length' and 'kerf' below matter"};
    Batch<double> load{optional, "thrust at each pose; unconnected: the reference force", "N"};
    In<bool> running{optional, "the saw runs; unconnected: always"};
    In<double> strokes{optional, "reciprocation rate; unconnected: the reference rate", "Hz"};
    Out<volume::BoneSnapshot> bone{"the carved bone"};
    Out<double> removed{"volume removed since the start", "m^3"};
    Asset<bone::Bone> source{"the bone to carve"};
    Param speed{"0.67 mm/s", "0 mm/s", "100 mm/s", "of advance at the reference density, force and rate"};
    Param reference_force{"7 N", "0.1 N", "100 N", "thrust that 'speed' refers to"};
    Param reference_rate{"228 Hz", "1 Hz", "1000 Hz", "reciprocation rate that 'speed' refers to"};
    Param reference_density{"1800 mg/cm^3", "1 mg/cm^3", "5000 mg/cm^3",
                            "density that 'speed' refers to: cortical bone"};
    Param force_exponent{"0", "0", "2", "speed is proportional to thrust to this power; 0: the law of the thesis"};
    Param length{structural, "40 mm", "5 mm", "200 mm", "of the tooth edge"};
    Param kerf{structural, "1 mm", "0.1 mm", "8 mm", "width of the cut; of a front, the widest"};
    Param stroke{structural, "3 mm", "1 mm", "20 mm", "of the blade, peak to peak"};
    Flag find_site{true, find_site_about};
    Vector site{"0 mm, 0 mm, 0 mm", site_about};
    Vector approach{"0, 0, 0", approach_about};
    Vector along{"0, 0, 0", along_about};
    Param bricks_per_tick{structural, "512", "16", "4096",
                          "maximum number of bricks of 8 x 8 x 8 voxels that one tick may change"};

    std::vector<Visual> visuals() const { return {{.kind = VisualKind::bone, .value = "bone"}}; }

    void prepare(const Setup& setup) {
        bone_ = source.shared();
        name_ = setup.name;
        refine(setup);
        volume::BoneEditorOptions options;
        options.max_dirty = static_cast<int>(bricks_per_tick);
        options.band =
            4.0 * std::max({bone_->distance.spacing.x, bone_->distance.spacing.y, bone_->distance.spacing.z}) + kerf;
        volume::Grid density = bone_->density;
        if (!refined_) volume::extend_density(bone_->distance, density);
        editor_ = std::make_unique<volume::BoneEditor>(bone_->distance, density, options);
        carver_.prepare(*editor_, settings());
        samples_.reserve(4096);
        bone = editor_->current();
        last_ = editor_->current().version;
    }

    void process(const Tick&) noexcept {
        if (!front.connected) {
            gather();
            carver_.set_law(settings());
        }
        // A version that was dropped has no reader, unless an earlier publication of the same version was taken.
        if (bone.last_was_dropped && last_was_new_) editor_->forget(last_);
        editor_->reclaim(bone.oldest_readable);
        const carve::CarveResult now =
            front.connected ? carver_.update(*editor_, front.values()) : carver_.update(*editor_, samples_);
        total_ += now.removed_m3;
        for (std::size_t i = 0; i < by_density_.size(); ++i) by_density_[i] += now.removed_by_density[i];
        if (now.budget_hit) ++budget_hits_;
        const volume::BoneSnapshot next = editor_->publish();
        last_was_new_ = next.version != last_;
        last_ = next.version;
        bone = next;
        removed = total_;
    }

    void report(Report& report) const {
        std::vector<double> classes;
        for (const double volume : by_density_) classes.push_back(volume * 1e9);
        report.set("carve_sources", name_, bone::content_hash(*source.shared()));
        report.set("carve", "removed_mm3", total_ * 1e9);
        report.set("carve", "by_density", classes);
        report.set("carve", "kerf_voxels", carver_.kerf_voxels());
        report.set("carve", "ticks_over_budget", budget_hits_);
        auto carved = std::make_shared<bone::Bone>(*bone_);
        carved->distance = volume::to_grid(editor_->current());
        report.set("carve", "severed", parts_of(carved->distance) > parts_of(bone_->distance) ? 1.0 : 0.0);
        report.set("carve", "refined", refined_ ? 1.0 : 0.0);
        report.results["bone"] = std::shared_ptr<const bone::Bone>(std::move(carved));
    }

private:
    /// A kerf needs three voxels. A coarse bone is resampled around the site where workspace puts the saw.
    void refine(const Setup& setup) {
        const Vec3& spacing = bone_->distance.spacing;
        const double voxels = kerf / std::max({spacing.x, spacing.y, spacing.z});
        refined_ = voxels < 3.0;
        if (!refined_) return;
        const std::optional<volume::SawSite> where = site_of(*bone_, find_site, site, approach, along, setup);
        if (!where)
            setup.fail(
                fmt::format("the kerf of {:.3g} mm is only {:.2g} voxels wide and no site was found to refine "
                            "the bone at; give --site X,Y,Z, or import the bone with --spacing {:.2g} or finer",
                            kerf * 1e3, voxels, carve::coarsest_voxel(kerf) * 1e3));
        auto made = std::make_shared<bone::Bone>();
        made->name = bone_->name;
        made->colour = bone_->colour;
        made->provenance = bone_->provenance;
        volume::SiteVolume fine;
        try {
            fine = volume::refine_at(*where, bone_->distance, bone_->density, kerf / carve::voxels_per_kerf);
        } catch (const Error& error) {
            setup.fail(error.message());
        }
        made->distance = std::move(fine.distance);
        made->density = std::move(fine.density);
        bone_ = std::move(made);
    }

    /// Parts of more than 20 mm³: chips do not count.
    static double parts_of(volume::Grid distance) {
        for (float& value : distance.values) value = -value;
        const Vec3& h = distance.spacing;
        const double voxel = h.x * h.y * h.z;
        const volume::Components found = volume::components_above(distance, 0.0f);
        return static_cast<double>(
            std::ranges::count_if(found.voxels, [&](std::size_t n) { return static_cast<double>(n) * voxel > 20e-9; }));
    }

    carve::CarveSettings settings() const {
        carve::CarveSettings s;
        s.kerf = kerf;
        s.stroke = stroke;
        if (front.connected) s.tooth_pitch = saw::tooth_pitch;
        // A front brings its nodes; as many places as it can have.
        s.blade_length = front.connected ? (carve::CutFront::max_nodes - 1) * s.tooth_pitch - s.stroke : length.value;
        s.speed = speed;
        s.reference_force = reference_force;
        s.reference_rate = reference_rate;
        s.reference_density = reference_density;
        s.force_exponent = force_exponent;
        return s;
    }

    /// Copies the path for the carver. When a tick has more than 4096 poses, the oldest are dropped.
    void gather() noexcept {
        samples_.clear();
        const auto poses = path.connected ? path.values() : std::span<const Pose>{};
        const auto loads = load.connected ? load.values() : std::span<const double>{};
        const std::size_t first = poses.size() > samples_.capacity() ? poses.size() - samples_.capacity() : 0;
        for (std::size_t i = first; i < poses.size(); ++i) {
            if (i < loads.size()) thrust_ = loads[i];
            samples_.push_back({poses[i], seconds(path.period),
                                load.connected ? thrust_ : static_cast<double>(reference_force),
                                strokes.connected ? *strokes.operator->() : static_cast<double>(reference_rate),
                                running.connected ? running.get() : true});
        }
    }

    std::shared_ptr<const bone::Bone> bone_;
    std::string name_;
    std::unique_ptr<volume::BoneEditor> editor_;
    carve::Carver carver_;
    std::vector<carve::CarveSample> samples_;
    std::array<double, 4> by_density_{};
    double total_ = 0.0, thrust_ = 0.0, budget_hits_ = 0.0;
    std::int64_t last_ = 0;
    bool last_was_new_ = false, refined_ = false;
};

TACTUS_NODE(Carve, path, front, load, running, strokes, bone, removed, source, speed, reference_force, reference_rate,
            reference_density, force_exponent, length, kerf, stroke, find_site, site, approach, along, bricks_per_tick)
TACTUS_VISUALS(Carve)

}  // namespace tactus::nodes
