// SPDX-License-Identifier: Apache-2.0
#include "tools/analysis/plan/flap_export.hpp"

#include "assets/file/whole_file.hpp"
#include "assets/markup/markup.hpp"
#include "tools/analysis/plan/vessel_export.hpp"

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <algorithm>

namespace tactus::analysis {

namespace {

namespace fs = std::filesystem;

using markup::Kind;
using markup::Markup;

Markup markup_of(Kind kind, const std::string& name, std::vector<markup::ControlPoint> points) {
    Markup made;
    made.kind = kind;
    made.name = name;
    made.points = std::move(points);
    made.is_locked = true;
    return made;
}

Markup plane_markup(const std::string& name, const reconstruction::Plane& plane) {
    Markup made = markup_of(Kind::plane, name, {{name, plane.origin, ""}});
    made.normal = glm::normalize(plane.normal);
    return made;
}

class Writer {
public:
    Writer(const fs::path& out, std::string mesh_type) : out_(out), mesh_type_(std::move(mesh_type)) {}

    void write(const std::string& name, const Markup& made) {
        std::string file = file_name_of(name) + ".mrk.json";
        // Names that differ only in replaced characters, or are those of other things.
        for (int n = 2; std::ranges::find(files_, file) != files_.end(); ++n)
            file = fmt::format("{}-{}.mrk.json", file_name_of(name), n);
        file::write_whole_file(out_ / file, markup::text_of({&made, 1}));
        files_.push_back(file);
    }
    void write_vessel(const std::string& name, const std::vector<Vec3>& line, double radius) {
        export_vessel(name, line, radius, {mesh_type_, ".vtp"}, out_, files_);
    }
    std::vector<std::string> files() { return std::move(files_); }

private:
    fs::path out_;
    std::string mesh_type_;
    std::vector<std::string> files_;
};

std::vector<markup::ControlPoint> named(const std::string& name, const std::vector<Vec3>& line) {
    std::vector<markup::ControlPoint> points;
    for (const Vec3& p : line) points.push_back({fmt::format("{}-{}", name, points.size() + 1), p, ""});
    return points;
}

}  // namespace

std::string file_name_of(const std::string& name) {
    std::string file = name;
    for (char& c : file)
        if (c == '/' || c == '\\' || c == ':') c = '_';
    if (file.starts_with('.')) file[0] = '_';
    return file;
}

std::vector<std::string> export_flap(const reconstruction::FibulaInputs& inputs, const reconstruction::FibulaPlan& plan,
                                     const reconstruction::Flap& flap, const reconstruction::FlapMeasures& measures,
                                     const fs::path& out, const std::string& mesh_type) {
    Writer writer(out, mesh_type);
    for (std::size_t n = 0; n < inputs.planes.size(); ++n) {
        const std::size_t segment = std::min(n, plan.segments.size() - 1), end = n > segment ? 1 : 0;
        const reconstruction::FibulaSegment& s = plan.segments[segment];
        const std::string name = fmt::format("jaw-plane-{}", n + 1);
        writer.write(
            name, plane_markup(name, {inputs.planes[n].origin, s.donor_to_target.rotate(s.donor_plane[end].normal)}));
    }
    for (std::size_t n = 0; n < plan.segments.size(); ++n)
        for (const std::size_t end : {std::size_t{0}, std::size_t{1}}) {
            const std::string name = fmt::format("fibula-cut-{}-{}", n + 1, end + 1);
            writer.write(name, plane_markup(name, plan.segments[n].donor_plane[end]));
        }
    for (const reconstruction::PlacedVessel& vessel : measures.vessels)
        for (std::size_t n = 0; n < vessel.lines.size(); ++n) {
            const std::string name = fmt::format("vessel-{}-{}", vessel.name, n == 0 ? "on-bone" : "pedicle");
            writer.write(name, markup_of(Kind::curve, name, named(vessel.name, vessel.lines[n])));
            writer.write_vessel(name, vessel.lines[n], vessel.radius);
        }
    for (const reconstruction::FlapVessel& vessel : flap.vessels) {
        const std::string name = fmt::format("vessel-{}-in-leg", vessel.name);
        writer.write(name, markup_of(Kind::curve, name, named(vessel.name, vessel.points)));
        writer.write_vessel(name, vessel.points, vessel.radius);
    }
    for (const reconstruction::Plate& plate : flap.plates) {
        writer.write("plate-" + plate.name, markup_of(Kind::curve, plate.name, named(plate.name, plate.points)));
        for (std::size_t n = 0; n < plate.screws.size(); ++n) {
            const reconstruction::Screw& s = plate.screws[n];
            const std::string name = fmt::format("plate-{}-screw-{}", plate.name, n + 1);
            writer.write(name, markup_of(Kind::line, name, named(name, {s.head, s.head + s.length * s.axis})));
        }
    }
    for (const reconstruction::DentalImplant& implant : flap.implants)
        writer.write("implant-" + implant.name,
                     markup_of(Kind::line, implant.name,
                               named(implant.name, {implant.head, implant.head + implant.length * implant.axis})));
    std::vector<markup::ControlPoint> sites, perforators;
    for (const reconstruction::RecipientSite& site : flap.sites) sites.push_back({site.name, site.at, ""});
    for (const reconstruction::Perforator& p : flap.perforators) perforators.push_back({p.name, p.at, ""});
    if (!sites.empty()) writer.write("sites", markup_of(Kind::fiducial, "sites", sites));
    if (!perforators.empty()) writer.write("perforators", markup_of(Kind::fiducial, "perforators", perforators));
    return writer.files();
}

}  // namespace tactus::analysis
