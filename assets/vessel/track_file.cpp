// SPDX-License-Identifier: Apache-2.0
#include "assets/vessel/track_file.hpp"
#include "assets/file/whole_file.hpp"
#include "assets/markup/markup.hpp"
#include "assets/mesh/write_mesh.hpp"
#include "assets/table/csv_file.hpp"
#include "dsp/core/error.hpp"
#include "dsp/vessel/track_warnings.hpp"
#include "dsp/vessel/tube_surface.hpp"

#include <fmt/format.h>

#include <functional>
#include <iterator>
#include <utility>

namespace tactus::vessel {

namespace {

constexpr std::array<Vec3, 6> colours{Vec3(0.80, 0.16, 0.14), Vec3(0.90, 0.55, 0.13), Vec3(0.20, 0.45, 0.75),
                                      Vec3(0.35, 0.62, 0.30), Vec3(0.55, 0.35, 0.65), Vec3(0.45, 0.45, 0.45)};

Vec3 colour_of(std::size_t branch) { return colours[branch % colours.size()]; }

/// The row of each branch's first node.
std::vector<std::size_t> first_rows(const Track& track) {
    std::vector<std::size_t> rows;
    std::size_t next = 0;
    for (const Branch& branch : track.branches) {
        rows.push_back(next);
        next += branch.nodes.size();
    }
    return rows;
}

long parent_of(const Track& track, const std::vector<std::size_t>& rows, std::size_t branch, std::size_t node) {
    if (node > 0) return static_cast<long>(rows[branch] + node) - 1;
    const Branch& of = track.branches[branch];
    if (of.parent < 0) return -1;
    return static_cast<long>(rows[static_cast<std::size_t>(of.parent)]) + of.parent_node;
}

std::string csv(const Track& track) {
    const std::vector<std::size_t> rows = first_rows(track);
    std::string text = "branch,x_mm,y_mm,z_mm,radius_mm,contrast,confidence,parent\n";
    for (std::size_t b = 0; b < track.branches.size(); ++b)
        for (std::size_t n = 0; n < track.branches[b].nodes.size(); ++n) {
            const Node& node = track.branches[b].nodes[n];
            fmt::format_to(std::back_inserter(text), "{},{:.4f},{:.4f},{:.4f},{:.4f},{:.6g},{:.4f},{}\n", b,
                           node.position.x * 1e3, node.position.y * 1e3, node.position.z * 1e3, node.radius * 1e3,
                           node.contrast, node.confidence, parent_of(track, rows, b, n));
        }
    return text;
}

/// VTK's strings are bytes that end with a 0.
std::string field_data(const std::vector<TrackWarning>& warnings) {
    if (warnings.empty()) return {};
    std::string text =
        fmt::format("<FieldData>\n<Array type=\"String\" Name=\"warnings\" NumberOfTuples=\"{}\" format=\"ascii\">\n",
                    warnings.size());
    for (const TrackWarning& warning : warnings) {
        for (const char byte : warning.text)
            fmt::format_to(std::back_inserter(text), "{} ", static_cast<unsigned>(static_cast<unsigned char>(byte)));
        text += "0\n";
    }
    return text + "</Array>\n</FieldData>\n";
}

/// Those of the whole vessel hold at its first node.
std::vector<TrackWarning> all_warnings(const Track& track, std::span<const std::string> whole) {
    std::vector<TrackWarning> all;
    for (const std::string& text : whole) all.push_back({0, 0, text});
    for (TrackWarning& warning : warnings_of(track)) all.push_back(std::move(warning));
    return all;
}

std::string vtp(const Track& track, const std::vector<TrackWarning>& warnings) {
    const std::vector<std::size_t> rows = first_rows(track);
    std::size_t points = 0;
    for (const Branch& branch : track.branches) points += branch.nodes.size();
    std::string text = fmt::format(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" "
        "byte_order=\"LittleEndian\">\n<PolyData>\n{}"
        "<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
        "NumberOfPolys=\"0\">\n<Points>\n<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n",
        field_data(warnings), points, track.branches.size());
    const auto out = std::back_inserter(text);
    const auto each = [&](const std::function<void(std::size_t, std::size_t, const Node&)>& write) {
        for (std::size_t b = 0; b < track.branches.size(); ++b)
            for (std::size_t n = 0; n < track.branches[b].nodes.size(); ++n) write(b, n, track.branches[b].nodes[n]);
    };
    each([&](std::size_t, std::size_t, const Node& node) {
        fmt::format_to(out, "{:.6f} {:.6f} {:.6f}\n", node.position.x * 1e3, node.position.y * 1e3,
                       node.position.z * 1e3);
    });
    text += "</DataArray>\n</Points>\n<Lines>\n<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">\n";
    for (std::size_t n = 0; n < points; ++n) fmt::format_to(out, "{} ", n);
    text += "\n</DataArray>\n<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">\n";
    for (std::size_t b = 0; b < track.branches.size(); ++b)
        fmt::format_to(out, "{} ", rows[b] + track.branches[b].nodes.size());
    text += "\n</DataArray>\n</Lines>\n<PointData Scalars=\"radius_mm\">\n";
    const auto array = [&](const char* type, const char* name,
                           const std::function<std::string(std::size_t, std::size_t, const Node&)>& value) {
        fmt::format_to(out, "<DataArray type=\"{}\" Name=\"{}\" format=\"ascii\">\n", type, name);
        each([&](std::size_t b, std::size_t n, const Node& node) { text += value(b, n, node) + " "; });
        text += "\n</DataArray>\n";
    };
    array("Float64", "radius_mm",
          [](std::size_t, std::size_t, const Node& node) { return fmt::format("{:.6f}", node.radius * 1e3); });
    array("Float64", "contrast",
          [](std::size_t, std::size_t, const Node& node) { return fmt::format("{:.6g}", node.contrast); });
    array("Float64", "confidence",
          [](std::size_t, std::size_t, const Node& node) { return fmt::format("{:.4f}", node.confidence); });
    array("Int64", "branch", [](std::size_t b, std::size_t, const Node&) { return fmt::format("{}", b); });
    array("Int64", "parent",
          [&](std::size_t b, std::size_t n, const Node&) { return fmt::format("{}", parent_of(track, rows, b, n)); });
    return text + "</PointData>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::string markups(const Track& track, const std::vector<TrackWarning>& warnings) {
    const auto description = [&](std::size_t branch, std::size_t n) {
        const Node& node = track.branches[branch].nodes[n];
        std::string text =
            fmt::format("radius {:.3f} mm{}", node.radius * 1e3, node.is_lost ? ", without contrast" : "");
        for (const TrackWarning& warning : warnings)
            if (warning.branch == branch && warning.node == n) text += "; warning: " + warning.text;
        return text;
    };
    std::vector<markup::Markup> curves;
    for (std::size_t b = 0; b < track.branches.size(); ++b) {
        markup::Markup curve;
        curve.kind = markup::Kind::curve;
        curve.colour = colour_of(b);
        for (std::size_t n = 0; n < track.branches[b].nodes.size(); ++n)
            curve.points.push_back(
                {fmt::format("B{}-{}", b, n + 1), track.branches[b].nodes[n].position, description(b, n)});
        curves.push_back(std::move(curve));
    }
    return markup::text_of(curves);
}

bool ends_with(const std::filesystem::path& path, std::string_view end) {
    return path.filename().string().ends_with(end);
}

}  // namespace

bool is_track_file(const std::filesystem::path& path) {
    for (const char* const end : {".csv", ".vtp", ".mrk.json", ".stl", ".ply"})
        if (ends_with(path, end)) return true;
    return false;
}

void write_track(const Track& track, const std::filesystem::path& path, std::span<const std::string> warnings) {
    if (track.branches.empty()) throw Error("there is no vessel to write to " + path.string());
    if (ends_with(path, ".csv")) return table::save_csv(path, csv(track));
    if (ends_with(path, ".vtp")) return file::write_whole_file(path, vtp(track, all_warnings(track, warnings)));
    if (ends_with(path, ".mrk.json"))
        return file::write_whole_file(path, markups(track, all_warnings(track, warnings)));
    if (!is_track_file(path))
        throw Error(path.string() + ": a vessel is written as .csv, .vtp, .mrk.json, .stl or .ply");
    std::vector<mesh::ColouredSurface> tubes;
    for (std::size_t b = 0; b < track.branches.size(); ++b)
        tubes.push_back({tube_surface(track.branches[b]), colour_of(b)});
    mesh::write_mesh(tubes, path);
}

}  // namespace tactus::vessel
