// SPDX-License-Identifier: Apache-2.0
#include "assets/mesh/three_mf.hpp"

#include "dsp/core/error.hpp"

#include <fmt/format.h>
#include <zip.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <string_view>

namespace tactus::mesh {

namespace {

constexpr std::string_view content_types =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types">
 <Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/>
 <Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/>
</Types>
)";
constexpr std::string_view relations =
    R"(<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
 <Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/>
</Relationships>
)";

std::string model_of(std::span<const ColouredSurface> surfaces) {
    std::string xml =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<model unit=\"millimeter\" xml:lang=\"en-US\" "
        "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\">\n"
        " <metadata name=\"Application\">Tactus</metadata>\n <metadata name=\"Description\">SPACE=LPS</metadata>\n"
        " <resources>\n  <basematerials id=\"1\">\n";
    auto out = std::back_inserter(xml);
    for (const ColouredSurface& s : surfaces) {
        int c[3];
        for (int n = 0; n < 3; ++n) c[n] = static_cast<int>(std::lround(255.0 * std::clamp(s.colour[n], 0.0, 1.0)));
        fmt::format_to(out, "   <base name=\"surface\" displaycolor=\"#{:02X}{:02X}{:02X}\"/>\n", c[0], c[1], c[2]);
    }
    xml += "  </basematerials>\n";
    for (std::size_t n = 0; n < surfaces.size(); ++n) {
        fmt::format_to(out, "  <object id=\"{}\" type=\"model\" pid=\"1\" pindex=\"{}\">\n   <mesh>\n    <vertices>\n",
                       n + 2, n);
        for (const Vec3& v : surfaces[n].surface.vertices)
            fmt::format_to(out, "<vertex x=\"{:.5f}\" y=\"{:.5f}\" z=\"{:.5f}\"/>\n", v.x * 1e3, v.y * 1e3, v.z * 1e3);
        xml += "    </vertices>\n    <triangles>\n";
        for (const auto& t : surfaces[n].surface.triangles)
            fmt::format_to(out, "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", t[0], t[1], t[2]);
        xml += "    </triangles>\n   </mesh>\n  </object>\n";
    }
    xml += " </resources>\n <build>\n";
    for (std::size_t n = 0; n < surfaces.size(); ++n) fmt::format_to(out, "  <item objectid=\"{}\"/>\n", n + 2);
    xml += " </build>\n</model>\n";
    return xml;
}

[[noreturn]] void fail(zip_error_t* error) {
    const std::string why = zip_error_strerror(error);
    throw Error(fmt::format("the 3MF archive cannot be made: {}", why));
}

}  // namespace

std::string three_mf_of(std::span<const ColouredSurface> surfaces) {
    const std::string model = model_of(surfaces);
    zip_error_t error;
    zip_error_init(&error);
    zip_source_t* bytes = zip_source_buffer_create(nullptr, 0, 0, &error);
    if (!bytes) fail(&error);
    // The archive owns one reference, this function the other.
    zip_source_keep(bytes);
    const std::unique_ptr<zip_source_t, void (*)(zip_source_t*)> held(bytes, zip_source_free);
    zip_t* archive = zip_open_from_source(bytes, ZIP_TRUNCATE, &error);
    if (!archive) {
        zip_source_free(bytes);
        fail(&error);
    }
    const auto add = [&](const char* name, std::string_view text) {
        zip_source_t* source = zip_source_buffer(archive, text.data(), text.size(), 0);
        const zip_int64_t index = source ? zip_file_add(archive, name, source, ZIP_FL_ENC_UTF_8) : -1;
        if (index < 0) {
            if (source) zip_source_free(source);
            zip_error_t why = *zip_get_error(archive);
            const std::string words = zip_error_strerror(&why);
            zip_discard(archive);
            throw Error(fmt::format("the 3MF archive cannot be made: {}", words));
        }
        // Same input, same bytes.
        zip_file_set_dostime(archive, static_cast<zip_uint64_t>(index), 0, 0x21,
                             0);  // 1 January 1980 in every time zone
        zip_set_file_compression(archive, static_cast<zip_uint64_t>(index), ZIP_CM_DEFLATE, 3);
    };
    add("[Content_Types].xml", content_types);
    add("_rels/.rels", relations);
    add("3D/3dmodel.model", model);
    if (zip_close(archive) < 0) {
        zip_error_t why = *zip_get_error(archive);
        const std::string words = zip_error_strerror(&why);
        zip_discard(archive);
        throw Error(fmt::format("the 3MF archive cannot be made: {}", words));
    }
    if (zip_source_open(bytes) < 0) fail(zip_source_error(bytes));
    zip_source_seek(bytes, 0, SEEK_END);
    const zip_int64_t size = zip_source_tell(bytes);
    zip_source_seek(bytes, 0, SEEK_SET);
    std::string made(static_cast<std::size_t>(std::max<zip_int64_t>(0, size)), '\0');
    const zip_int64_t read = zip_source_read(bytes, made.data(), made.size());
    zip_source_close(bytes);
    if (size <= 0 || read != size) throw Error("the 3MF archive cannot be made: its bytes cannot be read back");
    return made;
}

}  // namespace tactus::mesh
