// SPDX-License-Identifier: Apache-2.0
#include "tests/tools/window/on_display.hpp"
#include "tests/support/places.hpp"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#pragma GCC diagnostic ignored "-Wsign-compare"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <numeric>

namespace tactus::test {

Outcome on(const VirtualDisplay& display, const Folder& folder, const std::string& arguments, int max_s) {
    // Edits that a script does not save are kept there, not with the user's.
    const std::string command =
        fmt::format("cd {0} && {1} XDG_STATE_HOME={0}/state timeout {2} {3} {4} >stdout 2>stderr", folder.path.string(),
                    display.environment(), max_s, tactus::test::command(), arguments);
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, slurp(folder.path / "stdout"), slurp(folder.path / "stderr")};
}

std::pair<std::string, std::int64_t> hash_of(const VirtualDisplay& display, const Folder& folder,
                                             const std::string& arguments) {
    const Outcome done = on(display, folder, arguments);
    INFO(done.err);
    REQUIRE(done.code == 0);
    const nlohmann::json summary = nlohmann::json::parse(done.out);
    std::int64_t late = 0;
    for (const nlohmann::json& group : summary["groups"])
        for (const char* how : {"misses", "skipped", "dropped"}) late += group[how].get<std::int64_t>();
    return {summary["output_hash"].get<std::string>(), late};
}

std::size_t Picture::colours() const {
    std::set<int> seen;
    for (std::size_t i = 0; i + 2 < rgb.size(); i += 3) seen.insert(rgb[i] << 16 | rgb[i + 1] << 8 | rgb[i + 2]);
    return seen.size();
}

double Picture::brightness() const {
    if (rgb.empty()) return 0.0;
    return std::accumulate(rgb.begin(), rgb.end(), 0.0) / (255.0 * static_cast<double>(rgb.size()));
}

Picture read_picture(const std::filesystem::path& png) {
    Picture picture;
    int parts = 0;
    unsigned char* data = stbi_load(png.c_str(), &picture.width, &picture.height, &parts, 3);
    if (!data) return picture;
    picture.rgb.assign(data, data + static_cast<std::ptrdiff_t>(3) * picture.width * picture.height);
    stbi_image_free(data);
    return picture;
}

int beside_screen(const std::filesystem::path& png) {
    const Picture picture = read_picture(png);
    int count = 0;
    for (int y = 0; y < picture.height; ++y)
        for (int x = picture.width * 2 / 3; x < picture.width; ++x)
            count += picture.at(x, y, 0) == 0x0b && picture.at(x, y, 1) == 0x0e && picture.at(x, y, 2) == 0x13;
    return count;
}

void check_picture(const std::filesystem::path& png, int width, int height) {
    INFO(png.string());
    const Picture seen = read_picture(png);
    CHECK(seen.width == width);
    CHECK(seen.height == height);
    CHECK(seen.colours() > 300);
    CHECK((seen.brightness() > 0.04 && seen.brightness() < 0.6));
}

}  // namespace tactus::test
