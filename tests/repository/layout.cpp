// SPDX-License-Identifier: Apache-2.0
// What the tree promises: rooms include only to the left, folders are namespaces, files carry their licence, nodes are
// in the catalogue, and no room knows the names of what is built on it.
#include "tests/support/catch.hpp"
#include "tests/support/places.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace {

namespace fs = std::filesystem;

const fs::path root = tactus::test::source_folder();
constexpr std::array<std::string_view, 7> rooms{"dsp", "assets", "graph", "devices", "nodes", "engine", "tools"};
constexpr std::array<std::string_view, 7> tool_rooms{"run",    "analysis", "render", "report",
                                                     "window", "command",  "bench"};

std::string read(const fs::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<fs::path> files_under(std::string_view folder, const std::set<std::string>& extensions) {
    std::vector<fs::path> files;
    if (!fs::exists(root / folder)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
        if (entry.is_regular_file() && extensions.contains(entry.path().extension().string()))
            files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

/// The names in `#include "..."` and `#include <...>` lines.
std::vector<std::string> includes_of(const fs::path& file) {
    std::vector<std::string> names;
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
        const auto hash = line.find_first_not_of(" \t");
        if (hash == std::string::npos || line.compare(hash, 8, "#include") != 0) continue;
        const auto open = line.find_first_of("<\"", hash);
        const auto close = line.find_first_of(">\"", open + 1);
        if (open != std::string::npos && close != std::string::npos)
            names.push_back(line.substr(open + 1, close - open - 1));
    }
    return names;
}

/// "blade_contact" → "BladeContact".
std::string struct_name_of(std::string_view file_stem) {
    std::string name;
    bool start = true;
    for (const char c : file_stem) {
        if (c != '_') name += start ? static_cast<char>(std::toupper(c)) : c;
        start = c == '_';
    }
    return name;
}

/// The namespace that a file's folder stands for. What every room is written in (dsp/core, graph/node) is `tactus`
/// itself; all families of nodes share one, since the name of a node type is unique in a patch.
std::string namespace_of(const fs::path& file) {
    const fs::path folder = fs::relative(file, root).parent_path();
    const auto depth = std::distance(folder.begin(), folder.end());
    if (*folder.begin() == "nodes") return "tactus::nodes";
    if (depth < 2 || folder == "dsp/core" || folder == "graph/node") return "tactus";
    return "tactus::" + std::next(folder.begin())->string();
}

/// "tactus::bone" of each `namespace … {` that starts a line, in order, and the text of its block.
std::vector<std::pair<std::string, std::string>> namespaces_of(const std::string& text) {
    std::vector<std::pair<std::string, std::string>> found;
    static const std::regex opening("(^|\n)namespace (tactus[a-z_:]*) \\{");
    for (std::sregex_iterator at(text.begin(), text.end(), opening), end; at != end; ++at) {
        const auto from = static_cast<std::size_t>(at->position() + at->length());
        found.emplace_back((*at)[2].str(), text.substr(from, text.find("\n}", from) - from));
    }
    return found;
}

/// A block of another folder's namespace may declare a type of it, or specialise a template of the vocabulary.
bool only_declares(const std::string& block) {
    static const std::regex defined(
        "(^|\n)(inline|constexpr|void|[a-z_]+ [a-z_]+\\(|class [A-Za-z]+ *(:[^;]*)?\\{|struct "
        "[A-Za-z]+ *(:[^;]*)?\\{)");
    return !std::regex_search(block, defined);
}

}  // namespace

TEST_CASE("rooms include only what stands left of them") {
    for (std::size_t room = 0; room < rooms.size(); ++room) {
        for (const fs::path& file : files_under(rooms[room], {".cpp", ".hpp"})) {
            for (const std::string& name : includes_of(file)) {
                const auto first = name.substr(0, name.find('/'));
                CAPTURE(file.string(), name);
                CHECK_FALSE(name.starts_with("../"));
                CHECK(first != "tests");
                const auto included = std::ranges::find(rooms, first);
                if (included != rooms.end() && first != name)
                    CHECK(static_cast<std::size_t>(included - rooms.begin()) <= room);
            }
        }
    }
}

TEST_CASE("a folder is a namespace") {
    for (const auto room : rooms)
        for (const fs::path& file : files_under(room, {".cpp", ".hpp"})) {
            const std::string own = namespace_of(file);
            for (const auto& [name, block] : namespaces_of(read(file))) {
                CAPTURE(file.string(), name, own);
                CHECK((name == own || name.starts_with(own + "::") || only_declares(block)));
            }
        }
}

TEST_CASE("no two types have one name in one namespace") {
    static const std::regex definition(
        "(^|\n)(?:class|struct|enum class|enum) ([A-Z][A-Za-z0-9]*)(?: final)?(?: ?:[^;{\n]*)? \\{");
    std::map<std::string, std::string> seen;
    for (const auto room : rooms)
        for (const fs::path& file : files_under(room, {".hpp"})) {
            const std::string text = read(file);
            for (std::sregex_iterator at(text.begin(), text.end(), definition), end; at != end; ++at) {
                const auto before = text.rfind("\nnamespace ", static_cast<std::size_t>(at->position()));
                const auto line =
                    before == std::string::npos ? std::string() : text.substr(before, text.find('{', before) - before);
                const auto [other, is_new] =
                    seen.emplace(namespace_of(file) + line + "::" + (*at)[2].str(), file.string());
                CAPTURE(file.string(), other->second, other->first);
                CHECK(is_new);
            }
        }
}

TEST_CASE("every source file stands in a folder of its room") {
    // The table of all node types; what the command and its window share.
    const std::set<std::string> shared{"nodes/catalogue", "nodes/declare",  "tools/counted",
                                       "tools/exit_code", "tools/terminal", "tools/make_library"};
    for (const auto room : rooms)
        for (const fs::path& file : files_under(room, {".cpp", ".hpp"})) {
            const fs::path place = fs::relative(file, root);
            CAPTURE(place.string());
            CHECK((std::distance(place.begin(), place.end()) > 2 ||
                   shared.contains((place.parent_path() / place.stem()).string())));
        }
}

TEST_CASE("below the nodes nobody knows a node type, a patch or a display file by its name") {
    // One-word names such as "scene" are words of the language as well.
    std::set<std::string> names;
    for (const fs::path& file : files_under("nodes", {".cpp"}))
        if (file.stem().string().find('_') != std::string::npos) names.insert(file.stem().string());
    for (const fs::path& file : files_under("assets/library", {".toml"}))
        if (file.stem().string().find('-') != std::string::npos) names.insert(file.stem().string());
    static const std::regex literal("\"([a-z_-]+)(\\.toml)?\"");
    for (const std::string_view room : {"dsp", "assets", "graph", "devices", "engine"})
        for (const fs::path& file : files_under(room, {".cpp", ".hpp"})) {
            if (file.parent_path() == root / "assets/library") continue;  // makes the library
            const std::string text = std::regex_replace(read(file), std::regex("//[^\n]*"), "");
            for (std::sregex_iterator at(text.begin(), text.end(), literal), end; at != end; ++at) {
                CAPTURE(file.string(), (*at)[1].str());
                CHECK_FALSE(names.contains((*at)[1].str()));
            }
        }
}

TEST_CASE("below the tools one header reads clocks and sleeps") {
    static const std::regex clock("steady_clock|clock_gettime|nanosleep|usleep|this_thread::sleep");
    for (const std::string_view room : {"dsp", "assets", "graph", "devices", "nodes", "engine"})
        for (const fs::path& file : files_under(room, {".cpp", ".hpp"})) {
            const fs::path name = file.lexically_relative(root);
            if (name == "dsp/core/clock.hpp" || name == "dsp/core/processor_time.hpp") continue;
            CAPTURE(name.string());
            CHECK_FALSE(std::regex_search(std::regex_replace(read(file), std::regex("//[^\n]*"), ""), clock));
        }
}

TEST_CASE("every source file says its licence first") {
    std::vector<fs::path> files{root / "CMakeLists.txt", root / "dev", root / ".ci/run"};
    for (const auto folder :
         {"dsp", "assets", "graph", "devices", "nodes", "engine", "tools", "tests", "cmake", "docs"})
        for (const auto& file : files_under(folder, {".cpp", ".hpp", ".cmake", ".py", ".sh"})) files.push_back(file);
    for (const fs::path& file : files) {
        std::ifstream stream(file);
        std::string line;
        std::getline(stream, line);
        if (line.starts_with("#!")) std::getline(stream, line);
        CAPTURE(file.string());
        const bool is_cpp = file.extension() == ".cpp" || file.extension() == ".hpp";
        CHECK(line == (is_cpp ? "// SPDX-License-Identifier: Apache-2.0" : "# SPDX-License-Identifier: Apache-2.0"));
    }
}

TEST_CASE("every node file is in the catalogue") {
    const std::string catalogue = read(root / "nodes/catalogue.cpp");
    for (const fs::path& file : files_under("nodes", {".cpp"})) {
        if (file.parent_path() == root / "nodes") continue;
        if (read(file).find("TACTUS_NODE(") == std::string::npos) continue;  // shared by nodes of the family
        const std::string type = struct_name_of(file.stem().string());
        CAPTURE(file.string());
        CHECK(catalogue.find("X(" + type + ", " + file.parent_path().filename().string() + ")") != std::string::npos);
    }
}

TEST_CASE("heavy libraries stay out of headers") {
    for (const auto room : rooms)
        for (const fs::path& file : files_under(room, {".hpp"}))
            for (const std::string& name : includes_of(file))
                for (const std::string_view heavy :
                     {"openvdb/", "CLI/", "nlohmann/", "toml++", "Eigen/", "gdcm", "bzlib.h", "hdf5", "kissfft",
                      "zlib.h", "GL/", "EGL/", "portaudio"}) {
                    CAPTURE(file.string(), name);
                    CHECK_FALSE(name.starts_with(heavy));
                }
}

TEST_CASE("two files alone include the JSON library, which takes seconds to compile") {
    std::vector<std::string> found;
    for (const auto room : rooms)
        for (const fs::path& file : files_under(room, {".cpp"}))
            if (std::ranges::count(includes_of(file), "nlohmann/json.hpp") > 0)
                found.push_back(fs::relative(file, root).string());
    std::ranges::sort(found);
    CHECK(found == std::vector<std::string>{"assets/file/json.cpp", "engine/take/take_reader.cpp"});
}

TEST_CASE("only the module of bone files and benchmarks include OpenVDB, which is slow to load") {
    for (const auto room : rooms)
        for (const fs::path& file : files_under(room, {".cpp"})) {
            const std::string path = fs::relative(file, root).string();
            if (path.starts_with("assets/bone/openvdb/") || path.starts_with("tools/bench/")) continue;
            for (const std::string& name : includes_of(file)) {
                CAPTURE(path, name);
                CHECK_FALSE(name.starts_with("openvdb/"));
            }
        }
}

TEST_CASE("rooms of tools include only what stands left of them") {
    for (std::size_t room = 0; room < tool_rooms.size(); ++room) {
        const std::string folder = "tools/" + std::string(tool_rooms[room]);
        const std::vector<fs::path> files = files_under(folder, {".cpp", ".hpp"});
        CHECK_FALSE(files.empty());
        for (const fs::path& file : files) {
            CAPTURE(file.string());
            if (file.stem() != "main")
                CHECK(read(file).find("namespace tactus::" + std::string(tool_rooms[room])) != std::string::npos);
            for (const std::string& name : includes_of(file)) {
                if (!name.starts_with("tools/")) continue;
                CAPTURE(name);
                const std::string inner = name.substr(6, name.find('/', 6) - 6);
                const auto included = std::ranges::find(tool_rooms, inner);
                if (included == tool_rooms.end()) continue;
                CHECK(static_cast<std::size_t>(included - tool_rooms.begin()) <= room);
            }
        }
    }
}

TEST_CASE("only commands read command lines and write JSON") {
    for (const std::string_view room : {"run", "analysis", "render", "report", "window"})
        for (const fs::path& file : files_under("tools/" + std::string(room), {".cpp", ".hpp"})) {
            // A run leaves its summary behind as JSON.
            if (file.filename() == "summary.cpp") continue;
            for (const std::string& name : includes_of(file)) {
                CAPTURE(file.string(), name);
                CHECK_FALSE(name.starts_with("CLI/"));
                CHECK_FALSE(name.starts_with("nlohmann/"));
            }
        }
}

TEST_CASE("studies print nothing") {
    for (const fs::path& file : files_under("tools/analysis", {".cpp", ".hpp"})) {
        const std::string text = read(file);
        CAPTURE(file.string());
        for (const std::string_view word : {"fmt::print", "stderr", "stdout", "std::cout", "std::cerr", "printf("})
            CHECK(text.find(word) == std::string::npos);
    }
}

TEST_CASE("every verb is in the catalogue, in the folder that it names") {
    const std::string catalogue = read(root / "tools/command/catalogue.cpp");
    const std::regex definition("^Verb (\\w+)_verb\\(\\)", std::regex::multiline);
    int verbs = 0;
    for (const fs::path& file : files_under("tools/command", {".cpp"})) {
        const std::string text = read(file);
        for (auto found = std::sregex_iterator(text.begin(), text.end(), definition); found != std::sregex_iterator();
             ++found, ++verbs) {
            CAPTURE(file.string(), found->str());
            const std::string line = "X(" + found->str(1) + ", " + file.parent_path().filename().string();
            CHECK((catalogue.find(line + ",") != std::string::npos || catalogue.find(line + ")") != std::string::npos));
        }
    }
    CHECK(verbs > 40);
}
