// SPDX-License-Identifier: Apache-2.0
#include "assets/reconstruct/flap_files.hpp"

#include "assets/file/json_vector.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/mesh/mesh.hpp"
#include "assets/reconstruct/fibula_inputs.hpp"
#include "dsp/core/constants.hpp"
#include "dsp/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace tactus::reconstruct {

namespace fs = std::filesystem;
using file::Json;

namespace {

Json parsed(std::string_view text, const std::string& file) {
    try {
        return Json::parse(text);
    } catch (const file::JsonSyntaxError& error) {
        throw Error(fmt::format("{}: byte {}: {}", file, error.byte, error.message()));
    }
}

/// Names that fit on one line; others are numbered.
std::string plain(const std::string& label, const char* otherwise, std::size_t number) {
    const bool is_plain =
        !label.empty() && std::ranges::none_of(label, [](char c) { return static_cast<unsigned char>(c) < 0x20; });
    return is_plain ? label : fmt::format("{} {}", otherwise, number);
}

std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    while (true) {
        const std::size_t comma = line.find(',');
        std::string_view cell = line.substr(0, comma);
        while (!cell.empty() && (cell.front() == ' ' || cell.front() == '\t')) cell.remove_prefix(1);
        while (!cell.empty() && (cell.back() == ' ' || cell.back() == '\r')) cell.remove_suffix(1);
        cells.push_back(cell);
        if (comma == std::string_view::npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

/// An object in which each member of a list of strings has become what it names.
Json with_files_read(Json json, const fs::path& folder, const std::string& where) {
    const auto marks = [&](const char* key, bool with_kind) {
        const Json* named = json.find(key);
        if (!named || !named->is_string()) return;
        const std::string file = named->as_text();
        Json list = Json::array();
        for (const MarkedPoint& mark : read_marks(folder / file)) {
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
                const FlapVessel read = read_vessel(folder / file->as_text(), VesselKind::artery);
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

std::vector<MarkedPoint> marks_of_text(std::string_view text, const std::string& file) {
    const Json json = parsed(text, file);
    const Json* markups = json.find("markups");
    if (!markups || !markups->is_array())
        throw Error(fmt::format("{}: has no list 'markups': expected a file of markups of 3D Slicer", file));
    std::vector<MarkedPoint> all;
    for (const Json& markup : *markups) {
        const Json* system = markup.find("coordinateSystem");
        const std::string frame = system && system->is_string() ? system->as_text() : "LPS";
        if (frame != "LPS" && frame != "RAS")
            throw Error(fmt::format("{}: 'coordinateSystem' must be \"LPS\" or \"RAS\", not \"{}\"", file, frame));
        const Json* unit = markup.find("coordinateUnits");
        if (unit && !(unit->is_string() && (unit->as_text() == "mm" || unit->as_text() == "millimeter")))
            throw Error(fmt::format("{}: 'coordinateUnits' must be \"mm\"", file));
        const Json* points = markup.find("controlPoints");
        if (!points || !points->is_array()) continue;
        for (const Json& point : *points) {
            const Json* position = point.find("position");
            const std::optional<Vec3> at = position ? file::vector_of(*position, farthest_mm) : std::nullopt;
            if (!at) throw Error(fmt::format("{}: control point {} has no position", file, all.size() + 1));
            const Json* label = point.find("label");
            const double side = frame == "RAS" ? -mm : mm;
            all.push_back({plain(label && label->is_string() ? label->as_text() : "", "mark", all.size() + 1),
                           {at->x * side, at->y * side, at->z * mm}});
        }
    }
    if (all.empty()) throw Error(fmt::format("{}: has no control points", file));
    return all;
}

std::vector<MarkedPoint> read_marks(const fs::path& path) {
    return marks_of_text(file::read_whole_file(path), path.string());
}

FlapVessel vessel_of_table(std::string_view text, const std::string& file, int branch) {
    constexpr std::array<std::string_view, 5> wanted{"branch", "x_mm", "y_mm", "z_mm", "radius_mm"};
    std::array<std::size_t, 5> column{};
    FlapVessel vessel;
    std::size_t number = 0;
    double radii = 0.0;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        const std::string_view line = text.substr(0, end);
        text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        ++number;
        if (line.empty() || line.front() == '#') continue;
        const std::vector<std::string_view> cells = cells_of(line);
        if (cells.empty() || (cells.size() == 1 && cells[0].empty())) continue;
        if (column == std::array<std::size_t, 5>{}) {
            for (std::size_t c = 0; c < wanted.size(); ++c) {
                const auto found = std::ranges::find(cells, wanted[c]);
                if (found == cells.end())
                    throw Error(fmt::format("{}: has no column '{}': expected a table as 'tactus vessel' writes it",
                                            file, wanted[c]));
                column[c] = static_cast<std::size_t>(found - cells.begin());
            }
            continue;
        }
        std::array<double, 5> values{};
        for (std::size_t c = 0; c < wanted.size(); ++c) {
            const std::string_view cell = column[c] < cells.size() ? cells[column[c]] : std::string_view{};
            const auto [rest, error] = std::from_chars(cell.data(), cell.data() + cell.size(), values[c]);
            if (error != std::errc{} || rest != cell.data() + cell.size() || !(std::abs(values[c]) <= farthest_mm))
                throw Error(fmt::format("{}: line {}: '{}' is not a number", file, number, wanted[c]));
        }
        if (values[0] != branch) continue;
        vessel.points.emplace_back(values[1] * mm, values[2] * mm, values[3] * mm);
        radii += values[4] * mm;
    }
    if (vessel.points.size() < 2) throw Error(fmt::format("{}: its branch {} has less than two points", file, branch));
    vessel.radius = radii / static_cast<double>(vessel.points.size());
    if (!(vessel.radius > 0.0)) throw Error(fmt::format("{}: 'radius_mm' must be above 0", file));
    return vessel;
}

FlapVessel read_vessel(const fs::path& path, VesselKind kind, int branch) {
    std::string stem = path.filename().string();
    FlapVessel vessel;
    if (stem.ends_with(".mrk.json")) {
        if (branch != 0) throw Error(fmt::format("{}: branches are told apart in tables (.csv) only", path.string()));
        stem.resize(stem.size() - 9);
        for (const MarkedPoint& mark : read_marks(path)) vessel.points.push_back(mark.at);
        if (vessel.points.size() < 2) throw Error(fmt::format("{}: a vessel needs two points", path.string()));
    } else if (stem.ends_with(".csv")) {
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
    for (Vec3& v : surface.vertices) v *= origin.unit.value_or(mm);
    return surface;
}

ReconstructionInputs read_reconstruction_inputs(const fs::path& path) {
    const std::string text = file::read_whole_file(path), where = path.string();
    std::string donor, jaw;
    ReconstructionInputs all;
    all.inputs = fibula_inputs_of_text(text, where, &donor, &jaw);
    const fs::path folder = path.parent_path();
    const Json json = parsed(text, where);
    all.flap = flap_of_inputs(with_files_read(json, folder, where), where);
    if (const Json* tumour = json.find("tumour")) {
        if (!tumour->is_string() || tumour->as_text().empty())
            throw Error(fmt::format("{}: 'tumour' must be the path of a mesh", where));
        all.tumour = folder / tumour->as_text();
    }
    if (!donor.empty()) all.donor = folder / donor, all.inputs.donor = read_surface(all.donor);
    if (!jaw.empty()) all.jaw = folder / jaw, all.inputs.jaw = read_surface(all.jaw);
    return all;
}

}  // namespace tactus::reconstruct
