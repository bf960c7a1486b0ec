// SPDX-License-Identifier: Apache-2.0
#include "assets/mesh/mesh_readers.hpp"
#include "dsp/core/error.hpp"
#include "dsp/core/stop.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <vector>

namespace tactus::mesh {

namespace {

enum class Coding { text, little, big };

struct Property {
    std::string name;
    std::string type;
    std::string count_type;  // type of a list's length; empty for a single number
};

struct Element {
    std::string name;
    double count = 0.0;
    std::vector<Property> properties;
};

struct Header {
    Coding coding = Coding::text;
    std::vector<Element> elements;
    std::size_t size = 0;
};

// Reads numbers of the body, in text or binary.
class Body {
public:
    Body(std::string_view bytes, Coding coding, const std::string& file)
        : bytes_(bytes), words_(bytes), coding_(coding), file_(file) {}

    double number(std::string_view type) {
        if (coding_ == Coding::text) return words_.number(file_);
        if (type == "char" || type == "int8") return take<std::int8_t>();
        if (type == "uchar" || type == "uint8") return take<std::uint8_t>();
        if (type == "short" || type == "int16") return take<std::int16_t>();
        if (type == "ushort" || type == "uint16") return take<std::uint16_t>();
        if (type == "int" || type == "int32") return take<std::int32_t>();
        if (type == "uint" || type == "uint32") return take<std::uint32_t>();
        if (type == "float" || type == "float32") return static_cast<double>(take<float>());
        if (type == "double" || type == "float64") return take<double>();
        throw Error(fmt::format("{}: unknown PLY type '{}'", file_, type));
    }

    /// "3 words" or "12 bytes" that no element is read from; empty: none but blanks.
    std::string rest() {
        std::size_t count = 0;
        if (coding_ == Coding::text) {
            while (!words_.next().empty()) ++count;
            return count == 0 ? "" : fmt::format("{} word{}", count, count == 1 ? "" : "s");
        }
        if (bytes_.find_first_not_of(" \t\r\n", at_) == std::string_view::npos) return "";
        count = bytes_.size() - at_;
        return fmt::format("{} byte{}", count, count == 1 ? "" : "s");
    }

private:
    template <typename T>
    T take() {
        if (bytes_.size() - at_ < sizeof(T)) throw Error(fmt::format("{}: cut short; copy the file again", file_));
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        if ((coding_ == Coding::big) != (std::endian::native == std::endian::big)) std::reverse(raw.begin(), raw.end());
        return std::bit_cast<T>(raw);
    }

    std::string_view bytes_;
    Words words_;
    Coding coding_;
    const std::string& file_;
    std::size_t at_ = 0;
};

std::string_view line_at(std::string_view bytes, std::size_t& at) {
    const std::size_t end = std::min(bytes.find('\n', at), bytes.size());
    std::string_view line = bytes.substr(at, end - at);
    at = std::min(end + 1, bytes.size());
    if (line.ends_with('\r')) line.remove_suffix(1);
    return line;
}

Header header_of(std::string_view bytes, const std::string& file, std::optional<volume::Frame>& frame,
                 std::optional<double>& unit) {
    Header header;
    std::size_t at = 0;
    bool has_coding = false;
    if (line_at(bytes, at) != "ply") throw Error(fmt::format("{}: no PLY header", file));
    while (at < bytes.size() && at < 65536) {
        const std::string_view line = line_at(bytes, at);
        Words words(line);
        const std::string_view first = words.next();
        if (first == "end_header") {
            if (!has_coding) throw Error(fmt::format("{}: the PLY header has no 'format' line", file));
            header.size = at;
            return header;
        }
        if (first == "comment" || first == "obj_info") {
            if (const auto stated = stated_frame(line)) frame = stated;
            if (const auto stated = stated_unit(line)) unit = stated;
        } else if (first == "format") {
            const std::string_view name = words.next();
            if (name != "ascii" && name != "binary_little_endian" && name != "binary_big_endian")
                throw Error(fmt::format("{}: unknown PLY format '{}'", file, name));
            header.coding = name == "ascii" ? Coding::text : name == "binary_big_endian" ? Coding::big : Coding::little;
            has_coding = true;
        } else if (first == "element") {
            Element& element = header.elements.emplace_back();
            element.name = words.next();
            element.count = words.number(file);
            if (!(element.count >= 0.0 && element.count <= static_cast<double>(bytes.size())))
                throw Error(
                    fmt::format("{}: cut short: its header asks for more elements than the file has bytes", file));
        } else if (first == "property") {
            if (header.elements.empty())
                throw Error(fmt::format("{}: the PLY header has a property before any element", file));
            Property property;
            property.type = words.next();
            if (property.type == "list") {
                property.count_type = words.next();
                property.type = words.next();
            }
            property.name = words.next();
            header.elements.back().properties.push_back(property);
        }
    }
    throw Error(fmt::format("{}: the PLY header has no end", file));
}

/// A triangle for every three points that follow each other, every second one turned; −1 begins a new strip.
void read_strips(Body& body, const Property& property, double count, const std::string& file,
                 geometry::TriangleSurface& surface) {
    std::array<int, 2> last{};
    std::size_t points = 0;
    for (double c = 0.0; c < count; c += 1.0) {
        if (c - 4096.0 * std::floor(c / 4096.0) == 0.0) leave_if_stopped();
        const double value = body.number(property.type);
        if (value == -1.0) {
            points = 0;
            continue;
        }
        if (!(value >= 0.0 && value < 2147483647.0))
            throw Error(fmt::format("{}: a strip names a point that is not there", file));
        const int index = static_cast<int>(value);
        if (points >= 2 && index != last[0] && index != last[1] && last[0] != last[1])
            surface.triangles.push_back(points % 2 == 0 ? std::array{last[0], last[1], index}
                                                        : std::array{last[1], last[0], index});
        last = {last[1], index};
        ++points;
    }
}

void read_element(Body& body, const Element& element, const std::string& file, geometry::TriangleSurface& surface,
                  std::vector<std::string>& notes) {
    const bool is_vertex = element.name == "vertex", is_face = element.name == "face";
    const bool is_strips =
        element.name == "tristrips" || element.name == "tristrip" || element.name == "triangle_strips";
    if (element.properties.empty()) return;
    if (!is_vertex && !is_face && !is_strips && element.count > 0.0)
        notes.push_back(fmt::format("{:.0f} elements '{}' were not read", element.count, element.name));
    for (double n = 0.0; n < element.count; n += 1.0) {
        leave_if_stopped();
        Vec3 point(0.0);
        for (const Property& property : element.properties) {
            if (property.count_type.empty()) {
                const double value = body.number(property.type);
                if (is_vertex && property.name == "x") point.x = value;
                if (is_vertex && property.name == "y") point.y = value;
                if (is_vertex && property.name == "z") point.z = value;
                continue;
            }
            const double count = body.number(property.count_type);
            const bool is_list = property.name == "vertex_indices" || property.name == "vertex_index";
            if (is_strips && is_list) {
                read_strips(body, property, count, file, surface);
                continue;
            }
            const bool corners = is_face && is_list;
            int first = 0, last = 0;
            for (double c = 0.0; c < count; c += 1.0) {
                const double value = body.number(property.type);
                if (!corners) continue;
                if (!(value >= 0.0 && value < 2147483647.0))
                    throw Error(fmt::format("{}: a triangle names a point that is not there", file));
                const int index = static_cast<int>(value);
                if (c == 0.0) first = index;
                if (c >= 2.0) surface.triangles.push_back({first, last, index});
                last = index;
            }
        }
        if (is_vertex) surface.vertices.push_back(point);
    }
}

}  // namespace

MeshText read_ply(const std::string& bytes, const std::string& file) {
    MeshText mesh;
    const Header header = header_of(bytes, file, mesh.frame, mesh.unit);
    Body body(std::string_view(bytes).substr(header.size), header.coding, file);
    for (const Element& element : header.elements) read_element(body, element, file, mesh.surface, mesh.notes);
    if (const std::string rest = body.rest(); !rest.empty())
        mesh.notes.push_back(fmt::format(
            "{} behind the last element were not read: the header states fewer elements than the file has", rest));
    return mesh;
}

}  // namespace tactus::mesh
