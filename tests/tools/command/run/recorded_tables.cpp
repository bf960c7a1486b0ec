// SPDX-License-Identifier: Apache-2.0
// Tables that 'record' writes, read by Python's csv module.
#include "tests/support/catch.hpp"
#include "tests/support/skip.hpp"
#include "tests/tools/run_command.hpp"

#include <nlohmann/json.hpp>

using nlohmann::json;
using tactus::test::Folder;
using tactus::test::Outcome;
using tactus::test::slurp;

namespace {

/// Records a value of each type that has columns; signals become sound files.
constexpr const char* every_type = R"(title = "Every type"
wires = [
  "hand.pose        -> ball.pose",
  "ball.wrench      -> out.wrench",
  "hand.pose        -> pose.in",
  "hand.twist       -> twist.in",
  "ball.wrench      -> wrench.in",
  "seven.value      -> number.in",
  "hand.trigger     -> bool.in",
]
[devices.simulated]
driver  = "simulated"
start_z = "60 mm"
[nodes.hand]
type = "device_input"
rate = "1 kHz"
[nodes.seven]
type = "constant"
rate = "1 kHz"
number = "7"
[nodes.ball]
type = "sphere_contact"
rate = "1 kHz"
[nodes.out]
type = "device_output"
rate = "1 kHz"
[nodes.pose]
type = "record"
rate = "1 kHz"
unit = "m"
[nodes.twist]
type = "record"
rate = "1 kHz"
unit = "m/s, rad/s"
[nodes.wrench]
type = "record"
rate = "1 kHz"
unit = "N, N m"
[nodes.number]
type = "record"
rate = "1 kHz"
unit = "mm, odd"
[nodes.bool]
type = "record"
rate = "1 kHz"
)";

constexpr const char* script = R"(
import csv, json, sys
out = {}
for name in sys.argv[2:]:
    with open(sys.argv[1] + '/' + name + '.csv', newline='') as file:
        rows = list(csv.reader(file))
    out[name] = {'names': rows[0], 'rows': len(rows) - 1, 'widths': sorted({len(row) for row in rows}),
                 'numbers': all(float(cell) == float(cell) for row in rows[1:] for cell in row)}
print(json.dumps(out))
)";

}  // namespace

TEST_CASE("Python's csv module reads the table of each value type, one name per column with its unit") {
    if (std::system("python3 -c 'import csv' 2>/dev/null") != 0) {
        tactus::test::skip("needs python3");
        return;
    }
    const Folder folder;
    const std::string out = (folder.path / "out").string();
    const Outcome rendered =
        folder.tactus("render " + folder.write("all.toml", every_type).string() + " --seconds 0.05 --out " + out);
    INFO(rendered.err);
    REQUIRE(rendered.code == 0);
    const std::string read = (folder.path / "read.json").string();
    REQUIRE(std::system(("python3 " + folder.write("read.py", script).string() + " " + out +
                         " pose twist wrench number bool >" + read)
                            .c_str()) == 0);
    const json tables = json::parse(slurp(read));
    const json wanted{{"pose", {"t_s", "px_m", "py_m", "pz_m", "qw", "qx", "qy", "qz"}},
                      {"twist", {"t_s", "vx_m/s", "vy_m/s", "vz_m/s", "wx_rad/s", "wy_rad/s", "wz_rad/s"}},
                      {"wrench", {"t_s", "fx_N", "fy_N", "fz_N", "tx_N_m", "ty_N_m", "tz_N_m"}},
                      {"number", {"t_s", "value_mm"}},
                      {"bool", {"t_s", "value"}}};
    for (const auto& [name, names] : wanted.items()) {
        const json& table = tables[name];
        CAPTURE(name, table["names"].dump());
        CHECK(table["names"] == names);
        CHECK(table["widths"] == json::array({names.size()}));
        CHECK(table["rows"] == 50);
        CHECK(table["numbers"] == true);
    }
}
