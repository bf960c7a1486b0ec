// SPDX-License-Identifier: Apache-2.0
#include "assets/reconstruction/flap_files.hpp"

#include "assets/file/json_vector.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/markup/markup.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/reconstruction/fibula_inputs.hpp"
#include "assets/table/number_table.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/lower.hpp"

#include <fmt/format.h>
#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace tactus::reconstruction {

namespace fs = std::filesystem;
using file::Json;

namespace {

/// Names that fit on one line; others are numbered.
std::string plain(const std::string& label, const char* otherwise, std::size_t number) {
    const bool is_plain =
        !label.empty() && std::ranges::none_of(label, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
    return is_plain ? label : fmt::format("{} {}", otherwise, number);
}

/// An object in which each member of a list of strings has become what it names.
Json with_files_read(Json json, const fs::path& folder, const std::string& where, std::vector<std::string>& notes) {
    const auto marks = [&](const char* key, bool with_kind) {
        const Json* named = json.find(key);
        if (!named || !named->is_string()) return;
        const std::string file = named->as_text();
        Json list = Json::array();
        for (const MarkedPoint& mark : read_marks(folder / file, notes)) {
            Json one{{"name", mark.name}, {"at_mm", {mark.at.x / mm, mark.at.y / mm, mark.at.z / mm}}};
            if (with_kind) one["kind"] = name_of(kind_in(mark.name, (folder / file).string()));
            list.push_back(one);
        }
        json[key] = list;
    };
    marks("perforators", false);
    marks("sites", true);
    if (const Json* vessels = json.find("vessels"); vessels && vessels->is_array()) {
        Json list = Json::array();
        for (const Json& given : *vessels) {
            Json one = given;
            const Json* file = given.find("file");
            if (file) {
                if (!file->is_string() || file->as_text().empty())
                    throw Error(fmt::format("{}: vessels[{}] has a 'file' that is not a path", where, list.size()));
                const FlapVessel read = read_vessel(folder / file->as_text(), VesselKind::artery, 0, notes);
                Json points = Json::array();
                for (const Vec3& p : read.points) points.push_back({p.x / mm, p.y / mm, p.z / mm});
                one["points_mm"] = points;
                if (!given.contains("name")) one["name"] = read.name;
                if (!given.contains("radius_mm")) one["radius_mm"] = read.radius / mm;
            }
            list.push_back(one);
        }
        json["vessels"] = list;
    }
    return json;
}

}  // namespace

std::vector<MarkedPoint> marks_of(const markup::ReadPoints& read, const std::string& file) {
    std::vector<MarkedPoint> all;
    for (const markup::ControlPoint& point : read.points)
        all.push_back({plain(point.label, "mark", all.size() + 1), point.position});
    if (all.empty()) throw Error(fmt::format("{}: has no control points with a position", file));
    return all;
}

std::vector<MarkedPoint> read_marks(const fs::path& path, std::vector<std::string>& notes) {
    const markup::ReadPoints read = markup::read_points(path);
    notes.insert(notes.end(), read.notes.begin(), read.notes.end());
    return marks_of(read, path.string());
}

FlapVessel vessel_of_table(std::string_view text, const std::string& file, int branch) {
    const table::NumberTable table = table::read_number_table(text, file);
    table.know({"branch", "x_mm", "y_mm", "z_mm", "radius_mm", "contrast", "confidence", "parent"});
    const std::vector<double> branches = table.numbers("branch"), x = table.numbers("x_mm"), y = table.numbers("y_mm"),
                              z = table.numbers("z_mm"), radii = table.numbers("radius_mm");
    FlapVessel vessel;
    vessel.radius = 0.0;
    for (std::size_t n = 0; n < table.rows(); ++n) {
        if (branches[n] != branch) continue;
        const Vec3 at(x[n], y[n], z[n]);
        if (!(std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z), std::abs(radii[n])}) <= farthest_mm))
            throw Error({file, table.lines[n], 1},
                        fmt::format("a position or radius is beyond {:.0f} mm", farthest_mm));
        vessel.points.push_back(at * mm);
        vessel.radius += radii[n] * mm;
    }
    if (vessel.points.size() < 2) throw Error(fmt::format("{}: its branch {} has less than two points", file, branch));
    vessel.radius /= static_cast<double>(vessel.points.size());
    if (!(vessel.radius > 0.0)) throw Error(fmt::format("{}: 'radius_mm' must be above 0", file));
    return vessel;
}

FlapVessel read_vessel(const fs::path& path, VesselKind kind, int branch, std::vector<std::string>& notes) {
    std::string stem = path.filename().string();
    const std::string name = lower(stem);
    FlapVessel vessel;
    if (name.ends_with(".mrk.json")) {
        if (branch < 0) throw Error(fmt::format("{}: curves are counted from 0, not {}", path.string(), branch));
        stem.resize(stem.size() - 9);
        const markup::ReadPoints read = markup::read_points(path);
        notes.insert(notes.end(), read.notes.begin(), read.notes.end());
        for (const markup::ControlPoint& point :
             markup::points_of_markup(read, static_cast<std::size_t>(branch), path.string()))
            vessel.points.push_back(point.position);
        if (const std::size_t count = read.firsts.size(); count > 1)
            notes.push_back(fmt::format("{}: curve {} of {} is the vessel; {} {} left out", path.string(), branch,
                                        count, count - 1, count == 2 ? "was" : "were"));
        if (vessel.points.size() < 2) throw Error(fmt::format("{}: a vessel needs two points", path.string()));
    } else if (name.ends_with(".csv")) {
        stem.resize(stem.size() - 4);
        vessel = vessel_of_table(file::read_whole_file(path), path.string(), branch);
    } else {
        throw Error(fmt::format("{}: a vessel is a table (.csv) or a curve (.mrk.json)", path.string()));
    }
    vessel.name = plain(stem, "vessel", 1);
    vessel.kind = kind;
    return vessel;
}

VesselKind kind_in(const std::string& name, const std::string& where) {
    std::string low = name;
    for (char& c : low) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    const bool artery = low.find("arter") != std::string::npos, vein = low.find("vein") != std::string::npos;
    if (artery == vein) throw Error(fmt::format("{}: '{}' must say \"artery\" or \"vein\"", where, name));
    return artery ? VesselKind::artery : VesselKind::vein;
}

geometry::TriangleSurface read_surface(const fs::path& path) {
    mesh::MeshOrigin origin;
    geometry::TriangleSurface surface = mesh::load_mesh(path, 1.0, &origin);
    if (!origin.unit) {
        // A tooth is 5 mm across, a leg 2 m: in metres, a jaw has the numbers of a grain of salt.
        Vec3 low = surface.vertices.front(), high = low;
        for (const Vec3& v : surface.vertices) low = glm::min(low, v), high = glm::max(high, v);
        const Vec3 size = high - low;
        const double extent = std::max({size.x, size.y, size.z});
        if (!(extent >= 5.0 && extent <= 2000.0))
            throw Error(
                fmt::format("{}: the mesh states no unit and is {:.4g} units across, which is no bone in mm; is it in "
                            "metres? write it in mm, or convert it with 'tactus import --unit'",
                            path.string(), extent));
    }
    for (Vec3& v : surface.vertices) v *= origin.unit.value_or(mm);
    return surface;
}

ReconstructionInputs read_reconstruction_inputs(const fs::path& path) {
    const std::string text = file::read_whole_file(path), where = path.string();
    std::string donor, jaw;
    ReconstructionInputs all;
    all.inputs = fibula_inputs_of_text(text, where, &donor, &jaw);
    const fs::path folder = path.parent_path();
    const Json json = file::parse_json(text, where);
    all.flap = flap_of_inputs(with_files_read(json, folder, where, all.notes), where);
    if (const Json* tumour = json.find("tumour")) {
        if (!tumour->is_string() || tumour->as_text().empty())
            throw Error(fmt::format("{}: 'tumour' must be the path of a mesh", where));
        all.tumour = folder / tumour->as_text();
    }
    if (!donor.empty()) all.donor = folder / donor, all.inputs.donor = read_surface(all.donor);
    if (!jaw.empty()) all.jaw = folder / jaw, all.inputs.jaw = read_surface(all.jaw);
    return all;
}

}  // namespace tactus::reconstruction
